/* fourier.c - see fourier.h */
#include "fourier.h"

#include "base.h"
#include "lanes/lanes.h"
#include "num.h"

#define KNOTS TYNI_FOURIER_KNOTS
#define BINS TYNI_FOURIER_BINS
#define EVEN 0.25f /* see tyni_fourier_cells */

#define TYNI_KERNEL "fourier_kernel.h"
#include "lanes/each.h"

/* The columns of a slice on their way into a row. */
typedef struct mill {
    const tyni_fourier *f;
    const tyni_slice *slice;
    tyni_shelf *shelf;
    int32_t cell;             /* in hand: next to be stored */
    float from, to;           /* its columns */
    float start[12], end[12]; /* of the sets: weight per column at from and to */
    int32_t steep;            /* parts of the cell for which a straight line between those serves; 0: the whole */
    /* sums over the columns so far, of each set; the column's basis, as stored: sines, then cosines; the histogram */
    float *total, *constant, *share, *sum, *wave, *bins;
} mill;

size_t tyni_fourier_bytes(int32_t bases, int32_t columns, int32_t sets)
{
    return sizeof(tyni_shelf) + (size_t)columns * (size_t)sets * TYNI_FOURIER_LENGTH((size_t)bases);
}

size_t tyni_fourier_scratch(int32_t bases, int32_t sets)
{
    return sizeof(float) * ((size_t)sets * (3 + (size_t)bases) + (size_t)bases + 8 + BINS);
}

static void mill_scratch(mill *m, void *scratch)
{
    float *at = scratch;
    int32_t sets = m->f->sets;
    m->total = at;
    m->constant = at + sets;
    m->share = at + 2 * sets;
    m->sum = at + 3 * sets;
    m->wave = m->sum + sets * m->f->bases;
    m->bins = m->wave + m->f->bases + 8;
    memset(at, 0, sizeof *at * (size_t)(sets * (3 + m->f->bases)));
}

/* The paper's one reference ray, as k: between the outermost rays of the slice, whose sines to the light are sigma / k. */
static float bisectrix(const tyni_fourier *f, const float lean[2])
{
    const tyni_medium *m = f->medium;
    float sine, bend = 0.0f, cosine;
    for (int32_t i = 0; i < 2; i++) {
        sine = tyni_clampf(m->sigma[i ? m->high : m->low] / tyni_maxf(lean[i], 1e-20f), 0.0f, 1.0f);
        bend += 0.5f * tyni_num_atan2(sine, sqrtf(1.0f - sine * sine));
    }
    tyni_num_sincos(bend, &sine, &cosine);
    return 0.5f * (m->sigma[m->low] + m->sigma[m->high]) / tyni_maxf(sine, 1e-9f);
}

/* Reference rays of a directional light: between the least and the largest k, about as far apart in ratio, closer where k is
 * little, since few rays lean as far as those next to the epipole. Visibility is interpolated over k itself all the same:
 * straight lines over log k miss three times as much around an epipole, over 1 / k six times. */
static void set_rates(mill *m, const float lean[2])
{
    const tyni_fourier *f = m->f;
    tyni_shelf *s = m->shelf;
    float a = tyni_maxf(lean[0], 0.1f / s->high), b = tyni_maxf(lean[1], a), ratio = tyni_num_log(b / a); /* less is none */
    int32_t n = f->references;
    s->lean[0] = n > 1 ? a : f->geometric ? a * tyni_num_exp(0.5f * ratio) : bisectrix(f, lean);
    for (int32_t i = 1; i < n; i++)
        s->lean[i] = i + 1 == n ? b : a * tyni_num_exp(ratio * 0.9f * (float)i / (float)(n - 1));
    s->density = f->average ? 0.0f : a * tyni_num_exp(0.5f * ratio);
}

/* Reference rays of a spot or point light: by their angle to the way to the light. A straight line through two is best where
 * those are not at the ends. */
static void set_angles(mill *m, const float lean[2])
{
    int32_t n = m->f->references;
    float inset = n == 1 ? 0.5f : n == 2 ? 0.15f : 0.0f, step = n > 1 ? (1.0f - 2.0f * inset) / (float)(n - 1) : 0.0f;
    for (int32_t i = 0; i < n; i++)
        m->shelf->lean[i] = lean[0] + (lean[1] - lean[0]) * (inset + (float)i * step);
    m->shelf->density = 0.0f;
}

