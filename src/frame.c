/* frame.c - see frame.h. Data flows from top to bottom:
 *
 *   for each light:  lay out its slices
 *       slice jobs:  depth along the line -> break bits -> ray samples -> row of thresholds -> visibility at the rays
 *                    -> interpolation -> the finished line into memory
 *       pixel jobs:  the two nearest lines -> visibility -> light; rejected pixels by rays of their own; after the last light
 *                    transmittance, colour, exposure, tone, dither, format */
#include "frame.h"

#include "art.h"
#include "base.h"
#include "check.h"
#include "composite.h"
#include "debug.h"
#include "door.h"
#include "entry.h"
#include "gather.h"
#include "medium.h"
#include "num.h"
#include "ray.h"
#include "row.h"
#include "sample.h"
#include "slice.h"
#include "view.h"

#define BAND 8   /* rows of pixels a job */
#define CHUNK 16 /* pixels at a time, at most the bits of a word; their buffers are on the stack */

/* One light on its way through the frame. */
typedef struct pass {
    tyn_context *context;
    const tyn_frame *frame;
    tyni_view view;
    tyni_door depth;
    tyni_medium medium;
    float fog[3]; /* extinction of surfaces */
    const tyni_lamp *lamp;
    tyni_slices slices;
    tyni_field field;
    tyn_method method;
    int32_t channels[3], count; /* the channels whose visibility is kept */
    int first, last;            /* of the lights */
} pass;

/* A worker's scratch, and its bytes; before it is placed, only the bytes. */
static size_t scratch_of(const tyn_context *c, int32_t worker, tyni_scratch *s)
{
    tyni_arena arena = {NULL, 0, 0};
    size_t samples = (size_t)c->samples, words = (size_t)tyni_sample_words(c->samples);
    size_t row = tyni_row_room(c->config.shadow_size, c->config.maps);
    arena.block = c->scratch ? c->scratch + c->scratch_bytes * (size_t)worker : NULL;
    s->row = tyni_arena_take(&arena, 1, TYN_ROW_BYTES);
    s->threshold = tyni_arena_take(&arena, 2 * row, sizeof *s->threshold);
    s->split = tyni_arena_take(&arena, row, sizeof *s->split);
    s->depth = tyni_arena_take(&arena, samples, sizeof *s->depth);
    s->value[0] = tyni_arena_take(&arena, samples, sizeof *s->value[0]);
    s->value[1] = tyni_arena_take(&arena, samples, sizeof *s->value[1]);
    s->value[2] = tyni_arena_take(&arena, samples, sizeof *s->value[2]);
    s->breaks = tyni_arena_take(&arena, words, sizeof *s->breaks);
    s->rays = tyni_arena_take(&arena, words, sizeof *s->rays);
    s->fresh = tyni_arena_take(&arena, words, sizeof *s->fresh);
    s->stats = tyni_arena_take(&arena, 1, sizeof *s->stats);
    return arena.used;
}

/* ---- slices -------------------------------------------------------------------------------------------------------- */

/* Where the ray ends for this light: the surface, or the far side of a spot's cone. 0: no part of it is in the cone. */
static int ray_range(const pass *p, const tyni_sight *v, float s, float *t0, float *t1)
{
    *t0 = 0.0f;
    *t1 = tyni_art_reach(p->frame, s);
    return s > 0.0f && tyni_view_clip(p->lamp, v, t0, t1);
}

