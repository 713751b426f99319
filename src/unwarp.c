/* unwarp.c - see unwarp.h */
#include "unwarp.h"

#include "base.h"
#include "check.h"
#include "entry.h"
#include "lanes/lanes.h"

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

/* Of pixels to a sample: strides are powers of 2. */
static int32_t shift_of(const tyni_slices *slices)
{
    int32_t shift = 0;
    while (1 << shift < slices->stride)
        shift++;
    return shift;
}

#define TYNI_KERNEL "unwarp_kernel.h"
#include "lanes/each.h"
#define TYNI_KERNEL "beside_kernel.h"
#include "lanes/each.h"

void tyni_unwarp_sights(const tyni_pass *p, const tyni_run *r)
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
static TYNI_NOINLINE void unwarp_rows(const tyni_pass *p, const tyni_run *r, const tyni_sector *sector, int32_t first,
                                      int32_t end)
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
static int cover(const tyni_pass *p, const tyni_sector *s, float a, float b, int32_t y, tyni_tile *t)
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
        if (line + 16 < t->count)
            TYNI_PREFETCH(from + 16 * (ptrdiff_t)p->lines.pitch);
        for (int32_t j = 0; j < t->samples; j++)
            t->row[j][line] = from[j];
    }
    return 1;
}

/* Pixels first .. end - 1 of the row, all in one sector of the shear grid. */
static void unwarp_sector(const tyni_pass *p, const tyni_run *r, const tyni_sector *s, int32_t first, int32_t end, tyni_tile *t)
{
    const int32_t isa = p->context->config.isa;
    const tyni_tile *ready = NULL;
    /* one threshold for all */
    const int plain = TYNI_CHAINS > 3 && TYNI_LANES_WIDE(isa) && tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL;
    if (s->count < 2)
        return; /* no slices at all */
    TYNI_LANES_CALL(isa, pixel_places, (p, r, s, first, end));
    if (s->along_y && TYNI_LANES_WIDE(isa) && cover(p, s, r->value[0][first], r->value[0][end - 1], r->y, t))
        ready = t;
    for (int32_t i = first, next; i < end; i = next) {
        if (plain)
            i = TYNI_LANES_CALL(isa, pixel_unwarp_pairs, (p, r, s, ready, i, end));
        next = plain ? tyni_mini(i + 64, end) : end;
        if (i < end)
            TYNI_LANES_CALL(isa, pixel_unwarp, (p, r, s, ready, i, next));
    }
    /* In the light of an unbounded sun: a lamp's varies too fast, and ends at its cone. Leaves have most such pixels: of 9951
     * with rays of their own in a picture of 1920x1080, 521 are left, at a loss of 0.1 dB to the march. */
    if (tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL && !tyni_view_bounded(p->lamp))
        TYNI_LANES_CALL(isa, pixel_beside, (p, r, s, first, end));
}

/* The row's pixels in at most three parts, one for each sector that it crosses. */
static void unwarp_shear(const tyni_pass *p, const tyni_run *r, tyni_tile *t)
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
static void unwarp_each(const tyni_pass *p, const tyni_run *r)
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
static TYNI_NOINLINE void clip_rays(const tyni_pass *p, const tyni_run *r)
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

void tyni_unwarp_run(const tyni_pass *p, tyni_run *r, tyni_tile *t)
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
