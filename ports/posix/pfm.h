/* pfm.h - float images as files. */
#ifndef TOOL_PFM_H
#define TOOL_PFM_H

#include <stdint.h>
#include <stdio.h>

#include "error.h"

typedef struct pfm {
    int32_t width, height, channels; /* channels: 1 or 3 */
    float *values;                   /* top row first; free() it */
} pfm;

/* Both byte orders. -1: error set. */
int pfm_load(pfm *image, const char *path, tool_error *error);

/* Little-endian, scale -1.0, bottom row first. `values` has the top row first, without gaps. -1: errno says why. */
int pfm_write(FILE *file, const float *values, int32_t width, int32_t height, int32_t channels);

#endif
