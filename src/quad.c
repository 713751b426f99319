/* quad.c - see quad.h */
#include "quad.h"

#include "base.h"
#include "check.h"
#include "num.h"
#include "pixel.h"
#include "stray.h"

/* Pixels whose depths are within so many float steps share an exponential, a 128th of an octave; an eighth is as far as its
 * tangent reaches. */
#define FLAT (1u << 16)
#define SPREAD (1u << 20)
#define LEVEL (1u << 18)

/* The pixels of a row share one if their depths are within a 64th of each other: the square of that. */
#define EVEN (1.0f / 1024.0f)

/* Pixels of a run at most: a line's bits have room for 16 words at least, and two rows' lie in there. */
#define RUN 256

/* ---- which frames ---- */

int tyni_quad_takes(const tyni_pass *p)
{
    const tyn_config *c = &p->context->config;
    const tyn_frame *f = p->frame;
    const uint32_t bytes = 1u << TYN_RGBA8_SRGB | 1u << TYN_BGRA8_SRGB | 1u << TYN_RGB565_SRGB;
    if (!TYNI_HAS(TYN_PART_QUADS) || !c->quads || p->method != TYN_METHOD_EPIPOLAR || c->gather != TYN_GATHER_SHEAR ||
        tyni_ray_way(c->rays, TYN_RAYS_STEPS) || tyni_pass_gridded(p) || !p->slices.count || p->slices.stride > 2)
        return 0;
    if (!f->target.pixels || !f->colour.pixels || !(bytes >> f->target.format & 1) || !(bytes >> f->colour.format & 1))
        return 0;
    return p->first && p->last && tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL && !tyni_view_bounded(p->lamp) &&
           p->count < 3 && !f->debug && f->max_distance == 0.0f && f->fog_scale == 0.0f && f->display.exposure <= 1e12f &&
           p->medium.sigma[p->medium.low] * p->view.far_depth > 1e-3f;
}

/* ---- tables ---- */

/* Bits of the farthest distance, without what is between fades. */
static TYNI_NOINLINE int32_t fade_end(const tyni_view *view)
{
    float far = 0.0f;
    for (int32_t i = 0; i < 4; i++) {
        tyni_sight v;
        far = tyni_maxf(far, tyni_view_sight(view, i & 1 ? (float)view->width : 0.0f, i & 2 ? (float)view->height : 0.0f, &v));
    }
    return (int32_t)(tyni_float_bits(far * view->far_depth) >> TYNI_QUADS_FADE_BITS);
}

/* What is left after so many extinction lengths. It is below 1 by more than a tangent's rounding, and nothing from where
 * tangents, a tenth of the way on, fall below 0: so no share is below 0 or above 1, nor any mix of colour and light below 0. */
static float fade_of(float lengths)
{
    return lengths < 10.0f ? (1.0f - 1e-6f) * tyni_num_exp(-lengths) : 0.0f;
}

/* What hangs on the frame alone. */
static TYNI_NOINLINE void set_up(tyni_quads *q, const tyni_pass *p)
{
    const tyn_frame *f = p->frame;
    memset(q, 0, sizeof *q);
    q->pass = p;
    q->frame = f;
    q->base = fade_end(&p->view) - (TYNI_QUADS_FADES - 2);
    q->twice = (uint32_t)q->base + TYNI_QUADS_OCTAVE;
    q->entries = p->lines.entries;
    q->pitch = p->lines.pitch;
    q->far = p->view.far_depth;
    q->near = 1.0f / q->far;
    q->most = TYNI_QUADS_LEVELS * TYNI_QUADS_LEVELS;
    q->gain = (f->display.exposure > 0.0f ? f->display.exposure : 1.0f) * q->most;
    q->inverse = 1.0f / q->gain;
    q->from_bytes = tyn_format_bytes(f->colour.format);
    q->to_bytes = tyn_format_bytes(f->target.format);
    q->red = f->colour.format == TYN_BGRA8_SRGB ? 2 : 0;
    q->plain = f->target.format == f->colour.format && q->from_bytes == 4 && f->display.tone == TYN_TONE_CLAMP &&
               !f->scatter.pixels && !f->transmittance.pixels;
    for (int32_t c = 0; c < 3; c++) {
        const int32_t i = tyni_quads_colour(q, c);
        q->falls[c] = -p->medium.sigma[i];
        q->glow[c] = p->lamp->colour[i] / (p->medium.sigma[i] * TYNI_QUADS_ROOTS * TYNI_QUADS_ROOTS);
        q->blend[c] = i == p->medium.low ? 0.0f : i == p->medium.high ? 1.0f : p->medium.blend;
    }
}

