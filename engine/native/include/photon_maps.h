/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The C interface of the Photon Maps helper: plain arrays in, radiance out.
 *
 * Units are radiometric: lengths in scene units (metres), flux in watts, radiance in W/(m2 sr), linear RGB.
 * Matrices are 3x4, row-major, column vectors: world = M * (x, y, z, 1).
 *
 * Every function returns a pm_status; on failure pm_last_error() of the same thread says what was wrong.
 * Nothing throws or aborts. All input arrays are validated and copied: none is read after the call returns.
 * Handles may be used from any thread, by one thread at a time; only pm_render_cancel may be called
 * while another call on the same handle is running.
 */
#pragma once

#include <stdint.h>

#include "photon_maps_scene.h"

/* Exported symbols; all others are hidden. */
#if defined(_WIN32)
#define PM_API __declspec(dllexport)
#else
#define PM_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

enum { PM_ABI_VERSION = 8 };

typedef enum pm_status {
    PM_OK = 0,
    PM_INVALID_ARGUMENT = 1,  /* a null handle, a wrong struct_size, an array that fails its checks */
    PM_INVALID_OPERATION = 2, /* a call out of order, such as changing a scene that is rendered */
    PM_OUT_OF_MEMORY = 3,
    PM_CANCELLED = 4,    /* pm_render_cancel was called; the unfinished pass left no trace */
    PM_EMBREE_ERROR = 5, /* Embree is missing, of another version, or failed */
    PM_INTERNAL_ERROR = 6
} pm_status;

typedef enum pm_integrator {
    PM_PHOTON_MAP = 0,
    PM_PATH_TRACING = 1,
    PM_REGULAR_SHADING = 2 /* the lights at what is seen directly, in mirrors and through glass; nothing else */
} pm_integrator;

/* Which photons are counted around a point. */
typedef enum pm_estimate {
    PM_ESTIMATE_RADIUS = 0,
    PM_ESTIMATE_NEAREST = 1, /* nearest_count of them, or those within the radius where they are fewer */
    /* Caustics by eight radii that halve in area, of which the radius is the largest: when the picture is read every
     * pixel takes the largest that agrees with the smaller ones in the mean over all passes. No choice is fed back into
     * what is traced, so none brightens the picture. PM_PASS_PHOTON_DENSITY, pm_render_irradiance and surfaces that a
     * final gather meets go by the largest; surfaces scatter each photon, whatever brdf_direction says. Indirect light
     * is so smooth that the choice does not pay: as PM_ESTIMATE_RADIUS. */
    PM_ESTIMATE_ADAPTIVE = 2
} pm_estimate;

/* By which direction a surface that is not Lambertian scatters photons. */
typedef enum pm_brdf_direction { PM_BRDF_PER_PHOTON = 0, PM_BRDF_MEAN = 1 } pm_brdf_direction;

/* What brings the light of diffuse bounces to what the eye sees. */
typedef enum pm_indirect {
    PM_INDIRECT_PHOTONS = 0,  /* the global map */
    PM_INDIRECT_GATHER = 1,   /* a final gather: rays, which ask the global map where they end */
    PM_INDIRECT_PATHS = 2,    /* rays that go on as in path tracing; caustics are still the photons' */
    PM_INDIRECT_ALL_PATHS = 3 /* rays that go on as in path tracing, and find caustics, too */
} pm_indirect;

typedef enum pm_filter {
    PM_FILTER_NONE = 0,
    PM_FILTER_CONE = 1, /* Jensen 1996, with the constant cone_k >= 1 */
    PM_FILTER_GAUSSIAN = 2,
    PM_FILTER_EPANECHNIKOV = 3
} pm_filter;

typedef enum pm_pixel_filter { PM_PIXEL_BOX = 0, PM_PIXEL_GAUSSIAN = 1, PM_PIXEL_BLACKMAN_HARRIS = 2 } pm_pixel_filter;

