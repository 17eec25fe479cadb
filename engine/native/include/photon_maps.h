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

/* Exported symbols; all others are hidden. */
#if defined(_WIN32)
#define PM_API __declspec(dllexport)
#else
#define PM_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

enum { PM_ABI_VERSION = 2 };

typedef enum pm_status {
    PM_OK = 0,
    PM_INVALID_ARGUMENT = 1,  /* a null handle, a wrong struct_size, an array that fails its checks */
    PM_INVALID_OPERATION = 2, /* a call out of order, such as changing a scene that is rendered */
    PM_OUT_OF_MEMORY = 3,
    PM_CANCELLED = 4,    /* pm_render_cancel was called; the unfinished pass left no trace */
    PM_EMBREE_ERROR = 5, /* Embree is missing, of another version, or failed */
    PM_INTERNAL_ERROR = 6
} pm_status;

typedef enum pm_light_type {
    PM_LIGHT_POINT = 0,     /* sphere of radius size[0]; power in W */
    PM_LIGHT_SUN = 1,       /* disk of the angle size[0] (radians, full); power is irradiance in W/m2 */
    PM_LIGHT_SPOT = 2,      /* as a point, times a cone that fades; power is that of the whole sphere in W */
    PM_LIGHT_RECTANGLE = 3, /* full sides size[0], size[1]; one-sided; power in W */
    PM_LIGHT_ELLIPSE = 4    /* full diameters size[0], size[1]; one-sided; power in W */
} pm_light_type;

typedef enum pm_camera_type {
    PM_CAMERA_PERSPECTIVE = 0,
    PM_CAMERA_ORTHOGRAPHIC = 1,
    PM_CAMERA_EQUIRECTANGULAR = 2 /* the window counts in radians: longitude from -z to the right, latitude upwards */
} pm_camera_type;

typedef enum pm_integrator { PM_PHOTON_MAP = 0, PM_PATH_TRACING = 1 } pm_integrator;

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
    PM_PASS_COUNT = 11
} pm_pass;

/* How a ray came about: a bit 1 << pm_ray each, for what objects and lights are visible to. */
typedef enum pm_ray {
    PM_RAY_CAMERA = 0,
    PM_RAY_DIFFUSE = 1,
    PM_RAY_GLOSSY = 2,
    PM_RAY_TRANSMISSION = 3,
    PM_RAY_SHADOW = 4,
    PM_RAY_COUNT = 5
} pm_ray;

/* Which photons: by the bounces before the hit they record. */
typedef enum pm_photon_kind {
    PM_PHOTONS_DIRECT = 0,   /* straight from a light */
    PM_PHOTONS_INDIRECT = 1, /* after one diffuse bounce or more */
    PM_PHOTONS_CAUSTIC = 2   /* after specular bounces only, one or more */
} pm_photon_kind;

typedef struct pm_device pm_device; /* the loaded Embree */
typedef struct pm_scene pm_scene;   /* triangles, instances, materials, lights, world */
typedef struct pm_render pm_render; /* one picture of a scene */

/* Values that vary over a mesh: UV maps, colours, and so on. */
typedef struct pm_attribute {
    uint32_t struct_size;
    uint32_t id;       /* chosen by the caller; what PM_OP_ATTRIBUTE asks for. No mesh has two of one id */
    uint32_t domain;   /* pm_domain */
    uint32_t channels; /* 1 to 4; one is repeated to three, two are followed by a zero, the fourth is alpha (else 1) */
    const float *values; /* by the domain: triangle_count x 3, vertex_count or triangle_count, times channels */
} pm_attribute;

typedef enum pm_domain { PM_DOMAIN_CORNER = 0, PM_DOMAIN_VERTEX = 1, PM_DOMAIN_FACE = 2 } pm_domain;

typedef struct pm_mesh {
    uint32_t struct_size;
    uint32_t attribute_count;
    uint64_t vertex_count;
    uint64_t triangle_count;
    const float *vertices;       /* vertex_count x 3 */
    const uint32_t *triangles;   /* triangle_count x 3 vertex indices */
    const uint32_t *slots;       /* triangle_count material slots, or null: all 0 */
    const float *corner_normals; /* triangle_count x 3 x 3 shading normals, or null: flat */
    const pm_attribute *attributes;
} pm_mesh;