void tyni_quad_begin(const tyni_pass *p)
{
    tyni_quads q;
    set_up(&q, p);
    for (int32_t w = 0; w < p->context->config.workers; w++) {
        float(*fade)[3], *decode;
        tyni_scratch s;
        tyni_pass_scratch(p->context, w, &s);
        fade = (void *)s.bundle;
        decode = (void *)s.row;
        for (int32_t i = 0; i < 256; i++) {
            const float root = (float)tyni_composite_srgb[i] * TYNI_COMPOSITE_ROOT;
            decode[i] = q.gain * (root * root);
        }
        for (int32_t i = 0; i < TYNI_QUADS_FADES; i++)
            for (int32_t c = 0; c < 3; c++)
                fade[i][c] = fade_of(-q.falls[c] * tyni_bits_float((uint32_t)(q.base + i) << TYNI_QUADS_FADE_BITS));
    }
}

typedef char
    tables_fit[TYNI_QUADS_FADES * 3 * sizeof(float) <= TYN_BUNDLE_BYTES && 256 * sizeof(float) <= TYN_ROW_BYTES ? 1 : -1];

/* As far apart as straight lines allow: to be off by some per mille at most of the phase function, about whose peak it is
 * (1 + (angle / width)^2)^-1.5, and by less than one of a ray's length. Even. */
static int32_t span_of(const tyni_pass *p)
{
    const float g = p->medium.peak, width = (1.0f - g) / sqrtf(tyni_maxf(g, 0.01f));
    const float most = tyni_minf(0.125f * width, 0.08f) / tyni_vec_length(p->view.dx);
    return p->view.orthographic ? 14 : (int32_t)tyni_clampf(most, 2.0f, 14.0f) / 2 * 2;
}

/* Where things lie that a worker has of its own. Of a plane's length there are 11, one behind the other, and a run of pixels is
 * up to twice that long. */
static void take_scratch(tyni_quads *q, const tyni_pass *p, const tyni_scratch *s)
{
    const int32_t length = tyni_pass_run(p->context), points = tyni_maxi(p->context->points / 16 * 16, 16);
    q->decode = (void *)s->row;
    q->fade = (void *)s->bundle;
    q->span = span_of(p);
    q->run = tyni_mini(2 * length, tyni_mini(points, RUN));
    q->entry = (int32_t *)(void *)s->plane[0];
    q->part = (int32_t *)(void *)s->plane[1];
    q->knot = (void *)s->plane[2];
    q->rise = q->knot + q->run / q->span + 2;
    TYNI_ASSERT((void *)(q->rise + q->run / q->span + 2) <= (void *)(s->plane[2] + (TYNI_PASS_PLANES - 2) * length));
    q->rejected[0] = s->fresh;
    q->rejected[1] = s->fresh + RUN / 32;
    q->stats = s->stats;
}

/* ---- where quads lie ---- */

/* at: 64 times where it is between lines. */
TYNI_QUADS_INLINE void place_at(float at, float most, int32_t place, int32_t pitch, int32_t *entry, int32_t *part)
{
    const int32_t k = (int32_t)tyni_minf(tyni_maxf(at, 0.0f), most);
    *part = k & 63;
    *entry = place + (k >> 6) * pitch;
}

/* Each quad's place between lines, that of its middle; its sample is that of its upper or left pixels: along a line little
 * changes. */