/* What can be read back; each is the mean over the finished passes. */
typedef enum pm_pass {
    PM_PASS_COMBINED = 0, /* 4 channels: RGB premultiplied by alpha, alpha */
    PM_PASS_DEPTH = 1,    /* 1 channel: distance along the view direction; 1e10 where nothing is hit */
    PM_PASS_NORMAL = 2,   /* 3 channels: shading normal in world space */
    PM_PASS_POSITION = 3, /* 3 channels */
    PM_PASS_ALBEDO = 4,   /* 3 channels */
    PM_PASS_EMISSION = 5, /* 3 channels: light of surfaces and lamps seen directly */
    PM_PASS_DIRECT = 6,   /* 3 channels: one scattering between light and eye */
    PM_PASS_INDIRECT = 7, /* 3 channels: two scatterings or more that are no caustic */
    PM_PASS_CAUSTIC =
        8, /* 3 channels: specular scatterings, then a diffuse one, and specular ones to the eye (LS+DS*E) */
    PM_PASS_BACKGROUND = 9,      /* 3 channels: light of the world seen directly */
    PM_PASS_PHOTON_DENSITY = 10, /* 1 channel: photons per unit of area that the estimates of the pixel counted */
    PM_PASS_SPECULAR = 11,       /* 3 channels: of PM_PASS_INDIRECT what reaches the eye by a specular scattering */
    PM_PASS_SOFT_INDIRECT = 12,  /* 3 channels: the rest of PM_PASS_INDIRECT */
    PM_PASS_ERROR = 13,          /* 1 channel: relative standard error of the pixel, estimated from the passes */
    PM_PASS_COUNT = 14
} pm_pass;

/* Which photons: by the bounces before the hit they record. */
typedef enum pm_photon_kind {
    PM_PHOTONS_DIRECT = 0,   /* straight from a light */
    PM_PHOTONS_INDIRECT = 1, /* after one diffuse bounce or more */
    PM_PHOTONS_CAUSTIC = 2,  /* after specular bounces only, one or more */
    PM_PHOTONS_SHADOW = 3    /* where a light's shadow lies, with use_shadow_photons; only a snapshot tells them */
} pm_photon_kind;

/* What sent a photon out: the index of a lamp; that of an instance that shines, with PM_SOURCE_INSTANCE added; or the
 * world. */
enum { PM_SOURCE_INSTANCE = 0x40000000, PM_SOURCE_WORLD = 0x7fffffff };

typedef struct pm_device pm_device;     /* the loaded Embree */
typedef struct pm_scene pm_scene;       /* triangles, instances, materials, lights, world: photon_maps_scene.h */
typedef struct pm_render pm_render;     /* one picture of a scene */
typedef struct pm_snapshot pm_snapshot; /* the photons of one pass, and what they came from */

typedef struct pm_settings {
    uint32_t struct_size;
    uint32_t integrator;   /* pm_integrator */
    uint64_t photon_count; /* emitted per pass; 0: chosen from the picture's pixels */
    float radius;          /* of the first pass, in scene units; 0: chosen from the density of pilot photons */
    uint32_t filter;       /* pm_filter */
    float cone_k;          /* >= 1 */
    uint32_t max_bounces;  /* scatterings of light beyond the first; 0: direct light only */
    uint32_t use_caustics; /* 1: light focused by glass and metal, in a map of its own */
    uint32_t use_indirect; /* 1: light after diffuse bounces */
    uint32_t seed;
    uint32_t use_progressive; /* 1: the radius shrinks with the pass index (Knaus and Zwicker 2011) */
    uint32_t pixel_filter;    /* pm_pixel_filter */
    float pixel_filter_width; /* full width in pixels */
    uint32_t film_transparent;
    uint32_t threads;            /* 0: one for every core */
    uint32_t passes;             /* bit 1 << pm_pass for each pass that will be read */
    uint32_t estimate;           /* pm_estimate */
    uint32_t nearest_count;      /* PM_ESTIMATE_NEAREST: >= 1 */
    uint32_t brdf_direction;     /* pm_brdf_direction */
    uint32_t use_final_gather;   /* 1: indirect light by rays from what is seen; photons are asked where those end */
    uint32_t use_shadow_photons; /* 1: no shadow rays where only lit, or only shadow photons of a light lie */
    uint32_t use_photon_guiding; /* 1: diffuse rays go where photons came from */
    uint32_t keep_photons; /* 1: the last pass's photons can be asked for, and light straight from lights is stored */
    float stop_error;      /* >= 0; above: parts of the picture that are far below this relative error get no further
                                samples, which needs PM_PASS_ERROR */
    uint32_t use_auto; /* 1: with photon_count and radius 0, both follow from pilot passes: from what noise, blur and
                          cost those have in each map, and from the error that the picture is made for */
    uint32_t light_samples; /* of each light, or choices among many, where a camera's path asks the photons; 0: 1, or
                               with use_auto what pilot passes tell */
    uint64_t memory_limit; /* bytes that scene, picture and photons may take; 0: nine tenths of the machine's. Where the
                              photons of a pass would take more, fewer are emitted; where the picture would,
                              pm_render_create returns PM_OUT_OF_MEMORY */
} pm_settings;

