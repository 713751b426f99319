/* fourier.c - see fourier.h */
#include "fourier.h"

#include "base.h"
#include "lanes/lanes.h"
#include "num.h"

#define KNOTS TYNI_FOURIER_KNOTS
#define BINS TYNI_FOURIER_BINS
#define EVEN 0.25f                  /* see cells */
#define LENGTH(bases) (4 + (bases)) /* bytes of a set in a column */

#define TYNI_KERNEL "fourier_kernel.h"
#include "lanes/each.h"

/* ---- rays ---------------------------------------------------------------------------------------------------------- */

void tyni_fourier_sight(const tyni_fourier *f, const tyni_sight *v, float t1, tyni_fourier_ray *ray)
{
    const tyni_lamp *lamp = f->lamp;
    float along = tyni_vec_dot(v->d, lamp->to_light), across;
    across = tyni_vec_length(tyni_vec_mad(v->d, -along, lamp->to_light));
    if (lamp->kind == TYN_LIGHT_DIRECTIONAL) {
        float inverse = 1.0f / tyni_maxf(across, 1e-4f); /* nearer to the epipole rays are walked, or there is no map */
        ray->x = across * t1;
        for (int32_t c = 0; c < 3; c++)
            ray->lean[c] = f->medium->sigma[c] * inverse;
        return;
    }
    ray->x = tyni_num_atan2(across * t1, lamp->distance - along * t1);
    ray->lean[0] = ray->lean[1] = ray->lean[2] = tyni_num_atan2(across, along);
}

/* Texels that the ray crosses along a map's longer axis. */
static float texels_crossed(const tyni_map *map, tyni_vec3 a, tyni_vec3 b)
{
    float wa = tyni_maxf(tyni_form_at(&map->w, a), 1e-6f), wb = tyni_maxf(tyni_form_at(&map->w, b), 1e-6f);
    float du = tyni_form_at(&map->u, b) / wb - tyni_form_at(&map->u, a) / wa;
    float dv = tyni_form_at(&map->v, b) / wb - tyni_form_at(&map->v, a) / wa;
    return tyni_maxf(tyni_absf(du), tyni_absf(dv));
}

int tyni_fourier_coarse(const tyni_fourier *f, const tyni_sight *v, float t0, float t1)
{
    const tyni_lamp *lamp = f->lamp;
    float texels = 0.0f, depth = f->medium->sigma[f->medium->high] * (t1 - t0);
    if (!lamp->map_count || f->no_walks)
        return 0;
    if (lamp->kind == TYN_LIGHT_DIRECTIONAL) {
        for (int32_t i = 0; i < lamp->map_count; i++)
            texels = tyni_maxf(texels, texels_crossed(&lamp->maps[i], tyni_sight_at(v, t0), tyni_sight_at(v, t1)));
    } else { /* by the angle at the light: whichever faces the ray meets, their texels are of about one size */
        const tyni_map *map = &lamp->maps[0];
        float w = tyni_vec_length(map->w.v);
        tyni_vec3 axis = tyni_vec_normalise(map->w.v), a = tyni_vec_sub(tyni_sight_at(v, t0), lamp->position);
        tyni_vec3 b = tyni_vec_sub(tyni_sight_at(v, t1), lamp->position);
        float size = tyni_vec_length(tyni_vec_mad(map->u.v, -tyni_vec_dot(map->u.v, axis), axis));
        texels = tyni_num_atan2(tyni_vec_length(tyni_vec_cross(a, b)), tyni_vec_dot(a, b)) * size / tyni_maxf(w, 1e-20f);
    }
    /* as tyni_ray_coarse */
    return tyni_maxf(1.0f, depth) > 0.05f * texels;
}

void tyni_fourier_widen(tyni_fourier_range *r, const tyni_fourier_ray *ray)
{
    for (int32_t c = 0; c < 3; c++) {
        r->lean[0] = r->count + c ? tyni_minf(r->lean[0], ray->lean[c]) : ray->lean[c];
        r->lean[1] = r->count + c ? tyni_maxf(r->lean[1], ray->lean[c]) : ray->lean[c];
    }
    r->x = r->count ? tyni_maxf(r->x, ray->x) : ray->x;
    r->count++;
}

/* ---- z ------------------------------------------------------------------------------------------------------------- */

/* Place of a position between the knots, 0 .. KNOTS. */
static float place(const tyni_shelf *s, float position)
{
    int32_t a = 0;
    float low, high;
    for (int32_t half = KNOTS / 2; half; half >>= 1)
        a += (float)s->knot[a + half] <= position ? half : 0;
    low = (float)s->knot[a];
    high = (float)s->knot[a + 1];
    return (float)a + (high > low ? tyni_minf((position - low) / (high - low), 1.0f) : 0.5f);
}

