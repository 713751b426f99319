/* quad.c - see quad.h */
#include "quad.h"

#include "base.h"
#include "check.h"
#include "composite.h"
#include "entry.h"
#include "num.h"
#include "pixel.h"
#include "sample.h"
#include "walk.h"

/* Roots of linear values, 0 .. 1, are taken in so many steps: fine enough to tell 255 levels apart, 0.4 of one in the dark. */
#define LEVELS 1023.0f /* the last of tyni_composite_curve */

/* What 1 is in weighed roots of visibility: 10 bits of an entry times 64. */
#define ROOTS 65472.0f

/* Where e^-(extinction s) is known: at 16 distances an octave, over ten octaves up to the farthest. Between them goes a
 * tangent, which is off by less than 0.0003, and by less than 0.003 where the two pixels of a quad's row are farthest apart. */
#define FADES 162
#define FADE_BITS 19 /* of a float below those that tell them apart */

/* Depths that belong together lie within this many float steps of each other: an eighth of an octave either way, twice what
 * makes a break. */
#define WINDOW (1 << 20)

/* Rows within this many share an exponential: a 64th of an octave and more. */
#define NEAR (1 << 17)

typedef struct quads {
    const tyni_pass *pass;
    const tyn_frame *frame;
    float (*fade)[3]; /* red, green, blue, times `gain` */
    int32_t base;     /* of the first fade's bits */
    float far, gain;  /* gain: from radiance to the square of `LEVELS` */
    float falls[3];   /* -extinction */
    float glow[3];    /* by channel: the sun's colour over extinction, for visibility's roots */
    int32_t span;     /* pixels between two places where the phase function is known */
    int32_t y, x, count;
    const float *depth[2]; /* rows y and y + 1, pixels x .. x + count - 1 */
    const uint8_t *from[2];
    uint8_t *to[2];
    int32_t from_bytes, to_bytes, from_red, to_red; /* of pixels, and in them */
    int32_t *entry, *part; /* of each quad: its first line's sample, and 1/64 of the way to the next line */
    uint32_t dither[2][8];
    int plain;             /* bytes to bytes, no tone curve, and nothing but the picture is wanted */
    uint32_t *rejected[2]; /* bits */
    tyn_stats *stats;
} quads;

/* Between a quad's pixels: metres a ray goes per depth, and what shines there where all is lit. */
typedef struct knot {
    float length, glow[3];
} knot;

/* What a ray's pixel is made of, times `gain`: share * colour + (1 - share) * light, the share falling from what it is at
 * `from` metres. */
typedef struct air {
    float share[3], slope[3], from;
    float light[3], bare[3]; /* bare: without gain */
} air;

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
    return (int32_t)(tyni_float_bits(far * view->far_depth) >> FADE_BITS);
}

static float gain_of(const tyn_frame *f)
{
    return (f->display.exposure > 0.0f ? f->display.exposure : 1.0f) * (LEVELS * LEVELS);
}

void tyni_quad_begin(const tyni_pass *p)
{
    const int32_t base = fade_end(&p->view) - (FADES - 2);
    const float gain = gain_of(p->frame);
    for (int32_t w = 0; w < p->context->config.workers; w++) {
        float(*fade)[3];
        tyni_scratch s;
        tyni_pass_scratch(p->context, w, &s);
        fade = (void *)s.bundle;
        for (int32_t i = 0; i < FADES; i++)
            for (int32_t c = 0; c < 3; c++)
                fade[i][c] = gain * tyni_num_exp(-p->medium.sigma[c] * tyni_bits_float((uint32_t)(base + i) << FADE_BITS));
    }
}

typedef char fades_fit[FADES * 3 * sizeof(float) <= TYN_BUNDLE_BYTES ? 1 : -1];

/* As far apart as straight lines allow: to be off by some per mille at most of the phase function, about whose peak it is
 * (1 + (angle / width)^2)^-1.5, and by less than one of a ray's length. */