/* Visibility of one ray in the kept channels. */
static void ray_value(const pass *p, const tyni_row *row, const tyni_sight *v, float s, float at, tyn_stats *stats,
                      float value[3])
{
    const tyni_medium *medium = &p->medium;
    tyni_integral it;
    float t0, t1, norm[3], light[3] = {0.0f, 0.0f, 0.0f};
    value[0] = value[1] = value[2] = 0.0f;
    stats->rays++;
    if (!ray_range(p, v, s, &t0, &t1))
        return;
    if (p->context->config.rays == TYN_RAYS_STEPS) {
        float all[3];
        tyni_ray_steps(p->lamp, medium, v, t0, t1, p->context->config.steps, all);
        for (int32_t i = 0; i < p->count; i++)
            light[i] = all[p->channels[i]];
    } else {
        tyni_integral_begin(&it, medium, p->lamp, v, t0, t1, p->channels, p->count);
        if (!row || tyni_ray_coarse(row, &it, v)) {
            tyni_ray_walk(p->lamp, &it, v, light);
            stats->walks++;
        } else {
            tyni_ray_row(row, at, p->lamp, &it, v, light);
        }
    }
    tyni_integral_norm(medium, p->lamp, v, t0, t1, norm);
    for (int32_t i = 0; i < p->count; i++) {
        float n = norm[p->channels[i]];
        value[i] = n > 0.0f ? light[i] / n : 0.0f;
    }
    if (p->count == 1)
        value[1] = value[0];
}

/* Where light ends before the surface, depth does: at the far side of a spot's cone (or its slide's light), or at the frame's
 * max_distance. Clamps to it, so that breaks behind the beam cost
 * nothing, and marks samples beside the beam by depth 0. */
static void clamp_to_volume(const pass *p, const tyni_slice *slice, float *depth)
{
    for (int32_t j = slice->first; j <= slice->last; j++) {
        tyni_sight v;
        float length = tyni_slice_sight(slice, &p->view, tyni_slice_p(&p->slices, j), &v), t0, t1;
        depth[j] = ray_range(p, &v, depth[j] * length, &t0, &t1) ? t1 / length : 0.0f;
    }
}

/* How far from the axis origin - light the rays of a line get. */
static float reach_of(const pass *p, const tyni_slice *slice, const float *depth)
{
    float reach = 0.0f;
    for (int32_t j = slice->first; j <= slice->last; j++) {
        tyni_sight v;
        float t = depth[j] * tyni_slice_sight(slice, &p->view, tyni_slice_p(&p->slices, j), &v);
        reach = tyni_maxf(reach, tyni_vec_dot(tyni_vec_sub(tyni_sight_at(&v, t), slice->origin), slice->ex));
    }
    return reach;
}

/* Packs a line's samples; each line has the scale of its largest value. */
static void store_line(const pass *p, int32_t index, int32_t first, int32_t last, const tyni_scratch *s)
{
    uint32_t *entries = p->context->entries + (ptrdiff_t)index * p->field.pitch;
    float *scale = p->context->scales[index], inverse[3], far_inverse = 1.0f / p->view.far_depth;
    int32_t count = tyni_maxi(p->count, 2);
    for (int32_t n = 0; n < count; n++) {
        scale[n] = 0.0f;
        for (int32_t j = first; j <= last; j++)
            scale[n] = tyni_maxf(scale[n], s->value[n][j]);
        inverse[n] = scale[n] > 1e-30f ? 1.0f / scale[n] : 0.0f;
    }
    for (int32_t j = first; j <= last; j++)
        if (s->depth[j] > 0.0f)
            entries[j] = tyni_entry_pack(s->value[0][j], s->value[1][j], inverse, s->depth[j] * far_inverse);
    for (int32_t j = first; j <= last && count == 3; j++)
        p->context->thirds[(ptrdiff_t)index * p->field.pitch + j] = tyni_entry_third(s->value[2][j], inverse[2]);
}

/* The rays of the set bits. */
static void run_rays(const pass *p, const tyni_slice *slice, const uint32_t *rays, const tyni_scratch *s)
{
    for (int32_t j = tyni_sample_next(rays, slice->first, slice->last); j <= slice->last;
         j = tyni_sample_next(rays, j + 1, slice->last)) {
        float at = tyni_slice_p(&p->slices, j), length, value[3];
        tyni_sight v;
        length = tyni_slice_sight(slice, &p->view, at, &v);
        ray_value(p, s->row, &v, s->depth[j] * length, at, s->stats, value);
        s->value[0][j] = value[0];
        s->value[1][j] = value[1];
        s->value[2][j] = value[2];
    }
}

