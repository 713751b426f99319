/* pixel.c - see pixel.h */
#include "pixel.h"

#include "art.h"
#include "base.h"
#include "check.h"
#include "composite.h"
#include "entry.h"
#include "debug.h"
#include "lanes/lanes.h"
#include "num.h"
#include "sample.h"
#include "walk.h"

/* Whether an ISA has lanes side by side. */
#if defined(TYNI_LANES_X86) || defined(TYNI_LANES_NEON) || defined(TYNI_LANES_WASM)
#define WIDE(isa) ((isa) != TYN_ISA_SCALAR)
#else
#define WIDE(isa) 0
#endif

/* Samples of a band's pixels. */
#define TILE_SAMPLES (TYNI_PIXEL_BAND + 1)

/* A run of pixels in one row. Its planes lie in the worker's scratch and have room for a multiple of 16 pixels. */
typedef struct run {
    int32_t x, y, count;
    const float *depth; /* as in the depth image */
    float *nearness;    /* a length along the ray times this is a depth relative to far */
    float *reach;       /* metres to where the ray ends: the surface, or the frame's max_distance; 0: no ray */
    float *cosine;      /* of the ray and the way to the light: directional lights */
    float *from, *to;   /* the part of the ray that the light reaches; to = 0: none. Unbounded lights: 0, reach */
    float *value[3];    /* visibility */
    float *light[3];    /* L_scat so far */
    float *share[3];    /* of the surface's light, what is left; where `cosine`, `from` and `to` were */
    int shared;         /* pixel_shade finds it on the way: the last light, all of each ray, the medium's own extinction */
    uint32_t *rejected; /* bits */
    void *mill;
    tyn_stats *stats;
    uint64_t now;            /* the clock, when the last run in rows below one another was done */
    uint64_t walked, row[2]; /* what rays of their own took in these rows; up to the light and from there on in the last one */
} run;

/* Visibility from lines or from the grid; 0: nothing fits. `at`: depth relative to far. A function of its own: its copies take
 * stack that other stages need. */
static TYNI_NOINLINE int visible(const tyni_pass *p, float px, float py, float at, float value[3])
{
    const float threshold = tyni_gather_threshold(p->lines.threshold, &p->view, p->lamp, px, py, at);
    if (!tyni_pass_gridded(p))
        return tyni_gather_lines(&p->gather, &p->lines, &p->slices, px, py, at, threshold, value);
    if (tyni_gather_grid(&p->grid, px, py, at, threshold, value))
        return 1;
    if (p->naive)
        tyni_gather_nearest(&p->grid, px, py, at, value);
    return p->naive;
}

/* Pixels of images that are read after this run's depth: the row below, and of this one colour and target. */
typedef struct ahead {
    const uint8_t *pixels[3];
    int32_t bytes[3]; /* of a pixel; 0: no image */
} ahead;

/* Entries of lines along y as rows of pixels want them: lines side by side, sample after sample. Of one run of pixels in one
 * band. */
typedef struct tile {
    const tyni_sector *sector;
    int32_t low, count; /* lines of the field */
    int32_t sample, samples;
    int32_t room;                /* lines */
    uint32_t *row[TILE_SAMPLES]; /* with `room` + 16 words: vectors are read from any line on */
} tile;

/* Of pixels to a sample: strides are powers of 2. */
static int32_t shift_of(const tyni_slices *slices)
{
    int32_t shift = 0;
    while (1 << shift < slices->stride)
        shift++;
    return shift;
}

/* The usual picture: one sun over all of the screen in air that takes from all channels, out of four bytes a pixel into four.
 * Channels are in the order of the medium's least extinction, its largest and the one between. */
typedef struct picture {
    tyni_medium medium;
    float inverse[3], colour[3];                     /* 1 / extinction; of the sun */
    float between[3];                                /* pixel_between's factors of the least, the largest and their root */
    float base[TYN_MAX_MEDIA], slope[TYN_MAX_MEDIA]; /* Henyey and Greenstein's (1 - g)^2 and 2 g */
    int32_t from_byte[3], shift[3], opaque;          /* in pixels of four bytes; in words */
    float exposure;
    tyn_tone tone;
    /* of a run */
    const uint8_t *from;
    uint8_t *target;
    float offset[24]; /* tyni_composite_offsets */
} picture;