static int32_t span_of(const tyni_pass *p)
{
    const float g = p->medium.peak, width = (1.0f - g) / sqrtf(tyni_maxf(g, 0.01f));
    const float most = tyni_minf(0.125f * width, 0.08f) / tyni_vec_length(p->view.dx);
    int32_t span = 16;
    while (span > 2 && !p->view.orthographic && (float)span > most)
        span /= 2;
    return span;
}

static void set_up(quads *q, const tyni_pass *p, const tyni_scratch *s)
{
    const tyn_frame *f = p->frame;
    memset(q, 0, sizeof *q);
    q->pass = p;
    q->frame = f;
    q->fade = (void *)s->bundle;
    q->base = fade_end(&p->view) - (FADES - 2);
    q->far = p->view.far_depth;
    q->gain = gain_of(f);
    q->span = span_of(p);
    q->entry = (int32_t *)(void *)s->plane[0];
    q->part = (int32_t *)(void *)s->plane[1];
    q->rejected[0] = s->fresh;
    q->rejected[1] = s->fresh + TYNI_PASS_RUN / 32; /* a line's bits have room for 16 words at least */
    q->stats = s->stats;
    q->from_bytes = tyn_format_bytes(f->colour.format);
    q->to_bytes = tyn_format_bytes(f->target.format);
    q->from_red = f->colour.format == TYN_BGRA8_SRGB ? 2 : 0;
    q->to_red = f->target.format == TYN_BGRA8_SRGB ? 2 : 0;
    q->plain = q->from_bytes == 4 && q->to_bytes == 4 && f->display.tone == TYN_TONE_CLAMP && !f->scatter.pixels &&
               !f->transmittance.pixels;
    for (int32_t c = 0; c < 3; c++) {
        q->falls[c] = -p->medium.sigma[c];
        q->glow[c] = p->lamp->colour[c] / (p->medium.sigma[c] * ROOTS * ROOTS);
    }
}

/* ---- one pixel ---- */

static inline void decode(const quads *q, const uint8_t *p, float colour[3])
{
    if (q->from_bytes == 4) {
        colour[0] = tyni_composite_srgb[p[q->from_red]];
        colour[1] = tyni_composite_srgb[p[1]];
        colour[2] = tyni_composite_srgb[p[2 - q->from_red]];
    } else {
        const int32_t v = *(const uint16_t *)(const void *)p;
        colour[0] = tyni_composite_srgb[v >> 11 << 3 | v >> 13];
        colour[1] = tyni_composite_srgb[(v >> 3 & 0xfc) | (v >> 9 & 3)];
        colour[2] = tyni_composite_srgb[(v << 3 & 0xf8) | (v >> 2 & 7)];
    }
}

/* The light alone, and what is left of the surface's. */
static void put_apart(const quads *q, const tyn_image *image, int32_t i, int32_t row, const float rgb[3])
{
    if (image->pixels)
        memcpy((float *)tyni_image_row(image, q->y + row) + 3 * (q->x + i), rgb, 3 * sizeof *rgb);
}

/* 256 times the level, 0 .. 255, of an exposed value times the square of LEVELS. */
TYNI_INLINE uint32_t level_of(float x)
{
    return tyni_composite_curve[(int32_t)sqrtf(tyni_minf(tyni_maxf(x, 0.0f), LEVELS * LEVELS))];
}

/* away: metres from where the air's share is known to the surface. */
TYNI_INLINE void put_plain(const quads *q, const uint8_t *from, uint8_t *to, const air *a, float away, uint32_t dither)
{
    const int32_t red = q->from_red, to_red = q->to_red;
    const float r = tyni_composite_srgb[from[red]] - a->bare[0], g = tyni_composite_srgb[from[1]] - a->bare[1];
    const float b = tyni_composite_srgb[from[2 - red]] - a->bare[2];
    to[to_red] = (uint8_t)((level_of(a->light[0] + (a->share[0] + a->slope[0] * away) * r) + dither) >> 8);
    to[1] = (uint8_t)((level_of(a->light[1] + (a->share[1] + a->slope[1] * away) * g) + dither) >> 8);
    to[2 - to_red] = (uint8_t)((level_of(a->light[2] + (a->share[2] + a->slope[2] * away) * b) + dither) >> 8);
    to[3] = 255;
}