static void slice_job(void *argument, int32_t index, int32_t worker)
{
    const pass *p = argument;
    const tyn_config *config = &p->context->config;
    uint32_t *entries = p->context->entries + (ptrdiff_t)index * p->field.pitch;
    tyni_scratch s;
    tyni_slice slice;
    scratch_of(p->context, worker, &s);
    memset(entries, 0, sizeof *entries * (size_t)p->field.pitch);
    tyni_slice_line(&slice, &p->slices, p->lamp, &p->view, index);
    if (slice.first > slice.last)
        return;
    tyni_sample_depths(s.depth, &p->slices, &slice, &p->view, &p->depth);
    if (tyni_view_bounded(p->lamp) || p->frame->max_distance > 0.0f)
        clamp_to_volume(p, &slice, s.depth);
    s.stats->slices++;
    s.stats->samples += slice.last - slice.first + 1;
    s.stats->breaks += tyni_sample_breaks(s.breaks, s.depth, slice.first, slice.last, config->break_threshold);
    tyni_sample_rays(s.rays, s.breaks, &p->slices, &slice, config->initial_step);
    if (p->frame->debug == TYN_DEBUG_LINES || p->frame->debug == TYN_DEBUG_SAMPLES || p->frame->debug == TYN_DEBUG_BREAKS) {
        tyni_debug_mark(entries, s.rays, s.breaks, slice.first, slice.last);
        return;
    }
    tyni_row_build(s.row, s.threshold, s.split, tyni_row_room(config->shadow_size, config->maps), &p->slices, &slice, p->lamp,
                   &p->view, reach_of(p, &slice, s.depth));
    run_rays(p, &slice, s.rays, &s);
    while (tyni_sample_refine(s.fresh, s.rays, s.breaks, s.value, tyni_maxi(p->count, 2), slice.first, slice.last,
                              config->tolerance))
        run_rays(p, &slice, s.fresh, &s);
    tyni_sample_interpolate(s.value[0], s.rays, slice.first, slice.last);
    tyni_sample_interpolate(s.value[1], s.rays, slice.first, slice.last);
    if (p->count == 3)
        tyni_sample_interpolate(s.value[2], s.rays, slice.first, slice.last);
    store_line(p, index, slice.first, slice.last, &s);
}

/* TYN_METHOD_SUBSAMPLE: a row of the coarse grid. */
static void grid_job(void *argument, int32_t index, int32_t worker)
{
    const pass *p = argument;
    uint32_t *entries = p->context->entries + (ptrdiff_t)index * p->field.pitch;
    int32_t y = tyni_mini(index * p->field.spacing, p->view.height - 1);
    tyni_scratch s;
    scratch_of(p->context, worker, &s);
    memset(entries, 0, sizeof *entries * (size_t)p->field.pitch);
    for (int32_t i = 0; i < p->field.columns; i++) {
        int32_t x = tyni_mini(i * p->field.spacing, p->view.width - 1);
        tyni_sight v;
        float length = tyni_view_sight(&p->view, (float)x + 0.5f, (float)y + 0.5f, &v), value[3], t0, t1;
        s.depth[i] = tyni_view_depth(&p->view, tyni_door_depth(&p->depth, x, y));
        ray_value(p, NULL, &v, s.depth[i] * length, 0.0f, s.stats, value);
        s.depth[i] = ray_range(p, &v, s.depth[i] * length, &t0, &t1) ? t1 / length : 0.0f;
        s.value[0][i] = value[0];
        s.value[1][i] = value[1];
        s.value[2][i] = value[2];
    }
    s.stats->samples += p->field.columns;
    store_line(p, index, 0, p->field.columns - 1, &s);
}

/* ---- pixels -------------------------------------------------------------------------------------------------------- */

/* Visibility of the third channel. It falls about exponentially with extinction where the near air is in shadow. */
static float between(float a, float b, float blend)
{
    float least = tyni_minf(a, b);
    if (least <= 0.0f || tyni_absf(a - b) <= 0.1f * least)
        return a + (b - a) * blend;
    return a * tyni_num_exp(blend * tyni_num_log(b / a));
}

