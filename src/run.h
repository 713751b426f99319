/* run.h - a run of pixels on its way from visibility to the picture: what unwarp.c, picture.c and pixel.c share. */
#ifndef TYNI_RUN_H
#define TYNI_RUN_H

#include "pass.h"

#include "base.h"

#define TYNI_PIXEL_BAND 8 /* rows of pixels a job */

/* A run of pixels in one row. Its planes lie in the worker's scratch and have room for a multiple of 16 pixels. */
typedef struct tyni_run {
    int32_t x, y, count;
    const float *depth; /* as in the depth image */
    float *nearness;    /* a length along the ray times this is a depth relative to far */
    float *reach;       /* metres to where the ray ends: the surface, or the frame's max_distance; 0: no ray */
    float *cosine;      /* of the ray and the way to the light: directional lights */
    float *from, *to;   /* the part of the ray that the light reaches; to = 0: none. Unbounded lights: 0, reach */
    float *value[3];    /* visibility */
    float *light[3];    /* L_scat so far */
    float *share[3];    /* of the surface's light, what is left; where `cosine`, `from` and `to` were */
    int shared;         /* pixel_shade finds it on the way: the last light, all of each ray, the medium's own extinction */
    uint32_t *rejected; /* bits */
    void *mill;
    tyn_stats *stats;
    uint64_t now;            /* the clock, when the last run in rows below one another was done */
    uint64_t walked, row[2]; /* what rays of their own took in these rows; up to the light and from there on in the last one */
} tyni_run;

#endif
