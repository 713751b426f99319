/* trace.c - see trace.h */
#include "trace.h"

#include "base.h"
#include "border.h"
#include "debug.h"
#include "ray.h"
#include "sample.h"
#include "walk.h"

/* ---- slices -------------------------------------------------------------------------------------------------------- */

void tyni_trace_layout(tyni_pass *p)
{
    const tyn_config *c = &p->context->config;
    int32_t width = p->view.width, height = p->view.height, samples = p->context->samples;
    if (!TYNI_HAS(TYN_PART_GATHERS) || c->gather == TYN_GATHER_SHEAR || tyni_prefilter_kept(p->method)) {
        tyni_slice_layout(&p->slices, p->lamp, width, height, c->slices, tyni_slice_stride(width, height, samples));
        return;
    }
    p->slices.spokes = p->context->spokes;
    p->slices.slots = p->context->slots;
    tyni_border_layout(&p->slices, p->lamp, width, height, c->slices, samples, c->gather == TYN_GATHER_IVB);
}

/* Where light ends before the surface, depth does: at the far side of a spot's cone (or its slide's light), or at the frame's
 * max_distance. Clamps to it, so that breaks behind the beam cost nothing, and marks samples beside the beam by depth 0.
 * Returns how many are in it. */
static int32_t clamp_to_volume(const tyni_pass *p, const tyni_slice *slice, float *depth)
{
    int32_t inside = 0;
    for (int32_t j = slice->first; j <= slice->last; j++) {
        tyni_sight v;
        float length = tyni_slice_sight(slice, &p->view, tyni_slice_p(slice, j), &v), t0, t1;
        depth[j] = tyni_pass_range(p, &v, depth[j] * length, &t0, &t1) ? t1 / length : 0.0f;
        inside += depth[j] > 0.0f;
    }
    return inside;
}

/* One ray against the row; a walk over the map where its columns are too coarse. */
static void row_value(const tyni_pass *p, const tyni_finder *finder, const tyni_sight *v, float s, float at, tyn_stats *stats,
                      float value[3])
{
    float t0, t1, norm[3], light[3] = {0.0f, 0.0f, 0.0f};
    tyni_integral it;
    value[0] = value[1] = value[2] = 0.0f;
    if (!tyni_pass_range(p, v, s, &t0, &t1))
        return;
    tyni_integral_begin(&it, &p->medium, p->lamp, v, t0, t1, p->channels, p->count);
    if (tyni_ray_coarse(finder, &it, v)) {
        tyni_walk_ray(p->context->config.isa, p->lamp, &it, v, 1, light);
        stats->walks++;
    } else {
        stats->looked += tyni_ray_row(finder, at, p->lamp, &it, v, light);
    }
    tyni_integral_norm(&p->medium, p->lamp, v, t0, t1, norm);
    tyni_pass_visible(p, light, norm, value);
}

/* Visibility of a ray from the slice's prefiltered rows; 0: they do not know it. */
static int shelf_value(const tyni_pass *p, const tyni_shelf *shelf, const tyni_sight *v, float s, float at, float value[3])
{
    float t0, t1, all[3], exact[3], norm[3];
    value[0] = value[1] = value[2] = 0.0f;
    if (!tyni_pass_range(p, v, s, &t0, &t1))
        return 1;
    if (!tyni_prefilter_ray(&p->fourier, shelf, at, v, t0, t1, all))
        return 0;
    tyni_prefilter_light(&p->fourier, v, t0, t1, exact);
    tyni_integral_norm(&p->medium, p->lamp, v, t0, t1, norm);
    for (int32_t c = 0; c < 3; c++)
        exact[c] *= all[c];
    for (int32_t i = 0; i < p->count; i++)
        all[i] = exact[p->channels[i]];
    tyni_pass_visible(p, all, norm, value);
    return 1;
}

/* The rays of the set bits, one at a time. */
static void run_each(const tyni_pass *p, const tyni_slice *slice, const tyni_finder *finder, const uint32_t *rays,
                     tyni_scratch *s)
{
    for (int32_t j = tyni_sample_next(rays, slice->first, slice->last); j <= slice->last;
         j = tyni_sample_next(rays, j + 1, slice->last)) {
        float at = tyni_slice_p(slice, j), length, value[3];
        tyni_sight v;
        length = tyni_slice_sight(slice, &p->view, at, &v);
        if (tyni_ray_way(finder->rays, TYN_RAYS_SWEEP))
            tyni_sweep_to(&s->sweep, j);
        if (tyni_ray_way(finder->rays, TYN_RAYS_STEPS) && !tyni_prefilter_hybrid(p->method))
            tyni_pass_walk(p, &v, s->depth[j] * length, value);
        else if (!tyni_prefilter_hybrid(p->method) || !shelf_value(p, s->shelf, &v, s->depth[j] * length, at, value))
            row_value(p, finder, &v, s->depth[j] * length, at, s->stats, value);
        s->stats->rays++;
        s->value[0][j] = value[0];
        s->value[1][j] = value[1];
        s->value[2][j] = value[2];
    }
}