typedef struct pm_instances {
    uint32_t struct_size;
    uint32_t reserved;
    uint64_t count;
    uint64_t slot_material_count;
    const uint32_t *meshes;         /* count indices from pm_scene_add_mesh */
    const float *transforms;        /* count x 12, object to world */
    const uint32_t *first_slots;    /* count: where each instance's slots begin in slot_materials */
    const uint32_t *slot_materials; /* material of triangle t: slot_materials[first_slots[i] + slots[t]] */
    const uint32_t *visibility;     /* count x bits 1 << pm_ray, or null: visible to all */
    const float *properties;        /* count x 6: RGBA colour, index and random number of the object; or null: 0 */
} pm_instances;

/* One step of a material's shader. Registers hold three floats; a number is the same three times. */
typedef struct pm_instruction {
    uint32_t op;             /* pm_op, see photon_maps_shader.h */
    uint32_t option;         /* the op's own */
    uint32_t shift;          /* inputs: 0 at the point itself, 1 or 2 a step along the surface, for bump mapping */
    uint32_t output;         /* first register written; not written before */
    uint32_t first_argument; /* into pm_material.arguments */
    uint32_t argument_count;
} pm_instruction;

/* A shader: a flat program that ends in closures and emission (radiance). */
typedef struct pm_material {
    uint32_t struct_size;
    uint32_t index; /* Blender's pass index of the material */
    uint64_t constant_count;
    uint64_t instruction_count;
    uint64_t argument_count;
    const float *constants; /* constant_count x 3: registers 0 ... constant_count - 1 */
    const pm_instruction *instructions;
    const uint32_t *arguments; /* registers, written before */
} pm_material;

typedef enum pm_pixel_type { PM_PIXEL_UINT8 = 0, PM_PIXEL_FLOAT16 = 1, PM_PIXEL_FLOAT32 = 2 } pm_pixel_type;

/* A raster image, rows from the bottom. */
typedef struct pm_image {
    uint32_t struct_size;
    uint32_t type; /* pm_pixel_type */
    uint32_t width;
    uint32_t height;
    uint32_t channels; /* 1 (grey), 3 or 4 */
    uint32_t reserved;
    const void *pixels;  /* height x width x channels */
    const float *decode; /* uint8: 256 linear values for R, G, B (alpha is value / 255); else null */
} pm_image;

typedef enum pm_interpolation {
    PM_INTERPOLATION_LINEAR = 0,
    PM_INTERPOLATION_CLOSEST = 1,
    PM_INTERPOLATION_CUBIC = 2
} pm_interpolation;

typedef enum pm_extension {
    PM_EXTENSION_REPEAT = 0,
    PM_EXTENSION_EXTEND = 1,
    PM_EXTENSION_CLIP = 2,
    PM_EXTENSION_MIRROR = 3
} pm_extension;

typedef enum pm_projection {
    PM_PROJECTION_FLAT = 0,
    PM_PROJECTION_BOX = 1,
    PM_PROJECTION_SPHERE = 2,
    PM_PROJECTION_TUBE = 3,
    PM_PROJECTION_EQUIRECTANGULAR = 4, /* by a direction, for worlds */
    PM_PROJECTION_MIRROR_BALL = 5
} pm_projection;

typedef enum pm_alpha {
    PM_ALPHA_STRAIGHT = 0,      /* colour is not multiplied by alpha in the image, and comes out so */
    PM_ALPHA_PREMULTIPLIED = 1, /* colour is multiplied in the image, and is divided */
    PM_ALPHA_IGNORED = 2        /* alpha comes out as 1 */
} pm_alpha;

/* How images are looked up. */
typedef struct pm_texture {
    uint32_t struct_size;
    uint32_t interpolation; /* pm_interpolation */
    uint32_t extension;     /* pm_extension */
    uint32_t projection;    /* pm_projection */
    uint32_t alpha;         /* pm_alpha */
    float blend;            /* box projection: 0 to 1 */
    uint64_t tile_count;    /* 1, or the number of UDIM tiles */
    const uint32_t *images; /* tile_count images */
    const uint32_t *tiles;  /* UDIM numbers from 1001 on, or null: one image without tiles */
} pm_texture;

/* A function of a number from 0 to 1: colour ramps and curves. */
typedef struct pm_table {
    uint32_t struct_size;
    uint32_t is_stepped;  /* 1: no interpolation between entries */
    uint64_t entry_count; /* at least 1 */
    const float *entries; /* entry_count x 4: RGB and alpha */
} pm_table;

