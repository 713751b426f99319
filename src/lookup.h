/* lookup.h - what view rays see in prefiltered rows: one, or all pixels of a run. */
#ifndef TYNI_LOOKUP_H
#define TYNI_LOOKUP_H

#include "fourier.h"
#include "slice.h"
#include "view.h"

#include "base.h"

/* A view ray from the camera to t1. */
typedef struct tyni_lookup_ray {
    float x;       /* column where it ends */
    float lean[3]; /* of the channels: k; or the ray's angle to the way to the light (spot, point) */
} tyni_lookup_ray;

/* Sets `lean` and `x`. */
void tyni_lookup_sight(const tyni_fourier *f, const tyni_sight *v, float t1, tyni_lookup_ray *ray);

/* True for a ray near the epipole: columns are too coarse for it, and it leaves so few that a walk is cheap. */
int tyni_lookup_coarse(const tyni_fourier *f, const tyni_sight *v, float t0, float t1);

void tyni_lookup_widen(tyni_fourier_range *range, const tyni_lookup_ray *ray);

/* Visibility of the ray through p of the slice's line, in three channels. 0: the row knows nothing of it (it ends beyond the
 * last column). */
int tyni_lookup_value(const tyni_fourier *f, const tyni_shelf *shelf, float p, const tyni_lookup_ray *ray, float value[3]);

/* Pixels x .. x + count - 1 of row y, all in one sector of the shear grid: visibility between `from` and `to` (to = 0: no ray)
 * out of the shelves of the slices beside each. Bit first + i of `rejected` is set where pixel i wants a ray of its own. */
typedef struct tyni_lookup {
    const tyni_view *view;
    const tyni_slices *slices;
    const tyni_sector *sector;
    const uint8_t *shelves;
    size_t bytes; /* from shelf to shelf */
    int32_t x, y, count, first;
    const float *from, *to;
    float *value[3];
    uint32_t *rejected;
    void *scratch; /* of tyni_fourier_scratch's size, for floats */
} tyni_lookup;
void tyni_lookup_pixels(const tyni_fourier *f, const tyni_lookup *l);

#endif
