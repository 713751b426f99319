/* gather.h - from epipolar samples to screen pixels (IVB section 6.6: two lines, bilateral weights). */
#ifndef TYNI_GATHER_H
#define TYNI_GATHER_H

#include "slice.h"

#include "base.h"

/* The finished lines of one light. */
typedef struct tyni_field {
    const uint32_t *entries; /* entry.h; slice after slice, `pitch` apart */
    const uint16_t *thirds;  /* the third channel; NULL: none */
    const float (*scales)[3];
    int32_t pitch;
    float threshold; /* of relative depth, as for breaks: looser weights would leak */
    /* TYN_METHOD_SUBSAMPLE: a grid with a ray each `spacing` pixels instead of slices; a grid row takes the place of a slice */
    int32_t spacing, columns, rows;
} tyni_field;

/* Visibility at the pixel centre (x, y) with depth relative to far, as {low, high} or {red, green, blue}. 0: no sample fits,
 * the pixel is rejected.
 */
int tyni_gather_slices(const tyni_field *field, const tyni_slices *slices, float x, float y, float depth, float value[3]);

/* The same on the grid. Where no sample fits it takes the nearest in depth: naive, and never rejected. */
void tyni_gather_grid(const tyni_field *field, float x, float y, float depth, float value[3]);

#endif
