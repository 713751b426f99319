/* demo.h - a frame of the page from its controls, all of it by the library: shadow map, surface, shafts, and the march to hold
 * them against. The same code runs in the page and in the program of the tests that its pictures are compared with. */
#ifndef WASM_DEMO_H
#define WASM_DEMO_H

#include "scene.h"

/* What the controls say. The page fills it as an array of 32-bit words: worker.js has the same order. */
typedef struct demo_view {
    float yaw, pitch, distance; /* degrees, degrees, metres: where the camera stands as seen from the middle */
    float sun_yaw, sun_pitch;   /* degrees */
    float visibility;           /* metres, see tyn_medium_weather; 0: clear air */
    int32_t width, height, slices;
    int32_t method, rays, gather, downscale; /* as in tyn_config */
    int32_t shadow_size, isa, workers;
} demo_view;

typedef struct demo {
    scene scene;
    demo_view view;
    const tyn_executor *executor;
    tyn_clock clock;
    tyn_light sun;
    tyn_medium media[2];
    tyn_camera camera;
    tyn_raster *raster;
    tyn_context *shafts, *march;
    float *map, *depth, *colour;
    uint8_t *target, *truth; /* RGBA, width * height: by the view's method, and marched */
    tyn_stats stats;
    uint64_t shadow_ns, surface_ns;
    size_t raster_bytes, shaft_bytes, map_bytes, picture_bytes;
} demo;

/* Bytes for a view besides the scene; 0 for a view that is out of range. */
size_t demo_bytes(const demo_view *view);

/* A frame into d->target. `memory`: of that many bytes, at TYN_ALIGNMENT. */
tyn_status demo_draw(demo *d, const demo_view *view, void *memory, size_t bytes);

/* An exact ray for each pixel of a rectangle of the frame that was drawn, into d->truth. */
tyn_status demo_march(demo *d, int32_t x, int32_t y, int32_t width, int32_t height);

/* The largest and the mean squared difference of columns x .. x + width - 1 of target and truth, of 255. */
void demo_gap(const demo *d, int32_t x, int32_t width, float *largest, float *squared);

/* FNV-1a of d->target. */
uint64_t demo_hash(const demo *d);

#endif
