/* pixel.c - see pixel.h */
#include "pixel.h"

#include "art.h"
#include "base.h"
#include "composite.h"
#include "debug.h"
#include "lanes/lanes.h"
#include "picture.h"
#include "sample.h"
#include "unwarp.h"
#include "walk.h"

#define TYNI_KERNEL "shade_kernel.h"
#include "lanes/each.h"

/* From visibility to light: its phase functions, and what of it arrives. */
static void shade(const tyni_pass *p, tyni_run *r)
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
static void correct(const tyni_pass *p, const tyni_run *r)
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
static void finish(const tyni_pass *p, const tyni_run *r)
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

static void draw_debug(const tyni_pass *p, const tyni_run *r, float *const colour[3])
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

/* Whether any pixel wants a ray of its own. */
static int rejects(const tyni_run *r)
{
    return tyni_sample_next(r->rejected, 0, r->count - 1) < r->count;
}

/* From visibility to the end; `sum`: of the lights before, three planes of the run's pixels. */
static void light_run(const tyni_pass *p, tyni_run *r, int dark, float *sum)
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
static void draw_run(const tyni_pass *p, tyni_run *r, tyni_tile *t, tyni_picture *q, float *sum, int timed)
{
    /* where the lines hold marks there is no light to see */
    int dark = p->method == TYN_METHOD_NONE || tyni_debug_marks(p->frame->debug);
    const uint64_t walked = r->walked, start = timed ? tyni_pass_now(p) : 0;
    r->shared = 0;
    memset(r->rejected, 0, sizeof *r->rejected * (size_t)tyni_sample_words(r->count));
    tyni_unwarp_sights(p, r);
    if (!dark)
        tyni_unwarp_run(p, r, t);
    if (timed)
        r->row[0] = tyni_pass_now(p) - start;
    if (q && !rejects(r))
        tyni_picture_run(p, r, q);
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
static void draw_rows(const tyni_pass *p, tyni_run *r, tyni_tile *t, tyni_picture *q, float *room, int32_t first, int32_t end)
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
    tyni_tile t;
    tyni_run r;
    tyni_picture *q;
    tyni_pass_scratch(p->context, worker, &s);
    memset(&r, 0, sizeof r);
    memset(&t, 0, sizeof t);
    q = TYNI_LANES_WIDE(p->context->config.isa) && tyni_picture_begin(p, (void *)s.bundle) ? (void *)s.bundle : NULL;
    /* where a line's values were: three arrays, three samples in each */
    t.room = p->context->points / 3 - 16;
    for (int32_t j = 0; j < TYNI_UNWARP_SAMPLES; j++)
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