/* The rays of a bundle's samples: their visibility. */
static void run_bundle(const tyni_pass *p, const tyni_slice *slice, const tyni_finder *finder, tyni_scratch *s)
{
    tyni_bundle *b = s->bundle;
    float sigma[2];
    sigma[0] = p->medium.sigma[p->channels[0]];
    sigma[1] = p->medium.sigma[p->channels[p->count - 1]];
    s->stats->rays += b->count;
    s->stats->looked += tyni_ray_bundle(b, finder, slice, &p->view, s->depth, p->frame->max_distance, p->lamp, sigma);
    s->stats->walks += tyni_ones32(b->coarse & ((2u << (b->count - 1)) - 1u));
    for (int32_t n = 0; n < b->count; n++) {
        s->value[0][b->sample[n]] = b->visible[0][n];
        s->value[1][b->sample[n]] = b->visible[1][n];
    }
}

/* The rays of the set bits, side by side. */
static void run_bundles(const tyni_pass *p, const tyni_slice *slice, const tyni_finder *finder, const uint32_t *rays,
                        tyni_scratch *s)
{
    tyni_bundle *b = s->bundle;
    b->count = 0;
    for (int32_t w = slice->first >> 5; w <= slice->last >> 5; w++)
        for (uint32_t bits = rays[w]; bits; bits &= bits - 1) {
            b->sample[b->count++] = (uint16_t)(32 * w + tyni_ctz32(bits));
            if (b->count == TYNI_RAY_BUNDLE) {
                run_bundle(p, slice, finder, s);
                b->count = 0;
            }
        }
    if (b->count)
        run_bundle(p, slice, finder, s);
}

static void run_rays(const tyni_pass *p, const tyni_slice *slice, const tyni_finder *finder, const uint32_t *rays,
                     tyni_scratch *s)
{
    int plain = tyni_view_kind(p->lamp) == TYN_LIGHT_DIRECTIONAL && !tyni_view_coloured(p->lamp) && p->lamp->lift == 0.0f &&
                p->count < 3;
    if (plain && !tyni_ray_way(finder->rays, TYN_RAYS_STEPS) && !tyni_prefilter_hybrid(p->method))
        run_bundles(p, slice, finder, rays, s);
    else
        run_each(p, slice, finder, rays, s);
}

/* The row and what the finder needs of it. */
static void build_row(const tyni_pass *p, const tyni_slice *slice, tyni_scratch *s, tyni_finder *finder, tyni_tree *tree)
{
    const tyn_config *config = &p->context->config;
    finder->row = s->row;
    finder->isa = config->isa;
    finder->rays = config->rays;
    finder->blocks = &s->blocks;
    finder->tree = tree;
    finder->sweep = &s->sweep;
    finder->coarse = p->quads ? 0.2f : 0.05f; /* where pixels are about right, so may rays be */
    if (tyni_ray_way(config->rays, TYN_RAYS_STEPS) && !tyni_prefilter_method(p->method))
        return;
    tyni_row_build(s->row, config->isa, s->threshold, s->edge, tyni_row_room(config->shadow_size, config->maps), slice, p->lamp,
                   &p->view, tyni_sample_reach(s->depth, config->isa, slice, &p->view));
    s->stats->columns += s->row->columns;
    if (config->rays == TYN_RAYS_WORDS)
        tyni_row_bound(&s->blocks, config->isa, s->row);
    if (tyni_ray_way(config->rays, TYN_RAYS_TREE))
        tyni_tree_build(tree, s->nodes, s->row);
    if (tyni_ray_way(config->rays, TYN_RAYS_SWEEP))
        tyni_sweep_begin(&s->sweep, s->row, slice);
}