static void set_references(mill *m, const tyni_fourier_range *range)
{
    tyni_shelf *s = m->shelf;
    float width = s->high - s->low;
    if (m->f->lamp->kind == TYN_LIGHT_DIRECTIONAL)
        set_rates(m, range->lean);
    else
        set_angles(m, range->lean);
    s->near_share = s->density * width < 0.5f ? 0.0f : (1.0f - EVEN) / (width * tyni_num_fog(s->density * width));
    s->far_share = (s->near_share > 0.0f ? EVEN : 1.0f) / width;
}

/* Where cell `cell` ends: Newton's steps from where it begins, on a curve that only flattens; they stop short of the end. */
static float cell_end(const mill *m)
{
    const tyni_shelf *s = m->shelf;
    float y = (float)(m->cell + 1) / (float)m->f->columns, x = m->from - s->low;
    if (m->cell + 1 >= m->f->columns)
        return s->high;
    for (int32_t i = 0; i < 4; i++)
        x += (y - tyni_fourier_cells(s, x)) / (s->near_share * tyni_num_exp(-s->density * x) + s->far_share);
    return tyni_clampf(s->low + x, m->from, s->high);
}

/* What column x weighs in each set, per width. */
static void densities(const mill *m, float x, float *out)
{
    const tyni_fourier *f = m->f;
    for (int32_t r = 0; r < f->references; r++) {
        float sine, cosine, theta, path, tangent, mix[3], lean = m->shelf->lean[r];
        if (f->average || f->lamp->kind == TYN_LIGHT_DIRECTIONAL) {
            float k = f->average ? 0.0f : lean;
            for (int32_t c = 0; c < f->channels; c++)
                out[r * f->channels + c] = tyni_num_exp(-k * x);
            continue;
        }
        /* t + r = D cos(angle) + h tan(theta / 2); where the column passes the ray by, as far as light goes */
        tyni_num_sincos(lean, &sine, &cosine);
        theta = tyni_minf(lean + x, TYNI_PI);
        path = f->lamp->distance * cosine;
        tyni_num_sincos(0.5f * theta, &mix[0], &mix[1]);
        tangent = mix[1] > 1e-4f ? mix[0] / mix[1] : 1e4f;
        path = tyni_minf(path + f->lamp->distance * sine * tangent, f->far_x);
        tyni_num_sincos(theta, &sine, &cosine);
        tyni_medium_mix(f->medium, tyni_clampf(cosine, -1.0f, 1.0f), mix);
        if (f->channels == 1) {
            float grey = 0.5f * (f->medium->sigma[f->medium->low] + f->medium->sigma[f->medium->high]);
            out[r] = (mix[0] + mix[1] + mix[2]) * tyni_num_exp(-grey * path);
        } else {
            for (int32_t c = 0; c < 3; c++)
                out[r * 3 + c] = mix[c] * tyni_num_exp(-f->medium->sigma[c] * path);
        }
    }
}

/* The knots: z rises evenly with (1 - remap) of the positions and remap of the histogram. */
static void set_knots(mill *m, const tyni_columns *begin)
{
    tyni_columns c = *begin;
    tyni_shelf *s = m->shelf;
    float from, to, all = 0.0f, density = s->density, even, sum = 0.0f, scale = 1.0f, last = 0.0f;
    uint32_t q;
    int32_t k = 1;
    memset(m->bins, 0, sizeof *m->bins * BINS);
    while (tyni_columns_next(&c, &from, &to, &q)) {
        float w = tyni_minf(to, s->high) - tyni_maxf(from, s->low);
        if (!(w > 0.0f) || q == 0 || q == 65535)
            continue;
        if (density * (from - last) > 0.1f) { /* near enough to where it was last computed */
            scale = tyni_num_exp(-density * from);
            last = from;
        }
        w *= scale;
        m->bins[q * BINS >> 16] += w;
        all += w;
    }
    even = (all > 0.0f ? 1.0f - m->f->remap : 1.0f) / (float)BINS;
    all = all > 0.0f ? m->f->remap / all : 0.0f;
    s->knot[0] = 0;
    for (int32_t b = 0; b < BINS; b++) {
        float step = even + all * m->bins[b];
        for (; k < KNOTS && sum + step >= (float)k * (1.0f / (float)KNOTS); k++) {
            float at = step > 0.0f ? ((float)k * (1.0f / (float)KNOTS) - sum) / step : 0.0f;
            s->knot[k] = (uint16_t)(((float)b + tyni_clampf(at, 0.0f, 1.0f)) * (65535.0f / (float)BINS));
        }
        sum += step;
    }
    for (; k <= KNOTS + 1; k++)
        s->knot[k] = 65535;
}