/* The same of all formats, with a tone curve, and what is wanted besides the picture. */
static TYNI_NOINLINE void put_any(const quads *q, int32_t i, int32_t row, const air *a, float away)
{
    const uint32_t dither = q->dither[row][i & 7];
    float colour[3], light[3], share[3];
    uint32_t level[3];
    uint8_t *to = q->to[row] + i * q->to_bytes;
    decode(q, q->from[row] + i * q->from_bytes, colour);
    for (int32_t c = 0; c < 3; c++) {
        float x;
        share[c] = a->share[c] + a->slope[c] * away;
        x = a->light[c] + share[c] * (colour[c] - a->bare[c]);
        if (q->frame->display.tone == TYN_TONE_FILM)
            x = (1.0f - tyni_num_exp(x * (-1.0f / (LEVELS * LEVELS)))) * (LEVELS * LEVELS);
        level[c] = level_of(x);
        share[c] = tyni_clampf(share[c] / q->gain, 0.0f, 1.0f);
        light[c] = (1.0f - share[c]) * a->bare[c];
    }
    if (q->to_bytes == 4) {
        to[q->to_red] = (uint8_t)((level[0] + dither) >> 8);
        to[1] = (uint8_t)((level[1] + dither) >> 8);
        to[2 - q->to_red] = (uint8_t)((level[2] + dither) >> 8);
        to[3] = 255;
    } else {
        const uint32_t r = (level[0] * 31 / 255 + dither) >> 8, g = (level[1] * 63 / 255 + dither) >> 8;
        const uint32_t b = (level[2] * 31 / 255 + dither) >> 8;
        *(uint16_t *)(void *)to = (uint16_t)(r << 11 | g << 5 | b);
    }
    put_apart(q, &q->frame->scatter, i, row, light);
    put_apart(q, &q->frame->transmittance, i, row, share);
}

/* The nearest fade to s metres. */
TYNI_INLINE void fade_at(const quads *q, float s, air *a)
{
    const int32_t bits = (int32_t)((tyni_float_bits(s) + (1u << (FADE_BITS - 1))) >> FADE_BITS);
    const uint32_t i = (uint32_t)tyni_clampi(bits - q->base, 0, FADES - 1);
    a->from = tyni_bits_float(((uint32_t)q->base + i) << FADE_BITS);
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        a->share[c] = q->fade[i][c];
        a->slope[c] = q->falls[c] * q->fade[i][c];
    }
}

/* ---- visibility ---- */

/* Two 10-bit roots as the halves of a word, with room for a weight of 64 in all. */
TYNI_INLINE uint32_t roots(uint32_t entry)
{
    return (entry & 0x3ffu) | (entry & 0xffc00u) << 6;
}

/* Bits of a sample's depth in metres. */
TYNI_INLINE int32_t depth_bits(float far, uint32_t entry)
{
    return (int32_t)tyni_float_bits(far * tyni_entry_depth(entry));
}

/* From weighed roots of visibility and what shines where all is lit. Between the least and the largest extinction a root goes
 * straight: visibility falls about exponentially with extinction. */
TYNI_INLINE void light_of(const quads *q, float low, float high, const float glow[3], air *a)
{
    const tyni_medium *m = &q->pass->medium;
    const float middle = low + m->blend * (high - low);
    float v[3];
    v[m->low] = low * low;
    v[m->high] = high * high;
    v[m->middle] = middle * middle;
    TYNI_UNROLL
    for (int32_t c = 0; c < 3; c++) {
        a->bare[c] = v[c] * glow[c];
        a->light[c] = a->bare[c] * q->gain;
    }
}

