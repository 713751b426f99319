/* api.c - the public functions of level (a): check everything, then draw. */
#include "raster/raster.h"

#include "arena.h"
#include "check.h"
#include "jobs.h"
#include "lanes/lanes.h"
#include "medium.h"
#include "vec.h"

/* TYN_RASTER_MEMORY in tyndall.h counts with these sizes. A size that doesn't fit gives an array of length -1 here. */
typedef char size_of_raster[sizeof(struct tyn_raster) <= 128 ? 1 : -1];
typedef char size_of_piece[sizeof(tyni_raster_piece) == 128 ? 1 : -1];
typedef char size_of_chunk[sizeof(tyni_raster_chunk) == 24 ? 1 : -1];
typedef char size_of_tally[sizeof(tyni_raster_tally) == 64 ? 1 : -1];
typedef char size_of_count[sizeof(tyni_jobs_count) == 64 ? 1 : -1];
typedef char size_of_face[TYNI_RASTER_FACES * sizeof(tyni_raster_face) == 8192 ? 1 : -1];
typedef char size_of_slopes[TYN_MAX_LIGHTS * sizeof(tyni_raster_slopes) == 1088 ? 1 : -1];
typedef char size_of_numbers[offsetof(tyni_raster_face, ready) == 8 + 4 * TYNI_RASTER_NUMBERS ? 1 : -1];
typedef char size_of_lamp[sizeof(tyni_raster_lamp) <= 64 ? 1 : -1];
typedef char size_of_slide[sizeof(tyni_slide) <= 64 ? 1 : -1];
typedef char size_of_map[sizeof(tyni_raster_map) <= 128 ? 1 : -1];

static tyn_status resolve(tyn_raster_config *out, const tyn_raster_config *config)
{
    *out = *config;
    if (!out->batch)
        out->batch = TYNI_RASTER_BATCH;
    if (!out->workers)
        out->workers = 1;
    if (out->width < 1 || out->width > TYN_MAX_SIZE || out->height < 1 || out->height > TYN_MAX_SIZE || out->batch < 64 ||
        out->batch > 65536 || out->workers < 1 || out->workers > TYN_MAX_WORKERS || out->isa < 0 ||
        out->isa >= 2 * TYN_ISA_WASM)
        return TYN_E_CONFIG;
    return TYN_OK;
}

/* The block in order: the struct itself, then what it points to. */
static tyn_raster *carve(tyni_arena *arena, const tyn_raster_config *config)
{
    const size_t batch = (size_t)config->batch, workers = (size_t)config->workers;
    tyn_raster *raster = tyni_arena_take(arena, 1, 128);
    tyni_raster_piece *pieces = tyni_arena_take(arena, batch, sizeof *pieces);
    tyni_raster_rows *rows = tyni_arena_take(arena, batch, sizeof *rows);
    tyni_raster_chunk *chunks = tyni_arena_take(arena, (batch + TYNI_RASTER_CHUNK - 1) / TYNI_RASTER_CHUNK, sizeof *chunks);
    tyni_raster_tally *tallies = tyni_arena_take(arena, workers, sizeof *tallies);
    tyni_jobs_count *counts = tyni_arena_take(arena, workers, sizeof *counts);
    tyni_raster_face *faces = tyni_arena_take(arena, workers, TYNI_RASTER_FACES * sizeof *faces);
    uint8_t *groups = tyni_arena_take(arena, workers, TYNI_RASTER_GROUP);
    tyni_raster_slopes *slopes = tyni_arena_take(arena, workers, TYN_MAX_LIGHTS * sizeof *slopes);
    tyni_raster_lamp *lamps = tyni_arena_take(arena, TYN_MAX_LIGHTS, 64);
    tyni_raster_map *maps = tyni_arena_take(arena, (size_t)TYN_MAX_LIGHTS * TYN_MAX_MAPS, 128);
    tyni_slide *slides = tyni_arena_take(arena, TYN_MAX_LIGHTS * TYNI_RASTER_SLIDES, 64);
    if (raster) {
        raster->width = config->width;
        raster->height = config->height;
        raster->batch = config->batch;
        raster->workers = config->workers;
        raster->isa = config->isa;
        raster->pieces = pieces;
        raster->rows = rows;
        raster->chunks = chunks;
        raster->tallies = tallies;
        raster->counts = counts;
        raster->faces = faces;
        raster->groups = groups;
        raster->slopes = slopes;
        raster->lamps = lamps;
        raster->maps = maps;
        raster->slides = slides;
    }
    return raster;
}

