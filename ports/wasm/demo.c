/* demo.c - see demo.h */
#include "demo.h"

#include <string.h>

#define FAR 150.0f
#define EXPOSURE 0.34f
#define HAZE_G 0.6f /* less than real haze: the glow around the sun leaves room for the stones */

/* A block of the frame's memory; NULL where there is none to place in, only to measure. */
static void *take(uint8_t *memory, size_t *used, size_t bytes)
{
    void *at = memory ? memory + *used : NULL;
    *used += (bytes + TYN_ALIGNMENT - 1) / TYN_ALIGNMENT * TYN_ALIGNMENT;
    return at;
}

static void configs(const demo_view *v, tyn_raster_config *raster, tyn_config *shafts, tyn_config *march)
{
    memset(raster, 0, sizeof *raster);
    raster->width = v->width > v->shadow_size ? v->width : v->shadow_size;
    raster->height = v->height > v->shadow_size ? v->height : v->shadow_size;
    raster->workers = v->workers;
    raster->isa = v->isa;
    tyn_config_preset(shafts, TYN_PRESET_QUALITY, v->width, v->height);
    shafts->slices = v->slices;
    shafts->shadow_size = v->shadow_size;
    shafts->workers = v->workers;
    shafts->isa = v->isa;
    *march = *shafts;
    shafts->method = (tyn_method)v->method;
    shafts->rays = (tyn_rays)v->rays;
    shafts->gather = (tyn_gather)v->gather;
    shafts->downscale = v->downscale;
    march->method = TYN_METHOD_MARCH;
    march->slices = 8;
    march->samples = 2;
}

/* Places all, or only measures it with memory NULL. 0: the view is out of range. */
static size_t lay_out(demo *d, const demo_view *v, uint8_t *memory)
{
    tyn_raster_config raster;
    tyn_config shafts, march;
    size_t bytes[3], used = 0, pixels = (size_t)v->width * (size_t)v->height;
    void *at;
    if (v->width < 1 || v->width > 4096 || v->height < 1 || v->height > 4096 || v->shadow_size < 1 || v->shadow_size > 4096)
        return 0;
    configs(v, &raster, &shafts, &march);
    if (tyn_raster_measure(&raster, &bytes[0]) != TYN_OK || tyn_measure(&shafts, &bytes[1]) != TYN_OK ||
        tyn_measure(&march, &bytes[2]) != TYN_OK)
        return 0;
    d->raster_bytes = bytes[0];
    d->shaft_bytes = bytes[1];
    d->map_bytes = (size_t)v->shadow_size * (size_t)v->shadow_size * sizeof *d->map;
    d->map = take(memory, &used, d->map_bytes);
    d->picture_bytes = used;
    d->depth = take(memory, &used, pixels * sizeof *d->depth);
    d->colour = take(memory, &used, pixels * 3 * sizeof *d->colour);
    d->target = take(memory, &used, pixels * 4);
    d->truth = take(memory, &used, pixels * 4);
    d->picture_bytes = used - d->picture_bytes;
    at = take(memory, &used, bytes[0]);
    if (memory && tyn_raster_init(&d->raster, &raster, at, bytes[0]) != TYN_OK)
        return 0;
    at = take(memory, &used, bytes[1]);
    if (memory && tyn_init(&d->shafts, &shafts, at, bytes[1]) != TYN_OK)
        return 0;
    at = take(memory, &used, bytes[2]);
    if (memory && tyn_init(&d->march, &march, at, bytes[2]) != TYN_OK)
        return 0;
    return used;
}

size_t demo_bytes(const demo_view *view)
{
    demo d;
    return lay_out(&d, view, NULL);
}

/* Low suns are warm and dim. */
static void set_sun(demo *d)
{
    float s, c, x, z, high = d->view.sun_pitch / 45, warm;
    scene_turn(d->view.sun_yaw, &x, &z);
    scene_turn(d->view.sun_pitch, &s, &c);
    high = high > 1 ? 1 : high < 0 ? 0 : high;
    warm = 1 - high;
    d->sun.kind = TYN_LIGHT_DIRECTIONAL;
    d->sun.direction[0] = -x * c;
    d->sun.direction[1] = -s;
    d->sun.direction[2] = -z * c;
    d->sun.colour[0] = 20 + high;
    d->sun.colour[1] = 19.5f - 7 * warm;
    d->sun.colour[2] = 18 - 12.5f * warm;
}

static tyn_status set_camera(demo *d)
{
    static const float target[3] = {0, 3.2f, 0}, up[3] = {0, 1, 0};
    float s, c, x, z, position[3], tall = (float)d->view.height / (float)d->view.width;
    scene_turn(d->view.yaw, &x, &z);
    scene_turn(d->view.pitch, &s, &c);
    position[0] = target[0] + d->view.distance * x * c;
    position[1] = target[1] + d->view.distance * s;
    position[2] = target[2] + d->view.distance * z * c;
    if (position[1] < 0.9f)
        position[1] = 0.9f;
    tall = tall < 0.6f ? 0.6f : tall > 1.6f ? 1.6f : tall; /* an upright window sees more above and below */
    return tyn_camera_look(&d->camera, position, target, up, 0.55f + 0.4f * tall, 0.3f, FAR, d->view.width, d->view.height);
}

