/* stray.c - see stray.h */
#include "stray.h"

#include "base.h"
#include "check.h"
#include "num.h"
#include "sample.h"
#include "walk.h"

/* Pixels within this share an exponential: a 16th of an octave and more. */
#define NEAR (1u << 19)

/* How far apart, of what is displayed as 1, the bounds of a pixel's light may be before it has a ray of its own. */
#define GAP 0.25f

/* ---- any format ---- */

static inline void decode(const tyni_quads *q, const uint8_t *p, float colour[3])
{
    if (q->from_bytes == 4) {
        for (int32_t c = 0; c < 3; c++)
            colour[c] = q->decode[p[c]];
    } else {
        const int32_t v = *(const uint16_t *)(const void *)p;
        colour[0] = q->decode[v >> 11 << 3 | v >> 13];
        colour[1] = q->decode[(v >> 3 & 0xfc) | (v >> 9 & 3)];
        colour[2] = q->decode[(v << 3 & 0xf8) | (v >> 2 & 7)];
    }
}

/* The light alone, and what is left of the surface's. */
static void put_apart(const tyni_quads *q, const tyn_image *image, int32_t x, int32_t row, const float rgb[3])
{
    if (image->pixels)
        memcpy((float *)tyni_image_row(image, q->y + row) + 3 * (q->x + x), rgb, 3 * sizeof *rgb);
}

void tyni_stray_put(const tyni_quads *q, int32_t x, int32_t row, const tyni_air *a, float s)
{
    const uint32_t dither = q->dither[row][x & 7];
    float colour[3], share[3], rgb[2][3];
    uint32_t level[3];
    uint8_t *to = q->to[row] + x * q->to_bytes;
    decode(q, q->from[row] + x * q->from_bytes, colour);
    if (a->flat)
        memcpy(share, a->share, sizeof share);
    else
        tyni_quads_share(a, s, share);
    for (int32_t c = 0; c < 3; c++) {
        const int32_t i = tyni_quads_colour(q, c);
        const float left = share[c];
        float sum = a->flat ? a->light[c] + left * colour[c] : a->light[c] + left * (colour[c] - a->light[c]);
        if (q->frame->display.tone == TYN_TONE_FILM)
            sum = (1.0f - tyni_num_exp(sum * (-1.0f / (TYNI_QUADS_LEVELS * TYNI_QUADS_LEVELS)))) * q->most;
        level[i] = tyni_quads_level(q, sum);
        rgb[0][i] = left;
        rgb[1][i] = (a->flat ? a->light[c] : a->light[c] - a->light[c] * left) * q->inverse;
    }
    if (q->to_bytes == 4) {
        const int32_t red = q->frame->target.format == TYN_BGRA8_SRGB ? 2 : 0;
        to[red] = (uint8_t)((level[0] + dither) >> 8);
        to[1] = (uint8_t)((level[1] + dither) >> 8);
        to[2 - red] = (uint8_t)((level[2] + dither) >> 8);
        to[3] = 255;
    } else {
        const uint32_t r = (level[0] * 31 / 255 + dither) >> 8, g = (level[1] * 63 / 255 + dither) >> 8;
        const uint32_t b = (level[2] * 31 / 255 + dither) >> 8;
        *(uint16_t *)(void *)to = (uint16_t)(r << 11 | g << 5 | b);
    }
    put_apart(q, &q->frame->transmittance, x, row, rgb[0]);
    put_apart(q, &q->frame->scatter, x, row, rgb[1]);
}

/* ---- light from beside ---- */

/* From a sum of roots by weights. */
TYNI_QUADS_INLINE void weighed(const tyni_quads *q, uint32_t sum, uint32_t weight, const float glow[3], float light[3])
{
    const float scale = 64.0f / (float)(int32_t)weight;
    tyni_quads_light(q, (float)(int32_t)(sum & 0xffffu) * scale, (float)(int32_t)(sum >> 16) * scale, glow, light);
}

/* Of a sample at s metres: its light, and what is lost of its surface's. */
static TYNI_NOINLINE void light_at(const tyni_quads *q, uint32_t entry, float s, const float glow[3], float light[3],
                                   float lost[3])
{
    tyni_air a;
    weighed(q, 64u * tyni_quads_roots(entry), 64, glow, light);
    tyni_quads_fade(q, s, &a);
    tyni_quads_share(&a, s, lost);
    for (int32_t c = 0; c < 3; c++)
        lost[c] = 1.0f - lost[c];
}

