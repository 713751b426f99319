/* raster.h - what the rasterizer's benchmark draws, for us and for others. */
#ifndef TYN_BENCH_RASTER_H
#define TYN_BENCH_RASTER_H

#include "scene.h"
#include "tyndall.h"

enum { RASTER_MAP, RASTER_DEPTH, RASTER_PLAIN, RASTER_SHADOWED, RASTER_PASSES };

typedef struct raster_work {
    const scene *scene;
    tyn_camera camera;
    tyn_light light; /* with its map's matrix and size */
    int32_t width, height, map;
    float ambient[3], background[3];
} raster_work;

typedef struct raster_times {
    double ms[RASTER_PASSES]; /* minima */
} raster_times;

/* A picture to compare: depth in metres with far where nothing is, and radiance of the plain pass. */
typedef struct raster_picture {
    float *depth, *rgb, *map;
} raster_picture;

double raster_now(void); /* ms */

/* Mesa's llvmpipe over EGL with `threads` of its own (0: it draws in the calling thread): takes the least times, fills the
 * picture. -1 and a reason where it cannot run. Must be called once a process: Mesa reads its environment once. */
int llvmpipe_draw(const raster_work *work, int threads, int repeats, raster_times *times, raster_picture *picture,
                  char reason[200]);

#endif