/* Depth, breaks, initial rays; 0 if there is nothing to do. */
static int32_t sample_line(const tyni_pass *p, tyni_slice *slice, int32_t index, tyni_scratch *s)
{
    const tyn_config *config = &p->context->config;
    tyni_pass_line(p, slice, index);
    if (slice->first > slice->last)
        return 0;
    tyni_sample_depths(s->depth, config->isa, slice, &p->view, &p->depth);
    if ((tyni_view_bounded(p->lamp) || p->frame->max_distance > 0.0f) && !clamp_to_volume(p, slice, s->depth))
        return 0;
    s->stats->samples += slice->last - slice->first + 1;
    s->stats->breaks +=
        tyni_sample_breaks(s->breaks, config->isa, s->depth, slice->first, slice->last, config->break_threshold);
    if (tyni_view_kind(p->lamp) != TYN_LIGHT_DIRECTIONAL)
        s->stats->breaks +=
            tyni_sample_breaks_at(s->breaks, s->depth, slice, &p->view, p->lamp->position, config->break_threshold);
    return tyni_sample_rays(s->rays, s->breaks, slice, config->initial_step);
}

int tyni_trace_row(const tyni_pass *p, int32_t index, tyni_slice *slice, tyni_scratch *s, tyni_finder *finder, tyni_tree *tree)
{
    if (tyni_ray_way(p->context->config.rays, TYN_RAYS_STEPS) || !sample_line(p, slice, index, s))
        return 0;
    build_row(p, slice, s, finder, tree);
    return 1;
}

void tyni_trace_shelf(void *argument, int32_t index, int32_t worker)
{
    const tyni_pass *p = argument;
    tyni_shelf *shelf = (void *)(p->context->shelves + (size_t)index * p->context->shelf_bytes);
    uint64_t time[4];
    tyni_scratch s;
    tyni_slice slice;
    tyni_finder finder;
    tyni_tree tree;
    tyni_pass_scratch(p->context, worker, &s);
    time[0] = tyni_pass_now(p);
    shelf->valid = 0;
    if (!sample_line(p, &slice, index, &s)) {
        s.stats->culled++;
        return;
    }
    s.stats->slices++;
    time[1] = tyni_pass_now(p);
    build_row(p, &slice, &s, &finder, &tree);
    time[2] = tyni_pass_now(p);
    tyni_prefilter_slice(&p->fourier, shelf, s.mill, s.row, &slice, &p->view, s.depth);
    time[3] = tyni_pass_now(p);
    s.stats->sample_ns += time[1] - time[0];
    s.stats->row_ns += time[2] - time[1];
    s.stats->line_ns += time[3] - time[2];
}

void tyni_trace_slice(void *argument, int32_t index, int32_t worker)
{
    const tyni_pass *p = argument;
    const tyn_config *config = &p->context->config;
    /* down to single samples leaves cost 0.4 ms of 22 more (1920x1080), for 0.01 to 0.06 dB: only where much is asked for */
    const int32_t least = config->tolerance < 0.01f ? 1 : tyni_maxi(config->initial_step / 8, 1);
    uint64_t time[5];
    tyni_scratch s;
    tyni_slice slice;
    tyni_finder finder;
    tyni_tree tree;
    int32_t initial;
    tyni_pass_scratch(p->context, worker, &s);
    time[0] = tyni_pass_now(p);
    tyni_pass_clear(&p->lines, index);
    initial = sample_line(p, &slice, index, &s);
    time[1] = tyni_pass_now(p);
    s.stats->sample_ns += time[1] - time[0];
    if (!initial) {
        s.stats->culled++;
        return;
    }
    s.stats->slices++;
    s.stats->initial += initial;
    build_row(p, &slice, &s, &finder, &tree);
    if (tyni_prefilter_hybrid(p->method))
        tyni_prefilter_slice(&p->fourier, s.shelf, s.mill, s.row, &slice, &p->view, s.depth);
    time[2] = tyni_pass_now(p);
    if (tyni_debug_marks(p->frame->debug))
        tyni_debug_mark_initial(p, index, &slice, s.rays, s.breaks);
    memset(s.bundle, 0, sizeof *s.bundle);
    run_rays(p, &slice, &finder, s.rays, &s);
    memcpy(s.fresh, s.rays, sizeof *s.fresh * (size_t)tyni_sample_words(slice.last + 1));
    while (config->tolerance < 1.0f &&
           tyni_sample_refine(s.fresh, s.rays, s.breaks, config->isa, s.value, tyni_maxi(p->count, 2), slice.first, slice.last,
                              config->tolerance, least))
        run_rays(p, &slice, &finder, s.fresh, &s);
    time[3] = tyni_pass_now(p);
    if (tyni_debug_marks(p->frame->debug)) {
        tyni_debug_mark_sources(p, index, &slice, s.rays);
    } else {
        tyni_sample_interpolate(s.value, tyni_maxi(p->count, 2), config->isa, s.rays, slice.first, slice.last);
        tyni_pass_store(p, &p->lines, index, slice.first, slice.last, &s);
    }
    time[4] = tyni_pass_now(p);
    s.stats->row_ns += time[2] - time[1];
    s.stats->ray_ns += time[3] - time[2];
    s.stats->line_ns += time[4] - time[3];
}

