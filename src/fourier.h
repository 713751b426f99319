/* fourier.h - prefiltered rows (KSE14): visibility of any view ray of a slice as a few products, whatever the scene.
 *
 * A ray at position z sees column i lit where z < z_i. A basis takes z and z_i apart, so that the sum over the columns up to
 * where the ray ends can be made before any ray is known: a row stores, for some columns, weighted means of the basis over all
 * columns before. 8 bits suffice. Where this departs from the paper, and what that brings (mean L1 of the light to the exact
 * march, of nine scenes; tests/bench/prefiltered.c has the tables):
 *
 *  - Columns that are lit or dark for every ray of the slice stay out of the basis and are kept as a number of 16 bits: exact,
 *    and nothing rings for them. With them in the basis the error is 2 to 20 times as large, and the period's wrap a danger;
 *    what is left lies inside the range, and a margin of 1 % serves for its very ends.
 *  - The means are normalised by the weight of what is left, not of all: 8 bits of a part are finer than 8 bits of the whole.
 *  - z is remapped slice by slice, half evenly, half by the histogram of thresholds: only their order matters for visibility.
 *  - Several reference rays. A column's weight e^(-k x) has k = extinction / sin(angle to the light), for each ray and channel
 *    its own: rows for some k between the slice's least and largest are kept, and rays interpolate over k. One (the paper) is
 *    wrong for most rays around an epipole on the screen, which no number of bases mends; and this takes colour in as well.
 *  - Columns are stored at equal steps of transmittance (for a part), not of distance: 128 miss a tenth more than 1024. 96 with
 * four reference rays are better than 128 with three, of the same size, by a third where the sun is low on the screen.
 *  - Rays near the epipole that cross few texels are no part of it: they are walked (tyni_fourier_coarse).
 *
 * What lost: visibility tabulated at the knots of z instead of a basis (no ringing, and M does not count at the pixel, but half
 * as much again of error at equal bytes, twice as much with 8); windows by default; a quadratic through three reference
 * rays; regions that start anew within a slice (a slice is one job, and there are more slices than threads).
 *
 * A spot's or point light's columns are angles at the light: dt / r^2 = d(angle) / h takes the fall-off with distance out of
 * the integral (method.md section 2), and e^(-sigma (t + r)) p(theta) along the reference rays, which are at different angles
 * there, is the weight. */
#ifndef TYNI_FOURIER_H
#define TYNI_FOURIER_H

#include "columns.h"
#include "medium.h"
#include "num.h"

#include "base.h"

#define TYNI_FOURIER_KNOTS 64 /* pieces of the map from positions to z */
#define TYNI_FOURIER_BINS 512 /* of the histogram that places them */

/* What all slices of a light share. */
typedef struct tyni_fourier {
    const tyni_lamp *lamp;
    const tyni_medium *medium;
    int32_t bases, columns, references, channels, sets; /* sets: references * channels */
    int average, geometric, no_walks;
    int32_t isa;           /* of lanes.h */
    float remap;           /* 0 .. 1: share of the histogram in the map to z */
    float margin;          /* z stays this far from the ends of 0 .. 1, where the series wraps */
    int all;               /* lit and dark columns go into the basis too, as the paper has it */
    float far_x;           /* no ray is longer */
    float map_scale;       /* spot, point: texels of a map per radian at the light */
    int16_t amplitude[64]; /* of the orders, with the window; 32767 is 2 / pi */
} tyni_fourier;

/* One slice's rows; its columns follow in memory: `columns` times `sets`. */
typedef struct tyni_shelf {
    int32_t valid;                        /* 0: no ray of the line is lit from anywhere, or there is no line */
    float p_start, p_scale;               /* position of a ray, as of tyni_row */
    float low, high;                      /* columns that are summed up */
    float density, near_share, far_share; /* columns are stored at equal steps of near_share x fog(density x) + far_share x */
    float lean[4];                        /* of the reference rays, rising */
    float scale[3];                       /* of constant and share */
    uint16_t knot[TYNI_FOURIER_KNOTS + 2];
} tyni_shelf;

/* Bytes of a set in a column: constant (int16_t), share (uint16_t), int8_t of the bases, sines before cosines. */
#define TYNI_FOURIER_LENGTH(bases) (4 + (bases))

/* Bytes from one column to the next. The first begins after the shelf. */
static inline ptrdiff_t tyni_fourier_pitch(const tyni_fourier *f)
{
    return (ptrdiff_t)f->sets * TYNI_FOURIER_LENGTH(f->bases);
}

/* Where columns are stored: at equal steps of this, 0 at `low` .. 1 at `high`: of transmittance along a middling ray, and for a
 * part of distance, so that the last of them in thick air are not as wide as all others. x from low. */
static inline float tyni_fourier_cells(const tyni_shelf *s, float x)
{
    return x * (s->far_share + (s->near_share > 0.0f ? s->near_share * tyni_num_fog(s->density * x) : 0.0f));
}

#define TYNI_KERNEL "knot_kernel.h"
#include "lanes/each.h"

/* What the rays of a slice are at most and at least: see tyni_lookup_ray. */
typedef struct tyni_fourier_range {
    float lean[2], x;
    int32_t count;
} tyni_fourier_range;

/* Bytes of a slice, and of a worker's scratch. */
size_t tyni_fourier_bytes(int32_t bases, int32_t columns, int32_t sets);
size_t tyni_fourier_scratch(int32_t bases, int32_t sets);

/* Makes a slice's rows. range->x: beyond it nothing is needed. */
void tyni_fourier_build(const tyni_fourier *f, tyni_shelf *shelf, void *scratch, const tyni_row *row, const tyni_slice *slice,
                        const tyni_fourier_range *range);

/* A stored column as numbers 0 .. 1, of the middle reference ray: part of the light that all rays see; first sine and cosine
 * of the rest. Left alone where there is none. */
void tyni_fourier_show(const tyni_fourier *f, const tyni_shelf *shelf, int32_t column, float show[3]);

#endif
