/* pass.c - see pass.h */
#include "pass.h"

#include "arena.h"
#include "art.h"
#include "base.h"
#include "border.h"
#include "entry.h"
#include "lanes/lanes.h"
#include "sample.h"
#include "walk.h"

int32_t tyni_pass_run(const tyn_context *c)
{
    return tyni_mini(((c->samples + 1) / 2 + 15) / 16 * 16, TYNI_PASS_RUN);
}

size_t tyni_pass_scratch(const tyn_context *c, int32_t worker, tyni_scratch *s)
{
    tyni_arena arena = {NULL, 0, 0};
    size_t samples = (size_t)c->samples, points = (size_t)c->points, words = (size_t)tyni_sample_words(c->samples);
    size_t columns = 2 * tyni_row_room(c->config.shadow_size, c->config.maps), run = (size_t)tyni_pass_run(c);
    arena.block = c->scratch ? c->scratch + c->scratch_bytes * (size_t)worker : NULL;
    memset(s, 0, sizeof *s);
    s->row = tyni_arena_take(&arena, 1, TYN_ROW_BYTES);
    s->threshold = tyni_arena_take(&arena, columns, sizeof *s->threshold);
    s->edge = tyni_arena_take(&arena, columns, sizeof *s->edge);
    s->blocks.low = tyni_arena_take(&arena, tyni_row_blocks(columns), 2 * sizeof *s->blocks.low);
    s->blocks.high = s->blocks.low ? s->blocks.low + tyni_row_blocks(columns) : NULL;
    s->depth = tyni_arena_take(&arena, points, sizeof *s->depth);
    for (int32_t i = 0; i < 3; i++)
        s->value[i] = tyni_arena_take(&arena, points, sizeof *s->value[i]);
    s->bundle = tyni_arena_take(&arena, 1, TYN_BUNDLE_BYTES + TYNI_PLANES(run * sizeof *s->plane[0]));
    for (size_t i = 0; i < TYNI_PASS_PLANES && s->bundle; i++)
        s->plane[i] = (float *)(void *)((uint8_t *)s->bundle + TYN_BUNDLE_BYTES) + i * run;
    s->breaks = tyni_arena_take(&arena, words, sizeof *s->breaks);
    s->rays = tyni_arena_take(&arena, words, sizeof *s->rays);
    s->fresh = tyni_arena_take(&arena, words, sizeof *s->fresh);
    s->stats = tyni_arena_take(&arena, 1, TYN_STATS_BYTES);
    if (tyni_prefilter_hybrid(c->config.method))
        s->shelf = tyni_arena_take(&arena, 1, tyni_prefilter_bytes(&c->config));
    if (tyni_prefilter_method(c->config.method))
        s->mill = tyni_arena_take(&arena, 1, tyni_prefilter_scratch(&c->config));
    if (tyni_ray_way(c->config.rays, TYN_RAYS_TREE))
        s->nodes = tyni_arena_take(&arena, tyni_tree_room(columns), sizeof *s->nodes);
    if (tyni_ray_way(c->config.rays, TYN_RAYS_SWEEP)) {
        s->sweep.order = tyni_arena_take(&arena, columns, sizeof *s->sweep.order);
        s->sweep.bits = tyni_arena_take(&arena, tyni_sweep_words(columns), sizeof *s->sweep.bits);
        s->sweep.heads = tyni_arena_take(&arena, samples + 1, sizeof *s->sweep.heads);
        s->sweep.position = tyni_arena_take(&arena, samples, sizeof *s->sweep.position);
    }
    return arena.used;
}

uint64_t tyni_pass_now(const tyni_pass *p)
{
    return p->frame->clock ? p->frame->clock(p->frame->clock_context) : 0;
}

void tyni_pass_line(const tyni_pass *p, tyni_slice *slice, int32_t index)
{
    if (tyni_slice_bordered(&p->slices))
        tyni_border_line(slice, &p->slices, p->lamp, &p->view, index);
    else
        tyni_slice_line(slice, &p->slices, p->lamp, &p->view, index);
}

static int nearest_slice(const tyni_pass *p, float x, float y, int32_t *index)
{
    const tyni_sector *sector;
    int32_t slot[2];
    float k;
    if (!p->slices.count)
        return 0;
    if (tyni_slice_bordered(&p->slices)) {
        if (!tyni_border_find(&p->slices, x, y, slot, &k))
            return 0;
        *index = tyni_border_slice(&p->slices, slot[k > 0.5f]);
        return *index >= 0;
    }
    sector = tyni_slice_find(&p->slices, x, y, &k);
    *index = sector->start + (int32_t)(k + 0.5f);
    return sector->count > 0;
}

