/* check.h - arguments at the door: what both levels of the public API must check before they write anything. */
#ifndef TYNI_CHECK_H
#define TYNI_CHECK_H

#include "base.h"

#define TYNI_FORMAT_BIT(format) (1u << (format))
#define TYNI_DEPTH_FORMATS (TYNI_FORMAT_BIT(TYN_DEPTH_F32) | TYNI_FORMAT_BIT(TYN_DEPTH_U16) | TYNI_FORMAT_BIT(TYN_DEPTH_U24))

/* Size, stride, alignment, and a format out of the set `formats` (of TYNI_FORMAT_BIT). pixels must not be NULL. */
tyn_status tyni_check_image(const tyn_image *image, uint32_t formats);

/* Bytes from row to row with stride 0 resolved. */
ptrdiff_t tyni_image_stride(const tyn_image *image);

/* Address of a row. */
void *tyni_image_row(const tyn_image *image, int32_t y);

tyn_status tyni_check_camera(const tyn_camera *camera);
/* Limits: texels of a map, maps of a light. */
tyn_status tyni_check_lights(const tyn_light *lights, int32_t count, int32_t shadow_limit, int32_t map_limit);
tyn_status tyni_check_media(const tyn_medium *media, int32_t count);
tyn_status tyni_check_display(const tyn_display *display);

/* A box: both NULL (none) or finite and min <= max. TYN_E_NULL for one of the two, TYN_E_MESH. */
tyn_status tyni_check_bounds(const float low[3], const float high[3]);

/* All of n floats finite; and not below 0. */
int tyni_check_finite(const float *v, int32_t n);
int tyni_check_colour(const float v[3]);
/* None of n beyond `most`, on either side, or NaN. */
int tyni_check_within(const float *v, int32_t n, float most);

/* The stored values of a range's ends, of which 0, 0 means 0, 1; 0 where they are too close together, or too large, to compute
 * with. */
int tyni_check_range(float at_near, float at_far, float ends[2]);

/* Rows of a shadow map, and bytes of a texel. */
static inline int32_t tyni_shadow_height(const tyn_shadow *shadow)
{
    return shadow->height ? shadow->height : shadow->size;
}
static inline int32_t tyni_shadow_bytes(const tyn_shadow *shadow)
{
    return shadow->format == TYN_DEPTH_U16 ? 2 : 4;
}
/* Whether its stride is one that a map of its size may have. */
int tyni_check_shadow_stride(const tyn_shadow *shadow);
/* w does not depend on the place. */
static inline int tyni_shadow_parallel(const tyn_shadow *shadow)
{
    return shadow->matrix[12] == 0.0f && shadow->matrix[13] == 0.0f && shadow->matrix[14] == 0.0f;
}

#endif