typedef char picture_fits[sizeof(picture) <= TYN_BUNDLE_BYTES ? 1 : -1]; /* it has that part of the worker's scratch */

#define TYNI_KERNEL "pixel_kernel.h"
#include "lanes/each.h"
#define TYNI_KERNEL "beside_kernel.h"
#include "lanes/each.h"
#define TYNI_KERNEL "shade_kernel.h"
#include "lanes/each.h"
#define TYNI_KERNEL "picture_kernel.h"
#include "lanes/each.h"

/* What follows from the pixels' depths. A function of its own, as others below, for the stack that later stages need. */
static TYNI_NOINLINE void see(const tyni_pass *p, const run *r)
{
    const tyn_image *image[3];
    ahead a;
    image[0] = p->depth.image;
    image[1] = &p->frame->colour;
    image[2] = &p->frame->target;
    for (int32_t i = 0; i < 3; i++) {
        int32_t y = i ? r->y : tyni_mini(r->y + 1, p->view.height - 1);
        a.bytes[i] = image[i]->pixels ? tyn_format_bytes(image[i]->format) : 0;
        a.pixels[i] = image[i]->pixels ? tyni_image_row(image[i], y) : (const void *)r->depth;
        a.pixels[i] += (ptrdiff_t)r->x * a.bytes[i];
    }
    TYNI_LANES_CALL(p->context->config.isa, pixel_sights, (p, r, &a));
}

/* TYN_METHOD_PREFILTERED: pixels first .. end - 1 from the rows of the slices beside each. */
static TYNI_NOINLINE void unwarp_rows(const tyni_pass *p, const run *r, const tyni_sector *sector, int32_t first, int32_t end)
{
    tyni_lookup l;
    if (sector->count < 2)
        return; /* no slices at all */
    l.view = &p->view;
    l.slices = &p->slices;
    l.sector = sector;
    l.shelves = p->context->shelves;
    l.bytes = p->context->shelf_bytes;
    l.x = r->x + first;
    l.y = r->y;
    l.count = end - first;
    l.first = first;
    l.from = r->from + first;
    l.to = r->to + first;
    for (int32_t c = 0; c < 3; c++)
        l.value[c] = r->value[c] + first;
    l.rejected = r->rejected;
    l.scratch = r->mill;
    tyni_lookup_pixels(&p->fourier, &l);
}

/* Sees to it that the tile holds the lines beside pixels of slice coordinates a .. b in row y; 0: they are too many. The rows
 * below need some lines more, since lines are slanted by at most 45 degrees. */
static int cover(const tyni_pass *p, const tyni_sector *s, float a, float b, int32_t y, tile *t)
{
    const int32_t stride = p->slices.stride, margin = TYNI_PIXEL_BAND;
    int32_t low = s->start + (int32_t)tyni_minf(a, b), below;
    int32_t high = tyni_mini(s->start + (int32_t)tyni_maxf(a, b) + 1, s->start + s->count - 1);
    if (t->sector == s && low >= t->low && high < t->low + t->count)
        return 1;
    low = tyni_maxi(low - margin, s->start);
    high = tyni_mini(high + margin, s->start + s->count - 1);
    t->sector = s;
    t->low = low;
    t->count = high - low + 1;
    if (t->count > t->room) {
        t->count = 0;
        return 0;
    }
    below = tyni_mini((y / TYNI_PIXEL_BAND + 1) * TYNI_PIXEL_BAND, p->view.height) - 1;
    t->sample = y / stride;
    t->samples = tyni_mini((below + stride - 1) / stride, p->lines.pitch - 1) - t->sample + 1;
    for (int32_t line = 0; line < t->count; line++) {
        const uint32_t *from = p->lines.entries + (ptrdiff_t)(low + line) * p->lines.pitch + t->sample;
        if (line + 8 < t->count)
            TYNI_PREFETCH(from + 8 * (ptrdiff_t)p->lines.pitch);
        for (int32_t j = 0; j < t->samples; j++)
            t->row[j][line] = from[j];
    }
    return 1;
}