/* Samples beside, as ED10's taps look for them: so many either way on both lines. */
#define BESIDE 4

/* What a sample has at s metres. */
static TYNI_NOINLINE void air_of(const quads *q, uint32_t entry, float s, const float glow[3], air *a)
{
    light_of(q, (float)(int32_t)(64u * (entry & 1023u)), (float)(int32_t)(64u * (entry >> 10 & 1023u)), glow, a);
    fade_at(q, s, a);
}

/* How far apart, of what is displayed as 1, the bounds of a pixel's light may be before it has a ray of its own. */
#define GAP 0.25f

/* A pixel that fits none of them. Light only grows along a ray, and rays side by side see about the same: so it lies between
 * that of the nearest sample before its surface, or of the camera, and that of the nearest behind it. 0: too far between. */
static TYNI_NOINLINE int between(const quads *q, uint32_t before, uint32_t behind, float length, float s, const float glow[3],
                                 air *a)
{
    const float s0 = before ? length * q->far * tyni_entry_depth(before) : 0.0f;
    const float s1 = behind ? length * q->far * tyni_entry_depth(behind) : length * q->far, inverse = 1.0f / q->gain;
    air near, far;
    air_of(q, before, s0, glow, &near);
    air_of(q, behind, s1, glow, &far);
    for (int32_t c = 0; c < 3; c++) {
        const float lost = 1.0f - (a->share[c] + a->slope[c] * (s - a->from)) * inverse, full = glow[c] * ROOTS * ROOTS;
        const float lost0 = 1.0f - (near.share[c] + near.slope[c] * (s0 - near.from)) * inverse;
        const float lost1 = 1.0f - (far.share[c] + far.slope[c] * (s1 - far.from)) * inverse;
        const float light0 = near.bare[c] * lost0, light1 = behind ? far.bare[c] * lost1 : full * lost1;
        const float least = tyni_maxf(light0, light1 - full * (lost1 - lost));
        const float most = tyni_minf(light1, light0 + full * (lost - lost0));
        const float grown = lost1 > lost0 ? tyni_clampf((lost - lost0) / (lost1 - lost0), 0.0f, 1.0f) : 0.5f;
        float light = light0 + grown * (light1 - light0);
        if (!behind)
            light = before ? near.bare[c] * lost : 0.5f * full * lost;
        if (tyni_absf(most - least) * q->gain > GAP * LEVELS * LEVELS)
            return 0;
        a->bare[c] = lost > 0.0f ? tyni_maxf(light, 0.0f) / lost : 0.0f;
        a->light[c] = a->bare[c] * q->gain;
    }
    return 1;
}

/* A pixel that fits neither of its quad's samples. 0: nor any beside. */
static TYNI_NOINLINE int look_about(const quads *q, int32_t i, float z, float length, const float glow[3], air *a)
{
    const int32_t pitch = q->pass->lines.pitch, place = q->entry[i >> 1], sample = place % pitch, f = q->part[i >> 1];
    const uint32_t *entry = q->pass->lines.entries + place;
    const int32_t low = (int32_t)tyni_float_bits(z) - WINDOW;
    uint32_t before = 0, behind = 0;
    if (!(z > 0.0f)) { /* no ray */
        memset(a->light, 0, sizeof a->light);
        memset(a->bare, 0, sizeof a->bare);
        return 1;
    }
    for (int32_t away = 0; away <= 2 * BESIDE; away++) {
        const int32_t at = away & 1 ? (away + 1) / 2 : -away / 2;
        uint32_t sum = 0, weight = 0;
        if (sample + at < 0 || sample + at >= pitch)
            continue;
        for (int32_t line = 0; line < 2; line++) {
            const uint32_t e = entry[at + line * pitch];
            const int32_t off = depth_bits(q->far, e) - low;
            if (!(e >> 20))
                continue;
            if ((uint32_t)off < 2 * WINDOW) {
                const uint32_t w = (uint32_t)(line ? f : 64 - f);
                sum += roots(e) * w;
                weight += w;
            } else if (off < 0) {
                before = e > before ? e : before;
            } else {
                behind = !behind || e < behind ? e : behind;
            }
        }
        if (weight > (uint32_t)(64.0f * TYNI_GATHER_ENOUGH)) {
            const float scale = 64.0f / (float)(int32_t)weight;
            light_of(q, (float)(int32_t)(sum & 0xffffu) * scale, (float)(int32_t)(sum >> 16) * scale, glow, a);
            return 1;
        }
    }
    return between(q, before, behind, length, z * length, glow, a);
}