/* Adds a light to `count` pixels from (x, y) on. */
static void add_light(const pass *p, int32_t x, int32_t y, int32_t count, const float *depth, tyn_stats *stats, float *rgb,
                      uint32_t *rejected)
{
    int32_t steps = p->context->config.rays == TYN_RAYS_STEPS ? p->context->config.steps : 0;
    const tyni_medium *m = &p->medium;
    *rejected = 0;
    for (int32_t i = 0; i < count; i++) {
        float px = (float)(x + i) + 0.5f, py = (float)y + 0.5f, t0, t1, length, norm[3], mix[3], value[3], light[3];
        tyni_sight v;
        length = tyni_view_sight(&p->view, px, py, &v);
        if (!ray_range(p, &v, tyni_view_depth(&p->view, depth[i]) * length, &t0, &t1))
            continue;
        if (p->method == TYN_METHOD_EPIPOLAR) {
            float at = t1 / (length * p->view.far_depth);
            *rejected |= (uint32_t)!tyni_gather_slices(&p->field, &p->slices, px, py, at, value) << i;
        } else if (p->method == TYN_METHOD_SUBSAMPLE) {
            tyni_gather_grid(&p->field, px, py, t1 / (length * p->view.far_depth), value);
        }
        if (p->method == TYN_METHOD_MARCH || *rejected >> i & 1u) {
            tyni_ray_pixel(p->lamp, m, &v, t1, steps, light);
            stats->rays += p->method == TYN_METHOD_MARCH;
            for (int32_t c = 0; c < 3; c++)
                rgb[3 * i + c] += light[c];
            continue;
        }
        if (p->count == 3) {
            memcpy(light, value, sizeof light);
        } else {
            light[m->low] = value[0];
            light[m->high] = value[1];
            light[m->middle] = between(value[0], value[1], m->blend);
        }
        tyni_integral_norm(m, p->lamp, &v, t0, t1, norm);
        mix[0] = mix[1] = mix[2] = 1.0f;
        if (p->lamp->kind == TYN_LIGHT_DIRECTIONAL)
            tyni_medium_mix(m, tyni_clampf(tyni_vec_dot(v.d, p->lamp->to_light), -1.0f, 1.0f), mix);
        for (int32_t c = 0; c < 3; c++)
            rgb[3 * i + c] += light[c] * norm[c] * mix[c] * p->lamp->colour[c];
    }
    for (uint32_t bits = *rejected; bits; bits &= bits - 1)
        stats->rejected++;
}

/* L = transmittance * colour + L_scat, into the target's format. */
static void finish(const pass *p, int32_t x, int32_t y, int32_t count, const float *depth, const float *light)
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

static void debug_chunk(const pass *p, int32_t x, int32_t y, int32_t count, const float *depth, uint32_t rejected)
{
    static const tyn_display plain = {1.0f, TYN_TONE_FILM, 0};
    float rgb[3 * CHUNK];
    tyni_composite_read(&p->frame->colour, x, y, count, rgb);
    for (int32_t i = 0; i < count; i++) {
        float exposure = p->frame->display.exposure > 0.0f ? p->frame->display.exposure : 1.0f;
        for (int32_t c = 0; c < 3; c++)
            rgb[3 * i + c] *= 0.5f * exposure;
        tyni_debug_pixel(p->frame->debug, &p->view, p->lamp, &p->slices, &p->field, x + i, y, depth[i],
                         (int)(rejected >> i & 1u), rgb + 3 * i);
    }
    tyni_composite_write(&p->frame->target, &plain, x, y, count, rgb);
}

