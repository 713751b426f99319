/* ray.c - see ray.h */
#include "ray.h"

#include "base.h"
#include "lanes/lanes.h"
#include "line.h"
#include "meter.h"

/* ---- where a ray goes into the light and out of it ------------------------------------------------------------------ */

/* A ray in one piece of the row, and how far the search has come. */
typedef struct crossing {
    const tyni_piece *piece;
    int32_t next, last; /* the column that is looked at next, before which it is as outside; behind last: all were */
    uint32_t position;
    int outside; /* lit before the first column and behind the last */
    int32_t looked;
    uint16_t *edges; /* where it changes, as the row has it: TYNI_RAY_EDGES and TYNI_RAY_SPARE */
} crossing;

/* An orthographic map: w is 1 everywhere. */
static int is_flat(const tyni_piece *piece)
{
    return piece->w.v.x == 0.0f && piece->w.v.y == 0.0f && piece->w.v.z == 0.0f;
}

/* What finding edges by compares reads. A copy is none of what is written. */
typedef struct arrays {
    const uint16_t *threshold, *edge, *low, *high;
} arrays;

static arrays arrays_of(const tyni_finder *finder)
{
    arrays a;
    a.threshold = finder->row->threshold;
    a.edge = finder->row->edge;
    a.low = finder->blocks->low;
    a.high = finder->blocks->high;
    return a;
}

/* ray_find without vectors: column by column, but for blocks without a change. */
static int32_t find_columns(const arrays *a, int32_t first, int32_t *next, int32_t end, uint32_t position, int outside,
                            uint16_t *edges)
{
    const uint16_t *threshold = a->threshold, *edge = a->edge;
    const int32_t last = first + end;
    int32_t i = first + *next, n = (position < threshold[i]) != outside;
    int lit = position < threshold[i];
    edges[0] = edge[i];
    for (i++; i <= last;) {
        const int32_t w = i >> 6, behind = tyni_mini(64 * w + 64, last + 1);
        if (position < a->low[w] || position >= a->high[w])
            i = behind;
        for (;; i++) {
            if (lit) {
                const uint16_t *t = threshold + i; /* four at a time: most of what is looked at is lit */
                for (; i + 3 < behind && position < t[0] && position < t[1] && position < t[2] && position < t[3]; i += 4)
                    t += 4;
                while (i < behind && position < threshold[i])
                    i++;
            } else {
                while (i < behind && position >= threshold[i])
                    i++;
            }
            if (i == behind)
                break;
            lit = !lit;
            edges[n++] = edge[i];
            if (n == TYNI_RAY_EDGES) {
                *next = i - first + 1;
                return n;
            }
        }
    }
    *next = end + 1;
    return n;
}

/* Of the bits that are set. */
static int32_t highest(uint64_t bits)
{
    const uint32_t high = (uint32_t)(bits >> 32);
    return high ? 63 - tyni_clz32(high) : 31 - tyni_clz32((uint32_t)bits);
}

/* Steps whose texels coarse rays cross together. */
#define PACES 16

/* Coarse rays of a bundle on their way over a piece's texels. */
typedef struct paces {
    float z[TYNI_RAY_BUNDLE], rise[TYNI_RAY_BUNDLE]; /* map depth where they come in, and its rise a step */
    float at[TYNI_RAY_BUNDLE];                       /* the step coordinate that they have come to */
    uint32_t on;                                     /* bit n: there ray n differs from what is outside */
    int32_t first, last;                             /* steps that any ray crosses */
} paces;

#define TYNI_KERNEL "ray_kernel.h"
#include "lanes/each.h"
#define TYNI_KERNEL "coarse_kernel.h"
#include "lanes/each.h"

/* The columns that a ray crosses from step coordinate `from` to `to`. */
static void columns_of(const tyni_row *row, const tyni_piece *piece, float from, float to, int32_t *first, int32_t *last)
{
    int32_t a = tyni_clampi((int32_t)from, 0, piece->steps - 1), b = tyni_clampi(tyni_ceili(to) - 1, a, piece->steps - 1);
    *first = 2 * a + (from >= tyni_row_edge(row, piece, 2 * a + 1));
    *last = 2 * b + (to > tyni_row_edge(row, piece, 2 * b + 1));
}

/* IVB's march without its tree. */
static int32_t each_column(crossing *c, const tyni_finder *finder)
{
    const uint16_t *threshold = finder->row->threshold + c->piece->first, *edge = finder->row->edge + c->piece->first;
    int32_t n = 0, i = c->next;
    int lit = c->outside;
    for (; i <= c->last && n < TYNI_RAY_EDGES; i++)
        if ((c->position < threshold[i]) != lit) {
            lit = !lit;
            c->edges[n++] = edge[i];
        }
    c->looked += i - c->next;
    c->next = i;
    return n;
}