/* A quad's pixels by themselves, as many as there are: light is that of the two samples, or of the one that fits. */
static TYNI_NOINLINE void each(const quads *original, int32_t i, int32_t rows, const knot *k)
{
    const quads own = *original, *q = &own; /* a copy is none of what is written */
    const uint32_t *entry = q->pass->lines.entries + q->entry[i >> 1];
    const uint32_t e0 = entry[0], e1 = entry[q->pass->lines.pitch], f = (uint32_t)q->part[i >> 1];
    const int32_t at0 = depth_bits(q->far, e0) + WINDOW, at1 = depth_bits(q->far, e1) + WINDOW;
    uint32_t ready = 256;      /* the weights that the air's light has */
    int32_t known = -2 * NEAR; /* bits of the depth whose share it has */
    air a;
    for (int32_t n = 0; n < 2 * rows; n++) {
        const int32_t x = i + (n & 1), row = n >> 1;
        const float z = tyni_maxf(tyni_minf(q->depth[row][tyni_mini(x, q->count - 1)], q->far), 0.0f);
        const float s = z * k->length;
        const int32_t bits = (int32_t)tyni_float_bits(z);
        const uint32_t w0 = (uint32_t)(at0 - bits) < 2 * WINDOW ? 64 - f : 0, w1 = (uint32_t)(at1 - bits) < 2 * WINDOW ? f : 0;
        if (x == q->count)
            continue;
        if ((uint32_t)(bits - known + NEAR) > 2 * NEAR) {
            fade_at(q, s, &a);
            known = bits;
        }
        if (w0 + w1 <= (uint32_t)(64.0f * TYNI_GATHER_ENOUGH)) {
            ready = 256;
            if (!look_about(original, x, z, k->length, k->glow, &a)) {
                q->rejected[row][x >> 5] |= 1u << (x & 31);
                continue;
            }
        } else if (w0 + 128 * w1 != ready) {
            const uint32_t sum = roots(e0) * w0 + roots(e1) * w1;
            const float scale = 64.0f / (float)(int32_t)(w0 + w1);
            light_of(q, (float)(int32_t)(sum & 0xffffu) * scale, (float)(int32_t)(sum >> 16) * scale, k->glow, &a);
            ready = w0 + 128 * w1;
        }
        if (q->plain)
            put_plain(q, q->from[row] + 4 * x, q->to[row] + 4 * x, &a, s - a.from, q->dither[row][x & 7]);
        else
            put_any(q, x, row, &a, s - a.from);
    }
}

/* The pixels with rays of their own. Not from within, for the sake of the stack. */
static TYNI_NOINLINE void walk(const quads *q, int32_t row)
{
    const tyni_pass *p = q->pass;
    for (int32_t i = tyni_sample_next(q->rejected[row], 0, q->count - 1); i < q->count;
         i = tyni_sample_next(q->rejected[row], i + 1, q->count - 1)) {
        float light[3], s;
        tyni_sight v;
        air a;
        s = tyni_view_sight(&p->view, (float)(q->x + i) + 0.5f, (float)(q->y + row) + 0.5f, &v);
        s *= tyni_maxf(tyni_minf(q->depth[row][i], q->far), 0.0f);
        tyni_walk_pixel(p->context->config.isa, p->lamp, &p->medium, &v, s, p->slices.stride, light);
        fade_at(q, s, &a);
        for (int32_t c = 0; c < 3; c++) {
            const float lost = 1.0f - (a.share[c] + a.slope[c] * (s - a.from)) / q->gain;
            a.bare[c] = lost > 0.0f ? light[c] / lost : 0.0f;
            a.light[c] = a.bare[c] * q->gain;
        }
        put_any(q, i, row, &a, s - a.from);
        q->stats->rejected++;
    }
}