static void band_job(void *argument, int32_t index, int32_t worker)
{
    const pass *p = argument;
    int32_t end = tyni_mini((index + 1) * BAND, p->view.height);
    tyni_scratch s;
    scratch_of(p->context, worker, &s);
    for (int32_t y = index * BAND; y < end; y++) {
        float *sum = p->context->light ? p->context->light + (ptrdiff_t)y * p->view.width * 3 : NULL;
        for (int32_t x = 0; x < p->view.width; x += CHUNK) {
            int32_t count = tyni_mini(CHUNK, p->view.width - x);
            float light[3 * CHUNK], room[CHUNK];
            const float *depth = tyni_door_row(&p->depth, x, y, count, room);
            uint32_t rejected = 0;
            if (p->first)
                memset(light, 0, sizeof light);
            else
                memcpy(light, sum + 3 * (ptrdiff_t)x, sizeof *light * 3u * (size_t)count);
            if (p->method != TYN_METHOD_NONE)
                add_light(p, x, y, count, depth, s.stats, light, &rejected);
            if (!p->last)
                memcpy(sum + 3 * (ptrdiff_t)x, light, sizeof *light * 3u * (size_t)count);
            else
                finish(p, x, y, count, depth, light);
            if (p->frame->debug && p->frame->target.pixels)
                debug_chunk(p, x, y, count, depth, rejected);
        }
    }
}

/* ---- the frame ----------------------------------------------------------------------------------------------------- */

/* A grid with about as many points as the slices would have initial rays. */
static int32_t grid_layout(pass *p)
{
    const tyn_config *c = &p->context->config;
    tyni_field *f = &p->field;
    float rays = (float)c->slices * ((float)p->context->samples / (float)c->initial_step + 1.0f);
    float pixels = (float)p->view.width * (float)p->view.height;
    for (f->spacing = 1;; f->spacing++) {
        f->columns = (p->view.width - 1 + f->spacing - 1) / f->spacing + 1;
        f->rows = (p->view.height - 1 + f->spacing - 1) / f->spacing + 1;
        if ((float)f->spacing * (float)f->spacing * rays >= pixels && f->columns <= p->context->samples && f->rows <= c->slices)
            return f->rows;
    }
}

static uint64_t now(const tyn_frame *frame)
{
    return frame->clock ? frame->clock(frame->clock_context) : 0;
}

/* White light: the channels of least and largest extinction, or one if they are equal; the third lies between them, well enough
 * unless the air is thick and coloured. Coloured light, and such air where there is room: all. */
static void choose_channels(pass *p)
{
    const tyni_medium *m = &p->medium;
    float apart = (m->sigma[m->high] - m->sigma[m->low]) * p->view.far_depth;
    int all = p->lamp->coloured || (p->context->thirds && apart > 0.5f);
    p->count = all ? 3 : 2;
    if (!all && apart == 0.0f && p->lamp->kind == TYN_LIGHT_DIRECTIONAL)
        p->count = 1;
    p->channels[0] = all ? 0 : m->low;
    p->channels[1] = all ? 1 : m->high;
    p->channels[2] = 2;
    p->field.thirds = all ? p->context->thirds : NULL;
}

static tyn_status render_light(pass *p, const tyni_jobs *jobs, const tyn_light *light, tyn_stats *stats)
{
    tyn_context *c = p->context;
    tyn_status status = TYN_OK;
    uint64_t start = now(p->frame), middle;
    p->method = c->config.method;
    if (!light || !p->medium.scatters || light->scale < 0.0f)
        p->method = TYN_METHOD_NONE;
    if (light) {
        tyni_view_lamp(&c->lamp, light, &p->view);
        tyni_art_lamp(&c->lamp, light, p->frame);
    }
    /* at the light's own position there is no epipole, and a ray stays inside one texel: a ray for each pixel costs nothing */
    if (p->method == TYN_METHOD_EPIPOLAR && p->lamp->no_epipole)
        p->method = TYN_METHOD_MARCH;
    p->field.entries = c->entries;
    p->field.scales = (const float(*)[3])c->scales;
    p->field.pitch = c->samples;
    p->field.threshold = c->config.break_threshold;
    choose_channels(p);
    if (p->method == TYN_METHOD_EPIPOLAR) {
        int32_t stride = tyni_slice_stride(p->view.width, p->view.height, c->samples);
        tyni_slice_layout(&p->slices, p->lamp, p->view.width, p->view.height, c->config.slices, stride);
        status = tyni_jobs_run(jobs, slice_job, p, p->slices.count);
    } else if (p->method == TYN_METHOD_SUBSAMPLE) {
        status = tyni_jobs_run(jobs, grid_job, p, grid_layout(p));
    }
    middle = now(p->frame);
    if (status == TYN_OK)
        status = tyni_jobs_run(jobs, band_job, p, (p->view.height + BAND - 1) / BAND);
    stats->slice_ns += middle - start;
    stats->gather_ns += now(p->frame) - middle;
    return status;
}