/* Pixels first .. end - 1 of the row, all in one sector of the shear grid. */
static void unwarp_sector(const tyni_pass *p, const run *r, const tyni_sector *s, int32_t first, int32_t end, tile *t)
{
    const int32_t isa = p->context->config.isa;
    const float *k = r->value[0];
    const tile *ready = NULL;
    /* samples on each column or row of pixels, and one threshold for all */
    const int plain = WIDE(isa) && p->slices.stride == 1 && tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL;
    if (s->count < 2)
        return; /* no slices at all */
    TYNI_LANES_CALL(isa, pixel_places, (p, r, s, first, end));
    if (s->along_y && isa != TYN_ISA_SCALAR && cover(p, s, k[first], k[end - 1], r->y, t))
        ready = t;
    for (int32_t i = first, next; i < end; i = next) {
        if (plain)
            i = TYNI_LANES_CALL(isa, pixel_unwarp_pairs, (p, r, s, ready, i, end));
        next = plain ? tyni_mini(i + 64, end) : end;
        if (i < end)
            TYNI_LANES_CALL(isa, pixel_unwarp, (p, r, s, ready, i, next));
    }
    /* In the light of an unbounded sun: a lamp's varies too fast, and ends at its cone. Leaves have most such pixels: of 9951
     * with rays of their own in a picture of 1920x1080, 832 are left, at a loss of 0.1 dB to the march; with samples two pixels
     * apart 5027 become 2288 at 960x540, for 0.2 dB. */
    if (tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL && !tyni_view_bounded(p->lamp))
        TYNI_LANES_CALL(isa, pixel_beside, (p, r, s, first, end));
}

/* The row's pixels in at most three parts, one for each sector that it crosses. */
static void unwarp_shear(const tyni_pass *p, const run *r, tile *t)
{
    const int32_t end = r->x + r->count;
    for (int32_t x = r->x, next; x < end; x = next) {
        const tyni_sector *s = tyni_slice_span(&p->slices, x, end, 1, (float)r->y + 0.5f, &next);
        if (tyni_prefilter_kept(p->method))
            unwarp_rows(p, r, s, x - r->x, next - r->x);
        else
            unwarp_sector(p, r, s, x - r->x, next - r->x, t);
    }
}

/* Pixel by pixel: other lines, grids, and three channels. */
static void unwarp_each(const tyni_pass *p, const run *r)
{
    int rays = p->method == TYN_METHOD_MARCH && !tyni_pass_gridded(p);
    for (int32_t i = 0; i < r->count; i++) {
        float px = (float)(r->x + i) + 0.5f, py = (float)r->y + 0.5f, value[3];
        if (!(r->to[i] > 0.0f))
            continue;
        if (rays || !visible(p, px, py, r->to[i] * r->nearness[i], value)) {
            r->rejected[i >> 5] |= 1u << (i & 31);
            continue;
        }
        for (int32_t c = 0; c < 3; c++)
            r->value[c][i] = value[c];
    }
}

/* The light's part of each ray, where that is not all of it. */
static TYNI_NOINLINE void clip_rays(const tyni_pass *p, const run *r)
{
    for (int32_t i = 0; i < r->count; i++) {
        tyni_sight v;
        float t0 = 0.0f, t1 = r->reach[i];
        tyni_view_sight(&p->view, (float)(r->x + i) + 0.5f, (float)r->y + 0.5f, &v);
        if (!(t1 > 0.0f) || !tyni_view_clip(p->lamp, &v, &t0, &t1))
            t0 = t1 = 0.0f;
        r->from[i] = t0;
        r->to[i] = t1;
    }
}

/* Visibility of the run's pixels. */
static void unwarp(const tyni_pass *p, run *r, tile *t)
{
    r->from = r->share[1];
    r->to = r->share[2];
    if (tyni_view_bounded(p->lamp)) {
        clip_rays(p, r);
    } else {
        memset(r->from, 0, sizeof *r->from * (size_t)r->count);
        r->to = r->reach;
        r->shared =
            p->last && p->fog[0] == p->medium.sigma[0] && p->fog[1] == p->medium.sigma[1] && p->fog[2] == p->medium.sigma[2];
    }
    if (tyni_prefilter_kept(p->method) ||
        (tyni_pass_sliced(p) && !tyni_slice_bordered(&p->slices) && !tyni_pass_gridded(p) && p->count < 3))
        unwarp_shear(p, r, t);
    else
        unwarp_each(p, r);
}