tyn_status tyn_raster_measure(const tyn_raster_config *config, size_t *bytes)
{
    tyni_arena arena = {NULL, 0, 0};
    tyn_raster_config resolved;
    tyn_status status;
    if (!config || !bytes)
        return TYN_E_NULL;
    status = resolve(&resolved, config);
    if (status != TYN_OK)
        return status;
    (void)carve(&arena, &resolved);
    *bytes = arena.used;
    return TYN_OK;
}

tyn_status tyn_raster_init(tyn_raster **raster, const tyn_raster_config *config, void *memory, size_t bytes)
{
    tyni_arena arena = {memory, 0, 0};
    tyn_raster_config resolved;
    tyn_status status;
    size_t needed;
    if (!raster || !config || !memory)
        return TYN_E_NULL;
    status = tyn_raster_measure(config, &needed);
    if (status != TYN_OK)
        return status;
    if ((uintptr_t)memory % TYN_ALIGNMENT)
        return TYN_E_ALIGN;
    if (bytes < needed)
        return TYN_E_MEMORY;
    (void)resolve(&resolved, config);
    status = tyni_lanes_choose(resolved.isa, &resolved.isa);
    if (status != TYN_OK)
        return status;
    *raster = carve(&arena, &resolved);
    return TYN_OK;
}

static tyn_status check_material(const tyn_material *material)
{
    const uint32_t textures =
        TYNI_FORMAT_BIT(TYN_RGB8_LINEAR) | TYNI_FORMAT_BIT(TYN_RGB16_LINEAR) | TYNI_FORMAT_BIT(TYN_RGB_F32);
    tyn_status status = TYN_OK;
    for (int32_t c = 0; c < 3; c++)
        if (!(material->albedo[c] >= 0.0f && material->albedo[c] <= 1.0f))
            return TYN_E_MESH;
    if (material->texture)
        status = tyni_check_image(material->texture, textures);
    if (status == TYN_OK && material->mask)
        status = tyni_check_image(material->mask, TYNI_FORMAT_BIT(TYN_MASK8));
    return status;
}

static tyn_status check_meshes(const tyn_mesh *meshes, int32_t count)
{
    if (count < 0)
        return TYN_E_MESH;
    if (count && !meshes)
        return TYN_E_NULL;
    for (int32_t i = 0; i < count; i++) {
        const tyn_mesh *mesh = &meshes[i];
        const size_t indices = (size_t)mesh->triangles * 3;
        const tyn_status status = check_material(&mesh->material);
        if (status != TYN_OK)
            return status;
        if (!mesh->triangles)
            continue;
        if (!mesh->positions || !mesh->indices)
            return TYN_E_NULL;
        for (size_t k = 0; k < indices; k++)
            if (mesh->indices[k] >= mesh->vertices)
                return TYN_E_MESH;
    }
    return TYN_OK;
}

static tyn_status check_targets(const tyn_raster *raster, const tyn_surface *surface)
{
    tyn_status status = tyni_check_image(&surface->depth, TYNI_FORMAT_BIT(TYN_DEPTH_F32));
    if (status != TYN_OK)
        return status;
    if (surface->colour.pixels) {
        status = tyni_check_image(&surface->colour, TYNI_FORMAT_BIT(TYN_RGB_F32));
        if (status != TYN_OK)
            return status;
        if (surface->colour.width != surface->depth.width || surface->colour.height != surface->depth.height)
            return TYN_E_IMAGE;
    }
    if (surface->depth.width > raster->width || surface->depth.height > raster->height)
        return TYN_E_LIMIT;
    return TYN_OK;
}

static tyn_status check_lights(const tyn_light *lights, int32_t count)
{
    tyn_status status;
    if (count > TYN_MAX_LIGHTS)
        return TYN_E_LIMIT;
    status = tyni_check_lights(lights, count, TYN_MAX_SHADOW, TYN_MAX_MAPS);
    for (int32_t i = 0; i < count && status == TYN_OK; i++) {
        status = tyni_slide_check(&lights[i]);
        for (int32_t k = 0; k <= lights[i].more_count && status == TYN_OK; k++) {
            const tyn_shadow *shadow = k ? &lights[i].more[k - 1] : &lights[i].shadow;
            if (shadow->tint)
                status = tyni_check_image(shadow->tint, TYNI_SLIDE_FORMATS);
        }
    }
    return status;
}

