/* ray.c - see ray.h */
#include "ray.h"

#include "base.h"
#include "line.h"
#include "meter.h"

/* A ray in one piece of the row. */
typedef struct crossing {
    const tyni_piece *piece;
    tyni_line r, w;
    float from, to; /* step coordinates where it comes in and leaves */
    int32_t first, last;
    uint32_t position;
    tyni_meter *meter;
} crossing;

/* Step coordinates of the ray's ends, of its part in front of the map. 0: none is. */
static int row_span(tyni_line r, tyni_line w, float part[2], float *from, float *to)
{
    tyni_line edge = w;
    edge.c -= 1e-6f;
    tyni_line_clip(edge, part);
    if (!(part[0] < part[1]))
        return 0;
    *from = tyni_line_at(r, part[0]) / tyni_line_at(w, part[0]);
    *to = tyni_line_at(r, part[1]) / tyni_line_at(w, part[1]);
    return 1;
}

static int crossing_begin(crossing *c, const tyni_piece *piece, const tyni_integral *it, const tyni_sight *v)
{
    float part[2];
    int32_t a, b;
    c->piece = piece;
    c->r = tyni_line_along(&piece->r, v);
    c->w = tyni_line_along(&piece->w, v);
    part[0] = it->t0;
    part[1] = it->t1;
    if (!row_span(c->r, c->w, part, &c->from, &c->to))
        return 0;
    /* a piece's columns begin and end inside its first and last step where another piece goes on */
    c->from = tyni_maxf(c->from, piece->from);
    c->to = tyni_minf(c->to, piece->to);
    if (!(c->from < c->to))
        return 0;
    a = tyni_clampi((int32_t)c->from, 0, piece->steps - 1);
    b = tyni_clampi(tyni_ceili(c->to) - 1, a, piece->steps - 1);
    c->first = 2 * a + (c->from - (float)a >= piece->split[a]);
    c->last = 2 * b + (c->to - (float)b > piece->split[b]);
    return 1;
}

/* t of a step coordinate. */
static float border_t(const crossing *c, float at)
{
    return (at * c->w.c - c->r.c) / (c->r.d - at * c->w.d);
}

/* From column i on it is lit, or not. The first column begins where the ray comes in. */
static void switch_at(const crossing *c, int32_t i, int lit)
{
    tyni_meter *m = c->meter;
    if (lit != (m->on ^ m->outside))
        tyni_meter_lit(m, lit, border_t(c, i <= c->first ? tyni_maxf(c->from, 0.0f) : tyni_row_edge(c->piece, i)));
}

/* IVB's march without its tree. */
static int32_t each_column(const crossing *c)
{
    for (int32_t i = c->first; i <= c->last; i++)
        switch_at(c, i, c->position < c->piece->threshold[i]);
    return c->last - c->first + 1;
}

/* Visibility of n columns from i on; the other bits are 0. */
static uint32_t compare(const uint16_t *threshold, int32_t n, uint32_t position)
{
    uint32_t bits = 0;
    for (int32_t b = 0; b < n; b++)
        bits |= (uint32_t)(position < threshold[b]) << b;
    return bits;
}

/* 32 columns at a time: a word of visibility, made by compares or kept by the sweep, and its transitions by bit scans. */
static int32_t packed_words(const crossing *c, const tyni_sweep *sweep)
{
    int32_t words = 0;
    for (int32_t i = c->first; i <= c->last; i += 32, words++) {
        int32_t n = tyni_mini(32, c->last - i + 1);
        uint32_t bits, changes;
        bits = sweep ? tyni_sweep_word(sweep, c->piece->first + i) : compare(c->piece->threshold + i, n, c->position);
        switch_at(c, i, (int)(bits & 1u));
        changes = bits ^ (bits << 1 | (bits & 1u));
        if (n < 32)
            changes &= (1u << n) - 1u;
        for (; changes; changes &= changes - 1) {
            int32_t k = tyni_ctz32(changes);
            switch_at(c, i + k, (int)(bits >> k & 1u));
        }
    }
    return words;
}

/* IVB's march with its tree. */
static int32_t descend(const crossing *c, const tyni_finder *finder)
{
    int32_t i = c->piece->first + c->first, end = c->piece->first + c->last, level = 0, looked = 0, top;
    int lit;
    for (; i <= end; i += 1 << level) {
        looked += tyni_tree_span(finder->tree, finder->row->threshold, c->position, i, &level, &top, &lit);
        switch_at(c, i - c->piece->first, lit);
    }
    return looked;
}

int32_t tyni_ray_row(const tyni_finder *finder, float p, const tyni_lamp *lamp, const tyni_integral *it, const tyni_sight *v,
                     float *light)
{
    const tyni_row *row = finder->row;
    int32_t looked = 0;
    tyni_meter m;
    crossing c;
    tyni_meter_begin(&m, it, lamp, v, light);
    if (!(it->t0 < it->t1))
        return 0;
    c.position = tyni_row_position(row, p);
    c.meter = &m;
    for (int32_t i = 0; i < row->count; i++) {
        if (!crossing_begin(&c, &row->pieces[i], it, v))
            continue;
        if (finder->rays == TYN_RAYS_TREE)
            looked += descend(&c, finder);
        else if (finder->rays == TYN_RAYS_COLUMNS)
            looked += each_column(&c);
        else
            looked += packed_words(&c, finder->rays == TYN_RAYS_SWEEP ? finder->sweep : NULL);
        tyni_meter_lit(&m, m.outside, border_t(&c, tyni_minf(c.to, (float)c.piece->steps)));
    }
    tyni_meter_end(&m);
    return looked;
}

int tyni_ray_columns(const tyni_piece *piece, const tyni_integral *it, const tyni_sight *v, int32_t *first, int32_t *last,
                     float *from, float *to)
{
    crossing c;
    if (!crossing_begin(&c, piece, it, v))
        return 0;
    *first = c.first;
    *last = c.last;
    *from = c.from;
    *to = c.to;
    return 1;
}

int tyni_ray_coarse(const tyni_row *row, const tyni_integral *it, const tyni_sight *v)
{
    float part[2], from, to, texels = 0.0f, depth = it->sigma[it->count - 1] * (it->t1 - it->t0);
    if (row->count < 1)
        return 0;
    for (int32_t i = 0; i < row->count; i++) {
        part[0] = it->t0;
        part[1] = it->t1;
        if (row_span(tyni_line_along(&row->pieces[i].r, v), tyni_line_along(&row->pieces[i].w, v), part, &from, &to))
            texels += tyni_maxf(tyni_minf(to, row->pieces[i].to) - tyni_maxf(from, row->pieces[i].from), 0.0f);
    }
    /* a texel's share of the light, at most: 1 / texels in thin air, its optical depth in thick */
    return tyni_maxf(1.0f, depth) > 0.05f * texels;
}
