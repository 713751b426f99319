/* slice.h - epipolar lines on the screen, in one of three layouts.
 *
 * Shear grid, tyndall's own: the screen is cut by the two diagonals through the epipole into four sectors; in a sector |dx| >
 * |dy| sample j of every line lies on pixel column j, in the others on pixel row j. So a pixel finds its two lines by one
 * linear function and its samples with no search: reconstruction is two taps, and along a row of pixels memory is read in
 * order. A line has one sample per pixel by construction (IVB's length stretching has nothing to do), and parallel lines
 * (epipole at infinity) are no special case: nothing is divided by the epipole's w.
 *
 * Border points, as ED10 and IVB have it: lines from the epipole, or from where they come into the screen, to points
 * equidistant along the screen's whole border, each with the same number of samples; see border.h.
 *
 * Coordinates: p is the pixel coordinate along the line's major axis, m the other one. */
#ifndef TYNI_SLICE_H
#define TYNI_SLICE_H

#include "vec.h"
#include "view.h"

#include "base.h"

typedef enum tyni_layout { TYNI_LAYOUT_SHEAR, TYNI_LAYOUT_BORDER } tyni_layout;

/* One quarter around the epipole, with lines through equidistant points m = first + k * spacing of the screen's border p =
 * border. Only the part of the border that lines of visible pixels reach has lines. */
typedef struct tyni_sector {
    int32_t along_y; /* axis: 0 = x, 1 = y */
    int32_t start;   /* number of its first slice */
    int32_t count;   /* slices, 0 or >= 2 */
    float border, first, spacing;
} tyni_sector;

/* A line to a border point: sample j is at (x, y) + j (ux, uy) / |u|^2, and a pixel's place on it is u . (pixel - (x, y)). */
typedef struct tyni_spoke {
    float x, y, ux, uy;
} tyni_spoke;

typedef struct tyni_slices {
    tyni_layout layout;
    int32_t count;    /* slices in all */
    float ex, ey, ew; /* epipole, scaled such that pixel differences x * ew - ex are of the order of pixels */
    int32_t width, height;
    int32_t samples; /* of a line, at most */
    /* shear grid */
    tyni_sector sectors[4]; /* right, left, down, up */
    int32_t stride;         /* pixels from sample to sample */
    /* border points */
    tyni_spoke *spokes; /* of the slices */
    int32_t *slots;     /* ED10's 1D look-up: of each of `slot_count` points around the border its slice, or -1: none */
    int32_t slot_count;
    float spacing; /* pixels from slot to slot, along the border */
} tyni_slices;

/* Points a `step` apart from the first pixel on, the last not before the last pixel. */
int32_t tyni_slice_points(int32_t pixels, int32_t step);

/* Shear grid: stride such that `samples` per line suffice for a width x height screen. */
int32_t tyni_slice_stride(int32_t width, int32_t height, int32_t samples);

static inline int tyni_slice_bordered(const tyni_slices *g)
{
    return TYNI_HAS(TYN_PART_GATHERS) && g->layout == TYNI_LAYOUT_BORDER;
}

/* For every layout: the screen's size and the epipole. */
void tyni_slice_epipole(tyni_slices *slices, const tyni_lamp *lamp, int32_t width, int32_t height);

/* The shear grid. */
void tyni_slice_layout(tyni_slices *slices, const tyni_lamp *lamp, int32_t width, int32_t height, int32_t limit,
                       int32_t stride);

/* One slice: its line m(p) = m0 + slope * p on the screen, and the slice's plane. */
typedef struct tyni_slice {
    int32_t along_y;
    int32_t first, last; /* samples on the screen (or within a line's spacing of it); first > last: none */
    float m0, slope;
    float p0, dp;  /* p of sample 0, and from sample to sample */
    float epipole; /* p of the epipole; +-1e9 if it is farther */
    /* The line on the pixel plane is a + p * b (see tyni_view). The slice's plane has its origin at `origin`: the camera, or
     * for an orthographic one a point on the far side of the epipole from all of the line. ey points to the light, ex to the
     * line's side. */
    tyni_vec3 a, b, origin, ex, ey;
} tyni_slice;

/* The ray through p; returns its length per depth. */
float tyni_slice_sight(const tyni_slice *slice, const tyni_view *view, float p, tyni_sight *v);

/* Of a line (along_y, m0, slope are set): the plane. border: p of its far end. */
void tyni_slice_plane(tyni_slice *slice, float border, const tyni_lamp *lamp, const tyni_view *view);

/* Shear grid: all of slice `index`. */
void tyni_slice_line(tyni_slice *slice, const tyni_slices *slices, const tyni_lamp *lamp, const tyni_view *view, int32_t index);

static inline float tyni_slice_p(const tyni_slice *slice, int32_t sample)
{
    return slice->p0 + (float)sample * slice->dp;
}

/* Shear grid: the sector of a pixel, and its slice coordinate in it: 0 .. count - 1. */
const tyni_sector *tyni_slice_find(const tyni_slices *slices, float x, float y, float *coordinate);

/* Shear grid: of the squares first .. end - 1 of `size` pixels in a row whose middle is at y, the first one's sector, and the
 * first square of another, or `end`. */
const tyni_sector *tyni_slice_span(const tyni_slices *slices, int32_t first, int32_t end, int32_t size, float y, int32_t *next);

#endif
