/* render.h - a scene to pictures: what `tyndall render` and the showcase share. */
#ifndef TOOL_RENDER_H
#define TOOL_RENDER_H

#include "error.h"
#include "pool.h"
#include "scene.h"

/* Shadow maps of a directional light: fitted; or in projective rectification by tyn_shadow_rectifiable's weight (both maps
 * where that is between 0 and 1), or wherever it is not 0. The fitted map follows the others, for what is nearer than they
 * reach. A light that is drawn by both takes up two of TYN_MAX_LIGHTS: the first lights for which there is room can have it. */
typedef enum render_rectify { RENDER_DEFAULT, RENDER_EPIPOLAR, RENDER_PROJECTIVE, RENDER_FORCED } render_rectify;

/* Zero bytes mean the defaults: the preset's. */
typedef struct render_settings {
    int32_t width, height;                                    /* 0: the scene's */
    int32_t preset, method, rays, gather, kernel, debug, isa; /* a value of the enum + 1 */
    int32_t steps, slices, samples, initial_step, shadow_size;
    int32_t taps, downscale, budget;
    int32_t bases, columns, references, weights; /* weights: of the enum + 1 */
    int32_t rectify, splits;                     /* render_rectify; maps of RENDER_PROJECTIVE, 1 .. RENDER_FACES, 0: 4 */
    float break_threshold, tolerance;
    float exposure;                            /* automatic for display, 1 for linear pictures */
    float debug_x, debug_y;                    /* as in tyn_frame */
    tyn_format debug_format;                   /* of the second picture that debug draws */
    int want_scatter, want_surface, want_maps; /* keep these too; depth is always there */
} render_settings;

typedef struct render_times {
    uint64_t shadow_ns, surface_ns, shafts_ns;
} render_times;

#define RENDER_FACES 6 /* of a point light's cube */
#define RENDER_MAPS 7  /* rectified and the fitted one */

typedef struct render_light {
    tyn_shadow faces[RENDER_MAPS]; /* count of them; their depth is `maps`, NULL without settings.want_maps */
    float *maps[RENDER_MAPS];
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
    render_light lights[TYN_MAX_LIGHTS]; /* of the scene; what follows is of lights that are drawn by both kinds of maps */
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
