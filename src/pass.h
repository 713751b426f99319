/* pass.h - one light on its way through the frame: what its stages share. */
#ifndef TYNI_PASS_H
#define TYNI_PASS_H

#include "door.h"
#include "gather.h"
#include "jobs.h"
#include "medium.h"
#include "prefilter.h"
#include "ray.h"
#include "row.h"
#include "slice.h"
#include "sweep.h"
#include "tree.h"
#include "view.h"

#include "base.h"

/* Pixels of a row that go through their stages together: at most this, nor more than half of a line's samples. A multiple of
 * 16. */
#define TYNI_PASS_RUN 512
#define TYNI_PASS_PLANES 11

/* What one worker needs for one slice, or for a run of pixels: small enough for its caches. */
typedef struct tyni_scratch {
    tyni_row *row;
    uint16_t *threshold, *edge;      /* 2 * tyni_row_room */
    tyni_blocks blocks;              /* of the thresholds */
    float *depth;                    /* points */
    float *value[3];                 /* points: visibility */
    tyni_bundle *bundle;             /* rays side by side, for slices: over the planes, too. Of pixels, TYN_BUNDLE_BYTES */
    float *plane[TYNI_PASS_PLANES];  /* tyni_pass_run each, for pixels */
    uint32_t *breaks, *rays, *fresh; /* bits */
    tyni_node *nodes;                /* TYN_RAYS_TREE, else NULL */
    tyni_sweep sweep;                /* arrays with TYN_RAYS_SWEEP, else NULL */
    tyni_shelf *shelf;               /* TYN_METHOD_HYBRID: the slice's prefiltered rows, else NULL */
    void *mill;                      /* what they are made in, also with TYN_METHOD_PREFILTERED, else NULL */
    tyn_stats *stats;
} tyni_scratch;

typedef struct tyni_pass {
    tyn_context *context;
    const tyn_frame *frame;
    tyni_view view;
    tyni_door depth;
    tyni_medium medium;
    float fog[3]; /* extinction of surfaces */
    const tyni_lamp *lamp;
    tyn_method method;
    tyni_slices slices;
    tyni_field lines;     /* TYN_METHOD_EPIPOLAR, _HYBRID: the finished slices */
    tyni_fourier fourier; /* TYN_METHOD_PREFILTERED, _HYBRID */
    tyni_gather gather;   /* pixels from them */
    tyni_grid grid;       /* rows 0: none; else pixels come from it */
    int naive;            /* from the grid, pixels that nothing fits take what is nearest; else they get rays of their own */
    int32_t channels[3], count; /* the channels whose visibility is kept */
    int first, last;            /* of the lights */
    int quads;                  /* quad.h has the pixels; lines have one scale */
} tyni_pass;

struct tyn_context {
    tyn_config config; /* defaults filled in; isa is the one that was picked */
    size_t bytes;
    int32_t samples;  /* room per line */
    int32_t points;   /* of depths and values in the scratch: samples, or more with downscale */
    tyni_field lines; /* slices * samples; not with TYN_METHOD_PREFILTERED, which has in its place: */
    uint8_t *shelves; /* slices * shelf_bytes, else NULL */
    size_t shelf_bytes;
    tyni_field grid;    /* downscale above 1: the coarse picture; else NULL */
    tyni_spoke *spokes; /* slices; IVB and ED10 */
    int32_t *slots;     /* the same */
    float *light;       /* width * height * 3 with more than one light, else NULL: L_scat of the lights before */
    tyni_jobs_count *counts;
    uint8_t *scratch; /* workers * scratch_bytes */
    size_t scratch_bytes;
    /* of the light in hand: too large for a stack */
    tyni_lamp lamp;
    tyni_pass pass;
};

/* Lines of finished samples: epipolar or hybrid. */
static inline int tyni_pass_sliced(const tyni_pass *p)
{
    return p->method == TYN_METHOD_EPIPOLAR || tyni_prefilter_hybrid(p->method);
}

/* Pixels come from a grid: sub-sampled, or coarse. */
static inline int tyni_pass_gridded(const tyni_pass *p)
{
    return TYNI_HAS(TYN_PART_GATHERS) && p->grid.rows;
}

/* A worker's scratch, and its bytes; before it is placed, only the bytes. */
size_t tyni_pass_scratch(const tyn_context *context, int32_t worker, tyni_scratch *scratch);

/* Pixels of a run: a multiple of 16. */
int32_t tyni_pass_run(const tyn_context *context);

/* The clock; 0 without one. */
uint64_t tyni_pass_now(const tyni_pass *pass);

/* The line of a slice, whatever the layout. */
void tyni_pass_line(const tyni_pass *pass, tyni_slice *slice, int32_t index);

/* The slice and sample nearest to a point on the screen, and how far the point is from the slice's line in pixels. 0: none. */
int tyni_pass_nearest(const tyni_pass *pass, float x, float y, int32_t *index, int32_t *sample, float *distance);

/* The part of a ray of length s that the light reaches. 0: none. */
int tyni_pass_range(const tyni_pass *pass, const tyni_sight *v, float s, float *t0, float *t1);

/* Visibility of a ray of length s in the kept channels, by an exact walk or by fixed steps over the maps; not counted. */
void tyni_pass_walk(const tyni_pass *pass, const tyni_sight *v, float s, float value[3]);

/* Light of the kept channels as visibility. */
void tyni_pass_visible(const tyni_pass *pass, const float light[3], const float norm[3], float value[3]);

/* Clears the entries of a line. */
void tyni_pass_clear(const tyni_field *field, int32_t line);

/* Packs samples first .. last of a line from the scratch's depths and values; each line has the scale of its largest value. */
void tyni_pass_store(const tyni_pass *pass, const tyni_field *field, int32_t line, int32_t first, int32_t last,
                     const tyni_scratch *scratch);

#endif