typedef struct pm_light {
    uint32_t struct_size;
    uint32_t type;         /* pm_light_type */
    uint32_t visibility;   /* bits 1 << pm_ray; PM_RAY_SHADOW has no meaning */
    uint32_t soft_falloff; /* point, spot: 1 scales by d2/(d2+r2), Blender's Soft Falloff */
    float transform[12];   /* light to world; lights shine along their local -z */
    float power[3];
    float size[2];
    float spot_angle; /* full angle in radians */
    float spot_blend; /* 0 to 1: share of the cone that fades */
    float spread;     /* area lights: full angle in radians, pi is all of the hemisphere */
} pm_light;

typedef struct pm_camera {
    uint32_t struct_size;
    uint32_t type;          /* pm_camera_type */
    float transform[12];    /* camera to world, rigid; the camera looks along its local -z, y up */
    float window[4];        /* left, right, bottom, top of the whole frame on the plane z = -1
                               (perspective), in scene units (orthographic) or in radians */
    uint32_t resolution[2]; /* of the whole frame */
    uint32_t region[4];     /* x, y, width, height of what is rendered; y counts from the bottom */
    float clip_start;       /* along the view direction; equirectangular: distance */
    float clip_end;
    float aperture_radius;    /* of the lens, in scene units; 0: all is in focus */
    float focus_distance;     /* along the view direction; equirectangular: distance */
    float aperture_rotation;  /* radians */
    float aperture_ratio;     /* above 0: of width to height is 1 / ratio, as Blender's anamorphic bokeh */
    uint32_t aperture_blades; /* fewer than 3: round */
    uint32_t reserved;
} pm_camera;

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
    uint32_t threads; /* 0: one for every core */
    uint32_t passes;  /* bit 1 << pm_pass for each pass that will be read */
} pm_settings;

typedef struct pm_statistics {
    uint32_t struct_size;
    uint32_t passes;       /* finished */
    uint64_t photon_count; /* emitted per pass, as chosen */
    uint64_t photons_emitted;
    uint64_t photons_stored;
    uint64_t rays;
    uint64_t memory_bytes; /* held by scene, maps and film at their peak */
    float radius_first;    /* of the earliest and the latest pass rendered; 0 without photons */
    float radius_last;
    uint64_t caustic_photons; /* stored, part of photons_stored */
    float caustic_radius_first;
    float caustic_radius_last;
    uint32_t caster_count; /* objects that can focus light; 0: no caustic photon is traced */
    uint32_t reserved;
    double emitted[3]; /* W, mean over the passes: emitted = absorbed + escaped + cut */
    double absorbed[3];
    double escaped[3];
    double cut[3];        /* carried by photons that reached max_bounces */
    double seconds_trace; /* wall time by phase */
    double seconds_build;
    double seconds_gather;
} pm_statistics;

typedef struct pm_photon {
    float position[3];
    float direction[3]; /* of travel, towards the surface */
    float normal[3];    /* of the surface, on the side that was hit */
    float flux[3];      /* W */
    uint32_t bounce;    /* bounces before this hit, 255 at most */
} pm_photon;

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
/* Sets the materials, after the textures and tables that they name and before the instances. */
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
/* Renders pass `index`, a function of scene, camera, settings and index alone, and adds it to the picture. */
PM_API pm_status pm_render_pass(pm_render *render, uint32_t index);
/* Makes the running pass, or the next one if none runs, return PM_CANCELLED within 100 ms; the one after that starts
 * afresh. */
PM_API pm_status pm_render_cancel(pm_render *render);
/* Gets a pass (pm_pass) as rows from the bottom, width x height x channels floats; count is their number. */
PM_API pm_status pm_render_read(const pm_render *render, uint32_t pass, float *pixels, uint64_t count);
PM_API pm_status pm_render_statistics(const pm_render *render, pm_statistics *statistics);
/* Counts the photons of a kind (pm_photon_kind) that the last pass stored. */
PM_API pm_status pm_render_photon_count(const pm_render *render, uint32_t kind, uint64_t *count);
/* Gets `count` photons of a kind from number `first` on, in the order of their emission. */
PM_API pm_status pm_render_photons(const pm_render *render, uint32_t kind, uint64_t first, uint64_t count,
                                   pm_photon *photons);
/* Estimates the irradiance (W/m2) that photons of a kind of the last pass bring to `count` points with unit
 * normals, at the radius and filter of that pass (the seed report's equation 4). */
PM_API pm_status pm_render_irradiance(const pm_render *render, uint32_t kind, uint64_t count, const float *points,
                                      const float *normals, float *irradiance);
/* Releases a render; null is ignored. */
PM_API void pm_render_release(pm_render *render);

#ifdef __cplusplus
}
#endif
