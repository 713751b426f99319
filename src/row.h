/* row.h - a slice's row: one 16-bit threshold per column of light (method.md section 1).
 *
 * The slice cuts the shadow map along a straight line of texels; each texel stepped over along the line's major axis is a
 * column. The surface that a column's light meets first is projected back on the slice's line on the screen: in front of that
 * point the column is lit, behind it dark, for every view ray of the slice. So a threshold is a position on the line, in
 * 65534ths of the part between its first and last sample, and `lit` is one integer compare. */
#ifndef TYNI_ROW_H
#define TYNI_ROW_H

#include "slice.h"
#include "vec.h"
#include "view.h"

#include "base.h"

typedef struct tyni_row {
    const uint16_t *threshold; /* of column i; lit for a ray at position q if q < threshold */
    int32_t count;             /* columns; 0: the slice misses the map */
    /* Column coordinate of a camera-relative point: r . p / w . p; column i covers i .. i + 1. Rises along every view ray. */
    tyni_form r, w;
    float p_start, p_scale; /* position of a ray through p: (p - p_start) * p_scale */
} tyni_row;

/* Builds the row into `threshold` (room for `room` columns). `reach`: no view ray gets farther from the axis camera - light
 * than this (directional lights; what lies beyond is not built). */
void tyni_row_build(tyni_row *row, uint16_t *threshold, int32_t room, const tyni_slices *slices, const tyni_slice *slice,
                    const tyni_lamp *lamp, float reach);

/* 0 .. 65534 */
static inline uint32_t tyni_row_position(const tyni_row *row, float p)
{
    return (uint32_t)tyni_clampf((p - row->p_start) * row->p_scale, 0.0f, 65534.0f);
}

#endif
