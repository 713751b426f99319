/* pixel.c - see pixel.h */
#include "pixel.h"

#include "art.h"
#include "base.h"
#include "composite.h"
#include "debug.h"
#include "num.h"
#include "sample.h"
#include "walk.h"

#define CHUNK 16 /* pixels at a time whose colours are on the stack */

/* A run of pixels in one row; what it needs lies in the worker's scratch. */
typedef struct run {
    int32_t x, y, count;
    const float *depth; /* as in the depth image */
    float *light;       /* 3 floats a pixel */
    uint32_t *rejected; /* bits */
    tyn_stats *stats;
} run;

/* Visibility of the third channel. It falls about exponentially with extinction where the near air is in shadow. */
static float between(float a, float b, float blend)
{
    float least = tyni_minf(a, b);
    if (least <= 0.0f || tyni_absf(a - b) <= 0.1f * least)
        return a + (b - a) * blend;
    return a * tyni_num_exp(blend * tyni_num_log(b / a));
}

/* Visibility from lines or from the grid; 0: nothing fits. `at`: depth relative to far. */
static int visible(const tyni_pass *p, float px, float py, float at, float value[3])
{
    if (!p->grid.rows)
        return tyni_gather_lines(&p->gather, &p->lines, &p->slices, px, py, at, value);
    if (tyni_gather_grid(&p->grid, px, py, at, value))
        return 1;
    if (p->naive)
        tyni_gather_nearest(&p->grid, px, py, at, value);
    return p->naive;
}

/* Adds visibility times the light that would be there without shadows. The phase function comes in here, last: it varies fast
 * near the epipole (IVB section 6.8). */
static void shade(const tyni_pass *p, const tyni_sight *v, float t0, float t1, const float value[3], float *rgb)
{
    const tyni_medium *m = &p->medium;
    float light[3], norm[3], mix[3] = {1.0f, 1.0f, 1.0f};
    if (p->count == 3) {
        memcpy(light, value, sizeof light);
    } else {
        light[m->low] = value[0];
        light[m->high] = value[1];
        light[m->middle] = between(value[0], value[1], m->blend);
    }
    tyni_integral_norm(m, p->lamp, v, t0, t1, norm);
    if (p->lamp->kind == TYN_LIGHT_DIRECTIONAL)
        tyni_medium_mix(m, tyni_clampf(tyni_vec_dot(v->d, p->lamp->to_light), -1.0f, 1.0f), mix);
    for (int32_t c = 0; c < 3; c++)
        rgb[c] += light[c] * norm[c] * mix[c] * p->lamp->colour[c];
}

static void unwarp(const tyni_pass *p, const run *r)
{
    for (int32_t i = 0; i < r->count; i++) {
        float px = (float)(r->x + i) + 0.5f, py = (float)r->y + 0.5f, t0, t1, length, value[3];
        tyni_sight v;
        length = tyni_view_sight(&p->view, px, py, &v);
        if (!tyni_pass_range(p, &v, tyni_view_depth(&p->view, r->depth[i]) * length, &t0, &t1))
            continue;
        if (p->method != TYN_METHOD_MARCH || p->grid.rows) {
            if (visible(p, px, py, t1 / (length * p->view.far_depth), value)) {
                shade(p, &v, t0, t1, value, r->light + 3 * (ptrdiff_t)i);
                continue;
            }
        }
        r->rejected[i >> 5] |= 1u << (i & 31);
    }
}

/* The rays of pixels that nothing fits, and of all with TYN_METHOD_MARCH. */
static void correct(const tyni_pass *p, const run *r)
{
    int32_t steps = p->context->config.rays == TYN_RAYS_STEPS ? p->context->config.steps : 0, count = 0;
    for (int32_t i = tyni_sample_next(r->rejected, 0, r->count - 1); i < r->count;
         i = tyni_sample_next(r->rejected, i + 1, r->count - 1)) {
        float length, light[3];
        tyni_sight v;
        length = tyni_view_sight(&p->view, (float)(r->x + i) + 0.5f, (float)r->y + 0.5f, &v);
        length = tyni_art_reach(p->frame, tyni_view_depth(&p->view, r->depth[i]) * length);
        tyni_walk_pixel(p->lamp, &p->medium, &v, length, steps, light);
        for (int32_t c = 0; c < 3; c++)
            r->light[3 * (ptrdiff_t)i + c] += light[c];
        count++;
    }
    if (p->grid.rows)
        r->stats->corrected += count;
    else if (p->method == TYN_METHOD_MARCH)
        r->stats->rays += count;
    else
        r->stats->rejected += count;
}