static float z_of(const tyni_fourier *f, const tyni_shelf *s, float position)
{
    return f->margin + (1.0f - 2.0f * f->margin) / (float)KNOTS * place(s, position);
}

/* Sines and cosines of pi (2 k - 1) z for k = 1 .. count; room for a multiple of 4. Four orders at a time turn by the same
 * angle: short chains, and a compiler can do them side by side. */
static void waves(float z, int32_t count, float *sine, float *cosine)
{
    float s, c, s2, c2, s4, c4, s8, c8;
    tyni_num_sincos(TYNI_PI * z, &s, &c);
    s2 = 2.0f * s * c;
    c2 = 1.0f - 2.0f * s * s;
    s4 = 2.0f * s2 * c2;
    c4 = 1.0f - 2.0f * s2 * s2;
    s8 = 2.0f * s4 * c4;
    c8 = 1.0f - 2.0f * s4 * s4;
    sine[0] = s;
    cosine[0] = c;
    sine[1] = s * c2 + c * s2;
    cosine[1] = c * c2 - s * s2;
    sine[2] = s * c4 + c * s4;
    cosine[2] = c * c4 - s * s4;
    sine[3] = sine[1] * c4 + cosine[1] * s4;
    cosine[3] = cosine[1] * c4 - sine[1] * s4;
    for (int32_t k = 4; k < count; k += 4)
        for (int32_t i = k; i < k + 4; i++) {
            sine[i] = sine[i - 4] * c8 + cosine[i - 4] * s8;
            cosine[i] = cosine[i - 4] * c8 - sine[i - 4] * s8;
        }
}

/* Columns are stored at equal steps of this, 0 at `low` .. 1 at `high`: of transmittance along a middling ray, and for a part
 * of distance, so that the last of them in thick air are not as wide as all others. x from low. */
static float cells(const tyni_shelf *s, float x)
{
    return x * (s->far_share + (s->near_share > 0.0f ? s->near_share * tyni_num_fog(s->density * x) : 0.0f));
}

/* ---- rows ---------------------------------------------------------------------------------------------------------- */

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
    return sizeof(tyni_shelf) + (size_t)columns * (size_t)sets * LENGTH((size_t)bases);
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
        s->lean[i] = i + 1 == n ? b : a * tyni_num_exp(ratio * 0.8f * (float)i / (float)(n - 1));
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
        x += (y - cells(s, x)) / (s->near_share * tyni_num_exp(-s->density * x) + s->far_share);
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

/* Bytes from one column to the next, which begin after the shelf. */
static ptrdiff_t pitch(const tyni_fourier *f)
{
    return (ptrdiff_t)f->sets * LENGTH(f->bases);
}