static TYNI_NOINLINE void places(const tyni_quads *q)
{
    const tyni_slices *g = &q->pass->slices;
    const int32_t shift = g->stride >> 1, pitch = (int32_t)q->pitch, start = q->x / 2, end = (q->x + q->count + 1) / 2;
    const float my = (float)q->y + 1.0f, dy = my * g->ew - g->ey;
    for (int32_t n = start, next; n < end; n = next) {
        const tyni_sector *s = tyni_slice_span(g, n, end, 2, my, &next);
        const float scale = 64.0f / s->spacing, most = 64.0f * (float)(s->count - 1) - 1.0f;
        const float mx = 2.0f * (float)n + 1.0f, dx = mx * g->ew - g->ex, away = 2.0f * g->ew;
        int32_t *entry = q->entry + (n - start), *part = q->part + (n - start), *until = q->entry + (next - start);
        float i = 0.0f; /* from n on */
        if (s->along_y) {
            const int32_t place = s->start * pitch + (q->y >> shift);
            const float slant = (s->border - my) / dy;
            const float at = (mx + dx * slant - s->first) * scale, step = (2.0f + away * slant) * scale;
            for (; entry < until; entry++, part++, i += 1.0f)
                place_at(at + step * i, most, place, pitch, entry, part);
        } else {
            int32_t place = s->start * pitch + (2 * n >> shift);
            const float at = (my - s->first) * scale, height = dy * scale * (s->border - mx), step = dy * scale * 2.0f;
            for (; entry < until; entry++, part++, i += 1.0f, place += 2 >> shift)
                place_at(at + (height - step * i) / (dx + away * i), most, place, pitch, entry, part);
        }
    }
}

static TYNI_NOINLINE void knot_at(const tyni_quads *q, int32_t x, int32_t y, tyni_knot *k)
{
    const tyni_pass *p = q->pass;
    tyni_sight v;
    float mix[3];
    k->length = tyni_view_sight(&p->view, (float)(q->x + x), (float)y + 1.0f, &v);
    tyni_medium_mix(&p->medium, tyni_clampf(tyni_vec_dot(v.d, p->lamp->to_light), -1.0f, 1.0f), mix);
    for (int32_t c = 0; c < 3; c++) /* times the gain no infinity */
        k->glow[c] =
            q->gain * tyni_minf(mix[tyni_quads_colour(q, c)] * q->glow[c], 1e20f / (TYNI_QUADS_ROOTS * TYNI_QUADS_ROOTS));
}

/* For so many pairs of rows, from y on. Between the first and the last they go straight as well. */
static TYNI_NOINLINE void knots(const tyni_quads *q, int32_t pairs)
{
    const float part = 1.0f / (float)tyni_maxi(pairs - 1, 1);
    for (int32_t i = 0; i * q->span < q->count + q->span; i++) {
        tyni_knot *k = q->knot + i, *rise = q->rise + i;
        knot_at(q, i * q->span, q->y, k);
        knot_at(q, i * q->span, q->y + 2 * (pairs - 1), rise);
        rise->length = (rise->length - k->length) * part;
        for (int32_t c = 0; c < 3; c++)
            rise->glow[c] = (rise->glow[c] - k->glow[c]) * part;
    }
}

TYNI_QUADS_INLINE void knot_add(tyni_knot *k, const tyni_knot *by)
{
    k->length += by->length;
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        k->glow[c] += by->glow[c];
}

/* On to the next two rows. From the middle of a narrow peak glow falls to almost nothing in a band, and what is rounded on the
 * way must not leave it below 0: no level is for that. */
TYNI_QUADS_INLINE void knot_down(tyni_knot *k, const tyni_knot *rise)
{
    knot_add(k, rise);
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++)
        k->glow[c] = tyni_maxf(k->glow[c], 0.0f);
}

/* ---- quads ---- */

/* How the pixels of a quad may be done together: one share for all, one for each row, one for each; or by tyni_stray_each. */
typedef enum way { WAY_FLAT, WAY_ROWS, WAY_PIXELS, WAY_NONE } way;

/* As far as the farthest depth. */
TYNI_QUADS_INLINE void depths_of(const tyni_quads *q, ptrdiff_t n, float z[4])
{
    const float *upper = q->depth[0] + 2 * n, *lower = q->depth[1] + 2 * n;
    z[0] = tyni_minf(upper[0], q->far);
    z[1] = tyni_minf(upper[1], q->far);
    z[2] = tyni_minf(lower[0], q->far);
    z[3] = tyni_minf(lower[1], q->far);
}

/* Number of the nearest fade to half of so many metres: TYNI_QUADS_FADES or more if there is none. */
TYNI_QUADS_INLINE uint32_t fade_of_twice(const tyni_quads *q, float twice)
{
    return ((tyni_float_bits(twice) + (1u << (TYNI_QUADS_FADE_BITS - 1))) >> TYNI_QUADS_FADE_BITS) - q->twice;
}