/* ---- grids --------------------------------------------------------------------------------------------------------- */

/* Points 0 .. count - 1 from the first pixel's centre to the last's. */
static float even(int32_t pixels, int32_t count)
{
    return count > 1 ? (float)(pixels - 1) / (float)(count - 1) : 0.0f;
}

void tyni_trace_spread(tyni_pass *p)
{
    const tyn_config *c = &p->context->config;
    int32_t width = p->view.width, height = p->view.height, most = tyni_mini(width, p->context->samples);
    float rays = c->budget ? (float)c->budget : (float)c->slices * ((float)p->context->samples / (float)c->initial_step + 1.0f);
    float columns;
    rays = tyni_minf(tyni_minf(rays, (float)width * (float)height), (float)c->slices * (float)p->context->samples);
    columns = sqrtf(rays * (float)width / (float)height);
    p->grid.field = p->lines;
    p->grid.columns = tyni_clampi((int32_t)(columns + 0.5f), tyni_mini(width, 2), most);
    p->grid.rows = tyni_clampi((int32_t)(rays / (float)p->grid.columns + 0.5f), 1, tyni_mini(height, c->slices));
    p->grid.step_x = even(width, p->grid.columns);
    p->grid.step_y = even(height, p->grid.rows);
    p->naive = 1;
}

void tyni_trace_coarse(tyni_pass *p)
{
    int32_t f = p->context->config.downscale;
    p->grid.field = p->context->grid;
    p->grid.field.threshold = p->lines.threshold;
    p->grid.columns = tyni_slice_points(p->view.width, f);
    p->grid.rows = tyni_slice_points(p->view.height, f);
    p->grid.step_x = p->grid.step_y = (float)f;
}

/* One point: from the slices, or by a ray. Returns its depth, or that of the end of the light's volume before it. */
static float point_value(const tyni_pass *p, float px, float py, tyn_stats *stats, uint64_t *correct_ns, float value[3])
{
    int32_t x = tyni_mini((int32_t)px, p->view.width - 1), y = tyni_mini((int32_t)py, p->view.height - 1);
    float length, depth = tyni_view_depth(&p->view, tyni_door_depth(&p->depth, x, y)), t0, t1, at, threshold;
    uint64_t start;
    tyni_sight v;
    length = tyni_view_sight(&p->view, px, py, &v);
    value[0] = value[1] = value[2] = 0.0f;
    if (!tyni_pass_range(p, &v, depth * length, &t0, &t1)) {
        stats->rays += !tyni_pass_sliced(p);
        return 0.0f;
    }
    if (!tyni_pass_sliced(p)) {
        tyni_pass_walk(p, &v, depth * length, value);
        stats->rays++;
        return t1 / length;
    }
    at = t1 / (length * p->view.far_depth);
    threshold = tyni_gather_threshold(p->lines.threshold, &p->view, p->lamp, px, py, at);
    if (!tyni_gather_lines(&p->gather, &p->lines, &p->slices, px, py, at, threshold, value)) {
        start = tyni_pass_now(p);
        tyni_pass_walk(p, &v, depth * length, value);
        *correct_ns += tyni_pass_now(p) - start;
        stats->rejected++;
    }
    return t1 / length;
}

void tyni_trace_grid(void *argument, int32_t index, int32_t worker)
{
    const tyni_pass *p = argument;
    const tyni_grid *g = &p->grid;
    uint64_t start, correct_ns = 0, *stage;
    tyni_scratch s;
    tyni_pass_scratch(p->context, worker, &s);
    start = tyni_pass_now(p);
    tyni_pass_clear(&g->field, index);
    for (int32_t i = 0; i < g->columns; i++) {
        float value[3];
        s.depth[i] = point_value(p, (float)i * g->step_x + 0.5f, (float)index * g->step_y + 0.5f, s.stats, &correct_ns, value);
        s.value[0][i] = value[0];
        s.value[1][i] = value[1];
        s.value[2][i] = value[2];
    }
    if (!tyni_pass_sliced(p))
        s.stats->samples += g->columns;
    tyni_pass_store(p, &g->field, index, 0, g->columns - 1, &s);
    stage = tyni_pass_sliced(p) ? &s.stats->unwarp_ns : &s.stats->ray_ns;
    *stage += tyni_pass_now(p) - start - correct_ns;
    s.stats->correct_ns += correct_ns;
}
