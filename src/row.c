/* row.c - see row.h */
#include "row.h"

#include "base.h"
#include "course.h"
#include "lanes/lanes.h"

/* Columns of a slice as directions (n, d) in half a circle: n = x and d = 1 - y / distance, so that n / d is the tangent of the
 * column's angle seen from the light (or x itself for a directional light). They begin at (0, 1), the column through the
 * camera. */
typedef struct fan {
    float n[2], d[2]; /* from, to: less than half a circle */
} fan;

static int fan_empty(const fan *f)
{
    return !(f->d[0] * f->n[1] - f->n[0] * f->d[1] > 0.0f);
}

/* Clips to fn * n + fd * d >= 0. */
static void fan_clip(fan *f, float fn, float fd)
{
    float a = f->n[0] * fn + f->d[0] * fd, b = f->n[1] * fn + f->d[1] * fd;
    int32_t out = a < 0.0f ? 0 : 1;
    if (a >= 0.0f && b >= 0.0f)
        return;
    if (a < 0.0f && b < 0.0f) {
        f->n[1] = f->n[0];
        f->d[1] = f->d[0];
        return;
    }
    a = tyni_absf(a);
    b = tyni_absf(b);
    f->n[out] = (f->n[0] * b + f->n[1] * a) / (a + b);
    f->d[out] = (f->d[0] * b + f->d[1] * a) / (a + b);
}

/* The part of a fan that falls on a map, and where its ends do, in texels; 0 if it misses the map. */
static int fan_on_map(fan *f, const tyni_map *map, const tyni_slice *slice, float u[2], float v[2])
{
    float un = tyni_vec_dot(map->u.v, slice->ex), vn = tyni_vec_dot(map->v.v, slice->ex);
    float wn = tyni_vec_dot(map->w.v, slice->ex), wd = tyni_form_at(&map->w, slice->origin);
    float width = (float)map->texels.width, height = (float)map->texels.height;
    float ud = tyni_form_at(&map->u, slice->origin), vd = tyni_form_at(&map->v, slice->origin);
    fan_clip(f, wn, wd - 1e-6f * (tyni_absf(wn) + tyni_absf(wd)));
    fan_clip(f, un, ud);
    fan_clip(f, width * wn - un, width * wd - ud);
    fan_clip(f, vn, vd);
    fan_clip(f, height * wn - vn, height * wd - vd);
    if (fan_empty(f))
        return 0;
    for (int32_t i = 0; i < 2; i++) {
        float w = f->n[i] * wn + f->d[i] * wd;
        if (!(w > 0.0f))
            return 0;
        u[i] = tyni_clampf((f->n[i] * un + f->d[i] * ud) / w, 0.0f, width);
        v[i] = tyni_clampf((f->n[i] * vn + f->d[i] * vd) / w, 0.0f, height);
    }
    return 1;
}

/* The threshold test of a surface at column coordinate g and map depth z as two numbers linear in (g, z, 1): their signs tell
 * whether it shadows the line's lit end and its dark end, their ratio where between the two the shadow begins. */
typedef struct ends {
    float g[2], z[2], c[2];
} ends;

static int ends_begin(ends *e, const tyni_piece *piece, const tyni_slice *slice, const tyni_view *view, const tyni_map *map,
                      const float p[2])
{
    /* (g w, z w, w) = M (x, y, 1) in the slice's plane */
    float m[3][3], x[3], y[3], w[3], det, sign;
    const tyni_form *form[3];
    form[0] = &piece->r;
    form[1] = &map->z;
    form[2] = &map->w;
    for (int32_t i = 0; i < 3; i++) {
        m[i][0] = tyni_vec_dot(form[i]->v, slice->ex);
        m[i][1] = tyni_vec_dot(form[i]->v, slice->ey);
        m[i][2] = tyni_form_at(form[i], slice->origin);
    }
    /* rows of the inverse, but for a positive factor */
    for (int32_t i = 0; i < 3; i++) {
        int32_t j = (i + 1) % 3, k = (i + 2) % 3;
        x[i] = m[j][1] * m[k][2] - m[k][1] * m[j][2];
        y[i] = m[k][0] * m[j][2] - m[j][0] * m[k][2];
        w[i] = m[j][0] * m[k][1] - m[k][0] * m[j][1];
    }
    det = m[0][0] * x[0] + m[1][0] * x[1] + m[2][0] * x[2];
    if (det == 0.0f || !tyni_finite(det))
        return 0;
    sign = det < 0.0f ? -1.0f : 1.0f;
    for (int32_t i = 0; i < 2; i++) {
        /* which side of the view ray through p the surface is on; linear in p for rays of depth 1, not of length 1 */
        tyni_sight v;
        float length = tyni_slice_sight(slice, view, p[i], &v), vx, vy, off;
        v.o = tyni_vec_sub(v.o, slice->origin);
        vx = sign * length * tyni_vec_dot(v.d, slice->ex);
        vy = sign * length * tyni_vec_dot(v.d, slice->ey);
        off = vx * tyni_vec_dot(v.o, slice->ey) - vy * tyni_vec_dot(v.o, slice->ex);
        e->g[i] = vy * x[0] - vx * y[0] + off * w[0];
        e->z[i] = vy * x[1] - vx * y[1] + off * w[1];
        e->c[i] = vy * x[2] - vx * y[2] + off * w[2];
    }
    return 1;
}

