/* columns.h - a slice's row as one run of columns, from the camera's column on outwards, whatever maps it is made of.
 *
 * A column's coordinate x is its distance from the axis camera - light (directional), or the angle at the light between it and
 * the way back to the camera, 0 .. pi (spot, point). Every view ray of the slice starts at 0 and meets columns at rising x. Not
 * for orthographic cameras, whose rays start anywhere. */
#ifndef TYNI_COLUMNS_H
#define TYNI_COLUMNS_H

#include "row.h"
#include "slice.h"
#include "view.h"

#include "base.h"

typedef struct tyni_columns {
    const tyni_row *row;
    int local;
    float distance;
    struct {
        float rn, rd, wn, wd; /* the step coordinate of a column is (rn * n + rd * d) / (wn * n + wd * d), see fan in row.c */
        float begin, end;
    } piece[TYNI_ROW_PIECES];
    int32_t order[TYNI_ROW_PIECES]; /* of pieces, by begin */
    int32_t at, k, last;            /* piece in hand; its next column, or -1 before its first */
    uint32_t outside;               /* threshold where no map is */
    float x, end;
} tyni_columns;

/* Columns from 0 to `end`. */
void tyni_columns_begin(tyni_columns *columns, const tyni_row *row, const tyni_slice *slice, const tyni_lamp *lamp, float end);

/* The next run of columns with one threshold: from *from to *to, *from being the last *to. 0: no more. */
int tyni_columns_next(tyni_columns *columns, float *from, float *to, uint32_t *threshold);

/* Narrows x[0] .. x[1] to the columns inside the light's volume: cone, slide or gobo. What is outside of it is no part of any
 * ray (tyni_view_clip). */
void tyni_columns_volume(const tyni_slice *slice, const tyni_lamp *lamp, float x[2]);

/* A point of column x, off the light and the camera: where to look up the colour of its light. */
tyni_vec3 tyni_columns_point(const tyni_slice *slice, const tyni_lamp *lamp, float x);

#endif
