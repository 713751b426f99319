/* door.h - formats at the door: scene depth as others store it. Inside there is one convention: view-space depth in metres,
 * 0 .. far. */
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

#endif
