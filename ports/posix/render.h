/* render.h - a scene to pictures: what `tyndall render` and the showcase share. */
#ifndef TOOL_RENDER_H
#define TOOL_RENDER_H

#include "error.h"
#include "pool.h"
#include "scene.h"

/* Zero bytes mean the defaults. */
typedef struct render_settings {
    int32_t width, height; /* 0: the scene's */
    tyn_preset preset;
    int preset_given; /* 0: TYN_PRESET_QUALITY */
    tyn_method method;
    int method_given;
    tyn_rays rays;
    int rays_given;
    int32_t steps, slices, samples, initial_step, shadow_size; /* 0: the preset's */
    float break_threshold;                                     /* 0: the preset's */
    int32_t isa;                                               /* 0: the best */
    float exposure;                                            /* 0: automatic for display, 1 for linear pictures */
    tyn_debug debug;                                           /* a second picture, drawn in debug_format */
    tyn_format debug_format;
    int want_scatter, want_surface, want_maps; /* keep these too; depth is always there */
} render_settings;

typedef struct render_times {
    uint64_t shadow_ns, surface_ns, shafts_ns;
} render_times;

#define RENDER_FACES 6 /* of a point light's cube */

typedef struct render_light {
    tyn_shadow faces[RENDER_FACES]; /* count of them; their depth is `maps`, NULL without settings.want_maps */
    float *maps[RENDER_FACES];
    int32_t count;
} render_light;

typedef struct render_result {
    int32_t width, height;
    float *radiance; /* linear, without exposure, 3 a pixel; top row first, as all of these */
    float *surface;  /* NULL unless wanted */
    float *scatter;  /* NULL unless wanted */
    float *depth;
    void *debug;     /* NULL without settings.debug */
    float exposure;  /* what was given, or what suits radiance */
    tyn_stats stats; /* of the shafts */
    render_times times;
    size_t raster_bytes, shadow_bytes; /* memory of the rasterizer, of all shadow maps */
    tyn_camera camera;
    render_light lights[TYN_MAX_LIGHTS];
} render_result;

/* All of it in float. -1: error set (`name` is the scene's for messages), nothing to free. */
int render_scene(const scene *s, const char *name, const render_settings *settings, pool *threads, render_result *result,
                 tool_error *error);
void render_free(render_result *result);
void render_free_maps(render_result *result);

/* The factor that shows a linear picture well under TYN_TONE_FILM. The same on every machine. */
float render_exposure(const float *radiance, int32_t width, int32_t height);

/* The picture for a display: film curve, dither, sRGB. `format` TYN_RGBA8_SRGB or TYN_RGB565_SRGB. NULL: error set; free() it.
 */
void *render_display(const render_result *result, float exposure, tyn_format format, tool_error *error);

#endif
