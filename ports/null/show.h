/* show.h - one small program for every machine: draws the hall of scene.h and the light in it. A port brings a block of memory
 * and takes pixels; see README.md. */
#ifndef NULL_SHOW_H
#define NULL_SHOW_H

#include "scene.h"

/* As TYN_PRESET_HANDHELD has it for pictures up to 512 x 512; rows of the picture that are rasterized together; triangles
 * that are. */
#define SHOW_MAP 256
#define SHOW_BAND 16
#define SHOW_BATCH 64

/* Bytes of a show of this size, as a constant expression for a static block. */
#define SHOW_MEMORY(width, height, workers)                                                                                    \
    (SHOW_ROUND(sizeof(scene)) + SHOW_ROUND(4 * SHOW_MAP * SHOW_MAP) + SHOW_ROUND(2 * (size_t)(width) * (height)) +            \
     SHOW_ROUND(16 * (size_t)(width)*SHOW_BAND) +                                                                              \
     TYN_RASTER_MEMORY(SHOW_MOST(width, SHOW_MAP), SHOW_MAP, SHOW_BATCH, workers) +                                            \
     TYN_MEMORY(width, height, SHOW_SLICES(width, height), SHOW_MOST(width, height) / 2 + 1, SHOW_MAP, 1, workers))
#define SHOW_SLICES(width, height) SHOW_MOST(SHOW_LEAST(((width) + (height)) / 8, 256), 16)
#define SHOW_MOST(a, b) ((a) > (b) ? (a) : (b))
#define SHOW_LEAST(a, b) ((a) < (b) ? (a) : (b))
#define SHOW_ROUND(bytes) (((size_t)(bytes) + TYN_ALIGNMENT - 1) / TYN_ALIGNMENT * TYN_ALIGNMENT)

typedef struct show {
    int32_t width, height;
    scene *scene;
    float *map, *colour, *deep; /* colour and deep: of a band */
    uint16_t *depth;            /* of the picture: SCENE_FAR / 65535 metres each */
    tyn_raster *raster;
    tyn_context *context;
    const tyn_executor *executor;
    tyn_clock clock; /* the port may set it */
    tyn_stats stats; /* of the last picture */
} show;

/* Places a show in a block that is aligned to TYN_ALIGNMENT. `executor`: as in tyndall.h, and as long as the show; may be NULL.
 */
tyn_status show_open(show *s, int32_t width, int32_t height, const tyn_executor *executor, void *memory, size_t bytes);

/* The surfaces into `picture`, which has any colour format but floats; then the light in the air over them. Two calls, so that
 * they can be measured apart: an engine has the first itself. */
tyn_status show_surfaces(show *s, float moment, const tyn_image *picture);
tyn_status show_light(show *s, const tyn_image *picture);

#endif
