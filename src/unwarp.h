/* unwarp.h - visibility of a run's pixels from the lines beside each. Samples lie on columns or rows of pixels, so that lines
 * are read as they lie in memory. */
#ifndef TYNI_UNWARP_H
#define TYNI_UNWARP_H

#include "run.h"

#include "base.h"

/* Samples of a band's pixels. */
#define TYNI_UNWARP_SAMPLES (TYNI_PIXEL_BAND + 1)

/* Entries of lines along y as rows of pixels want them: lines side by side, sample after sample. Of one run of pixels in one
 * band. */
typedef struct tyni_tile {
    const tyni_sector *sector;
    int32_t low, count; /* lines of the field */
    int32_t sample, samples;
    int32_t room;                       /* lines */
    uint32_t *row[TYNI_UNWARP_SAMPLES]; /* with `room` + 16 words: vectors are read from any line on */
} tyni_tile;

/* What follows from the depths of the run's pixels: nearness, reach and cosine. */
void tyni_unwarp_sights(const tyni_pass *pass, const tyni_run *run);

/* The part of each ray that the light reaches, the visibility there, and which pixels fit nothing. The tile's room and rows are
 * given; its sector is NULL before a band's first row. */
void tyni_unwarp_run(const tyni_pass *pass, tyni_run *run, tyni_tile *tile);

#endif
