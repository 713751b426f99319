/* ray.c - see ray.h */
#include "ray.h"

#include "base.h"
#include "lanes/lanes.h"
#include "line.h"
#include "meter.h"

#define TYNI_KERNEL "ray_kernel.h"
#include "lanes/each.h"

/* ---- where a ray goes into the light and out of it ------------------------------------------------------------------ */

#define WORDS 16 /* of visibility at a time */
#define EDGES 48 /* at a time: more than a word can have */

/* A ray in one piece of the row, and how far the search has come. */
typedef struct crossing {
    const tyni_piece *piece;
    float from, to; /* step coordinates where it comes in and leaves */
    int32_t first, last;
    uint32_t position;
    int32_t next;  /* the column that is looked at next; behind last: all were */
    int lit;       /* before it */
    int32_t level; /* of the tree */
    int32_t looked;
} crossing;

/* `lit`: before the first column, where the search starts. */
static void crossing_begin(crossing *c, const tyni_piece *piece, float from, float to, uint32_t position, int lit)
{
    int32_t a = tyni_clampi((int32_t)from, 0, piece->steps - 1), b = tyni_clampi(tyni_ceili(to) - 1, a, piece->steps - 1);
    c->piece = piece;
    c->from = from;
    c->to = to;
    c->first = 2 * a + (from - (float)a >= piece->split[a]);
    c->last = 2 * b + (to - (float)b > piece->split[b]);
    c->position = position;
    c->next = c->first;
    c->lit = lit;
    c->level = 0;
    c->looked = 0;
}

/* Where column i begins for the ray: the first one where it comes in. */
static float edge_of(const crossing *c, int32_t i)
{
    return i <= c->first ? tyni_maxf(c->from, 0.0f) : tyni_row_edge(c->piece, i);
}

/* IVB's march without its tree. */
static int32_t each_column(crossing *c, float *at)
{
    int32_t n = 0, start = c->next;
    for (; c->next <= c->last && n < EDGES; c->next++)
        if ((c->position < c->piece->threshold[c->next]) != c->lit) {
            c->lit = !c->lit;
            at[n++] = edge_of(c, c->next);
        }
    c->looked += c->next - start;
    return n;
}

/* IVB's march with its tree. */
static int32_t descend(crossing *c, const tyni_finder *finder, float *at)
{
    int32_t n = 0, top;
    while (c->next <= c->last && n < EDGES) {
        int32_t i = c->piece->first + c->next;
        int lit;
        c->looked += tyni_tree_span(finder->tree, finder->row->threshold, c->position, i, &c->level, &top, &lit);
        if (lit != c->lit) {
            c->lit = lit;
            at[n++] = edge_of(c, c->next);
        }
        c->next += 1 << c->level;
    }
    return n;
}

/* The transitions of a word of visibility that begins at column i. */
static int32_t transitions(crossing *c, int32_t i, uint32_t bits, float *at)
{
    int32_t left = c->last - i + 1, n = 0;
    uint32_t changes = bits ^ (bits << 1 | (uint32_t)c->lit);
    if (left < 32)
        changes &= (1u << left) - 1u;
    for (; changes; changes &= changes - 1) {
        c->lit = !c->lit;
        at[n++] = edge_of(c, i + tyni_ctz32(changes));
    }
    return n;
}

/* 32 columns at a time: words of visibility, made by compares or kept by the sweep, and their transitions by bit scans. */
static int32_t packed_words(crossing *c, const tyni_finder *finder, float *at)
{
    uint32_t words[WORDS];
    int32_t n = 0, w = 0, count = tyni_mini((c->last - c->next) / 32 + 1, WORDS);
    const uint16_t *threshold = c->piece->threshold + c->next;
    if (finder->rays == TYN_RAYS_SWEEP) {
        for (int32_t k = 0; k < count; k++)
            words[k] = tyni_sweep_word(finder->sweep, c->piece->first + c->next + 32 * k);
    } else {
        TYNI_LANES_CALL(finder->isa, ray_compare, (threshold, count, c->position, words));
    }
    for (; w < count && n <= EDGES - 32; w++, c->next += 32)
        n += transitions(c, c->next, words[w], at + n);
    c->looked += w;
    return n;
}

/* The next edges, at most EDGES; all are found when c->next is behind c->last. */
static int32_t find(crossing *c, const tyni_finder *finder, float *at)
{
    if (finder->rays == TYN_RAYS_TREE)
        return descend(c, finder, at);
    return finder->rays == TYN_RAYS_COLUMNS ? each_column(c, at) : packed_words(c, finder, at);
}

