/* row.h - a slice's row: one 16-bit threshold per column of light (method.md section 1).
 *
 * The slice cuts the shadow map along a straight line of texels. The surface that a column's light meets first is projected
 * back on the slice's line on the screen: in front of that point the column is lit, behind it dark, for every view ray of the
 * slice. So a threshold is a position on the line, in 65534ths of the part between its first and last sample, and `lit` is one
 * integer compare.
 *
 * The line crosses one or two texels for each step along its major axis, and each is a column: columns 2k and 2k + 1 share the
 * step k .. k + 1 and meet somewhere in it. One texel a step, as the papers have it, misplaces shadows by up to half a texel: 3
 * dB in a scene of leaves, which finer slices do not bring back. Where columns begin is kept in 16 bits too, 1/32 of a step for
 * 2047 steps: a list of a ray's edges is then made of these as they are, and nothing is looked up for them one by one. */
#ifndef TYNI_ROW_H
#define TYNI_ROW_H

#include "course.h"
#include "slice.h"
#include "vec.h"
#include "view.h"

#include "base.h"

/* The columns of one shadow map, or of a part of it: where several maps meet (cascades, the faces of a cube) each column is
 * looked up in the first map that covers it, and the row is a chain of pieces. */
typedef struct tyni_piece {
    int32_t first; /* column of the row that is its column 0 */
    int32_t steps;
    float unit;     /* in steps, of where columns begin: 2^-n, so that they all fit 16 bits */
    float from, to; /* step coordinates where the piece begins and ends, inside the first and the last step */
    /* Step coordinate of a camera-relative point: r . p / w . p. Rises along every view ray. */
    tyni_form r, w;
    tyni_cells cells; /* texels of its steps */
    int8_t map;       /* of the light's maps */
} tyni_piece;

/* 8 maps are 8 intervals of columns, which cut each other into 15 at most; one more where the two quarters of a local light
 * meet. */
#define TYNI_ROW_PIECES 16

/* All zeros before its first use: rows of neighbouring slices are built in the same place, and from where the texels of the
 * last one were it is known what the next one will read. */
typedef struct tyni_row {
    int32_t count;   /* of pieces; 0: the slice misses all maps */
    int32_t columns; /* of all pieces, one after the other */
    /* Both are read to the end of a block of 64, up to 63 entries behind the last. */
    const uint16_t *threshold; /* of these; lit for a ray at position q if q < threshold */
    const uint16_t *edge;      /* where they begin, in units; that of 2 k is k steps */
    float p_start, p_scale;    /* position of a ray through p: (p - p_start) * p_scale */
    tyni_piece pieces[TYNI_ROW_PIECES];
} tyni_row;

/* The step coordinate where column i of a piece begins. */
static inline float tyni_row_edge(const tyni_row *row, const tyni_piece *piece, int32_t i)
{
    return (float)row->edge[piece->first + i] * piece->unit;
}

/* Behind all edges. */
#define TYNI_ROW_END 65535

/* Steps that a row can have: threshold and edge have two entries for each. */
static inline size_t tyni_row_room(int32_t shadow_size, int32_t maps)
{
    return (size_t)maps * ((size_t)shadow_size + 4);
}

/* Builds the row into `threshold` and `edge`. `reach`: no view ray gets farther from the axis camera - light than this
 * (directional lights; what lies beyond is not built). */
void tyni_row_build(tyni_row *row, int32_t isa, uint16_t *threshold, uint16_t *edge, size_t room, const tyni_slice *slice,
                    const tyni_lamp *lamp, const tyni_view *view, float reach);

/* Least and greatest threshold of each 64 columns of the row and of the one before them: a ray whose position is below all or
 * none of them changes at none of the 64. */
typedef struct tyni_blocks {
    uint16_t *low, *high; /* tyni_row_blocks entries each; up to 31 behind the one in hand may be read */
} tyni_blocks;

/* Blocks of so many columns. */
static inline size_t tyni_row_blocks(size_t columns)
{
    return (columns + 63) / 64;
}

void tyni_row_bound(const tyni_blocks *blocks, int32_t isa, const tyni_row *row);

/* 0 .. 65534 */
static inline uint32_t tyni_row_position(const tyni_row *row, float p)
{
    return (uint32_t)tyni_clampf((p - row->p_start) * row->p_scale, 0.0f, 65534.0f);
}

#endif
