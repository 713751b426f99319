/* fill.c - stage 2: which pixel centres lie in a piece, and which of them pass the depth test.
 *
 * An edge crosses a row's centre line at a rational number. The first pixel centre at or right of it is calculated exactly, in
 * integers, from the two end points alone, upper one first; it is where the triangle on the edge's right begins and where the
 * one on its left ends. So triangles that share an edge leave no gap and hit no pixel twice, and left edges belong to a
 * triangle while right ones don't. For rows it is the same: a row at the upper corner's height belongs to it, one at the lower
 * corner's does not. That is the top-left rule. */
#include "raster/raster.h"

#include "lanes/lanes.h"

/* First pixel centre at or right of an edge, in one row: a division that is carried on row by row, quotient `x`, remainder
 * `rest`. */
typedef struct edge {
    int32_t x, step;
    int64_t rest, step_rest, whole; /* 0 <= rest < whole; also of a step */
} edge;

typedef struct brush {
    const tyni_raster_pass *pass;
    const tyni_raster_piece *piece;
    int64_t pixels;
    int32_t probe;  /* only asks whether anything is covered */
    int32_t masked; /* the piece has a mask */
    int32_t ready;  /* its cutout is set up, which waits for the first pixel that passes the depth test */
    tyni_raster_cutout cutout;
} brush;

static int32_t first_row(int32_t y)
{
    return ((y + TYNI_RASTER_SUB / 2 - 1 + (1 << 26)) >> 8) - (1 << 18);
}

/* Division that rounds down, for n > 0. */
static int64_t floor_div(int64_t a, int64_t n)
{
    const int64_t q = a / n;
    return q - (a - q * n < 0);
}

static int32_t floor_div_small(int32_t a, int32_t n)
{
    const int32_t q = a / n;
    return q - (a - q * n < 0);
}

/* The edge from a down to b (a.y < b.y) at row y: x = ceil((a.x - 128 + (256 y + 128 - a.y) dx / dy) / 256). `many`: it will be
 * stepped. Small edges do with 32 bits: |dx|, dy < 2^15 keep the sum below 2^30 + 2^23 + 2^23. */
static void start(edge *e, const tyni_raster_point *a, const tyni_raster_point *b, int32_t y, int many)
{
    const int32_t dx = b->x - a->x, dy = b->y - a->y, below = TYNI_RASTER_SUB * y + TYNI_RASTER_SUB / 2 - a->y;
    const int32_t column = first_row(a->x), from = a->x - TYNI_RASTER_SUB / 2 - column * TYNI_RASTER_SUB; /* -255 .. 0 */
    e->whole = (int64_t)dy * TYNI_RASTER_SUB;
    e->step = 0;
    e->step_rest = 0;
    if (dx < 32768 && dx > -32768 && dy < 32768) {
        const int32_t whole = dy * TYNI_RASTER_SUB, sum = from * dy + below * dx + whole - 1;
        const int32_t q = floor_div_small(sum, whole);
        e->x = column + q;
        e->rest = sum - q * whole;
    } else {
        const int64_t sum = (int64_t)from * dy + (int64_t)below * dx + e->whole - 1;
        const int64_t q = floor_div(sum, e->whole);
        e->x = (int32_t)(column + q);
        e->rest = sum - q * e->whole;
    }
    if (many) {
        e->step = floor_div_small(dx, dy);
        e->step_rest = ((int64_t)dx - (int64_t)e->step * dy) * TYNI_RASTER_SUB;
    }
}

static void advance(edge *e)
{
    e->x += e->step;
    e->rest += e->step_rest;
    if (e->rest >= e->whole) {
        e->rest -= e->whole;
        e->x++;
    }
}

/* A row's span, ready for its pixels. */
typedef struct span {
    float *depth;
    uint8_t *colour; /* NULL: not wanted */
    float row, dx, low, high, nearest;
    int32_t y, from, to, x0, width;
    uint32_t mesh, triangle;
} span;

/* What all spans of a piece share. */
static void begin_spans(const brush *b, span *s)
{
    const tyni_raster_piece *piece = b->piece;
    s->dx = piece->plane.dx;
    s->low = piece->low;
    s->high = piece->high;
    s->nearest = b->pass->nearest;
    s->x0 = piece->plane.x0;
    s->width = b->pass->view.width;
    s->mesh = piece->mesh;
    s->triangle = piece->triangle;
}

static void begin_row(const brush *b, span *s, int32_t y)
{
    const tyni_raster_pass *pass = b->pass;
    s->depth = (float *)(void *)(pass->depth + y * pass->depth_stride);
    s->colour = pass->kind == TYNI_RASTER_SEEN ? pass->colour + y * pass->colour_stride : NULL;
    s->row = b->piece->plane.dy * (float)(y - b->piece->plane.y0) + b->piece->plane.value;
    s->y = y;
}

#define TYNI_KERNEL "raster/span.h"
#include "lanes/each.h"

static int solid(brush *b, int32_t x, int32_t y)
{
    if (!b->ready)
        tyni_raster_set_cutout(b->pass, b->piece, &b->cutout);
    b->ready = 1;
    return tyni_raster_solid(&b->cutout, x, y);
}