static void store(mill *m)
{
    const tyni_fourier *f = m->f;
    uint8_t *out = (uint8_t *)(m->shelf + 1) + m->cell * pitch(f);
    for (int32_t i = 0; i < f->sets; i++, out += LENGTH(f->bases)) {
        const float *sum = m->sum + (ptrdiff_t)i * f->bases;
        float inverse = 1.0f / (tyni_maxf(m->total[i], 1e-30f) * m->shelf->scale[i % f->channels]);
        float part = m->share[i] > 0.0f ? 127.0f / m->share[i] : 0.0f;
        int16_t constant = (int16_t)tyni_floori(tyni_clampf(m->constant[i] * inverse, -1.0f, 1.0f) * 32767.0f + 0.5f);
        uint16_t share = (uint16_t)(tyni_clampf(m->share[i] * inverse, 0.0f, 1.0f) * 65535.0f + 0.5f);
        memcpy(out, &constant, sizeof constant);
        memcpy(out + 2, &share, sizeof share);
        for (int32_t k = 0; k < f->bases; k++)
            out[4 + k] = (uint8_t)(128 + tyni_floori(tyni_clampf(sum[k] * part, -127.0f, 127.0f) + 0.5f));
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

static void column_waves(const mill *m, float position)
{
    float sine[64], cosine[64];
    int32_t half = m->f->bases / 2;
    waves(z_of(m->f, m->shelf, position), half, sine, cosine);
    memcpy(m->wave, sine, sizeof *sine * (size_t)half);
    memcpy(m->wave + half, cosine, sizeof *cosine * (size_t)half);
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
            column_waves(m, (float)q - 0.5f);
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

/* ---- evaluation ---------------------------------------------------------------------------------------------------- */

/* 32767 a_k(z): the paper's eq. 8. Returns 128 times their sum. */
static int32_t coefficients(const tyni_fourier *f, float z, int32_t *a)
{
    float sine[64], cosine[64];
    int32_t half = f->bases / 2, sum = 0;
    waves(z, half, sine, cosine);
    for (int32_t k = 0; k < half; k++) {
        float most = (float)f->amplitude[k];
        a[k] = (int32_t)(most * cosine[k]);
        a[half + k] = (int32_t)(-most * sine[k]);
        sum += a[k] + a[half + k];
    }
    return 128 * sum;
}

/* The mean over a stored row with the sum of its bases. */
static float row_mean(const uint8_t *row, int32_t sum)
{
    int16_t constant;
    uint16_t share;
    memcpy(&constant, row, sizeof constant);
    memcpy(&share, row + 2, sizeof share);
    return (float)constant * (1.0f / 32767.0f) +
           (float)share * (1.0f / 65535.0f) * tyni_clampf(0.5f + (float)sum * (0.636619772f / (127.0f * 32767.0f)), 0.0f, 1.0f);
}

/* Means at position z of the sets first .. last - 1 of a stored column and, for the part 1 - at, of the one before it. */
static void means(const tyni_fourier *f, const uint8_t *high, const uint8_t *low, float at, float z, int32_t first,
                  int32_t last, float *out)
{
    int32_t a[128], dots[2][12], length = LENGTH(f->bases), count = last - first, shift = coefficients(f, z, a);
    high += (ptrdiff_t)first * length;
    low += (ptrdiff_t)first * length;
    TYNI_LANES_CALL(f->isa, fourier_dots, (a, high + 4, count, length, f->bases, dots[0]));
    if (at < 1.0f)
        TYNI_LANES_CALL(f->isa, fourier_dots, (a, low + 4, count, length, f->bases, dots[1]));
    for (int32_t i = 0; i < count; i++) {
        float b = row_mean(high + (ptrdiff_t)i * length, dots[0][i] - shift);
        if (at < 1.0f)
            b += (1.0f - at) * (row_mean(low + (ptrdiff_t)i * length, dots[1][i] - shift) - b);
        out[first + i] = b;
    }
}

/* A ray's place between the reference rays, 0 .. references - 1. */
static float between(const tyni_shelf *s, int32_t references, float lean)
{
    int32_t i = 0;
    float step;
    while (i < references - 2 && lean >= s->lean[i + 1])
        i++;
    if (references == 1)
        return 0.0f;
    step = s->lean[i + 1] - s->lean[i];
    return (float)i + (step > 1e-4f * s->lean[i] ? tyni_clampf((lean - s->lean[i]) / step, 0.0f, 1.0f) : 0.0f);
}

int tyni_fourier_value(const tyni_fourier *f, const tyni_shelf *s, float p, const tyni_fourier_ray *ray, float value[3])
{
    float y, at = 1.0f, node[3], mean[12];
    int32_t cell, first = 3, last = 0;
    const uint8_t *high;
    /* the last column holds for a little more: lines next to each other see about the same */
    if (!s->valid || ray->x > s->high + 0.05f * (s->high - s->low))
        return 0;
    y = cells(s, tyni_clampf(ray->x, s->low, s->high) - s->low) * (float)f->columns;
    cell = tyni_clampi((int32_t)y, 0, f->columns - 1);
    /* between two stored means M the mean over half a cell is no straight line: (y - cell) / y of the sum is new */
    if (cell > 0 && y > 0.0f)
        at = tyni_minf((y - (float)cell) * (float)(cell + 1) / y, 1.0f);
    for (int32_t c = 0; c < 3; c++) {
        node[c] = between(s, f->references, ray->lean[c]);
        first = tyni_mini(first, (int32_t)node[c]);
        last = tyni_maxi(last, tyni_mini((int32_t)node[c] + 1, f->references - 1));
    }
    high = (const uint8_t *)(s + 1) + cell * pitch(f);
    means(f, high, cell > 0 ? high - pitch(f) : high, at,
          z_of(f, s, tyni_clampf((p - s->p_start) * s->p_scale, 0.0f, 65534.0f)), first * f->channels, (last + 1) * f->channels,
          mean);
    for (int32_t c = 0; c < 3; c++) {
        int32_t n = tyni_clampi((int32_t)node[c], first, tyni_maxi(last - 1, first)), o = f->channels == 3 ? c : 0;
        float a = mean[n * f->channels + o], b = mean[tyni_mini(n + 1, last) * f->channels + o];
        value[c] = tyni_maxf(a + (node[c] - (float)n) * (b - a), 0.0f) * s->scale[c];
    }
    return 1;
}

void tyni_fourier_show(const tyni_fourier *f, const tyni_shelf *s, int32_t column, float show[3])
{
    const uint8_t *row = (const uint8_t *)(s + 1) + column * pitch(f) + (ptrdiff_t)(f->sets / 2) * LENGTH(f->bases);
    int16_t constant;
    if (!s->valid)
        return;
    memcpy(&constant, row, sizeof constant);
    show[0] = tyni_maxf((float)constant, 0.0f) * (1.0f / 32767.0f);
    show[1] = (float)row[4] * (1.0f / 255.0f);
    show[2] = (float)row[4 + f->bases / 2] * (1.0f / 255.0f);
}