/* The part a .. b of a column, inside the cell in hand. kind: 0 dark, 1 lit, 2 in the basis. */
static void add(const mill *m, float a, float b, int32_t kind, const float rgb[3])
{
    const tyni_fourier *f = m->f;
    float lift = f->lamp->lift, at = m->to > m->from ? (0.5f * (a + b) - m->from) / (m->to - m->from) : 0.5f, middle[12];
    if (m->steep)
        densities(m, 0.5f * (a + b), middle);
    for (int32_t i = 0; i < f->sets; i++) {
        /* never nothing: where all weights underflow there is still a mean */
        float w = (b - a) * tyni_maxf(m->steep ? middle[i] : m->start[i] + at * (m->end[i] - m->start[i]), 1e-20f);
        float light = f->channels == 3 ? w * rgb[i % 3] : w, *sum = m->sum + (ptrdiff_t)i * f->bases;
        m->total[i] += w;
        m->constant[i] += light * (kind == 1 ? 1.0f : lift);
        if (kind < 2)
            continue;
        light *= 1.0f - lift;
        m->share[i] += light;
        TYNI_LANES_CALL(f->isa, fourier_add, (sum, m->wave, light, f->bases));
    }
}

static void store(mill *m)
{
    const tyni_fourier *f = m->f;
    uint8_t *out = (uint8_t *)(m->shelf + 1) + m->cell * tyni_fourier_pitch(f);
    for (int32_t i = 0; i < f->sets; i++, out += TYNI_FOURIER_LENGTH(f->bases)) {
        const float *sum = m->sum + (ptrdiff_t)i * f->bases;
        float inverse = 1.0f / (tyni_maxf(m->total[i], 1e-30f) * m->shelf->scale[i % f->channels]);
        float part = m->share[i] > 0.0f ? 127.0f / m->share[i] : 0.0f;
        int16_t constant = (int16_t)tyni_floori(tyni_clampf(m->constant[i] * inverse, -1.0f, 1.0f) * 32767.0f + 0.5f);
        uint16_t share = (uint16_t)(tyni_clampf(m->share[i] * inverse, 0.0f, 1.0f) * 65535.0f + 0.5f);
        memcpy(out, &constant, sizeof constant);
        memcpy(out + 2, &share, sizeof share);
        TYNI_LANES_CALL(f->isa, fourier_bytes, (sum, part, f->bases, out + 4));
    }
}

/* The largest that constant and share can be. Colour is looked at more often than it is stored, and its means stay below
 * its peaks. */
static void set_scale(mill *m)
{
    const tyni_fourier *f = m->f;
    float most = tyni_maxf(1.0f, tyni_maxf(tyni_absf(f->lamp->lift), tyni_absf(1.0f - f->lamp->lift)));
    float peak[3] = {1e-6f, 1e-6f, 1e-6f}, rgb[3];
    int32_t looks = 2 * f->columns;
    for (int32_t i = 0; i < looks && f->channels == 3; i++) {
        float x = m->shelf->low + (m->shelf->high - m->shelf->low) * ((float)i + 0.5f) / (float)looks;
        tyni_view_colour(f->lamp, tyni_columns_point(m->slice, f->lamp, x), rgb);
        for (int32_t c = 0; c < 3; c++)
            peak[c] = tyni_maxf(peak[c], rgb[c]);
    }
    for (int32_t c = 0; c < 3; c++)
        m->shelf->scale[c] = f->channels == 3 ? most * peak[c] : most;
}