typedef struct pm_statistics {
    uint32_t struct_size;
    uint32_t passes;       /* finished */
    uint64_t photon_count; /* emitted per pass for the global map, as chosen */
    uint64_t photons_emitted;
    uint64_t photons_stored;
    uint64_t rays;
    uint64_t memory_bytes; /* held by scene, maps and film at their peak */
    float radius_first;    /* of the earliest and the latest pass rendered; 0 without photons */
    float radius_last;
    uint64_t caustic_photons; /* stored, part of photons_stored */
    float caustic_radius_first;
    float caustic_radius_last;
    uint32_t caster_count;       /* objects that can focus light; 0: no caustic photon is traced */
    uint32_t indirect;           /* pm_indirect: as set, or with use_auto as chosen */
    uint64_t shadow_rays;        /* traced by the camera's paths */
    uint64_t spared_shadow_rays; /* whose answer shadow photons knew */
    double emitted[3];           /* W, mean over the passes: emitted = absorbed + escaped + cut */
    double absorbed[3];
    double escaped[3];
    double cut[3];        /* carried by photons that reached max_bounces */
    double seconds_trace; /* wall time by phase */
    double seconds_build;
    double seconds_gather;
    float error; /* estimated relative error of the picture, noise and blur together; infinite without PM_PASS_ERROR and
                    before the second pass */
    float noise; /* part of it that varies from pass to pass */
    float blur;  /* part of it by the width of the kernels */
    uint64_t caustic_photon_count; /* emitted per pass for the caustic map, as chosen */
    /* Relative standard deviation of a pass as pilot passes saw it, by what photons do not carry and by those of either
     * map, as many as a pass emits; 0 without use_auto. */
    float pilot_camera_noise;
    float pilot_global_noise;
    float pilot_caustic_noise;
    float done;                   /* share of the picture that gets no further samples */
    uint32_t light_samples;       /* as set or chosen */
    uint64_t photons_stored_last; /* by the latest pass */
    uint32_t is_limited;          /* 1: passes emit fewer photons than asked for or planned, for the memory_limit */
} pm_statistics;

typedef struct pm_photon {
    float position[3];
    float direction[3]; /* of travel, towards the surface */
    float normal[3];    /* of the surface, on the side that was hit */
    float flux[3];      /* W */
    uint32_t bounce;    /* bounces before this hit, 255 at most */
} pm_photon;

/* A photon with what it came from. Of PM_PHOTONS_SHADOW position, source and instance are known; the rest is 0. */
typedef struct pm_traced_photon {
    pm_photon photon;
    uint32_t source;   /* the light: see PM_SOURCE_WORLD */
    uint32_t instance; /* that it landed on */
    uint32_t number;   /* among the photons that its pass emitted for the map of its kind */
} pm_traced_photon;

/* A photon's way from one place to the next. */
typedef struct pm_photon_segment {
    float start[3];
    float end[3];
    float flux[3];   /* W */
    uint32_t bounce; /* bounces before `start` */
    uint32_t source;
    uint32_t number;
} pm_photon_segment;

