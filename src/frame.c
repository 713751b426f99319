/* frame.c - see frame.h. Data flows from top to bottom:
 *
 *   for each light:  lay out its slices
 *       slice jobs (trace.c):  depth along the line -> break bits -> ray samples -> row of thresholds -> visibility at the rays
 *                              -> interpolation -> the finished line into memory
 *       grid jobs (trace.c):   only with downscale or sub-sampling: the points of a coarse picture, from the lines or by rays
 *       pixel jobs (pixel.c):  the two nearest lines (or four points) -> visibility (unwarp.c) -> light; rejected pixels by
 * rays of their own; after the last light transmittance, colour, exposure, tone, dither, format. The usual picture goes from
 * visibility to the end at once (picture.c); quad.c has those of handhelds, four at a time */
#include "frame.h"

#include "art.h"
#include "base.h"
#include "chart.h"
#include "pixel.h"
#include "quad.h"
#include "trace.h"

/* White light: the channels of least and largest extinction, or one if they are equal; the third lies between them, well enough
 * unless the air is thick and coloured. Coloured light, and such air where there is room: all. */
static void choose_channels(tyni_pass *p)
{
    const tyni_medium *m = &p->medium;
    float apart = (m->sigma[m->high] - m->sigma[m->low]) * p->view.far_depth;
    int all = tyni_view_coloured(p->lamp) || tyni_prefilter_kept(p->method) || (p->context->lines.thirds && apart > 0.5f);
    p->count = all ? 3 : 2;
    if (!all && apart == 0.0f && tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL)
        p->count = 1;
    p->channels[0] = all ? 0 : m->low;
    p->channels[1] = all ? 1 : m->high;
    p->channels[2] = 2;
    if (!all)
        p->lines.thirds = p->grid.field.thirds = NULL;
}

static void begin_light(tyni_pass *p, const tyn_light *light)
{
    tyn_context *c = p->context;
    p->method = c->config.method;
    if (!light || !p->medium.scatters || light->scale < 0.0f)
        p->method = TYN_METHOD_NONE;
    if (light) {
        tyni_view_lamp(&c->lamp, light, &p->view);
        tyni_art_lamp(&c->lamp, light, p->frame);
    }
    /* at the light's own position there is no epipole, and a ray stays inside one texel: a ray for each pixel costs nothing */
    if (tyni_prefilter_method(p->method) && p->view.orthographic)
        p->method = tyni_prefilter_hybrid(p->method) ? TYN_METHOD_EPIPOLAR : TYN_METHOD_MARCH;
    if ((p->method == TYN_METHOD_EPIPOLAR || tyni_prefilter_method(p->method)) && p->lamp->no_epipole)
        p->method = TYN_METHOD_MARCH;
    if (tyni_prefilter_method(p->method))
        tyni_prefilter_begin(&p->fourier, &c->config, p->lamp, &p->medium, &p->view);
    p->lines = c->lines;
    p->lines.threshold = c->config.break_threshold;
    p->gather.way = c->config.gather;
    p->gather.kernel = c->config.kernel;
    p->gather.taps = c->config.taps;
    memset(&p->slices, 0, sizeof p->slices);
    memset(&p->grid, 0, sizeof p->grid);
    p->naive = 0;
    if (TYNI_HAS(TYN_PART_GATHERS) && p->method == TYN_METHOD_SUBSAMPLE)
        tyni_trace_spread(p);
    else if (TYNI_HAS(TYN_PART_GATHERS) && p->method != TYN_METHOD_NONE && !tyni_prefilter_kept(c->config.method) &&
             c->config.downscale > 1)
        tyni_trace_coarse(p);
    choose_channels(p);
    p->quads = 0;
}

static tyn_status render_light(tyni_pass *p, const tyni_jobs *jobs, const tyn_light *light, tyn_stats *stats)
{
    tyn_status status = TYN_OK;
    uint64_t start = tyni_pass_now(p), middle;
    begin_light(p, light);
    if (tyni_prefilter_kept(p->method) || tyni_pass_sliced(p)) {
        tyni_trace_layout(p);
        p->quads = tyni_quad_takes(p);
        status = tyni_jobs_run(jobs, tyni_prefilter_kept(p->method) ? tyni_trace_shelf : tyni_trace_slice, p, p->slices.count);
    }
    middle = tyni_pass_now(p);
    if (status == TYN_OK && tyni_pass_gridded(p))
        status = tyni_jobs_run(jobs, tyni_trace_grid, p, p->grid.rows);
    if (TYNI_HAS(TYN_PART_QUADS) && p->quads)
        tyni_quad_begin(p);
    if (status == TYN_OK)
        status = tyni_jobs_run(jobs, TYNI_HAS(TYN_PART_QUADS) && p->quads ? tyni_quad_band : tyni_pixel_band, p,
                               (p->view.height + TYNI_PIXEL_BAND - 1) / TYNI_PIXEL_BAND);
    if (TYNI_HAS(TYN_PART_DEBUG) && status == TYN_OK && (p->frame->debug == TYN_DEBUG_ROW || p->frame->debug == TYN_DEBUG_TREE))
        tyni_chart_draw(p);
    stats->slice_ns += middle - start;
    stats->gather_ns += tyni_pass_now(p) - middle;
    return status;
}

/* ---- statistics ---------------------------------------------------------------------------------------------------- */