/* Below 2 TYNI_QUADS_WINDOW: the second sample is about as far as the first. */
TYNI_QUADS_INLINE uint32_t apart(uint32_t e0, uint32_t e1)
{
    return (e1 - (e0 & 0xfff00000u) + (TYNI_QUADS_WINDOW << 5)) >> 5;
}

/* The light of both samples. */
TYNI_QUADS_INLINE void light_of(const tyni_quads *q, uint32_t e0, uint32_t e1, uint32_t part, const tyni_knot *k,
                                float light[3])
{
    const uint32_t r0 = tyni_quads_roots(e0), sum = (r0 << 6) + (tyni_quads_roots(e1) - r0) * part;
    tyni_quads_light(q, (float)(int32_t)(sum & 0xffffu), (float)(int32_t)(sum >> 16), k->glow, light);
}

TYNI_QUADS_INLINE void flatten(const tyni_quads *q, uint32_t fade, float away, tyni_air *a)
{
    const float *share = q->fade[fade];
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        a->share[c] = share[c] + share[c] * (q->falls[c] * away);
        a->light[c] -= a->light[c] * a->share[c];
    }
}

/* The samples that the middle of a quad fits, both or one twice: at an edge lines go on that others end at. 0: neither. */
TYNI_QUADS_INLINE int fitting(const tyni_quads *q, float middle, uint32_t part, uint32_t *e0, uint32_t *e1)
{
    const uint32_t bits = tyni_float_bits(middle);
    const int first = bits - tyni_quads_low(q, *e0) < 2 * TYNI_QUADS_WINDOW;
    const int second = bits - tyni_quads_low(q, *e1) < 2 * TYNI_QUADS_WINDOW;
    if (first && !second && part <= 64 - TYNI_QUADS_ENOUGH)
        *e1 = *e0;
    else if (second && !first && part >= TYNI_QUADS_ENOUGH)
        *e0 = *e1;
    else
        return first && second;
    return 1;
}

/* What the pixels of a quad share: that takes their depths to be that of one surface, which the samples have too. */
TYNI_QUADS_INLINE way shared(const tyni_quads *q, ptrdiff_t n, const tyni_knot *k, const float z[4], uint32_t *fade,
                             tyni_air *a)
{
    const uint32_t *entry = q->entries + q->entry[n], part = (uint32_t)q->part[n];
    uint32_t e0 = entry[0], e1 = entry[q->pitch];
    const float near = tyni_minf(tyni_minf(z[0], z[1]), tyni_minf(z[2], z[3]));
    const float far = tyni_maxf(tyni_maxf(z[0], z[1]), tyni_maxf(z[2], z[3])), twice = (near + far) * k->length;
    const uint32_t low = tyni_quads_low(q, e0), from = tyni_float_bits(near), to = tyni_float_bits(far);
    const float upper = z[0] - z[1], lower = z[2] - z[3];
    *fade = fade_of_twice(q, twice);
    if (to - from >= SPREAD || *fade >= TYNI_QUADS_FADES) /* or one is below 0 */
        return WAY_NONE;
    if (((from - low) | (to - low) | apart(e0, e1)) < 2 * TYNI_QUADS_WINDOW ||
        fitting(q, 0.5f * (near + far), part, &e0, &e1)) {
        light_of(q, e0, e1, part, k, a->light);
    } else {
        float light[3]; /* of its own: else the air would lie in memory */
        if (to - from >= LEVEL || !tyni_stray_about(q, (int32_t)n, 0.5f * (near + far), k, light))
            return WAY_NONE;
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            a->light[c] = light[c];
    }
    a->from = tyni_bits_float(((uint32_t)q->base + *fade) << TYNI_QUADS_FADE_BITS);
    a->flat = to - from < FLAT;
    if (a->flat) {
        flatten(q, *fade, 0.5f * twice - a->from, a);
        return WAY_FLAT;
    }
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        a->share[c] = q->fade[*fade][c];
        a->slope[c] = q->falls[c] * q->fade[*fade][c];
    }
    return upper * upper + lower * lower < EVEN * (near * near) ? WAY_ROWS : WAY_PIXELS;
}

