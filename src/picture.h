/* picture.h - the usual picture, from visibility to the target at once. */
#ifndef TYNI_PICTURE_H
#define TYNI_PICTURE_H

#include "run.h"

#include "base.h"

/* The usual picture: one sun over all of the screen in air that takes from all channels, out of four bytes a pixel into four.
 * Channels are in the order of the medium's least extinction, its largest and the one between. */
typedef struct tyni_picture {
    tyni_medium medium;
    float inverse[3], colour[3];                     /* 1 / extinction; of the sun */
    float between[3];                                /* pixel_between's factors of the least, the largest and their root */
    float base[TYN_MAX_MEDIA], slope[TYN_MAX_MEDIA]; /* Henyey and Greenstein's (1 - g)^2 and 2 g */
    int32_t from_byte[3], shift[3], opaque;          /* in pixels of four bytes; in words */
    float exposure;
    tyn_tone tone;
    /* of a run */
    const uint8_t *from;
    uint8_t *target;
    float offset[24]; /* tyni_composite_offsets */
} tyni_picture;

/* Whether this light's pictures are the usual ones, and if so what is the same in all runs. */
int tyni_picture_begin(const tyni_pass *pass, tyni_picture *picture);

/* A run of which no pixel is rejected. */
void tyni_picture_run(const tyni_pass *pass, const tyni_run *run, tyni_picture *picture);

#endif