static void sum_stats(const tyn_context *c, tyn_stats *stats, int64_t pixels)
{
    for (int32_t w = 0; w < c->config.workers; w++) {
        tyni_scratch s;
        scratch_of(c, w, &s);
        stats->slices += s.stats->slices;
        stats->samples += s.stats->samples;
        stats->breaks += s.stats->breaks;
        stats->rays += s.stats->rays;
        stats->walks += s.stats->walks;
        stats->rejected += s.stats->rejected;
    }
    stats->pixels = pixels;
    stats->rays_percent = 100.0f * (float)(stats->rays + stats->rejected) / (float)pixels;
    stats->memory = c->bytes;
    stats->total_ns = stats->slice_ns + stats->gather_ns;
}

tyn_status tyni_frame_render(tyn_context *context, const tyn_frame *frame)
{
    tyni_jobs jobs;
    tyn_stats stats;
    tyn_status status = TYN_OK;
    pass p;
    /* a debug view shows one light: the first */
    int32_t lights = frame->debug ? 1 : tyni_maxi(frame->light_count, 1);
    memset(&p, 0, sizeof p);
    memset(&stats, 0, sizeof stats);
    jobs.executor = frame->executor;
    jobs.counts = context->counts;
    jobs.workers = frame->executor ? frame->executor->workers : 1;
    for (int32_t w = 0; w < context->config.workers; w++) {
        tyni_scratch s;
        scratch_of(context, w, &s);
        memset(s.stats, 0, sizeof *s.stats);
    }
    p.context = context;
    memset(&context->lamp, 0, sizeof context->lamp);
    p.lamp = &context->lamp;
    p.frame = frame;
    tyni_view_camera(&p.view, &frame->camera, frame->depth.width, frame->depth.height);
    tyni_door_open(&p.depth, &frame->depth, &frame->depth_coding, &frame->camera);
    tyni_medium_prepare(&p.medium, frame->media, frame->medium_count);
    tyni_art_fog(p.fog, p.medium.sigma, frame);
    for (int32_t i = 0; i < lights && status == TYN_OK; i++) {
        p.first = i == 0;
        p.last = i == lights - 1;
        status = render_light(&p, &jobs, frame->light_count ? &frame->lights[i] : NULL, &stats);
    }
    sum_stats(context, &stats, (int64_t)p.view.width * p.view.height);
    if (frame->stats)
        *frame->stats = stats;
    return status;
}

/* ---- memory -------------------------------------------------------------------------------------------------------- */

void tyni_frame_place(tyn_context *c, tyni_arena *arena)
{
    const tyn_config *g = &c->config;
    tyni_scratch s;
    size_t samples;
    c->samples = tyni_mini(g->samples, tyni_maxi(g->width, g->height));
    samples = (size_t)c->samples;
    c->entries = tyni_arena_take(arena, samples * (size_t)g->slices, sizeof *c->entries);
    c->thirds = g->textured ? tyni_arena_take(arena, samples * (size_t)g->slices, sizeof *c->thirds) : NULL;
    c->scales = tyni_arena_take(arena, (size_t)g->slices, sizeof *c->scales);
    c->light = g->lights > 1 ? tyni_arena_take(arena, (size_t)g->width * (size_t)g->height, 3 * sizeof *c->light) : NULL;
    c->counts = tyni_arena_take(arena, (size_t)g->workers, sizeof *c->counts);
    c->scratch = NULL;
    c->scratch_bytes = scratch_of(c, 0, &s);
    c->scratch = tyni_arena_take(arena, (size_t)g->workers, c->scratch_bytes);
    c->bytes = arena->used;
}