/* What of a light's photons met an instance, whether or not its materials keep photons. */
typedef struct pm_received {
    uint32_t instance;
    uint32_t source;
    uint32_t is_caustic; /* 1: of the photons that are aimed at what can focus light, and end at their first diffuse
                            scattering; 0: of those for the global map */
    uint32_t reserved;
    uint64_t arrived; /* photons that met it */
    uint64_t stored;  /* those that were stored there */
    double flux[3];   /* W, of those that met it */
} pm_received;

/* What a map's estimate is made from. */
typedef struct pm_map_probe {
    float radius; /* of the disc; 0 without a map */
    uint32_t photons;
    float irradiance[3];     /* W/m2, at PM_ESTIMATE_ADAPTIVE by the largest radius */
    float standard_error[3]; /* W/m2, as if photons fell independently of each other */
} pm_map_probe;

typedef struct pm_probe {
    uint32_t struct_size;
    uint32_t is_hit;        /* 0: the ray meets nothing, and the rest is 0 */
    uint32_t keeps_photons; /* 0: the surface scatters nothing diffusely, so that no map is asked */
    uint32_t instance;
    float position[3];
    float normal[3]; /* geometric, on the side that is seen */
    pm_map_probe global_map;
    pm_map_probe caustic_map;
} pm_probe;

/* Returns PM_ABI_VERSION as compiled; a caller built for another one must not go on. */
PM_API uint32_t pm_abi_version(void);

/* Returns what was wrong in the last failed call of this thread, in UTF-8; never null. */
PM_API const char *pm_last_error(void);

/* Loads the Embree 4 library at a full path (UTF-8) and checks its version. */
PM_API pm_status pm_device_create(const char *embree_path, pm_device **device);
/* Gets Embree's version as major * 10000 + minor * 100 + patch. */
PM_API pm_status pm_device_embree_version(const pm_device *device, uint32_t *version);
/* Releases a device after all of its scenes; null is ignored. */
PM_API void pm_device_release(pm_device *device);

/* Creates an empty scene. */
PM_API pm_status pm_scene_create(pm_device *device, pm_scene **scene);
/* Adds a mesh; its index counts up from 0. */
PM_API pm_status pm_scene_add_mesh(pm_scene *scene, const pm_mesh *mesh, uint32_t *index);
/* Sets where which mesh stands and of what it is made. */
PM_API pm_status pm_scene_set_instances(pm_scene *scene, const pm_instances *instances);
/* Adds an image, a texture of images added before, or a table; indices count up from 0. */
PM_API pm_status pm_scene_add_image(pm_scene *scene, const pm_image *image, uint32_t *index);
PM_API pm_status pm_scene_add_texture(pm_scene *scene, const pm_texture *texture, uint32_t *index);
PM_API pm_status pm_scene_add_table(pm_scene *scene, const pm_table *table, uint32_t *index);
/* Sets the materials, after the textures and tables that they name and before the instances and the world. */
PM_API pm_status pm_scene_set_materials(pm_scene *scene, const pm_material *materials, uint64_t count);
PM_API pm_status pm_scene_set_lights(pm_scene *scene, const pm_light *lights, uint64_t count);
/* Sets the material whose emission arrives from everywhere outside the scene, by direction (positions are the
 * direction, PM_INPUT_INCOMING and normals its opposite), and what it is visible to (bits 1 << pm_ray). Without a call:
 * black. */
PM_API pm_status pm_scene_set_world(pm_scene *scene, uint32_t material, uint32_t visibility);
/* Releases a scene after all of its renders; null is ignored. */
PM_API void pm_scene_release(pm_scene *scene);

/* Prepares a picture of a scene, which from now on does not change. The first pass of its first render builds the
 * acceleration structure. */
PM_API pm_status pm_render_create(pm_scene *scene, const pm_camera *camera, const pm_settings *settings,
                                  pm_render **render);
/* Begins another picture of the scene, seen by another camera and of another size if it has one: nothing of the one
 * before is left. Photon counts and radii stay those chosen for the first camera, and so does the view that shaders
 * ask for (PM_INPUT_CAMERA_POSITION, PM_INPUT_WINDOW). */