/* L = transmittance * colour + L_scat, into the target's format. */
static void finish(const tyni_pass *p, int32_t x, int32_t y, int32_t count, const float *depth, const float *light)
{
    static const tyn_display plain = {1.0f, TYN_TONE_CLAMP, 0};
    const tyn_frame *frame = p->frame;
    float rgb[3 * CHUNK], share[3 * CHUNK];
    if (frame->scatter.pixels)
        tyni_composite_write(&frame->scatter, &plain, x, y, count, light);
    if (!frame->target.pixels && !frame->transmittance.pixels)
        return;
    for (int32_t i = 0; i < count; i++) {
        tyni_sight v;
        float length = tyni_view_sight(&p->view, (float)(x + i) + 0.5f, (float)y + 0.5f, &v);
        float s = tyni_art_reach(frame, tyni_view_depth(&p->view, depth[i]) * length);
        for (int32_t c = 0; c < 3; c++)
            share[3 * i + c] = tyni_num_exp(-p->fog[c] * s);
    }
    if (frame->transmittance.pixels)
        tyni_composite_write(&frame->transmittance, &plain, x, y, count, share);
    if (!frame->target.pixels || frame->debug)
        return;
    tyni_composite_read(&frame->colour, x, y, count, rgb);
    for (int32_t i = 0; i < 3 * count; i++)
        rgb[i] = share[i] * rgb[i] + light[i];
    tyni_composite_write(&frame->target, &frame->display, x, y, count, rgb);
}

static void draw_debug(const tyni_pass *p, const run *r, int32_t first, int32_t count)
{
    static const tyn_display plain = {1.0f, TYN_TONE_FILM, 0};
    float rgb[3 * CHUNK], exposure = p->frame->display.exposure > 0.0f ? p->frame->display.exposure : 1.0f;
    tyni_composite_read(&p->frame->colour, r->x + first, r->y, count, rgb);
    for (int32_t i = 0; i < count; i++) {
        for (int32_t c = 0; c < 3; c++)
            rgb[3 * i + c] *= 0.5f * exposure;
        tyni_debug_pixel(p, r->x + first + i, r->y, r->depth[first + i], tyni_sample_bit(r->rejected, first + i), rgb + 3 * i);
    }
    tyni_composite_write(&p->frame->target, &plain, r->x + first, r->y, count, rgb);
}

static void draw_run(const tyni_pass *p, const run *r, float *sum)
{
    /* where the lines hold marks there is no light to see */
    int dark = p->method == TYN_METHOD_NONE || tyni_debug_marks(p->frame->debug);
    uint64_t time[4];
    if (p->first)
        memset(r->light, 0, sizeof *r->light * 3u * (size_t)r->count);
    else
        memcpy(r->light, sum, sizeof *r->light * 3u * (size_t)r->count);
    time[0] = tyni_pass_now(p);
    memset(r->rejected, 0, sizeof *r->rejected * (size_t)tyni_sample_words(r->count));
    if (!dark)
        unwarp(p, r);
    time[1] = tyni_pass_now(p);
    if (!dark)
        correct(p, r);
    time[2] = tyni_pass_now(p);
    if (!p->last)
        memcpy(sum, r->light, sizeof *r->light * 3u * (size_t)r->count);
    for (int32_t i = 0; i < r->count && p->last; i += CHUNK)
        finish(p, r->x + i, r->y, tyni_mini(CHUNK, r->count - i), r->depth + i, r->light + 3 * (ptrdiff_t)i);
    for (int32_t i = 0; i < r->count && p->frame->debug && p->frame->target.pixels; i += CHUNK)
        draw_debug(p, r, i, tyni_mini(CHUNK, r->count - i));
    time[3] = tyni_pass_now(p);
    *(p->grid.rows ? &r->stats->upscale_ns : &r->stats->unwarp_ns) += time[1] - time[0];
    r->stats->correct_ns += time[2] - time[1];
    r->stats->composite_ns += time[3] - time[2];
}

void tyni_pixel_band(void *argument, int32_t index, int32_t worker)
{
    const tyni_pass *p = argument;
    int32_t end = tyni_mini((index + 1) * TYNI_PIXEL_BAND, p->view.height);
    tyni_scratch s;
    run r;
    tyni_pass_scratch(p->context, worker, &s);
    r.light = s.value[0];
    r.rejected = s.fresh;
    r.stats = s.stats;
    for (r.y = index * TYNI_PIXEL_BAND; r.y < end; r.y++)
        for (r.x = 0; r.x < p->view.width; r.x += r.count) {
            float *sum = p->context->light ? p->context->light + ((ptrdiff_t)r.y * p->view.width + r.x) * 3 : NULL;
            r.count = tyni_mini(p->context->samples, p->view.width - r.x);
            r.depth = tyni_door_row(&p->depth, r.x, r.y, r.count, s.depth);
            draw_run(p, &r, sum);
        }
}