/* From visibility to light: its phase functions, and what of it arrives. */
static void shade(const tyni_pass *p, run *r)
{
    const int32_t isa = p->context->config.isa;
    if (tyni_view_kind(p->lamp) != TYN_LIGHT_DIRECTIONAL || (p->method == TYN_METHOD_MARCH && !tyni_pass_gridded(p)))
        r->shared = 0;
    if (p->method == TYN_METHOD_MARCH && !tyni_pass_gridded(p))
        return;
    if (tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL)
        TYNI_LANES_CALL(isa, pixel_shade, (p, r));
    else
        TYNI_LANES_CALL(isa, pixel_shade_local, (p, r));
}

/* The rays of pixels that nothing fits, and of all with TYN_METHOD_MARCH. */
static void correct(const tyni_pass *p, const run *r)
{
    int32_t steps = tyni_ray_way(p->context->config.rays, TYN_RAYS_STEPS) ? p->context->config.steps : 0, count = 0;
    /* where a line's samples are some pixels apart, so may the texels be */
    int32_t pace = p->method == TYN_METHOD_EPIPOLAR && !tyni_slice_bordered(&p->slices) ? tyni_maxi(p->slices.stride, 1) : 1;
    for (int32_t i = tyni_sample_next(r->rejected, 0, r->count - 1); i < r->count;
         i = tyni_sample_next(r->rejected, i + 1, r->count - 1)) {
        float light[3];
        tyni_sight v;
        tyni_view_sight(&p->view, (float)(r->x + i) + 0.5f, (float)r->y + 0.5f, &v);
        if (steps)
            tyni_walk_pixel_steps(p->context->config.isa, p->lamp, &p->medium, &v, r->reach[i], steps, light);
        else
            tyni_walk_pixel(p->context->config.isa, p->lamp, &p->medium, &v, r->reach[i], pace, light);
        for (int32_t c = 0; c < 3; c++)
            r->light[c][i] += light[c];
        count++;
    }
    if (tyni_pass_gridded(p))
        r->stats->corrected += count;
    else if (p->method == TYN_METHOD_MARCH)
        r->stats->rays += count;
    else
        r->stats->rejected += count;
}

/* L = transmittance * colour + L_scat, into the target's format. */
static void finish(const tyni_pass *p, const run *r)
{
    static const tyn_display plain = {1.0f, TYN_TONE_CLAMP, 0};
    const tyn_frame *frame = p->frame;
    const int32_t isa = p->context->config.isa;
    if (frame->scatter.pixels)
        tyni_composite_write(isa, &frame->scatter, &plain, r->x, r->y, r->count, r->light);
    if (!frame->target.pixels && !frame->transmittance.pixels)
        return;
    if (!r->shared)
        TYNI_LANES_CALL(isa, pixel_share, (p, r));
    if (frame->transmittance.pixels)
        tyni_composite_write(isa, &frame->transmittance, &plain, r->x, r->y, r->count, r->share);
    if (frame->target.pixels && !frame->debug)
        tyni_composite_blend(isa, &frame->target, &frame->display, &frame->colour, r->x, r->y, r->count, r->share, r->light);
}

static void draw_debug(const tyni_pass *p, const run *r, float *const colour[3])
{
    static const tyn_display plain = {1.0f, TYN_TONE_FILM, 0};
    const int32_t isa = p->context->config.isa;
    float exposure = p->frame->display.exposure > 0.0f ? p->frame->display.exposure : 1.0f;
    tyni_composite_read(isa, &p->frame->colour, r->x, r->y, r->count, colour);
    for (int32_t i = 0; i < r->count; i++) {
        float rgb[3];
        for (int32_t c = 0; c < 3; c++)
            rgb[c] = colour[c][i] * 0.5f * exposure;
        tyni_debug_pixel(p, r->x + i, r->y, r->depth[i], tyni_sample_bit(r->rejected, i), rgb);
        for (int32_t c = 0; c < 3; c++)
            colour[c][i] = rgb[c];
    }
    tyni_composite_write(isa, &p->frame->target, &plain, r->x, r->y, r->count, colour);
}

static int four_bytes(tyn_format format)
{
    return format == TYN_RGBA8_SRGB || format == TYN_BGRA8_SRGB;
}