/* ---- quads ---- */

/* Each quad's place between lines, that of its middle; its sample is that of its upper or left pixels: along a line little
 * changes. */
static TYNI_NOINLINE void places(const quads *q)
{
    const tyni_slices own = q->pass->slices, *g = &own; /* a copy is none of what is written */
    const int32_t shift = g->stride >> 1, pitch = q->pass->lines.pitch;
    const float my = (float)q->y + 1.0f, dy = my * g->ew - g->ey;
    const int32_t start = q->x / 2, end = (q->x + q->count + 1) / 2;
    for (int32_t n = start, next; n < end; n = next) {
        const tyni_sector *s = tyni_slice_span(g, n, end, 2, my, &next);
        const int32_t last = s->count - 2, along_y = s->along_y, step = along_y ? 0 : 2 >> shift;
        const float scale = 64.0f / s->spacing, most = 64.0f * (float)(s->count - 1), first = s->first;
        const float slant = (s->border - my) / dy, border = s->border;
        int32_t *entry = q->entry + (n - start), *part = q->part + (n - start);
        int32_t place = s->start * pitch + (along_y ? q->y >> shift : 2 * n >> shift);
        float mx = 2.0f * (float)n + 1.0f;
        for (; n < next; n++, place += step, mx += 2.0f) {
            const float dx = mx * g->ew - g->ex;
            int32_t line, k;
            float at;
            if (along_y)
                at = mx + dx * slant;
            else
                at = my + dy * (border - mx) / dx;
            k = (int32_t)tyni_clampf((at - first) * scale, 0.0f, most);
            line = tyni_mini(k >> 6, last);
            *part++ = k - 64 * line;
            *entry++ = place + line * pitch;
        }
    }
}

static TYNI_NOINLINE void knot_at(const quads *q, int32_t i, knot *k)
{
    const tyni_pass *p = q->pass;
    tyni_sight v;
    k->length = tyni_view_sight(&p->view, (float)(q->x + i), (float)q->y + 1.0f, &v);
    tyni_medium_mix(&p->medium, tyni_clampf(tyni_vec_dot(v.d, p->lamp->to_light), -1.0f, 1.0f), k->glow);
    for (int32_t c = 0; c < 3; c++)
        k->glow[c] = tyni_minf(k->glow[c] * q->glow[c], 1e20f / (ROOTS * ROOTS)); /* times the gain no infinity */
}

/* The quad at pixel i; 0: its depths are too far apart. */
TYNI_INLINE int whole(const quads *q, int32_t i, const knot *k)
{
    const uint32_t *entry = q->pass->lines.entries + q->entry[i >> 1];
    const uint32_t e0 = entry[0], e1 = entry[q->pass->lines.pitch];
    const int32_t far = (int32_t)tyni_float_bits(q->far), low = depth_bits(q->far, e0) - WINDOW;
    const uint32_t part = (uint32_t)q->part[i >> 1];
    uint32_t off = ((e1 >> 20) - (e0 >> 20) + (WINDOW >> 15)) << 15, sum;
    int32_t bits[4], known = 0;
    air a;
    TYNI_UNROLL
    for (int32_t n = 0; n < 4; n++) {
        bits[n] = tyni_mini((int32_t)tyni_float_bits(q->depth[n >> 1][i + (n & 1)]), far);
        off |= (uint32_t)bits[n] - (uint32_t)low; /* -0 is the least int */
    }
    if (off >= 2 * WINDOW)
        return 0;
    sum = roots(e0) * (64u - part) + roots(e1) * part;
    light_of(q, (float)(int32_t)(sum & 0xffffu), (float)(int32_t)(sum >> 16), k->glow, &a);
    TYNI_UNROLL
    for (int32_t n = 0; n < 4; n++) {
        const float s = tyni_bits_float((uint32_t)bits[n]) * k->length;
        const int32_t x = i + (n & 1), row = n >> 1;
        if (n == 0 || (uint32_t)(bits[n] - known + NEAR) > 2 * NEAR) {
            fade_at(q, s, &a);
            known = bits[n];
        }
        if (q->plain)
            put_plain(q, q->from[row] + 4 * x, q->to[row] + 4 * x, &a, s - a.from, q->dither[row][x & 7]);
        else
            put_any(q, x, row, &a, s - a.from);
    }
    return 1;
}