/* Where the last column ends, back to what is outside. */
static float end_of(const crossing *c)
{
    return tyni_minf(c->to, (float)c->piece->steps);
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

/* t of a step coordinate. */
static float edge_t(float at, float rc, float rd, float wc, float wd)
{
    return (at * wc - rc) / (rd - at * wd);
}

int32_t tyni_ray_row(const tyni_finder *finder, float p, const tyni_lamp *lamp, const tyni_integral *it, const tyni_sight *v,
                     float *light)
{
    const tyni_row *row = finder->row;
    uint32_t position = tyni_row_position(row, p);
    int32_t looked = 0;
    float at[EDGES], from, to;
    tyni_meter m;
    crossing c;
    tyni_meter_begin(&m, it, lamp, v, light);
    if (!(it->t0 < it->t1))
        return 0;
    for (int32_t i = 0; i < row->count; i++) {
        tyni_line r = tyni_line_along(&row->pieces[i].r, v), w = tyni_line_along(&row->pieces[i].w, v);
        int lit = m.outside;
        if (!row_span(&row->pieces[i], r, w, it, &from, &to))
            continue;
        crossing_begin(&c, &row->pieces[i], from, to, position, m.outside);
        while (c.next <= c.last) {
            int32_t n = find(&c, finder, at);
            for (int32_t k = 0; k < n; k++) {
                lit = !lit;
                tyni_meter_lit(&m, lit, edge_t(at[k], r.c, r.d, w.c, w.d));
            }
        }
        looked += c.looked;
        tyni_meter_lit(&m, m.outside, edge_t(end_of(&c), r.c, r.d, w.c, w.d));
    }
    tyni_meter_end(&m);
    return looked;
}

int tyni_ray_columns(const tyni_piece *piece, const tyni_integral *it, const tyni_sight *v, int32_t *first, int32_t *last,
                     float *from, float *to)
{
    crossing c;
    if (!row_span(piece, tyni_line_along(&piece->r, v), tyni_line_along(&piece->w, v), it, from, to))
        return 0;
    crossing_begin(&c, piece, *from, *to, 0, 0);
    *first = c.first;
    *last = c.last;
    return 1;
}

int tyni_ray_coarse(const tyni_row *row, const tyni_integral *it, const tyni_sight *v)
{
    float from, to, texels = 0.0f, depth = it->sigma[it->count - 1] * (it->t1 - it->t0);
    if (row->count < 1)
        return 0;
    for (int32_t i = 0; i < row->count; i++) {
        const tyni_piece *piece = &row->pieces[i];
        if (row_span(piece, tyni_line_along(&piece->r, v), tyni_line_along(&piece->w, v), it, &from, &to))
            texels += to - from;
    }
    /* a texel's share of the light, at most: 1 / texels in thin air, its optical depth in thick */
    return tyni_maxf(1.0f, depth) > 0.05f * texels;
}

/* ---- bundles -------------------------------------------------------------------------------------------------------- */

void tyni_ray_bundle(tyni_bundle *b, int32_t isa, const tyni_slice *slice, const tyni_view *view, float most,
                     const float sigma[2])
{
    TYNI_LANES_CALL(isa, ray_begin, (b, slice, view, most, sigma));
    b->edges = 0;
}

/* The integrals of the edges that wait, and their sums, ray by ray in order. */
static void settle(tyni_bundle *b, int32_t isa, const float sigma[2], int32_t channels)
{
    TYNI_LANES_CALL(isa, ray_integrals, (b, sigma, channels));
    for (int32_t i = 0; i < b->edges;) {
        int32_t n = b->ray[i], on = b->on[i];
        float sum[2];
        sum[0] = b->sum[0][n];
        sum[1] = b->sum[1][n];
        for (; i < b->edges && b->ray[i] == n; i++, on = !on) {
            sum[0] = on ? sum[0] - b->value[0][i] : sum[0] + b->value[0][i];
            if (channels > 1)
                sum[1] = on ? sum[1] - b->value[1][i] : sum[1] + b->value[1][i];
        }
        b->sum[0][n] = sum[0];
        b->sum[1][n] = sum[1];
    }
    b->edges = 0;
}

static int32_t cross(tyni_bundle *b, int32_t n, const tyni_finder *finder, const tyni_piece *piece, int outside,
                     const float sigma[2], int32_t channels)
{
    uint32_t position = tyni_row_position(finder->row, b->p[n]);
    float at[EDGES + 16]; /* whole vectors */
    int on = 0;
    crossing c;
    crossing_begin(&c, piece, b->from[n], b->until[n], position, outside);
    while (c.next <= c.last) {
        int32_t count = find(&c, finder, at);
        if (c.next > c.last && c.lit != outside)
            at[count++] = end_of(&c);
        if (b->edges + count > TYNI_RAY_EDGES)
            settle(b, finder->isa, sigma, channels);
        TYNI_LANES_CALL(finder->isa, ray_places, (b, n, at, count));
        for (int32_t k = 0; k < count; k++, on = !on) {
            b->ray[b->edges + k] = (uint8_t)n;
            b->on[b->edges + k] = (uint8_t)!on;
        }
        b->edges += count;
    }
    return c.looked;
}

int32_t tyni_ray_bundle_row(tyni_bundle *b, const tyni_finder *finder, int outside, const float sigma[2], int32_t channels)
{
    int32_t looked = 0;
    for (int32_t i = 0; i < finder->row->count; i++) {
        const tyni_piece *piece = &finder->row->pieces[i];
        TYNI_LANES_CALL(finder->isa, ray_spans, (b, piece));
        for (int32_t n = 0; n < b->count; n++)
            if (b->from[n] < b->until[n])
                looked += cross(b, n, finder, piece, outside, sigma, channels);
        settle(b, finder->isa, sigma, channels);
    }
    return looked;
}