/* Whether this light's pictures are the usual ones, and if so what is the same in all runs. */
static TYNI_NOINLINE int usual(const tyni_pass *p, picture *q)
{
    const tyn_frame *f = p->frame;
    const tyni_medium *m = &p->medium;
    const int32_t order[3] = {m->low, m->high, m->middle};
    if (!p->first || !p->last || p->count == 3 || p->method == TYN_METHOD_NONE ||
        (p->method == TYN_METHOD_MARCH && !tyni_pass_gridded(p)) || tyni_prefilter_kept(p->method) ||
        tyni_view_kind(p->lamp) != TYN_LIGHT_DIRECTIONAL || tyni_view_bounded(p->lamp))
        return 0;
    if (f->debug || f->scatter.pixels || f->transmittance.pixels || !f->colour.pixels || !f->target.pixels ||
        !four_bytes(f->colour.format) || !four_bytes(f->target.format))
        return 0;
    q->medium = *m;
    for (int32_t n = 0; n < 3; n++) {
        const int32_t c = order[n];
        if (p->fog[c] != m->sigma[c] || m->sigma[c] <= TYNI_SIGMA_LEAST)
            return 0;
        q->medium.sigma[n] = m->sigma[c];
        q->medium.isotropic[n] = m->isotropic[c];
        q->medium.rayleigh[n] = m->rayleigh[c];
        for (int32_t i = 0; i < m->hg_count; i++)
            q->medium.hg[i].scale[n] = m->hg[i].scale[c];
        q->inverse[n] = 1.0f / m->sigma[c];
        q->colour[n] = p->lamp->colour[c];
        q->from_byte[n] = f->colour.format == TYN_BGRA8_SRGB ? 2 - c : c;
        q->shift[n] = 8 * (f->target.format == TYN_BGRA8_SRGB ? 2 - c : c);
    }
    q->between[0] = (1.0f - m->blend) * (1.0f - m->blend);
    q->between[1] = m->blend * m->blend;
    q->between[2] = 2.0f * (1.0f - m->blend) * m->blend;
    for (int32_t i = 0; i < m->hg_count; i++) {
        q->base[i] = (1.0f - m->hg[i].g) * (1.0f - m->hg[i].g);
        q->slope[i] = 2.0f * m->hg[i].g;
    }
    q->opaque = (int32_t)0xff000000u;
    q->exposure = f->display.exposure > 0.0f ? f->display.exposure : 1.0f;
    q->tone = f->display.tone;
    return 1;
}

static TYNI_NOINLINE void paint(const tyni_pass *p, const run *r, picture *q)
{
    q->from = (const uint8_t *)tyni_image_row(&p->frame->colour, r->y) + (ptrdiff_t)r->x * 4;
    q->target = (uint8_t *)tyni_image_row(&p->frame->target, r->y) + (ptrdiff_t)r->x * 4;
    tyni_composite_offsets(&p->frame->display, r->y, q->offset);
    TYNI_LANES_CALL(p->context->config.isa, pixel_picture, (r, q));
}

/* Whether any pixel wants a ray of its own. */
static int rejects(const run *r)
{
    return tyni_sample_next(r->rejected, 0, r->count - 1) < r->count;
}

/* From visibility to the end; `sum`: of the lights before, three planes of the run's pixels. */
static void light_run(const tyni_pass *p, run *r, int dark, float *sum)
{
    const size_t bytes = sizeof **r->light * (size_t)r->count;
    for (int32_t c = 0; c < 3; c++) {
        if (p->first)
            memset(r->light[c], 0, bytes);
        else
            memcpy(r->light[c], sum + c * r->count, bytes);
    }
    if (!dark) {
        shade(p, r);
        if (rejects(r)) {
            const uint64_t start = tyni_pass_now(p);
            correct(p, r);
            r->walked += tyni_pass_now(p) - start;
        }
    }
    for (int32_t c = 0; c < 3 && !p->last; c++)
        memcpy(sum + c * r->count, r->light[c], bytes);
    if (p->last)
        finish(p, r);
    if (TYNI_HAS(TYN_PART_DEBUG) && p->frame->debug && p->frame->target.pixels)
        draw_debug(p, r, r->value);
}