#define TYNI_KERNEL "row_kernel.h"
#include "lanes/each.h"

typedef char edges_fit[TYN_MAX_SHADOW + 4 <= TYNI_ROW_END ? 1 : -1];

/* Where thresholds and edges are written. */
typedef struct pen {
    int32_t isa;
    uint16_t *threshold;
    uint16_t *edge;
    size_t room;
    int32_t before; /* pieces of the row that was here: their cells are there until new ones take their place */
} pen;

/* The part of the row on map i. */
static void add_piece(tyni_row *row, pen *w, const tyni_lamp *lamp, int32_t i, const tyni_slice *slice, const tyni_view *view,
                      const float u[2], const float v[2], const float p[2])
{
    const tyni_map *map = &lamp->maps[i];
    tyni_piece *piece = &row->pieces[row->count];
    const tyni_cells *last = NULL;
    tyni_cells before;
    const tyni_form *form;
    int32_t shift = 0;
    tyni_course c;
    ends e;
    tyni_course_begin(&c, u, v);
    if (row->count >= TYNI_ROW_PIECES || (size_t)c.steps > w->room)
        return;
    before = piece->cells;
    form = c.across ? &map->u : &map->v;
    piece->r.v = tyni_vec_scale(tyni_vec_mad(form->v, -c.base, map->w.v), c.sign);
    piece->r.c = c.sign * (form->c - c.base * map->w.c);
    piece->w = map->w;
    piece->from = c.from;
    piece->to = c.to;
    piece->first = row->columns;
    piece->map = (int8_t)i;
    if (!ends_begin(&e, piece, slice, view, map, p))
        return;
    piece->steps = tyni_course_on(&c, &map->texels, &piece->cells);
    while (shift < 15 && piece->steps << (shift + 1) <= TYNI_ROW_END)
        shift++;
    piece->unit = 1.0f / (float)(1 << shift);
    if (row->count < w->before && before.across == piece->cells.across && before.way == piece->cells.way)
        last = &before;
    TYNI_LANES_CALL(w->isa, row_fill,
                    (&map->texels, &piece->cells, last, c.from, &e, piece->steps, shift, w->threshold, w->edge));
    row->count++;
    row->columns += 2 * piece->steps;
    w->threshold += 2 * piece->steps;
    w->edge += 2 * piece->steps;
    w->room -= (size_t)piece->steps;
}

void tyni_row_build(tyni_row *row, int32_t isa, uint16_t *threshold, uint16_t *edge, size_t room, const tyni_slice *slice,
                    const tyni_lamp *lamp, const tyni_view *view, float reach)
{
    /* what no map has covered yet: a local light's columns as two quarters, since half a circle cannot be clipped by lines */
    fan open[TYNI_ROW_PIECES + 2] = {{{0.0f, 1.0f}, {1.0f, 0.0f}}, {{1.0f, 0.0f}, {0.0f, -1.0f}}};
    int32_t fans = tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL ? 1 : 2;
    float pa = tyni_slice_p(slice, slice->first), pb = tyni_slice_p(slice, slice->last), p[2], u[2], v[2];
    pen w = {isa, threshold, edge, room, row->count};
    int rising = (0.5f * (pa + pb) < slice->epipole) != lamp->behind; /* p rises towards the lit end */
    row->count = 0;
    row->columns = 0;
    row->threshold = threshold;
    row->edge = edge;
    /* the line's lit end comes first: the one nearer to the light on the screen */
    p[0] = rising == (pa < pb) ? pb : pa;
    p[1] = rising == (pa < pb) ? pa : pb;
    row->p_start = p[0];
    row->p_scale = pa != pb ? 65534.0f / (p[1] - p[0]) : 0.0f;
    if (fans == 1)
        fan_clip(&open[0], -1.0f, reach);
    for (int32_t i = 0; i < lamp->map_count; i++)
        for (int32_t k = fans - 1; k >= 0; k--) {
            fan f = open[k];
            if (fan_empty(&f) || !fan_on_map(&f, &lamp->maps[i], slice, u, v))
                continue;
            add_piece(row, &w, lamp, i, slice, view, u, v, p);
            if (fans < TYNI_ROW_PIECES + 2) { /* beyond it */
                open[fans] = open[k];
                open[fans].n[0] = f.n[1];
                open[fans++].d[0] = f.d[1];
            }
            open[k].n[1] = f.n[0];
            open[k].d[1] = f.d[0];
        }
}

void tyni_row_bound(const tyni_blocks *blocks, int32_t isa, const tyni_row *row)
{
    TYNI_LANES_CALL(isa, row_bound, (row->threshold, row->columns, blocks->low, blocks->high));
}
