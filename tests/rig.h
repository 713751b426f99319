/* rig.h - takes a model through the public API: meshes, shadow maps, depth and colour by level (a), then tyn_render. */
#ifndef TYN_TEST_RIG_H
#define TYN_TEST_RIG_H

#include "oracle.h"

typedef struct rig {
    int32_t width, height;
    tyn_camera camera;
    tyn_light light[ORACLE_LIGHTS];
    tyn_image texture[ORACLE_LIGHTS]; /* its pixels are the model's: a textured rig is used before its model is freed */
    tyn_medium medium[ORACLE_MEDIA];
    int32_t lights, media, meshes;
    tyn_mesh *mesh;
    float *positions;
    tyn_shadow face[ORACLE_LIGHTS][6]; /* of point lights; the first is the light's own */
    float *map[ORACLE_LIGHTS];         /* of a point light: six */
    float bounds_min[3], bounds_max[3];
    float *depth, *colour, *scatter; /* width * height (* 3), without gaps */
    uint8_t *target;                 /* RGBA8 */
    int32_t shadow_size;
    tyn_stats stats; /* of the last render */
} rig;

/* Everything that tyn_render needs of the model, shadow maps of shadow_size texels. NULL, with a line on stdout, where a call
 * of the library failed. Point lights are not for it. */
rig *rig_new(const oracle_scene *scene, int32_t shadow_size);
void rig_free(rig *r);

/* A rig of a stock model; ends the tests where there is none. */
rig *rig_stock(const char *name, int width, int height, int32_t shadow_size);

/* Every method, ways of rays, lines and reconstruction, for tests that hold for all. The last has no scattered light. */
typedef struct rig_way {
    const char *name;
    tyn_method method;
    tyn_rays rays;
    tyn_gather gather;
    int32_t downscale;
} rig_way;
enum { RIG_WAYS = 9 };
extern const rig_way rig_ways[RIG_WAYS];

/* What a config must have room for: shadow size, lights, maps of a light, textures. */
void rig_fill(const rig *r, tyn_config *config);

/* A config of the rig's size and lights with the method; the rest is left 0. */
tyn_config rig_config(const rig *r, tyn_method method, tyn_rays rays);

tyn_config rig_way_config(const rig *r, const rig_way *way);

/* A frame that reads and writes the rig's buffers; exposure 1, film. */
tyn_frame rig_frame(rig *r);

/* A context in memory of its own; NULL on failure. Give it to free(). */
tyn_context *rig_context(const tyn_config *config);

/* Renders the frame with a fresh context. */
tyn_status rig_render(rig *r, const tyn_config *config, const tyn_frame *frame);

/* A block aligned to TYN_ALIGNMENT, for free(). */
void *rig_block(size_t bytes);

/* Relative L1 of a to b; their largest difference in parts of b's largest number; PSNR of 8-bit pictures (alpha left out). */
double rig_l1(const float *a, const float *b, size_t count);
double rig_worst(const float *a, const float *b, size_t count);
double rig_psnr(const uint8_t *a, const uint8_t *b, size_t pixels);

/* FNV-1a, 64 bits. Of floats, their bytes from the lowest up, whatever the machine's order. */
uint64_t rig_hash(const void *data, size_t size);
uint64_t rig_hash_floats(const float *x, size_t count);

/* The largest number of a depth format. */
double rig_levels(tyn_format format);

#endif