static tyn_status check_surface(const tyn_raster *raster, const tyn_surface *surface)
{
    tyn_status status;
    if (!raster || !surface)
        return TYN_E_NULL;
    status = check_targets(raster, surface);
    if (status == TYN_OK)
        status = tyni_check_camera(&surface->camera);
    if (status == TYN_OK && surface->camera.kind != TYN_CAMERA_PERSPECTIVE)
        status = TYN_E_CAMERA;
    if (status == TYN_OK)
        status = check_lights(surface->lights, surface->light_count);
    if (status == TYN_OK)
        status = tyni_check_media(surface->media, surface->medium_count);
    if (status == TYN_OK && (!tyni_check_colour(surface->ambient) || !tyni_check_colour(surface->background) ||
                             !tyni_finite(surface->shadow_bias) || surface->shadow_bias < 0.0f))
        status = TYN_E_LIGHT;
    if (status == TYN_OK)
        status = check_meshes(surface->meshes, surface->mesh_count);
    if (status == TYN_OK)
        status = tyni_jobs_check(surface->executor, raster->workers);
    return status;
}

/* The part of a pass that cameras and shadow maps share. */
static void begin(tyni_raster_pass *pass, tyn_raster *raster, const tyn_mesh *meshes, int32_t count,
                  const tyn_executor *executor)
{
    memset(pass, 0, sizeof *pass);
    pass->raster = raster;
    pass->jobs.executor = executor;
    pass->jobs.counts = raster->counts;
    pass->jobs.workers = executor ? executor->workers : 1;
    pass->meshes = meshes;
    pass->mesh_count = (uint32_t)count;
}

static void report(const tyni_raster_pass *pass, tyn_raster_stats *stats, uint64_t ns)
{
    if (!stats)
        return;
    stats->triangles = pass->triangles;
    stats->bad = pass->bad;
    stats->drawn = 0;
    stats->pixels = 0;
    for (int32_t i = 0; i < pass->raster->workers; i++) {
        stats->drawn += pass->raster->tallies[i].drawn;
        stats->pixels += pass->raster->tallies[i].pixels;
    }
    stats->total_ns = ns;
}

static tyn_status shade(const tyni_raster_pass *pass, const tyn_surface *surface)
{
    const float bias = surface->shadow_bias > 0.0f ? surface->shadow_bias : 1.5f;
    tyni_raster_shading shading;
    shading.pass = pass;
    shading.surface = surface;
    shading.lamps = pass->raster->lamps;
    for (int32_t i = 0, number = 0; i < surface->light_count; number += 1 + surface->lights[i].more_count, i++)
        tyni_raster_set_lamp(&pass->raster->lamps[i], &pass->raster->maps[i * TYN_MAX_MAPS],
                             &pass->raster->slides[i * TYNI_RASTER_SLIDES], &surface->lights[i], surface->camera.position, bias,
                             number);
    tyni_medium_extinction(surface->media, surface->medium_count, shading.sigma);
    shading.hazy = shading.sigma[0] > 0.0f || shading.sigma[1] > 0.0f || shading.sigma[2] > 0.0f;
    return tyni_jobs_run(&pass->jobs, tyni_raster_shade, &shading,
                         (pass->view.height + TYNI_RASTER_BAND - 1) / TYNI_RASTER_BAND);
}

tyn_status tyn_raster_surface(tyn_raster *raster, const tyn_surface *surface)
{
    tyni_raster_pass pass;
    tyn_status status = check_surface(raster, surface);
    uint64_t begun;
    if (status != TYN_OK)
        return status;
    begun = surface->clock ? surface->clock(surface->clock_context) : 0;
    begin(&pass, raster, surface->meshes, surface->mesh_count, surface->executor);
    tyni_raster_view_camera(&pass.view, &surface->camera, surface->depth.width, surface->depth.height);
    pass.kind = surface->colour.pixels ? TYNI_RASTER_SEEN : TYNI_RASTER_DEPTH;
    pass.depth = surface->depth.pixels;
    pass.depth_stride = tyni_image_stride(&surface->depth);
    pass.nearest = surface->camera.near_depth;
    pass.clear = surface->camera.far_depth;
    if (pass.kind == TYNI_RASTER_SEEN) {
        pass.colour = surface->colour.pixels;
        pass.colour_stride = tyni_image_stride(&surface->colour);
    }
    status = tyni_raster_run(&pass);
    if (status == TYN_OK && pass.kind == TYNI_RASTER_SEEN)
        status = shade(&pass, surface);
    if (status == TYN_OK)
        report(&pass, surface->stats, surface->clock ? surface->clock(surface->clock_context) - begun : 0);
    return status;
}