/* IVB's march with its tree. */
static int32_t descend(crossing *c, const tyni_finder *finder)
{
    int32_t n = 0, top, level = 0;
    int lit = c->outside;
    while (c->next <= c->last && n < TYNI_RAY_EDGES) {
        int32_t i = c->piece->first + c->next;
        int now;
        c->looked += tyni_tree_span(finder->tree, finder->row->threshold, c->position, i, &level, &top, &now);
        if (now != lit) {
            lit = now;
            c->edges[n++] = finder->row->edge[i];
        }
        c->next += 1 << level;
    }
    return n;
}

/* 32 columns at a time, by the words that the sweep keeps. */
static int32_t swept_words(crossing *c, const tyni_finder *finder)
{
    const uint16_t *edge = finder->row->edge + c->piece->first;
    int32_t n = 0;
    uint32_t lit = (uint32_t)c->outside;
    while (c->next <= c->last && n < TYNI_RAY_EDGES) {
        uint32_t bits = tyni_sweep_word(finder->sweep, c->piece->first + c->next), changes = bits ^ (bits << 1 | lit);
        int32_t left = c->last - c->next + 1;
        if (left < 32)
            changes &= (1u << left) - 1u;
        for (; changes && n < TYNI_RAY_EDGES; changes &= changes - 1)
            c->edges[n++] = edge[c->next + tyni_ctz32(changes)];
        lit = bits >> 31;
        c->next += changes ? tyni_ctz32(changes) : tyni_mini(left, 32);
        c->looked++;
    }
    return n;
}

/* The next edges at which the ray changes, an even number: TYNI_RAY_EDGES, or all that are left and the end of the last column
 * where that is a change too; then c->next is behind c->last. */
static int32_t find(crossing *c, const tyni_finder *finder)
{
    int32_t n;
    if (tyni_ray_way(finder->rays, TYN_RAYS_TREE))
        n = descend(c, finder);
    else if (tyni_ray_way(finder->rays, TYN_RAYS_COLUMNS))
        n = each_column(c, finder);
    else if (tyni_ray_way(finder->rays, TYN_RAYS_SWEEP))
        n = swept_words(c, finder);
    else
        n = TYNI_LANES_CALL(finder->isa, ray_words, (c, finder));
    if (n & 1)
        c->edges[n++] = TYNI_ROW_END;
    return n;
}

/* ---- one ray -------------------------------------------------------------------------------------------------------- */

/* Step coordinates of the ray's ends, of its part in front of the map and on the piece. 0: none is. */
static int row_span(const tyni_piece *piece, tyni_line r, tyni_line w, const tyni_integral *it, float *from, float *to)
{
    tyni_line edge = w;
    float part[2];
    part[0] = it->t0;
    part[1] = it->t1;
    edge.c -= 1e-6f;
    tyni_line_clip(edge, part);
    if (!(part[0] < part[1]))
        return 0;
    /* a piece's columns begin and end inside its first and last step where another piece goes on */
    *from = tyni_maxf(tyni_line_at(r, part[0]) / tyni_line_at(w, part[0]), piece->from);
    *to = tyni_minf(tyni_line_at(r, part[1]) / tyni_line_at(w, part[1]), piece->to);
    return *from < *to;
}

int32_t tyni_ray_row(const tyni_finder *finder, float p, const tyni_lamp *lamp, const tyni_integral *it, const tyni_sight *v,
                     float *light)
{
    const tyni_row *row = finder->row;
    int32_t first;
    uint16_t edges[TYNI_RAY_EDGES + TYNI_RAY_SPARE];
    float from, to;
    tyni_meter m;
    crossing c;
    tyni_meter_begin(&m, it, lamp, v, light);
    c.position = tyni_row_position(row, p);
    c.outside = m.outside;
    c.looked = 0;
    c.edges = edges;
    for (int32_t i = 0; i < row->count && it->t0 < it->t1; i++) {
        const tyni_piece *piece = &row->pieces[i];
        tyni_line r = tyni_line_along(&piece->r, v), w = tyni_line_along(&piece->w, v);
        int lit = m.outside;
        if (!row_span(piece, r, w, it, &from, &to))
            continue;
        columns_of(row, piece, from, to, &first, &c.last);
        from = tyni_maxf(from, 0.0f);
        to = tyni_minf(to, (float)piece->steps);
        c.piece = piece;
        c.next = first;
        while (c.next <= c.last) {
            int32_t n = find(&c, finder);
            for (int32_t k = 0; k < n; k++) {
                /* the first column begins before the ray comes in, the last one ends behind its end; all others are between */
                float at = tyni_clampf((float)edges[k] * piece->unit, from, to);
                lit = !lit;
                tyni_meter_lit(&m, lit, (at * w.c - r.c) / (r.d - at * w.d));
            }
        }
    }
    if (it->t0 < it->t1)
        tyni_meter_end(&m);
    return c.looked;
}