/* The same of the next quad, if it is as flat, at the very depth of the last, and has the same fade: as in the sky. */
TYNI_QUADS_INLINE int again(const tyni_quads *q, ptrdiff_t n, const tyni_knot *k, float depth, uint32_t fade, tyni_air *a)
{
    const float *upper = q->depth[0] + 2 * n, *lower = q->depth[1] + 2 * n, z = tyni_minf(depth, q->far);
    const uint32_t *entry = q->entries + q->entry[n], e0 = entry[0], e1 = entry[q->pitch], bits = tyni_float_bits(depth);
    if (tyni_float_bits(upper[0]) != bits || tyni_float_bits(upper[1]) != bits || tyni_float_bits(lower[0]) != bits ||
        tyni_float_bits(lower[1]) != bits)
        return 0;
    if (((tyni_float_bits(z) - tyni_quads_low(q, e0)) | apart(e0, e1)) >= 2 * TYNI_QUADS_WINDOW)
        return 0;
    if (fade_of_twice(q, (z + z) * k->length) != fade)
        return 0;
    light_of(q, e0, e1, (uint32_t)q->part[n], k, a->light);
    flatten(q, fade, z * k->length - a->from, a);
    return 1;
}

/* share * colour + light */
TYNI_QUADS_INLINE void put_flat(const tyni_quads *q, const uint8_t *from, uint8_t *to, const tyni_air *a, uint32_t dither)
{
    to[0] = (uint8_t)((tyni_quads_level(q, a->light[0] + a->share[0] * q->decode[from[0]]) + dither) >> 8);
    to[1] = (uint8_t)((tyni_quads_level(q, a->light[1] + a->share[1] * q->decode[from[1]]) + dither) >> 8);
    to[2] = (uint8_t)((tyni_quads_level(q, a->light[2] + a->share[2] * q->decode[from[2]]) + dither) >> 8);
    to[3] = 255;
}

static TYNI_NOINLINE void put_pixels(const tyni_quads *q, ptrdiff_t n, const float s[4], const tyni_air *a)
{
    for (int32_t i = 0; i < 4; i++) {
        const ptrdiff_t at = 8 * n + 4 * (i & 1);
        float share[3];
        tyni_quads_share(a, s[i], share);
        tyni_quads_put(q, q->from[i >> 1] + at, q->to[i >> 1] + at, a->light, share, q->dither[i >> 1][(2 * n & 7) + (i & 1)]);
    }
}

/* Quads of a plain frame from n on, before `end`. Returns how many are done; 0: the first needs its pixels one by one. The knot
 * goes along. */
TYNI_QUADS_INLINE ptrdiff_t some(const tyni_quads *q, ptrdiff_t n, ptrdiff_t end, tyni_knot *k, const tyni_knot *step)
{
    const ptrdiff_t first = n;
    float z[4];
    tyni_air a;
    uint32_t fade;
    way w;
    depths_of(q, n, z);
    w = shared(q, n, k, z, &fade, &a);
    if (w == WAY_NONE)
        return 0;
    if (w == WAY_FLAT) {
        const float depth = q->depth[0][2 * n];
        do {
            const uint8_t *upper = q->from[0] + 8 * n, *lower = q->from[1] + 8 * n;
            uint8_t *to = q->to[0] + 8 * n, *below = q->to[1] + 8 * n;
            const uint32_t *dither = q->dither[0] + (2 * n & 7);
            put_flat(q, upper, to, &a, dither[0]);
            put_flat(q, upper + 4, to + 4, &a, dither[1]);
            put_flat(q, lower, below, &a, dither[8]);
            put_flat(q, lower + 4, below + 4, &a, dither[9]);
            knot_add(k, step);
            n++;
        } while (n < end && again(q, n, k, depth, fade, &a));
        return n - first;
    }
    if (w == WAY_ROWS) {
        const uint8_t *upper = q->from[0] + 8 * n, *lower = q->from[1] + 8 * n;
        uint8_t *to = q->to[0] + 8 * n, *below = q->to[1] + 8 * n;
        const uint32_t *dither = q->dither[0] + (2 * n & 7);
        float share[3];
        tyni_quads_share(&a, (z[0] + z[1]) * k->length * 0.5f, share);
        tyni_quads_put(q, upper, to, a.light, share, dither[0]);
        tyni_quads_put(q, upper + 4, to + 4, a.light, share, dither[1]);
        tyni_quads_share(&a, (z[2] + z[3]) * k->length * 0.5f, share);
        tyni_quads_put(q, lower, below, a.light, share, dither[8]);
        tyni_quads_put(q, lower + 4, below + 4, a.light, share, dither[9]);
    } else {
        const tyni_air own = a; /* else all of it would lie in memory */
        const float s[4] = {z[0] * k->length, z[1] * k->length, z[2] * k->length, z[3] * k->length};
        put_pixels(q, n, s, &own);
    }
    knot_add(k, step);
    return 1;
}

