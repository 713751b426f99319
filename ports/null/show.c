/* show.c - see show.h */
#include "show.h"

#include <string.h>

/* The next bytes of the block, or NULL behind its end. */
static void *take(uint8_t **at, const uint8_t *end, size_t bytes)
{
    uint8_t *block = *at;
    if ((size_t)(end - block) < SHOW_ROUND(bytes))
        return NULL;
    *at += SHOW_ROUND(bytes);
    return block;
}

tyn_status show_open(show *s, int32_t width, int32_t height, const tyn_executor *executor, void *memory, size_t bytes)
{
    const size_t pixels = (size_t)width * (size_t)height, band = (size_t)width * SHOW_BAND;
    uint8_t *at = memory, *end = at + bytes;
    tyn_raster_config drawing;
    tyn_config config;
    tyn_status status = tyn_config_preset(&config, TYN_PRESET_HANDHELD, width, height);
    size_t need;
    if (status != TYN_OK)
        return status;
    memset(s, 0, sizeof *s);
    s->width = width;
    s->height = height;
    s->executor = executor;
    s->scene = take(&at, end, sizeof *s->scene);
    s->map = take(&at, end, sizeof *s->map * SHOW_MAP * SHOW_MAP);
    s->depth = take(&at, end, sizeof *s->depth * pixels);
    s->colour = take(&at, end, sizeof *s->colour * 4 * band);
    if (!s->scene || !s->map || !s->depth || !s->colour)
        return TYN_E_MEMORY;
    s->deep = s->colour + 3 * band;
    memset(&drawing, 0, sizeof drawing);
    drawing.width = SHOW_MOST(width, SHOW_MAP);
    drawing.height = SHOW_MAP;
    drawing.batch = SHOW_BATCH;
    drawing.workers = config.workers = executor ? executor->workers : 1;
    status = tyn_raster_measure(&drawing, &need);
    if (status == TYN_OK)
        status = tyn_raster_init(&s->raster, &drawing, at, (size_t)(end - at));
    if (status != TYN_OK)
        return status;
    at += need;
    return tyn_init(&s->context, &config, at, (size_t)(end - at));
}

static tyn_image image(void *pixels, int32_t width, int32_t height, tyn_format format)
{
    tyn_image i = {pixels, width, height, 0, TYN_FORMAT_NONE};
    i.format = format;
    return i;
}

static void *row(const tyn_image *i, int32_t y)
{
    ptrdiff_t stride = i->stride ? i->stride : (ptrdiff_t)i->width * tyn_format_bytes(i->format);
    return (uint8_t *)i->pixels + y * stride;
}

/* Rows y .. y + height - 1: floats for a while, then the picture's format and depth of 16 bits. */
static tyn_status draw_band(show *s, tyn_surface *surface, int32_t y, int32_t height, const tyn_image *picture)
{
    static const tyn_display plain = {1, TYN_TONE_CLAMP, 0};
    const tyn_camera *whole = &s->scene->camera;
    const float tall = (whole->top_edge - whole->bottom_edge) / (float)s->height;
    tyn_image part = *picture;
    tyn_status status;
    surface->camera.top_edge = whole->top_edge - tall * (float)y;
    surface->camera.bottom_edge = whole->top_edge - tall * (float)(y + height);
    surface->colour = image(s->colour, s->width, height, TYN_RGB_F32);
    surface->depth = image(s->deep, s->width, height, TYN_DEPTH_F32);
    status = tyn_raster_surface(s->raster, surface);
    if (status != TYN_OK)
        return status;
    for (int32_t i = 0; i < s->width * height; i++)
        s->depth[y * s->width + i] = (uint16_t)(s->deep[i] * (65535 / SCENE_FAR));
    part.pixels = row(picture, y);
    part.height = height;
    return tyn_encode(&surface->colour, &plain, &part);
}

tyn_status show_surfaces(show *s, float moment, const tyn_image *picture)
{
    scene *c = s->scene;
    tyn_surface surface;
    tyn_status status = scene_make(c, moment, s->width, s->height);
    c->sun.shadow.size = SHOW_MAP;
    if (status == TYN_OK)
        status = tyn_shadow_fit_scene(&c->sun, &c->camera, NULL, c->mesh, 2);
    if (status == TYN_OK)
        status = tyn_raster_shadow(s->raster, &c->sun.shadow, s->map, c->mesh, 2, s->executor, NULL, NULL, NULL);
    c->sun.shadow.depth = s->map;
    memset(&surface, 0, sizeof surface);
    surface.camera = c->camera;
    surface.meshes = c->mesh;
    surface.mesh_count = 2;
    surface.lights = &c->sun;
    surface.light_count = 1;
    memcpy(surface.ambient, c->ambient, sizeof surface.ambient);
    memcpy(surface.background, c->sky, sizeof surface.background);
    surface.executor = s->executor;
    for (int32_t y = 0; y < s->height && status == TYN_OK; y += SHOW_BAND)
        status = draw_band(s, &surface, y, SHOW_LEAST(SHOW_BAND, s->height - y), picture);
    return status;
}

tyn_status show_light(show *s, const tyn_image *picture)
{
    tyn_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.camera = s->scene->camera;
    frame.depth = image(s->depth, s->width, s->height, TYN_DEPTH_U16);
    frame.depth_coding.scale = SCENE_FAR / 65535;
    frame.colour = *picture; /* in place */
    frame.target = *picture;
    frame.lights = &s->scene->sun;
    frame.light_count = 1;
    frame.media = &s->scene->air;
    frame.medium_count = 1;
    frame.display.dither = 1;
    frame.executor = s->executor;
    frame.clock = s->clock;
    frame.stats = &s->stats;
    return tyn_render(s->context, &frame);
}