static tyn_status draw_surface(demo *d)
{
    tyn_surface surface;
    tyn_status status;
    uint64_t start = d->clock ? d->clock(NULL) : 0, middle;
    d->sun.shadow.depth = NULL;
    d->sun.shadow.size = d->view.shadow_size;
    status = tyn_shadow_fit(&d->sun, &d->camera, d->scene.low, d->scene.high);
    if (status == TYN_OK)
        status = tyn_raster_shadow(d->raster, &d->sun.shadow, d->map, &d->scene.meshes[SCENE_CASTERS],
                                   SCENE_MESHES - SCENE_CASTERS, d->executor, NULL, NULL, NULL);
    if (status != TYN_OK)
        return status;
    d->sun.shadow.depth = d->map;
    middle = d->clock ? d->clock(NULL) : 0;
    memset(&surface, 0, sizeof surface);
    surface.camera = d->camera;
    surface.meshes = d->scene.meshes;
    surface.mesh_count = SCENE_MESHES;
    surface.lights = &d->sun;
    surface.light_count = 1;
    for (int i = 0; i < 3; i++) {
        surface.ambient[i] = 0.8f + 0.75f * (float)i + 0.03f * d->sun.colour[i];
        surface.background[i] = 0.3f + 0.5f * (float)i;
    }
    surface.colour = (tyn_image){d->colour, d->view.width, d->view.height, 0, TYN_RGB_F32};
    surface.depth = (tyn_image){d->depth, d->view.width, d->view.height, 0, TYN_DEPTH_F32};
    surface.executor = d->executor;
    status = tyn_raster_surface(d->raster, &surface);
    d->shadow_ns = middle - start;
    d->surface_ns = (d->clock ? d->clock(NULL) : 0) - middle;
    return status;
}

/* A rectangle of the frame. */
static tyn_status render(demo *d, tyn_context *context, uint8_t *picture, const int32_t at[4], tyn_stats *stats)
{
    tyn_frame frame;
    size_t from = (size_t)at[1] * (size_t)d->view.width + (size_t)at[0];
    ptrdiff_t row = d->view.width;
    float wide = (d->camera.right_edge - d->camera.left_edge) / (float)d->view.width;
    float tall = (d->camera.top_edge - d->camera.bottom_edge) / (float)d->view.height;
    memset(&frame, 0, sizeof frame);
    frame.camera = d->camera;
    if (at[2] != d->view.width || at[3] != d->view.height) {
        frame.camera.left_edge = d->camera.left_edge + wide * (float)at[0];
        frame.camera.right_edge = d->camera.left_edge + wide * (float)(at[0] + at[2]);
        frame.camera.top_edge = d->camera.top_edge - tall * (float)at[1];
        frame.camera.bottom_edge = d->camera.top_edge - tall * (float)(at[1] + at[3]);
    }
    frame.depth = (tyn_image){d->depth + from, at[2], at[3], row * 4, TYN_DEPTH_F32};
    frame.colour = (tyn_image){d->colour + 3 * from, at[2], at[3], row * 12, TYN_RGB_F32};
    frame.target = (tyn_image){picture + 4 * from, at[2], at[3], row * 4, TYN_RGBA8_SRGB};
    frame.lights = &d->sun;
    frame.light_count = 1;
    frame.media = d->media;
    frame.medium_count = d->view.visibility > 0 ? 2 : 0;
    frame.display = (tyn_display){EXPOSURE, TYN_TONE_FILM, 1};
    frame.executor = d->executor;
    frame.clock = d->clock;
    frame.stats = stats;
    return tyn_render(context, &frame);
}

tyn_status demo_draw(demo *d, const demo_view *view, void *memory, size_t bytes)
{
    const int32_t all[4] = {0, 0, view->width, view->height};
    size_t need = demo_bytes(view);
    tyn_status status;
    if (need == 0)
        return TYN_E_CONFIG;
    if (bytes < need)
        return TYN_E_MEMORY;
    d->view = *view;
    if (lay_out(d, view, memory) == 0)
        return TYN_E_ISA;
    set_sun(d);
    status = set_camera(d);
    if (status == TYN_OK && view->visibility > 0)
        status = tyn_medium_weather(d->media, 12, view->visibility, 0.3f);
    d->media[1].g = HAZE_G;
    if (status == TYN_OK)
        status = draw_surface(d);
    return status == TYN_OK ? render(d, d->shafts, d->target, all, &d->stats) : status;
}

tyn_status demo_march(demo *d, int32_t x, int32_t y, int32_t width, int32_t height)
{
    const int32_t at[4] = {x, y, width, height};
    return render(d, d->march, d->truth, at, NULL);
}

void demo_gap(const demo *d, int32_t x, int32_t width, float *largest, float *squared)
{
    uint64_t sum = 0;
    int32_t worst = 0;
    for (int32_t row = 0; row < d->view.height; row++) {
        size_t at = 4 * ((size_t)row * (size_t)d->view.width + (size_t)x);
        for (size_t i = at; i < at + 4 * (size_t)width; i++) {
            int32_t apart = d->target[i] - d->truth[i];
            sum += (uint64_t)(apart * apart);
            apart = apart < 0 ? -apart : apart;
            worst = apart > worst ? apart : worst;
        }
    }
    *largest = (float)worst;
    *squared = (float)sum / (3.0f * (float)width * (float)d->view.height); /* alpha is always the same */
}

uint64_t demo_hash(const demo *d)
{
    uint64_t hash = 14695981039346656037u;
    for (size_t i = 0; i < 4 * (size_t)d->view.width * (size_t)d->view.height; i++)
        hash = (hash ^ d->target[i]) * 1099511628211u;
    return hash;
}