static TYNI_NOINLINE void pair_of_rows(const quads *original, int32_t rows)
{
    const quads own = *original, *q = &own; /* a copy is none of what is written */
    const float part = 1.0f / (float)q->span;
    knot end;
    knot_at(original, 0, &end);
    for (int32_t i = 0; i < q->count; i += q->span) {
        const int32_t last = tyni_mini(i + q->span, q->count);
        knot k = end, step;
        knot_at(original, i + q->span, &end);
        step.length = (end.length - k.length) * part;
        k.length += step.length;
        TYNI_UNROLL
        for (int32_t c = 0; c < 3; c++) {
            step.glow[c] = (end.glow[c] - k.glow[c]) * part;
            k.glow[c] += step.glow[c];
        }
        for (int32_t j = i; j < last; j += 2) {
            if (rows < 2 || j + 2 > q->count || !whole(q, j, &k))
                each(original, j, rows, &k);
            k.length += 2.0f * step.length;
            TYNI_UNROLL
            for (int32_t c = 0; c < 3; c++)
                k.glow[c] += 2.0f * step.glow[c];
        }
    }
}

/* Pixels x .. of rows y and y + 1, or of y alone. */
static void draw_rows(quads *q, const tyni_scratch *s, int32_t rows)
{
    const tyni_pass *p = q->pass;
    q->count = tyni_mini(tyni_pass_run(p->context), p->view.width - q->x);
    for (int32_t i = 0; i < rows; i++) {
        q->depth[i] = tyni_door_row(&p->depth, q->x, q->y + i, q->count, i ? s->value[0] : s->depth);
        q->from[i] = (const uint8_t *)tyni_image_row(&p->frame->colour, q->y + i) + (ptrdiff_t)q->x * q->from_bytes;
        q->to[i] = (uint8_t *)tyni_image_row(&p->frame->target, q->y + i) + (ptrdiff_t)q->x * q->to_bytes;
        memset(q->rejected[i], 0, TYNI_PASS_RUN / 8);
    }
    places(q);
    pair_of_rows(q, rows);
    for (int32_t i = 0; i < rows; i++)
        walk(q, i);
}

void tyni_quad_band(void *argument, int32_t index, int32_t worker)
{
    const tyni_pass *p = argument;
    const int32_t end = tyni_mini((index + 1) * TYNI_PIXEL_BAND, p->view.height);
    uint64_t start = tyni_pass_now(p);
    tyni_scratch s;
    quads q;
    tyni_pass_scratch(p->context, worker, &s);
    set_up(&q, p, &s);
    for (q.y = index * TYNI_PIXEL_BAND; q.y < end; q.y += 2) {
        const int32_t rows = end - q.y > 1 ? 2 : 1;
        for (int32_t i = 0; i < rows; i++)
            tyni_composite_dither(&p->frame->display, q.y + i, q.dither[i]);
        for (q.x = 0; q.x < p->view.width; q.x += q.count)
            draw_rows(&q, &s, rows);
    }
    q.stats->unwarp_ns += tyni_pass_now(p) - start;
}