/* A column's part inside the cell in hand, in pieces where light changes along the cell: its colour, or its weight by much. */
static void add_part(const mill *m, float a, float b, int32_t kind)
{
    float rgb[3] = {1.0f, 1.0f, 1.0f}, step;
    int32_t parts = m->f->channels == 3 ? tyni_maxi(m->steep, 4) : m->steep;
    if (parts > 1)
        parts = tyni_clampi(tyni_ceili((float)parts * (b - a) / (m->to - m->from)), 1, parts);
    parts = tyni_maxi(parts, 1);
    step = (b - a) / (float)parts;
    for (int32_t i = 0; i < parts; i++) {
        float from = a + (float)i * step;
        if (m->f->channels == 3)
            tyni_view_colour(m->f->lamp, tyni_columns_point(m->slice, m->f->lamp, from + 0.5f * step), rgb);
        add(m, from, from + step, kind, rgb);
    }
}

/* The cell that begins at `to`, or the first. */
static void next_cell(mill *m)
{
    float fall = 1.0f;
    densities(m, m->from, m->start);
    m->to = cell_end(m);
    densities(m, m->to, m->end);
    for (int32_t i = 0; i < m->f->sets; i++)
        fall = m->end[i] < fall * m->start[i] ? m->end[i] / m->start[i] : fall;
    /* pieces over which weight falls to no less than two thirds or so, as long as that is of any account */
    m->steep = fall > 0.6f ? 0 : tyni_clampi((int32_t)(-2.5f * tyni_num_log(tyni_maxf(fall, 1e-6f))), 1, 24);
}

static void grind(mill *m, tyni_columns *c)
{
    const tyni_fourier *f = m->f;
    float from, to;
    uint32_t q;
    m->cell = 0;
    m->from = m->shelf->low;
    next_cell(m);
    while (m->cell < f->columns && tyni_columns_next(c, &from, &to, &q)) {
        int32_t kind = f->all ? 2 : q == 0 ? 0 : q == 65535 ? 1 : 2;
        from = tyni_maxf(from, m->shelf->low);
        if (!(to > from))
            continue;
        if (kind == 2)
            TYNI_LANES_CALL(f->isa, fourier_waves, (f, m->shelf, q, m->wave));
        while (m->cell < f->columns) {
            float end = tyni_minf(to, m->to);
            if (end > from)
                add_part(m, from, end, kind);
            if (to < m->to)
                break;
            from = end;
            store(m);
            m->cell++;
            m->from = m->to;
            next_cell(m);
        }
    }
    for (; m->cell < f->columns; m->cell++)
        store(m);
}

void tyni_fourier_build(const tyni_fourier *f, tyni_shelf *shelf, void *scratch, const tyni_row *row, const tyni_slice *slice,
                        const tyni_fourier_range *range)
{
    mill m;
    tyni_columns columns;
    float x[2];
    memset(shelf, 0, sizeof *shelf);
    if (!range->count)
        return;
    x[0] = 0.0f;
    x[1] = range->x;
    tyni_columns_volume(slice, f->lamp, x);
    if (!(x[1] - x[0] > 1e-30f)) /* shares of the width are finite */
        return;
    memset(&m, 0, sizeof m);
    m.f = f;
    m.slice = slice;
    m.shelf = shelf;
    mill_scratch(&m, scratch);
    shelf->low = x[0];
    shelf->high = x[1];
    shelf->p_start = row->p_start;
    shelf->p_scale = row->p_scale;
    shelf->valid = 1;
    set_references(&m, range);
    tyni_columns_begin(&columns, row, slice, f->lamp, shelf->high);
    set_knots(&m, &columns);
    set_scale(&m);
    grind(&m, &columns);
}

void tyni_fourier_show(const tyni_fourier *f, const tyni_shelf *s, int32_t column, float show[3])
{
    const uint8_t *row =
        (const uint8_t *)(s + 1) + column * tyni_fourier_pitch(f) + (ptrdiff_t)(f->sets / 2) * TYNI_FOURIER_LENGTH(f->bases);
    int16_t constant;
    if (!s->valid)
        return;
    memcpy(&constant, row, sizeof constant);
    show[0] = tyni_maxf((float)constant, 0.0f) * (1.0f / 32767.0f);
    show[1] = (float)(row[4] ^ 128) * (1.0f / 255.0f);
    show[2] = (float)(row[4 + f->bases / 2] ^ 128) * (1.0f / 255.0f);
}