int tyni_ray_columns(const tyni_row *row, const tyni_piece *piece, const tyni_integral *it, const tyni_sight *v, int32_t *first,
                     int32_t *last, float *from, float *to)
{
    if (!row_span(piece, tyni_line_along(&piece->r, v), tyni_line_along(&piece->w, v), it, from, to))
        return 0;
    columns_of(row, piece, *from, *to, first, last);
    return 1;
}

int tyni_ray_coarse(const tyni_finder *finder, const tyni_integral *it, const tyni_sight *v)
{
    const tyni_row *row = finder->row;
    float from, to, texels = 0.0f, depth = it->sigma[it->count - 1] * (it->t1 - it->t0);
    if (row->count < 1)
        return 0;
    for (int32_t i = 0; i < row->count; i++) {
        const tyni_piece *piece = &row->pieces[i];
        if (row_span(piece, tyni_line_along(&piece->r, v), tyni_line_along(&piece->w, v), it, &from, &to))
            texels += to - from;
    }
    /* a texel's share of the light, at most: 1 / texels in thin air, its optical depth in thick */
    return tyni_maxf(1.0f, depth) > finder->coarse * texels;
}

/* ---- bundles -------------------------------------------------------------------------------------------------------- */

/* Looks on along each ray until its edges are full or its columns have an end. Returns whether a ray has columns left. */
static int fill_edges(tyni_bundle *b, const tyni_finder *finder, const tyni_piece *piece, int outside, int32_t *looked)
{
    int left = 0;
    crossing c;
    c.piece = piece;
    c.outside = outside;
    c.looked = 0;
    for (int32_t n = 0; n < b->count; n++) {
        b->edges[n] = 0;
        if (b->next[n] > b->last[n])
            continue;
        if (tyni_ray_way(finder->rays, TYN_RAYS_SWEEP))
            tyni_sweep_to(finder->sweep, b->sample[n]);
        c.next = b->next[n];
        c.last = b->last[n];
        c.position = b->position[n];
        c.edges = b->edge + n * TYNI_RAY_EDGES;
        b->edges[n] = (uint16_t)find(&c, finder);
        b->next[n] = (uint16_t)c.next;
        left |= c.next <= c.last;
    }
    *looked += c.looked;
    return left;
}

/* The coarse rays of a bundle, from texel to texel: all of a slice's rays go along the same ones. */
static TYNI_NOINLINE void walk(tyni_bundle *b, int32_t isa, const tyni_slice *slice, const tyni_view *view,
                               const tyni_piece *piece, const tyni_lamp *lamp, const float sigma[2])
{
    const tyni_map *map = &lamp->maps[piece->map];
    paces w;
    TYNI_LANES_CALL(isa, ray_set_out, (b, slice, view, piece, map, &w));
    for (int32_t k = w.first; k <= w.last; k += PACES)
        TYNI_LANES_CALL(isa, ray_pass, (b, piece, &map->texels, k, lamp->outside, sigma, &w));
}

int32_t tyni_ray_bundle(tyni_bundle *b, const tyni_finder *finder, const tyni_slice *slice, const tyni_view *view,
                        const float *depth, float most, const tyni_lamp *lamp, const float sigma[2])
{
    const tyni_row *row = finder->row;
    int32_t looked = 0, isa = finder->isa;
    int left, outside = lamp->outside;
    b->coarse = 0;
    for (int32_t n = b->count; n < TYNI_RAY_BUNDLE; n++) {
        b->sample[n] = b->sample[0];
        b->edges[n] = 0;
    }
    TYNI_LANES_CALL(isa, ray_begin, (b, slice, view, row, depth, most));
    for (int32_t i = 1; i < row->count; i++)
        TYNI_LANES_CALL(isa, ray_spans, (b, slice, view, &row->pieces[i], 1));
    for (int32_t i = 0; i < row->count; i++) {
        const tyni_piece *piece = &row->pieces[i];
        if (row->count > 1)
            TYNI_LANES_CALL(isa, ray_spans, (b, slice, view, piece, 0));
        TYNI_LANES_CALL(isa, ray_enter, (b, row, piece, sigma[1], finder->coarse));
        if (b->coarse)
            walk(b, isa, slice, view, piece, lamp, sigma);
        do {
            if (finder->rays == TYN_RAYS_WORDS)
                left = TYNI_LANES_CALL(isa, ray_fill, (b, finder, piece, outside, &looked));
            else
                left = fill_edges(b, finder, piece, outside, &looked);
            TYNI_LANES_CALL(isa, ray_settle, (b, piece, sigma));
        } while (left);
    }
    TYNI_LANES_CALL(isa, ray_visible, (b, outside, sigma));
    return looked;
}
