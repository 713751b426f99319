/* frame.h - all stages in order, as jobs. */
#ifndef TYNI_FRAME_H
#define TYNI_FRAME_H

#include "arena.h"
#include "jobs.h"
#include "row.h"
#include "view.h"

#include "base.h"

/* What one worker needs for one slice: small enough for its caches. */
typedef struct tyni_scratch {
    tyni_row *row;
    uint16_t *threshold;             /* 2 * tyni_row_room */
    float *split;                    /* tyni_row_room */
    float *depth;                    /* samples */
    float *value[3];                 /* samples: visibility, low and high */
    uint32_t *breaks, *rays, *fresh; /* bits */
    tyn_stats *stats;
} tyni_scratch;

struct tyn_context {
    tyn_config config; /* defaults filled in */
    size_t bytes;
    int32_t samples;    /* room per line */
    uint32_t *entries;  /* slices * samples */
    uint16_t *thirds;   /* the same, with config.textured, else NULL */
    float (*scales)[3]; /* slices */
    float *light;       /* width * height * 3 with more than one light, else NULL: L_scat of the lights before */
    tyni_jobs_count *counts;
    uint8_t *scratch; /* workers * scratch_bytes */
    size_t scratch_bytes;
    tyni_lamp lamp; /* of the light in hand: too large for a stack */
};

/* Carves a context for a config with its defaults filled in; in an arena without a block it only counts. */
void tyni_frame_place(tyn_context *context, tyni_arena *arena);

/* All of tyn_render but for the checks. */
tyn_status tyni_frame_render(tyn_context *context, const tyn_frame *frame);

#endif