/* q: NULL where the picture is not the usual one. timed: clocks take as long as some pixels, and are read in one row of a band.
 */
static void draw_run(const tyni_pass *p, run *r, tile *t, picture *q, float *sum, int timed)
{
    /* where the lines hold marks there is no light to see */
    int dark = p->method == TYN_METHOD_NONE || tyni_debug_marks(p->frame->debug);
    const uint64_t walked = r->walked, start = timed ? tyni_pass_now(p) : 0;
    r->shared = 0;
    memset(r->rejected, 0, sizeof *r->rejected * (size_t)tyni_sample_words(r->count));
    see(p, r);
    if (!dark)
        unwarp(p, r, t);
    if (timed)
        r->row[0] = tyni_pass_now(p) - start;
    if (q && !rejects(r))
        paint(p, r, q);
    else
        light_run(p, r, dark, sum);
    if (timed) {
        r->now = tyni_pass_now(p);
        r->row[1] = r->now - start - r->row[0] - (r->walked - walked);
    }
}

/* all * part / whole, for less than a second. Not by 64-bit division, which small machines have out of their compiler's library
 * alone. */
static uint32_t part_of(uint64_t all, uint64_t part, uint64_t whole)
{
    const uint32_t second = 0x3fffffff;
    if (!((uint32_t)whole & second))
        return 0;
    return (uint32_t)((float)((uint32_t)all & second) *
                      tyni_minf((float)((uint32_t)part & second) / (float)((uint32_t)whole & second), 1.0f));
}

/* The run's pixels in rows first .. end - 1. A run in all rows before the next run: rows below one another read the same lines
 * of memory. */
static void draw_rows(const tyni_pass *p, run *r, tile *t, picture *q, float *room, int32_t first, int32_t end)
{
    const uint64_t before = r->now;
    uint64_t all;
    uint32_t light;
    r->walked = 0;
    t->sector = NULL;
    for (r->y = first; r->y < end; r->y++) {
        float *sum = p->context->light ? p->context->light + ((ptrdiff_t)r->y * p->view.width + r->x) * 3 : NULL;
        r->depth = tyni_door_row(&p->depth, r->x, r->y, r->count, room);
        draw_run(p, r, t, q, sum, r->y == end - 1);
    }
    all = r->now - before - r->walked;
    light = part_of(all, r->row[1], r->row[0] + r->row[1]);
    *(tyni_pass_gridded(p) ? &r->stats->upscale_ns : &r->stats->unwarp_ns) += all - light;
    r->stats->correct_ns += r->walked;
    r->stats->composite_ns += light;
}

void tyni_pixel_band(void *argument, int32_t index, int32_t worker)
{
    const tyni_pass *p = argument;
    int32_t end = tyni_mini((index + 1) * TYNI_PIXEL_BAND, p->view.height), most = tyni_pass_run(p->context);
    tyni_scratch s;
    tile t;
    run r;
    picture *q;
    tyni_pass_scratch(p->context, worker, &s);
    memset(&r, 0, sizeof r);
    memset(&t, 0, sizeof t);
    q = WIDE(p->context->config.isa) && usual(p, (void *)s.bundle) ? (void *)s.bundle : NULL;
    /* where a line's values were: three arrays, three samples in each */
    t.room = p->context->points / 3 - 16;
    for (int32_t j = 0; j < TILE_SAMPLES; j++)
        t.row[j] = (uint32_t *)(void *)s.value[j % 3] + j / 3 * (p->context->points / 3);
    r.nearness = s.plane[0];
    r.reach = s.plane[1];
    r.cosine = s.plane[2];
    for (int32_t c = 0; c < 3; c++) {
        r.value[c] = s.plane[3 + c];
        r.light[c] = s.plane[6 + c];
    }
    r.share[0] = r.cosine;
    r.share[1] = s.plane[9];
    r.share[2] = s.plane[10];
    r.rejected = s.fresh;
    r.mill = s.mill;
    r.stats = s.stats;
    r.now = tyni_pass_now(p);
    for (r.x = 0; r.x < p->view.width; r.x += r.count) {
        r.count = tyni_mini(most, p->view.width - r.x);
        draw_rows(p, &r, &t, q, s.depth, index * TYNI_PIXEL_BAND, end);
    }
}