/* Far from singular: the determinant of the rows, each divided by its largest entry. */
static int invertible(const float m[16])
{
    float a[4][4], s[6], c[6];
    for (int32_t i = 0; i < 4; i++) {
        float largest = 0.0f;
        for (int32_t k = 0; k < 4; k++)
            largest = tyni_maxf(largest, tyni_absf(m[4 * i + k]));
        if (!(largest > 1e-30f))
            return 0;
        for (int32_t k = 0; k < 4; k++)
            a[i][k] = m[4 * i + k] / largest;
    }
    for (int32_t i = 0, n = 0; i < 3; i++)
        for (int32_t k = i + 1; k < 4; k++, n++) {
            s[n] = a[0][i] * a[1][k] - a[0][k] * a[1][i];
            c[n] = a[2][i] * a[3][k] - a[2][k] * a[3][i];
        }
    {
        const float d = s[0] * c[5] - s[1] * c[4] + s[2] * c[3] + s[3] * c[2] - s[4] * c[1] + s[5] * c[0];
        return tyni_finite(d) && d != 0.0f;
    }
}

static tyn_status check_shadow(const tyn_raster *raster, const tyn_shadow *shadow, const float *depth, const tyn_mesh *meshes,
                               int32_t mesh_count, const tyn_executor *executor)
{
    const float *m;
    tyn_status status;
    int32_t height;
    if (!raster || !shadow || !depth)
        return TYN_E_NULL;
    m = shadow->matrix;
    height = tyni_shadow_height(shadow);
    if (shadow->size < 1 || shadow->size > TYN_MAX_SHADOW || !tyni_check_finite(m, 16) || !invertible(m))
        return TYN_E_LIGHT;
    if (height < 1 || height > TYN_MAX_SHADOW || shadow->coding != TYN_MAP_REVERSED ||
        (shadow->format != TYN_FORMAT_NONE && shadow->format != TYN_DEPTH_F32) || !tyni_check_shadow_stride(shadow))
        return TYN_E_LIGHT;
    if (m[12] == 0.0f && m[13] == 0.0f && m[14] == 0.0f && m[15] < 0.0f) /* nothing is in front of this light */
        return TYN_E_LIGHT;
    if ((uintptr_t)depth % sizeof *depth)
        return TYN_E_ALIGN;
    if (shadow->size > raster->width || height > raster->height)
        return TYN_E_LIMIT;
    status = check_meshes(meshes, mesh_count);
    return status == TYN_OK ? tyni_jobs_check(executor, raster->workers) : status;
}

tyn_status tyn_raster_shadow(tyn_raster *raster, const tyn_shadow *shadow, float *depth, const tyn_mesh *meshes,
                             int32_t mesh_count, const tyn_executor *executor, tyn_clock clock, void *clock_context,
                             tyn_raster_stats *stats)
{
    tyni_raster_pass pass;
    tyn_status status = check_shadow(raster, shadow, depth, meshes, mesh_count, executor);
    uint64_t begun;
    if (status != TYN_OK)
        return status;
    begun = clock ? clock(clock_context) : 0;
    begin(&pass, raster, meshes, mesh_count, executor);
    tyni_raster_view_shadow(&pass.view, shadow);
    pass.kind = TYNI_RASTER_SHADOW;
    pass.depth = (uint8_t *)depth;
    pass.depth_stride = shadow->stride ? shadow->stride : (ptrdiff_t)shadow->size * (ptrdiff_t)sizeof *depth;
    status = tyni_raster_run(&pass);
    if (status == TYN_OK)
        report(&pass, stats, clock ? clock(clock_context) - begun : 0);
    return status;
}