PM_API pm_status pm_render_set_camera(pm_render *render, const pm_camera *camera);
/* Keeps the photon maps of the earliest passes in so many bytes at most, and a quarter of the memory_limit, so that
 * pictures after pm_render_set_camera() need not trace them again; without a call none is kept. */
PM_API pm_status pm_render_keep_maps(pm_render *render, uint64_t bytes);
/* Renders pass `index`, a function of scene, camera, settings and index alone, and adds it to the picture. Where memory
 * ran out the picture is whole, too; whether it has this pass is told by the passes of pm_statistics. */
PM_API pm_status pm_render_pass(pm_render *render, uint32_t index);
/* Makes the running pass, or the next one if none runs, return PM_CANCELLED within 100 ms; the one after that starts
 * afresh. */
PM_API pm_status pm_render_cancel(pm_render *render);
/* Gets a pass (pm_pass) as rows from the bottom, width x height x channels floats; count is their number. */
PM_API pm_status pm_render_read(const pm_render *render, uint32_t pass, float *pixels, uint64_t count);
PM_API pm_status pm_render_statistics(const pm_render *render, pm_statistics *statistics);
/* Counts the photons of a kind (pm_photon_kind) that the last pass stored; needs keep_photons, as the next two do. */
PM_API pm_status pm_render_photon_count(const pm_render *render, uint32_t kind, uint64_t *count);
/* Gets `count` photons of a kind from number `first` on, in the order of their emission. */
PM_API pm_status pm_render_photons(const pm_render *render, uint32_t kind, uint64_t first, uint64_t count,
                                   pm_photon *photons);
/* Estimates the irradiance (W/m2) that photons of a kind of the last pass bring to `count` points with unit
 * normals, at the radius, estimate and filter of that pass (the seed report's equation 4). */
PM_API pm_status pm_render_irradiance(const pm_render *render, uint32_t kind, uint64_t count, const float *points,
                                      const float *normals, float *irradiance);
/* Traces the photons of pass `index` again, at least one pass having been rendered, with what they came from. What the
 * maps of a render need is kept as small as can be; photons are a function of scene, settings and index. A snapshot
 * does not depend on the render, keeps its scene in memory, and may be asked by any number of threads.
 * pm_render_cancel makes it return PM_CANCELLED. */
PM_API pm_status pm_snapshot_create(pm_render *render, uint32_t index, pm_snapshot **snapshot);
/* Counts the photons of a kind; of all kinds but PM_PHOTONS_SHADOW together there are photons_stored_last of the
 * pass. */
PM_API pm_status pm_snapshot_count(const pm_snapshot *snapshot, uint32_t kind, uint64_t *count);
/* Gets `count` photons of a kind from number `first` on, in the order of their emission. The first ones are a fair
 * sample of all: photons follow a low-discrepancy sequence. */
PM_API pm_status pm_snapshot_photons(const pm_snapshot *snapshot, uint32_t kind, uint64_t first, uint64_t count,
                                     pm_traced_photon *photons);
/* Gets the ways of `count` photons of the global or the caustic map, by their numbers: up to `capacity` segments, those
 * of a photon in their order; segment_count is what there are. */
PM_API pm_status pm_snapshot_segments(const pm_snapshot *snapshot, uint32_t is_caustic, const uint32_t *numbers,
                                      uint64_t count, pm_photon_segment *segments, uint64_t capacity,
                                      uint64_t *segment_count);
/* Gets what instances received of each light: up to `capacity` rows; row_count is what there are. */
PM_API pm_status pm_snapshot_received(const pm_snapshot *snapshot, pm_received *rows, uint64_t capacity,
                                      uint64_t *row_count);
/* Finds the first surface along a ray, with a unit direction, that the camera sees and that hides most of what lies
 * behind it, and estimates the irradiance there as the pass did. */
PM_API pm_status pm_snapshot_probe(const pm_snapshot *snapshot, const float *origin, const float *direction,
                                   pm_probe *probe);
/* Releases a snapshot; null is ignored. */
PM_API void pm_snapshot_release(pm_snapshot *snapshot);
/* Releases a render; null is ignored. */
PM_API void pm_render_release(pm_render *render);

#ifdef __cplusplus
}
#endif
