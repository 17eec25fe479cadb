/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * What a scene is made of, for the C interface (photon_maps.h has the functions and the units): arrays of the caller,
 * which are copied. struct_size is sizeof of the structure as the caller was compiled. */
#pragma once

#include <stdint.h>

/* How a ray came about: a bit 1 << pm_ray each, for what objects and lights are visible to. */
typedef enum pm_ray {
    PM_RAY_CAMERA = 0,
    PM_RAY_DIFFUSE = 1,
    PM_RAY_GLOSSY = 2,
    PM_RAY_TRANSMISSION = 3,
    PM_RAY_SHADOW = 4,
    PM_RAY_COUNT = 5
} pm_ray;

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

typedef enum pm_light_type {
    PM_LIGHT_POINT = 0,     /* sphere of radius size[0]; power in W */
    PM_LIGHT_SUN = 1,       /* disk of the angle size[0] (radians, full); power is irradiance in W/m2 */
    PM_LIGHT_SPOT = 2,      /* as a point, times a cone that fades; power is that of the whole sphere in W */
    PM_LIGHT_RECTANGLE = 3, /* full sides size[0], size[1]; one-sided; power in W */
    PM_LIGHT_ELLIPSE = 4    /* full diameters size[0], size[1]; one-sided; power in W */
} pm_light_type;

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

typedef enum pm_camera_type {
    PM_CAMERA_PERSPECTIVE = 0,
    PM_CAMERA_ORTHOGRAPHIC = 1,
    PM_CAMERA_EQUIRECTANGULAR = 2 /* the window counts in radians: longitude from -z to the right, latitude upwards */
} pm_camera_type;

typedef struct pm_camera {
    uint32_t struct_size;
    uint32_t type;          /* pm_camera_type */
    float transform[12];    /* camera to world, rigid; the camera looks along its local -z, y up */
    float window[4];        /* left, right, bottom, top of the whole frame on the plane z = -1
                               (perspective), in scene units (orthographic) or in radians */
    uint32_t resolution[2]; /* of the whole frame */
    uint32_t region[4];     /* x, y of the first pixel that is rendered, and how many across and up; y counts from the
                               bottom */
    float clip_start;       /* along the view direction; equirectangular: distance */
    float clip_end;
    float aperture_radius;    /* of the lens, in scene units; 0: all is in focus */
    float focus_distance;     /* along the view direction; equirectangular: distance */
    float aperture_rotation;  /* radians */
    float aperture_ratio;     /* above 0: of width to height is 1 / ratio, as Blender's anamorphic bokeh */
    uint32_t aperture_blades; /* fewer than 3: round */
    uint32_t stride;          /* >= 1: the region is a sample of the frame, one pixel of each stride x stride */
} pm_camera;