/* A pixel that fits none of them. Light only grows along a ray, and rays side by side see about the same: so it lies between
 * that of the nearest sample before its surface, or of the camera, and that of the nearest behind it. 0: too far between. */
static TYNI_NOINLINE int between(const tyni_quads *q, uint32_t before, uint32_t behind, float z, const tyni_knot *k,
                                 float light[3])
{
    const float far = k->length * q->far;
    float near_light[3], far_light[3], near_lost[3], own_lost[3], far_lost[3];
    light_at(q, before, before ? far * tyni_entry_depth(before) : 0.0f, k->glow, near_light, near_lost);
    light_at(q, 0, z * k->length, k->glow, far_light, own_lost);
    light_at(q, behind, behind ? far * tyni_entry_depth(behind) : far, k->glow, far_light, far_lost);
    for (int32_t c = 0; c < 3; c++) {
        const float full = k->glow[c] * TYNI_QUADS_ROOTS * TYNI_QUADS_ROOTS, lost = own_lost[c], lost0 = near_lost[c],
                    lost1 = far_lost[c];
        const float light0 = near_light[c] * lost0, light1 = behind ? far_light[c] * lost1 : full * lost1;
        const float least = tyni_maxf(light0, light1 - full * (lost1 - lost));
        const float most = tyni_minf(light1, light0 + full * (lost - lost0));
        const float grown = lost1 > lost0 ? tyni_clampf((lost - lost0) / (lost1 - lost0), 0.0f, 1.0f) : 0.5f;
        float own = light0 + grown * (light1 - light0);
        if (!behind)
            own = light0 + 0.5f * (near_light[c] + full) * (lost - lost0);
        if (tyni_absf(most - least) > GAP * TYNI_QUADS_LEVELS * TYNI_QUADS_LEVELS)
            return 0;
        light[c] = lost > 0.0f ? tyni_maxf(own, 0.0f) / lost : 0.0f;
    }
    return 1;
}

/* The first entry that is not nearer than what these are the bits of: the whole entry tells depths apart. */
TYNI_QUADS_INLINE uint32_t entry_from(const tyni_quads *q, int32_t bits)
{
    const float depth = tyni_bits_float((uint32_t)tyni_maxi(bits, 0)) * q->near;
    const int32_t steps = (int32_t)tyni_float_bits(depth) - (int32_t)(TYNI_ENTRY_FLOOR + 0x4000u) + 0x7fff;
    return (uint32_t)tyni_mini((tyni_maxi(steps, 0) >> 15) + 1, 4095) << 20;
}

/* Samples beside a quad's that a pixel may fit. */
typedef struct search {
    uint32_t first, span;    /* of entries that fit */
    uint32_t before, behind; /* the nearest that don't */
    uint32_t sum, weight;
} search;

TYNI_QUADS_INLINE void look_at(search *s, uint32_t entry, uint32_t weight)
{
    if (entry - s->first < s->span) {
        s->sum += tyni_quads_roots(entry) * weight;
        s->weight += weight;
    } else if (entry < s->first) {
        s->before = entry > s->before ? entry : s->before;
    } else {
        s->behind = entry < s->behind ? entry : s->behind;
    }
}

int tyni_stray_about(const tyni_quads *q, int32_t n, float z, const tyni_knot *k, float light[3])
{
    const int32_t pitch = (int32_t)q->pitch, place = q->entry[n], sample = place % pitch, bits = (int32_t)tyni_float_bits(z);
    const uint32_t *entry = q->entries + place, part = (uint32_t)q->part[n];
    search s = {0, 0, 0, ~0u, 0, 0};
    if (!(z > 0.0f)) { /* no ray */
        light[0] = light[1] = light[2] = 0.0f;
        return 1;
    }
    s.first = entry_from(q, bits - TYNI_QUADS_WINDOW);
    s.span = entry_from(q, bits + TYNI_QUADS_WINDOW) - s.first;
    for (int32_t away = 0; away <= 2 * TYNI_GATHER_BESIDE; away++) {
        const int32_t at = away & 1 ? (away + 1) / 2 : -away / 2;
        if ((uint32_t)(sample + at) >= (uint32_t)pitch)
            continue;
        s.sum = s.weight = 0;
        look_at(&s, entry[at], 64u - part);
        look_at(&s, entry[at + pitch], part);
        if (s.weight >= TYNI_QUADS_ENOUGH) {
            weighed(q, s.sum, s.weight, k->glow, light);
            return 1;
        }
    }
    return between(q, s.before >> 20 ? s.before : 0, ~s.behind ? s.behind : 0, z, k, light);
}

