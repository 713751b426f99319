/* stage.h - what `tyndall bench` and the other benchmarks share: a built-in scene drawn once, and frames of it that are timed
 * and compared. */
#ifndef TOOL_STAGE_H
#define TOOL_STAGE_H

#include "pool.h"
#include "scene.h"
#include "tyndall.h"

/* All that a frame reads, made once. */
typedef struct stage {
    scene scene;
    int32_t width, height, shadow_size;
    size_t pixels;
    tyn_camera camera;
    tyn_light light;
    float *map, *depth, *colour;
    float *scatter, *truth_scatter; /* 3 a pixel; scatter is of the last frame that wanted it */
    uint8_t *colour8, *target, *truth;
    tyn_raster *raster;
    void *raster_memory;
    double raster_ms, shadow_ms; /* of the last */
} stage;

/* The least of all repeats. */
typedef struct record {
    double ms;
    tyn_stats stats; /* of the fastest frame */
} record;

/* Ends the program with a message. */
#if defined(__GNUC__)
__attribute__((noreturn))
#endif
void bench_die(const char *what);
void bench_need(tyn_status status, const char *what);

uint64_t bench_now(void *context);
double bench_ms_since(uint64_t start);

/* Draws a built-in scene; ends the program where it can't. */
void stage_set_up(stage *s, const char *name, int32_t width, int32_t height, int32_t shadow_size, pool *threads);
void stage_tear_down(stage *s);

/* Draws anew, after s->light or s->camera was changed: the shadow map, fitted; depth and colour, by the map as it is. */
void stage_shadow(stage *s, pool *threads);
void stage_surface(stage *s, pool *threads);

/* The quality preset for the stage. */
tyn_config stage_config(const stage *s, int32_t workers);

/* In memory of its own: free() it. */
tyn_context *stage_context(const tyn_config *config);

/* Renders once, into target; `best` keeps the fastest. */
void stage_time(stage *s, tyn_context *context, pool *threads, record *best);
void stage_time_by(stage *s, tyn_context *context, const tyn_executor *executor, record *best);

/* The exact march as the truth of stage_compare. Returns its time. */
record stage_truth(stage *s, pool *threads);

/* How far a frame is from the truth: relative L1 of L_scat in percent, PSNR and largest difference of the 8-bit picture. */
typedef struct gap {
    double l1_percent, psnr;
    int worst;
} gap;
gap stage_compare(stage *s, tyn_context *context, pool *threads);

/* A pass that reads depth and colour and writes a picture: what no renderer can be faster than. ms */
double stage_floor(stage *s, pool *threads);

#endif
