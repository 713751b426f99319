/* slice.h - epipolar lines on the screen as a shear grid.
 *
 * ED10 and IVB space samples along each line by its own length. Here the screen is cut by the two diagonals through the epipole
 * into four sectors; in a sector |dx| > |dy| sample j of every line lies on pixel column j, in the others on pixel row j. So a
 * pixel finds its two lines by one linear function and its samples with no search: reconstruction is two taps, and along a row
 * of pixels memory is read in order. A line has one sample per pixel by construction (IVB's length stretching has nothing to
 * do), and parallel lines (epipole at infinity) are no special case: nothing is divided by the epipole's w.
 *
 * Coordinates: p is the pixel coordinate along the sector's axis (x in x-major sectors), m the other one. */
#ifndef TYNI_SLICE_H
#define TYNI_SLICE_H

#include "vec.h"
#include "view.h"

#include "base.h"

/* One quarter around the epipole, with lines through equidistant points m = first + k * spacing of the screen's border p =
 * border. Only the part of the border that lines of visible pixels reach has lines. */
typedef struct tyni_sector {
    int32_t along_y; /* axis: 0 = x, 1 = y */
    int32_t start;   /* number of its first slice */
    int32_t count;   /* slices, 0 or >= 2 */
    float border, first, spacing;
} tyni_sector;

typedef struct tyni_slices {
    tyni_sector sectors[4]; /* right, left, down, up */
    int32_t count;          /* slices in all */
    float ex, ey, ew;       /* epipole, scaled such that pixel differences x * ew - ex are of the order of pixels */
    int32_t width, height;
    int32_t stride;  /* pixels from sample to sample */
    int32_t samples; /* room per line */
} tyni_slices;

/* Stride such that `samples` per line suffice for a width x height screen, and the samples then needed. */
int32_t tyni_slice_stride(int32_t width, int32_t height, int32_t samples);
int32_t tyni_slice_samples(int32_t width, int32_t height, int32_t stride);

void tyni_slice_layout(tyni_slices *slices, const tyni_lamp *lamp, int32_t width, int32_t height, int32_t limit,
                       int32_t stride);

/* One slice: its line m(p) = m0 + slope * p on the screen, and the slice's plane. */
typedef struct tyni_slice {
    int32_t along_y;
    int32_t first, last; /* samples on the screen (or within a line's spacing of it); first > last: none */
    float m0, slope;
    float epipole; /* p of the epipole; +-1e9 if it is farther */
    /* The line on the pixel plane is a + p * b (see tyni_view). The slice's plane has its origin at `origin`: the camera, or
     * for an orthographic one a point on the far side of the epipole from all of the line. ey points to the light, ex to the
     * line's side. */
    tyni_vec3 a, b, origin, ex, ey;
} tyni_slice;

/* The ray through p; returns its length per depth. */
float tyni_slice_sight(const tyni_slice *slice, const tyni_view *view, float p, tyni_sight *v);

void tyni_slice_line(tyni_slice *slice, const tyni_slices *slices, const tyni_lamp *lamp, const tyni_view *view, int32_t index);

static inline float tyni_slice_p(const tyni_slices *slices, int32_t sample)
{
    return (float)(sample * slices->stride) + 0.5f;
}

/* The sector of a pixel, and its slice coordinate in it: 0 .. count - 1. p, m are (x, y) or (y, x). */
const tyni_sector *tyni_slice_find(const tyni_slices *slices, float x, float y, float *coordinate);

#endif