/* ---- one by one ---- */

static TYNI_NOINLINE void reject(const tyni_quads *q, int32_t row, const float *depth)
{
    const ptrdiff_t x = depth - q->depth[row];
    q->rejected[row][x >> 5] |= 1u << (x & 31);
}

void tyni_stray_each(const tyni_quads *q, int32_t n, int32_t rows, const tyni_knot *k)
{
    const uint32_t *entry = q->entries + q->entry[n];
    const uint32_t e0 = entry[0], e1 = entry[q->pitch], part = (uint32_t)q->part[n];
    const uint32_t low0 = tyni_quads_low(q, e0), low1 = tyni_quads_low(q, e1);
    const int32_t columns = tyni_mini(q->count - 2 * n, 2);
    struct {
        tyni_air air;
        uint32_t ready, known; /* the weights that its light has; bits of the depth whose share it has */
    } two[2], *a;              /* of pixels that the first sample fits, and of others: whichever way the edge runs */
    two[0].ready = two[1].ready = 0;
    two[0].known = two[1].known = 0u - 2 * NEAR;
    for (int32_t row = 0; row < rows; row++) {
        const float *depth = q->depth[row] + 2 * n, *end = depth + columns;
        const uint8_t *from = q->from[row] + 8 * n;
        const uint32_t *dither = &q->dither[row][2 * n & 7];
        uint8_t *to = q->to[row] + 8 * n;
        for (; depth < end; depth++, from += 4, to += 4, dither++) {
            const float z = tyni_maxf(tyni_minf(*depth, q->far), 0.0f), s = z * k->length;
            const uint32_t bits = tyni_float_bits(z), w1 = bits - low1 < 2 * TYNI_QUADS_WINDOW ? part : 0;
            uint32_t w0 = 0;
            a = two + 1;
            if (bits - low0 < 2 * TYNI_QUADS_WINDOW) {
                w0 = 64u - part;
                a = two;
            }
            if (bits - a->known + NEAR > 2 * NEAR) {
                tyni_quads_fade(q, s, &a->air);
                a->known = bits;
            }
            if (w0 + w1 < TYNI_QUADS_ENOUGH) {
                a->ready = 0;
                if (!tyni_stray_about(q, n, z, k, a->air.light)) {
                    reject(q, row, depth);
                    continue;
                }
            } else if (w0 + 128 * w1 != a->ready) {
                weighed(q, tyni_quads_roots(e0) * w0 + tyni_quads_roots(e1) * w1, w0 + w1, k->glow, a->air.light);
                a->ready = w0 + 128 * w1;
            }
            if (q->plain) {
                float share[3];
                tyni_quads_share(&a->air, s, share);
                tyni_quads_put(q, from, to, a->air.light, share, *dither);
            } else {
                tyni_stray_put(q, (int32_t)(depth - q->depth[row]), row, &a->air, s);
            }
        }
    }
}

void tyni_stray_walk(const tyni_quads *q, int32_t row)
{
    const tyni_pass *p = q->pass;
    for (int32_t i = tyni_sample_next(q->rejected[row], 0, q->count - 1); i < q->count;
         i = tyni_sample_next(q->rejected[row], i + 1, q->count - 1)) {
        float light[3], share[3], s;
        tyni_sight v;
        tyni_air a;
        s = tyni_view_sight(&p->view, (float)(q->x + i) + 0.5f, (float)(q->y + row) + 0.5f, &v);
        s *= tyni_maxf(tyni_minf(q->depth[row][i], q->far), 0.0f);
        tyni_walk_pixel(p->context->config.isa, p->lamp, &p->medium, &v, s, p->slices.stride, light);
        tyni_quads_fade(q, s, &a);
        tyni_quads_share(&a, s, share);
        for (int32_t c = 0; c < 3; c++) {
            const float lost = 1.0f - share[c];
            a.light[c] = lost > 0.0f ? tyni_maxf(light[tyni_quads_colour(q, c)], 0.0f) * q->gain / lost : 0.0f;
            a.light[c] = tyni_minf(a.light[c], 1e20f * q->gain); /* as knots have it: no infinity, whose differences are NaN */
        }
        tyni_stray_put(q, i, row, &a, s);
        q->stats->rejected++;
    }
}