/* With a mask, asked last: it costs most. */
static int32_t span_cutout(const span *s, brush *b)
{
    const int shadow = b->pass->kind == TYNI_RASTER_SHADOW;
    int32_t passed = 0;
    for (int32_t x = s->from; x < s->to; x++) {
        const float value = tyni_clampf(s->dx * (float)(x - s->x0) + s->row, s->low, s->high), old = s->depth[x];
        const float z = shadow ? tyni_minf(value, 1.0f) : 1.0f / value;
        if (!(shadow ? z > old : z < old && z >= s->nearest) || !solid(b, x, s->y))
            continue;
        s->depth[x] = z;
        if (s->colour) {
            uint8_t *mark = s->colour + tyni_raster_mark_at(x);
            memcpy(mark, &s->mesh, 4);
            memcpy(mark + tyni_raster_mark_step(x, s->width), &s->triangle, 4);
        }
        passed++;
    }
    return passed;
}

static int cutout_rows(brush *b, edge *left, edge *right, int32_t y, int32_t end)
{
    int covered = 0;
    span s;
    begin_spans(b, &s);
    for (; y < end; y++) {
        s.from = tyni_maxi(left->x, 0);
        s.to = tyni_mini(right->x, s.width);
        if (s.from < s.to) {
            covered = 1;
            begin_row(b, &s, y);
            b->pixels += span_cutout(&s, b);
        }
        advance(left);
        advance(right);
    }
    return covered;
}

/* Whether there is a pixel between two edges in rows y .. end - 1. */
static int probe_rows(const brush *b, edge *left, edge *right, int32_t y, int32_t end)
{
    for (; y < end; y++) {
        if (tyni_maxi(left->x, 0) < tyni_mini(right->x, b->pass->view.width))
            return 1;
        advance(left);
        advance(right);
    }
    return 0;
}

static int fill_rows(brush *b, edge *left, edge *right, int32_t y, int32_t end)
{
    if (b->probe)
        return probe_rows(b, left, right, y, end);
    if (b->masked)
        return cutout_rows(b, left, right, y, end);
    return TYNI_LANES_CALL(b->pass->raster->isa, raster_fill_rows, (b, left, right, y, end));
}

static void order(const tyni_raster_point **a, const tyni_raster_point **b)
{
    if ((*b)->y < (*a)->y) {
        const tyni_raster_point *swap = *a;
        *a = *b;
        *b = swap;
    }
}

/* The part of a triangle in rows first .. end - 1. Says whether it covers a pixel there. */
static int fill_triangle(brush *b, const tyni_raster_point *top, const tyni_raster_point *middle,
                         const tyni_raster_point *bottom, int32_t first, int32_t end)
{
    edge longer, shorter;
    int32_t y, turn, last;
    int64_t right, left;
    int covered = 0, longer_left;
    order(&top, &middle);
    order(&middle, &bottom);
    order(&top, &middle);
    y = tyni_maxi(first, first_row(top->y));
    last = tyni_mini(end, first_row(bottom->y));
    if (y >= last)
        return 0;
    turn = tyni_clampi(first_row(middle->y), y, last);
    /* Compared, not subtracted: clang 14 turns the sign of such a difference on 32-bit MIPS (msub). */
    right = (int64_t)(middle->x - top->x) * (bottom->y - top->y);
    left = (int64_t)(bottom->x - top->x) * (middle->y - top->y);
    if (right == left)
        return 0;
    longer_left = right > left;
    start(&longer, top, bottom, y, last - y > 1);
    if (y < turn) {
        start(&shorter, top, middle, y, turn - y > 1);
        covered = longer_left ? fill_rows(b, &longer, &shorter, y, turn) : fill_rows(b, &shorter, &longer, y, turn);
        if (covered && b->probe)
            return 1;
    }
    if (turn < last) {
        start(&shorter, middle, bottom, turn, last - turn > 1);
        covered |= longer_left ? fill_rows(b, &longer, &shorter, turn, last) : fill_rows(b, &shorter, &longer, turn, last);
    }
    return covered;
}

/* A piece as a fan. A triangle is counted in the first band in which it covers a pixel. */
static int64_t fill_piece(brush *b, int32_t first, int32_t end, int32_t piece_first)
{
    const tyni_raster_point *p = b->piece->corner;
    int64_t drawn = 0;
    for (int32_t i = 2; i < b->piece->corners; i++) {
        if (!fill_triangle(b, &p[0], &p[i - 1], &p[i], first, end))
            continue;
        if (piece_first < first) {
            int before;
            b->probe = 1;
            before = fill_triangle(b, &p[0], &p[i - 1], &p[i], piece_first, first);
            b->probe = 0;
            if (before)
                continue;
        }
        drawn++;
    }
    return drawn;
}

void tyni_raster_fill(void *argument, int32_t band, int32_t worker)
{
    const tyni_raster_pass *pass = argument;
    const tyn_raster *raster = pass->raster;
    const int32_t first = band * TYNI_RASTER_BAND, end = tyni_mini(first + TYNI_RASTER_BAND, pass->view.height);
    tyni_raster_tally *tally = &raster->tallies[worker];
    int64_t drawn = 0;
    brush b;
    b.pass = pass;
    b.pixels = 0;
    b.probe = 0;
    for (int32_t c = 0; c < pass->chunks; c++) {
        const tyni_raster_chunk *chunk = &raster->chunks[c];
        if (chunk->first >= end || chunk->last < first)
            continue;
        for (int32_t i = c * TYNI_RASTER_CHUNK; i < c * TYNI_RASTER_CHUNK + chunk->count; i++) {
            const tyni_raster_rows rows = raster->rows[i];
            if (rows.first >= end || rows.last < first || rows.first > rows.last)
                continue;
            b.piece = &raster->pieces[i];
            b.masked = tyni_raster_masked(&pass->meshes[b.piece->mesh]);
            b.ready = 0;
            drawn += fill_piece(&b, first, end, rows.first);
        }
    }
    tally->drawn += drawn;
    tally->pixels += b.pixels;
}