static void add_stats(tyn_stats *sum, const tyn_stats *s)
{
    sum->slices += s->slices;
    sum->culled += s->culled;
    sum->samples += s->samples;
    sum->breaks += s->breaks;
    sum->initial += s->initial;
    sum->rays += s->rays;
    sum->walks += s->walks;
    sum->columns += s->columns;
    sum->looked += s->looked;
    sum->rejected += s->rejected;
    sum->corrected += s->corrected;
    sum->sample_ns += s->sample_ns;
    sum->row_ns += s->row_ns;
    sum->ray_ns += s->ray_ns;
    sum->line_ns += s->line_ns;
    sum->unwarp_ns += s->unwarp_ns;
    sum->correct_ns += s->correct_ns;
    sum->upscale_ns += s->upscale_ns;
    sum->composite_ns += s->composite_ns;
}

static TYNI_NOINLINE void sum_stats(const tyn_context *c, tyn_stats *stats, int64_t pixels)
{
    for (int32_t w = 0; w < c->config.workers; w++) {
        tyni_scratch s;
        tyni_pass_scratch(c, w, &s);
        add_stats(stats, s.stats);
    }
    stats->pixels = pixels;
    stats->rays_percent = 100.0f * (float)(stats->rays + stats->rejected + stats->corrected) / (float)pixels;
    stats->looked_per_ray = stats->rays > stats->walks ? (float)stats->looked / (float)(stats->rays - stats->walks) : 0.0f;
    stats->memory = c->bytes;
    stats->total_ns = stats->slice_ns + stats->gather_ns;
}

/* ---- the frame ----------------------------------------------------------------------------------------------------- */

static TYNI_NOINLINE void begin_frame(tyni_pass *p, tyn_context *context, const tyn_frame *frame)
{
    for (int32_t w = 0; w < context->config.workers; w++) {
        tyni_scratch s;
        tyni_pass_scratch(context, w, &s);
        memset(s.stats, 0, sizeof *s.stats);
        memset(s.row, 0, sizeof *s.row);
    }
    memset(p, 0, sizeof *p);
    memset(&context->lamp, 0, sizeof context->lamp);
    p->context = context;
    p->lamp = &context->lamp;
    p->frame = frame;
    tyni_view_camera(&p->view, &frame->camera, frame->depth.width, frame->depth.height);
    tyni_door_open(&p->depth, &frame->depth, &frame->depth_coding, &frame->camera);
    tyni_medium_prepare(&p->medium, frame->media, frame->medium_count);
    tyni_art_fog(p->fog, p->medium.sigma, frame);
}

tyn_status tyni_frame_render(tyn_context *context, const tyn_frame *frame)
{
    tyni_pass *p = &context->pass;
    tyni_jobs jobs;
    tyn_stats stats;
    tyn_status status = TYN_OK;
    /* a debug view shows one light: the first */
    int32_t lights = frame->debug ? 1 : tyni_maxi(frame->light_count, 1);
    memset(&stats, 0, sizeof stats);
    jobs.executor = frame->executor;
    jobs.counts = context->counts;
    jobs.workers = frame->executor ? frame->executor->workers : 1;
    begin_frame(p, context, frame);
    for (int32_t i = 0; i < lights && status == TYN_OK; i++) {
        p->first = i == 0;
        p->last = i == lights - 1;
        status = render_light(p, &jobs, frame->light_count ? &frame->lights[i] : NULL, &stats);
    }
    sum_stats(context, &stats, (int64_t)p->view.width * p->view.height);
    if (frame->stats)
        *frame->stats = stats;
    return status;
}

/* ---- memory -------------------------------------------------------------------------------------------------------- */

static void place_field(tyni_field *field, tyni_arena *arena, size_t lines, size_t pitch, int textured)
{
    field->pitch = (int32_t)pitch;
    /* followed by the scales: a vector may be read behind the last line */
    field->entries = tyni_arena_take(arena, lines * pitch, sizeof *field->entries);
    field->thirds = textured ? tyni_arena_take(arena, lines * pitch, sizeof *field->thirds) : NULL;
    for (int32_t i = 0; i < 3; i++)
        field->scales[i] = tyni_arena_take(arena, lines + 16, sizeof *field->scales[i]); /* a vector from any line on */
}

void tyni_frame_place(tyn_context *c, tyni_arena *arena)
{
    const tyn_config *g = &c->config;
    int32_t longer = tyni_maxi(g->width, g->height);
    tyni_scratch s;
    c->samples = c->points = tyni_mini(g->samples, longer);
    /* a row of the coarse picture goes through the scratch of a line */
    if (g->downscale > 1 && !tyni_prefilter_kept(g->method)) {
        c->points = tyni_maxi(c->samples, tyni_slice_points(g->width, g->downscale));
        place_field(&c->grid, arena, (size_t)tyni_slice_points(g->height, g->downscale),
                    (size_t)tyni_slice_points(g->width, g->downscale), g->textured);
    }
    if (tyni_prefilter_kept(g->method)) {
        c->shelf_bytes = tyni_prefilter_bytes(g);
        c->shelves = tyni_arena_take(arena, (size_t)g->slices, c->shelf_bytes);
    } else {
        place_field(&c->lines, arena, (size_t)g->slices, (size_t)c->samples, g->textured);
    }
    if (g->gather != TYN_GATHER_SHEAR && !tyni_prefilter_kept(g->method)) {
        c->spokes = tyni_arena_take(arena, (size_t)g->slices, sizeof *c->spokes);
        c->slots = tyni_arena_take(arena, (size_t)g->slices, sizeof *c->slots);
    }
    c->light = g->lights > 1 ? tyni_arena_take(arena, (size_t)g->width * (size_t)g->height, 3 * sizeof *c->light) : NULL;
    c->counts = tyni_arena_take(arena, (size_t)g->workers, sizeof *c->counts);
    c->scratch = NULL;
    c->scratch_bytes = tyni_pass_scratch(c, 0, &s);
    c->scratch = tyni_arena_take(arena, (size_t)g->workers, c->scratch_bytes);
    c->bytes = arena->used;
}
