/* tyndall.c - the public calls of the post process: check arguments, call inward. The rasterizer's are in raster/api.c. */
#include "tyndall.h"

#include "base.h"
#include "arena.h"
#include "art.h"
#include "check.h"
#include "composite.h"
#include "config.h"
#include "debug.h"
#include "door.h"
#include "frame.h"
#include "jobs.h"
#include "lanes/lanes.h"
#include "slide.h"

/* A context takes as much room as TYN_MEMORY says. */
typedef char context_fits[sizeof(struct tyn_context) <= TYN_CONTEXT_BYTES ? 1 : -1];
typedef char shelf_fits[sizeof(tyni_shelf) == TYN_SHELF_BYTES ? 1 : -1];
typedef char row_fits[sizeof(tyni_row) <= TYN_ROW_BYTES ? 1 : -1];
typedef char bundle_fits[sizeof(tyni_bundle) <= TYN_BUNDLE_BYTES + TYN_PLANES_BYTES ? 1 : -1];
typedef char stats_fit[sizeof(tyn_stats) <= TYN_STATS_BYTES ? 1 : -1];

static void place(tyn_context *context, tyni_arena *arena)
{
    tyni_arena_take(arena, 1, TYN_CONTEXT_BYTES);
    tyni_frame_place(context, arena);
}

tyn_status tyn_measure(const tyn_config *config, size_t *bytes)
{
    tyni_arena arena = {NULL, 0, 0};
    struct tyn_context context;
    if (!config || !bytes)
        return TYN_E_NULL;
    memset(&context, 0, sizeof context);
    context.config = *config;
    if (tyni_config_fill(&context.config) != TYN_OK)
        return TYN_E_CONFIG;
    place(&context, &arena);
    if (arena.overflow)
        return TYN_E_CONFIG;
    *bytes = arena.used;
    return TYN_OK;
}

tyn_status tyn_init(tyn_context **context, const tyn_config *config, void *memory, size_t bytes)
{
    tyni_arena arena = {NULL, 0, 0};
    tyn_context *c = memory;
    tyn_config own;
    size_t need;
    tyn_status status;
    if (!context || !config || !memory)
        return TYN_E_NULL;
    status = tyn_measure(config, &need);
    if (status != TYN_OK)
        return status;
    if ((uintptr_t)memory % TYN_ALIGNMENT)
        return TYN_E_ALIGN;
    if (bytes < need)
        return TYN_E_MEMORY;
    own = *config;
    tyni_config_fill(&own);
    status = tyni_lanes_choose(own.isa, &own.isa);
    if (status != TYN_OK)
        return status;
    memset(c, 0, sizeof *c);
    c->config = own;
    arena.block = memory;
    place(c, &arena);
    *context = c;
    return TYN_OK;
}

/* Image of the frame's size, or none at all. */
static tyn_status check_optional(const tyn_image *image, uint32_t formats, const tyn_image *depth)
{
    tyn_status status;
    if (!image->pixels)
        return TYN_OK;
    status = tyni_check_image(image, formats);
    if (status == TYN_OK && (image->width != depth->width || image->height != depth->height))
        return TYN_E_IMAGE;
    return status;
}

static tyn_status check_debug(const tyn_config *c, const tyn_frame *f)
{
    if ((uint32_t)f->debug > (uint32_t)(TYNI_HAS(TYN_PART_DEBUG) ? TYN_DEBUG_BASIS : TYN_DEBUG_NONE) ||
        !tyni_finite(f->debug_x) || !tyni_finite(f->debug_y))
        return TYN_E_DISPLAY;
    if (tyni_prefilter_kept(c->method) ? tyni_debug_marks(f->debug) || f->debug == TYN_DEBUG_SCATTER
                                       : f->debug == TYN_DEBUG_BASIS)
        return TYN_E_DISPLAY;
    return f->debug == TYN_DEBUG_TREE && !tyni_ray_way(c->rays, TYN_RAYS_TREE) ? TYN_E_DISPLAY : TYN_OK;
}

static tyn_status check_frame(const tyn_context *context, const tyn_frame *f)
{
    const tyn_config *c = &context->config;
    tyn_status status = tyni_check_image(&f->depth, TYNI_DEPTH_FORMATS);
    if (status == TYN_OK && (f->depth.width > c->width || f->depth.height > c->height))
        status = TYN_E_LIMIT;
    if (status == TYN_OK)
        status = check_optional(&f->colour, TYNI_COLOUR_FORMATS, &f->depth);
    if (status == TYN_OK)
        status = check_optional(&f->target, TYNI_COLOUR_FORMATS, &f->depth);
    if (status == TYN_OK)
        status = check_optional(&f->scatter, TYNI_FORMAT_BIT(TYN_RGB_F32), &f->depth);
    if (status == TYN_OK)
        status = check_optional(&f->transmittance, TYNI_FORMAT_BIT(TYN_RGB_F32), &f->depth);
    if (status == TYN_OK)
        status = tyni_check_camera(&f->camera);
    if (status == TYN_OK)
        status = tyni_door_check(&f->depth_coding, &f->camera);
    if (status == TYN_OK && f->light_count > c->lights)
        status = TYN_E_LIMIT;
    if (status == TYN_OK)
        status = tyni_check_lights(f->lights, f->light_count, c->shadow_size, c->maps);
    if (status == TYN_OK)
        status = tyni_slide_lights(f->lights, f->light_count, c->textured);
    if (status == TYN_OK)
        status = tyni_check_media(f->media, f->medium_count);
    if (status == TYN_OK)
        status = tyni_art_check(f);
    if (status == TYN_OK)
        status = tyni_check_display(&f->display);
    if (status == TYN_OK)
        status = check_debug(c, f);
    if (status == TYN_OK)
        status = tyni_jobs_check(f->executor, c->workers);
    return status;
}

tyn_status tyn_render(tyn_context *context, const tyn_frame *frame)
{
    tyn_status status;
    if (!context || !frame)
        return TYN_E_NULL;
    status = check_frame(context, frame);
    return status == TYN_OK ? tyni_frame_render(context, frame) : status;
}

tyn_status tyn_encode(const tyn_image *linear, const tyn_display *display, const tyn_image *target)
{
    tyn_status status;
    float red[32], green[32], blue[32];
    float *const rgb[3] = {red, green, blue};
    int32_t isa = TYN_ISA_SCALAR;
    if (!linear || !display || !target)
        return TYN_E_NULL;
    status = tyni_check_image(linear, TYNI_FORMAT_BIT(TYN_RGB_F32));
    if (status == TYN_OK)
        status = tyni_check_image(target, TYNI_COLOUR_FORMATS);
    if (status == TYN_OK && (linear->width != target->width || linear->height != target->height))
        status = TYN_E_IMAGE;
    if (status == TYN_OK)
        status = tyni_check_display(display);
    if (status == TYN_OK)
        status = tyni_lanes_choose(0, &isa);
    if (status != TYN_OK)
        return status;
    for (int32_t y = 0; y < target->height; y++)
        for (int32_t x = 0; x < target->width; x += 32) {
            int32_t count = tyni_mini(32, target->width - x);
            tyni_composite_read(isa, linear, x, y, count, rgb);
            tyni_composite_write(isa, target, display, x, y, count, rgb);
        }
    return TYN_OK;
}
