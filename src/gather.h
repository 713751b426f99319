/* gather.h - from epipolar samples to screen pixels.
 *
 * Three ways for lines, one for a grid. All weigh samples by how near their depth is to the pixel's: 1 within the threshold of
 * relative depth that also makes breaks, then falling with the fourth power (IVB section 6.6). Looser weights would leak. */
#ifndef TYNI_GATHER_H
#define TYNI_GATHER_H

#include "border.h"
#include "slice.h"

#include "base.h"

/* Below this sum of weights the samples tell too little of the pixel. A sample one and a half thresholds off has a fifth. */
#define TYNI_GATHER_ENOUGH 0.15f

/* So many samples either way where none fits at a pixel's place, as ED10's taps look for them. */
#define TYNI_GATHER_BESIDE 4

/* Finished lines of one light. */
typedef struct tyni_field {
    uint32_t *entries; /* entry.h; line after line, `pitch` apart */
    uint16_t *thirds;  /* the third channel; NULL: none */
    float *scales[3];  /* of each line, by channel */
    int32_t pitch;
    float threshold; /* of relative depth; a pixel's own may be less */
} tyni_field;

/* Points on the screen at (i * step_x + 0.5, j * step_y + 0.5): a line of the field is a row of them. */
typedef struct tyni_grid {
    tyni_field field;
    int32_t columns, rows;
    float step_x, step_y;
} tyni_grid;

/* How pixels are put together from lines. */
typedef struct tyni_gather {
    tyn_gather way;
    tyn_kernel kernel; /* of TYN_GATHER_ED10 */
    int32_t taps;
} tyni_gather;

/* The threshold of relative depth of a pixel in the light of a lamp: near it, what a ray gathers changes with its end's
 * distance to the lamp and not with the one to the camera. depth: relative to far. Never 0: weights are divided by it. */
#define TYNI_GATHER_NARROW 1e-3f
float tyni_gather_threshold(float threshold, const tyni_view *view, const tyni_lamp *lamp, float x, float y, float depth);

/* Visibility at (x, y) with depth relative to far and this pixel's threshold, as {low, high} or {red, green, blue}. 0: no
 * sample fits, the pixel is rejected. */
int tyni_gather_lines(const tyni_gather *gather, const tyni_field *field, const tyni_slices *slices, float x, float y,
                      float depth, float threshold, float value[3]);

/* The same as tyni_gather_lines on a grid: 2 x 2 points. */
int tyni_gather_grid(const tyni_grid *grid, float x, float y, float depth, float threshold, float value[3]);

/* The point of these with the nearest depth, whatever it is: naive sub-sampling, which rejects nothing. */
void tyni_gather_nearest(const tyni_grid *grid, float x, float y, float depth, float value[3]);

#endif