/* A quad of other frames. 0: not done. */
static TYNI_NOINLINE int any(const tyni_quads *q, ptrdiff_t n, const tyni_knot *k)
{
    float z[4];
    tyni_air a;
    uint32_t fade;
    way w;
    depths_of(q, n, z);
    w = shared(q, n, k, z, &fade, &a);
    if (w == WAY_NONE)
        return 0;
    for (int32_t i = 0; i < 4; i++)
        tyni_stray_put(q, 2 * (int32_t)n + (i & 1), i >> 1, &a,
                       w == WAY_ROWS ? (z[i & 2] + z[(i & 2) + 1]) * k->length * 0.5f : z[i] * k->length);
    return 1;
}

static TYNI_NOINLINE void pair_of_rows(const tyni_quads *original, int32_t rows)
{
    const tyni_quads own = *original, *q = &own; /* a copy is none of what is written */
    const float part = 1.0f / (float)q->span;
    const ptrdiff_t full = rows > 1 ? q->count / 2 : 0, plain = q->plain ? full : 0;
    tyni_knot *next = q->knot;
    for (int32_t i = 0; i < q->count; i += q->span, next++) {
        const ptrdiff_t last = (tyni_mini(i + q->span, q->count) + 1) / 2;
        tyni_knot k = next[0], step;
        step.length = (next[1].length - k.length) * part;
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++)
            step.glow[c] = (next[1].glow[c] - k.glow[c]) * part;
        knot_add(&k, &step);
        knot_add(&step, &step);
        knot_down(next, &q->rise[next - q->knot]);
        for (ptrdiff_t n = i / 2, done; n < last; n += done) {
            done = n < plain ? some(q, n, last < plain ? last : plain, &k, &step) : 0;
            if (!done) {
                if (plain || n >= full || !any(original, n, &k))
                    tyni_stray_each(original, (int32_t)n, rows, &k);
                knot_add(&k, &step);
                done = 1;
            }
        }
    }
    knot_down(next, &q->rise[next - q->knot]);
}

/* Pixels x .. of rows y and y + 1, or of y alone. */
static void draw_rows(tyni_quads *q, const tyni_scratch *s, int32_t rows)
{
    const tyni_pass *p = q->pass;
    for (int32_t i = 0; i < rows; i++) {
        q->depth[i] = tyni_door_row(&p->depth, q->x, q->y + i, q->count, i ? s->value[0] : s->depth);
        q->from[i] = (const uint8_t *)tyni_image_row(&p->frame->colour, q->y + i) + (ptrdiff_t)q->x * q->from_bytes;
        q->to[i] = (uint8_t *)tyni_image_row(&p->frame->target, q->y + i) + (ptrdiff_t)q->x * q->to_bytes;
        memset(q->rejected[i], 0, RUN / 8);
    }
    places(q);
    pair_of_rows(q, rows);
    for (int32_t i = 0; i < rows; i++)
        tyni_stray_walk(q, i);
}

void tyni_quad_band(void *argument, int32_t index, int32_t worker)
{
    const tyni_pass *p = argument;
    const int32_t top = index * TYNI_PIXEL_BAND, end = tyni_mini(top + TYNI_PIXEL_BAND, p->view.height);
    uint64_t start = tyni_pass_now(p);
    uint32_t dither[TYNI_PIXEL_BAND + 1][8];
    tyni_scratch s;
    tyni_quads q;
    tyni_pass_scratch(p->context, worker, &s);
    set_up(&q, p);
    take_scratch(&q, p, &s);
    for (int32_t y = top; y < end; y++)
        tyni_composite_dither(&p->frame->display, y, dither[y - top]);
    for (q.x = 0; q.x < p->view.width; q.x += q.count) {
        q.count = tyni_mini(q.run, p->view.width - q.x);
        q.y = top;
        knots(&q, (end - top + 1) / 2);
        for (; q.y < end; q.y += 2) {
            q.dither = (const uint32_t(*)[8])dither + (q.y - top);
            draw_rows(&q, &s, tyni_mini(end - q.y, 2));
        }
    }
    q.stats->unwarp_ns += tyni_pass_now(p) - start;
}
