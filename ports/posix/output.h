/* output.h - files that appear whole or not at all: written beside their place, renamed when all are complete. */
#ifndef TOOL_OUTPUT_H
#define TOOL_OUTPUT_H

#include <stdint.h>
#include <stdio.h>

#include "error.h"

typedef enum output_kind { OUTPUT_UNKNOWN, OUTPUT_PNG, OUTPUT_PPM, OUTPUT_PFM, OUTPUT_RGB565, OUTPUT_RGBA } output_kind;

/* By the ending of the name, in any case. */
output_kind output_kind_of(const char *path);

#define OUTPUT_MAX 128 /* render --frame: four pictures, the frame, and of 16 lights a texture and six maps each */

typedef struct output_set {
    struct output {
        char *path, *temporary; /* temporary NULL: a device or pipe, written in place */
        char *old;              /* what the file that is replaced is called meanwhile */
        int kept, fresh;        /* it is called so; there was none */
        FILE *file;
    } all[OUTPUT_MAX];
    int count;
} output_set;

/* Opens one more; before the work, so that a folder without permission is known at once. NULL: error set. A new file gets the
 * mode of the one that it replaces. */
FILE *output_open(output_set *set, const char *path, tool_error *error);

/* The message for a failed write to the last opened or to a given file, by errno. Returns -1. */
int output_failed(const output_set *set, const FILE *file, tool_error *error);

/* Closes and renames all. -1: error set, and all is as it was before. */
int output_commit(output_set *set, tool_error *error);

/* Removes what was written. Harmless after output_commit. */
void output_abort(output_set *set);

/* Display pictures: `pixels` is what the library wrote, RGBA8 or (OUTPUT_RGB565) 16 bit. -1: errno says why. */
int output_picture(FILE *file, output_kind kind, const void *pixels, int32_t width, int32_t height);

#endif
