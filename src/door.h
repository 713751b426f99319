/* door.h - formats at the door: scene depth and shadow maps as others store them. Inside there is one convention: view-space
 * depth in metres, 0 .. far, and map depth that falls with the distance from the light. */
#ifndef TYNI_DOOR_H
#define TYNI_DOOR_H

#include "base.h"
#include "vec.h"

/* A depth image and how to read it. */
typedef struct tyni_door {
    const tyn_image *image;
    ptrdiff_t stride;
    int plain; /* float metres along the forward axis: rows are read where they lie, and whoever reads them clamps */
    tyn_depth_kind kind;
    float scale;           /* metres of a stored 1 */
    float end, step, base; /* projected: base + (end - stored) * step is 1 / depth, or the depth of a parallel projection */
    int parallel;
    int marked;
    float sky, far_depth;
    tyni_vec3 origin, dx, dy; /* distance: as in tyni_view, direction of a pixel at depth 1 */
} tyni_door;

/* TYN_E_IMAGE where the coding is none. The camera is checked before. */
tyn_status tyni_door_check(const tyn_depth_coding *coding, const tyn_camera *camera);

void tyni_door_open(tyni_door *door, const tyn_image *image, const tyn_depth_coding *coding, const tyn_camera *camera);

/* Depth of one pixel, of any image. */
float tyni_door_depth(const tyni_door *door, int32_t x, int32_t y);

/* Depths of `count` pixels from (x, y) on: where they lie if the image is plain, else in `room`. */
const float *tyni_door_row(const tyni_door *door, int32_t x, int32_t y, int32_t count, float *room);

/* A shadow map and how to read it. */
typedef struct tyni_texels {
    const uint8_t *pixels;
    ptrdiff_t pitch; /* bytes from row to row */
    int32_t width, height;
    int32_t bytes; /* of a texel: 2 or 4 */
    int32_t inverse;
    float end, step, limit; /* (stored - end) * step is the depth; inverse: the distance, if below the limit */
} tyni_texels;

/* `z`: the row of a matrix that, over the matrix's W, gives a point's depth in the terms of tyni_texels_z. The bias, in texels,
 * moves what is stored away from the light. */
void tyni_door_map(tyni_texels *texels, float z[4], const tyn_shadow *shadow, float bias);

/* Depth of a texel at an address: 0 where there is nothing, else it falls with the distance from the light. */
static inline float tyni_texels_z(const tyni_texels *t, const uint8_t *texel)
{
    float z = t->bytes == 2 ? (float)*(const uint16_t *)(const void *)texel : *(const float *)(const void *)texel;
    z = (z - t->end) * t->step;
    if (t->inverse)
        return z > 0.0f && z < t->limit ? 1.0f / tyni_maxf(z, 1e-6f) : 0.0f;
    return z > 0.0f ? tyni_minf(z, 1.0f) : 0.0f;
}

static inline float tyni_texels_at(const tyni_texels *t, int32_t x, int32_t y)
{
    return tyni_texels_z(t, t->pixels + t->pitch * y + (ptrdiff_t)t->bytes * x);
}

#endif