int tyni_pass_nearest(const tyni_pass *p, float x, float y, int32_t *index, int32_t *sample, float *distance)
{
    tyni_slice s;
    float at, m, end = (float)(p->slices.samples - 1);
    if (!nearest_slice(p, x, y, index))
        return 0;
    tyni_pass_line(p, &s, *index);
    at = s.along_y ? y : x;
    m = s.along_y ? x : y;
    *distance = tyni_absf(m - (s.m0 + s.slope * at)) / sqrtf(1.0f + s.slope * s.slope);
    /* nearest along the line: move to the foot of the perpendicular */
    if (tyni_slice_bordered(&p->slices))
        at += s.slope * (m - (s.m0 + s.slope * at)) / (1.0f + s.slope * s.slope);
    *sample = (int32_t)(tyni_clampf((at - s.p0) / s.dp, 0.0f, end) + 0.5f);
    return 1;
}

int tyni_pass_range(const tyni_pass *p, const tyni_sight *v, float s, float *t0, float *t1)
{
    *t0 = 0.0f;
    *t1 = tyni_art_reach(p->frame, s);
    return s > 0.0f && tyni_view_clip(p->lamp, v, t0, t1);
}

/* A function of its own: its table takes stack that steps need. */
static TYNI_NOINLINE void walk_exactly(const tyni_pass *p, const tyni_sight *v, float t0, float t1, float light[3])
{
    tyni_integral it;
    tyni_integral_begin(&it, &p->medium, p->lamp, v, t0, t1, p->channels, p->count);
    tyni_walk_ray(p->context->config.isa, p->lamp, &it, v, 1, light);
}

void tyni_pass_walk(const tyni_pass *p, const tyni_sight *v, float s, float value[3])
{
    const tyn_config *config = &p->context->config;
    float t0, t1, norm[3], light[3] = {0.0f, 0.0f, 0.0f}, all[3];
    value[0] = value[1] = value[2] = 0.0f;
    if (!tyni_pass_range(p, v, s, &t0, &t1))
        return;
    if (tyni_ray_way(config->rays, TYN_RAYS_STEPS)) {
        tyni_walk_steps(config->isa, p->lamp, &p->medium, v, t0, t1, config->steps, all);
        for (int32_t i = 0; i < p->count; i++)
            light[i] = all[p->channels[i]];
    } else {
        walk_exactly(p, v, t0, t1, light);
    }
    tyni_integral_norm(&p->medium, p->lamp, v, t0, t1, norm);
    tyni_pass_visible(p, light, norm, value);
}

void tyni_pass_visible(const tyni_pass *p, const float light[3], const float norm[3], float value[3])
{
    for (int32_t i = 0; i < p->count; i++) {
        float n = norm[p->channels[i]];
        value[i] = n > 0.0f ? light[i] / n : 0.0f;
    }
    if (p->count == 1)
        value[1] = value[0];
}

#define TYNI_KERNEL "pass_kernel.h"
#include "lanes/each.h"

void tyni_pass_clear(const tyni_field *field, int32_t line)
{
    memset(field->entries + (ptrdiff_t)line * field->pitch, 0, sizeof *field->entries * (size_t)field->pitch);
    /* also those of lines that nothing is stored in: a weight of 0 takes no infinity or NaN */
    for (int32_t n = 0; n < 3; n++)
        field->scales[n][line] = 0.0f;
}

void tyni_pass_store(const tyni_pass *p, const tyni_field *field, int32_t line, int32_t first, int32_t last,
                     const tyni_scratch *s)
{
    uint32_t *entries = field->entries + (ptrdiff_t)line * field->pitch;
    float inverse[3];
    int32_t count = tyni_maxi(p->count, 2), isa = p->context->config.isa;
    for (int32_t n = 0; n < count; n++) {
        float *scale = &field->scales[n][line];
        if (p->quads)
            *scale = 1.0f;
        else
            TYNI_LANES_CALL(isa, pass_largest, (s->value[n], first, last, scale));
        inverse[n] = *scale > 1e-30f ? 1.0f / *scale : 0.0f;
    }
    TYNI_LANES_CALL(isa, pass_pack, (entries, s, first, last, inverse, 1.0f / p->view.far_depth));
    for (int32_t j = first; j <= last && count == 3; j++)
        field->thirds[(ptrdiff_t)line * field->pitch + j] = tyni_entry_third(s->value[2][j], inverse[2]);
}
