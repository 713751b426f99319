/* ray.h - view rays against a slice's row of thresholds: their lit intervals and their light.
 *
 * There are several ways to find the intervals. They switch at the same columns, so that their light is the same to the byte.
 */
#ifndef TYNI_RAY_H
#define TYNI_RAY_H

#include "medium.h"
#include "row.h"
#include "sweep.h"
#include "tree.h"
#include "view.h"

#include "base.h"

/* Of rays that go this way, where the build has more than one. */
static inline int tyni_ray_way(tyn_rays rays, tyn_rays way)
{
    return TYNI_HAS(TYN_PART_RAYS) && rays == way;
}

/* A row, and how its lit columns are found. */
typedef struct tyni_finder {
    const tyni_row *row;
    int32_t isa;
    tyn_rays rays;             /* not TYN_RAYS_STEPS */
    const tyni_blocks *blocks; /* of the row, for TYN_RAYS_WORDS */
    const tyni_tree *tree;     /* the same, for TYN_RAYS_TREE */
    float coarse;              /* the largest share of a ray's light that a texel may have: see tyni_ray_coarse */
    tyni_sweep *sweep;         /* for TYN_RAYS_SWEEP: it stands at the ray's sample, or is sent there for a bundle */
} tyni_finder;

/* p: of the ray on the slice's line. light[n]: one value for each channel of the integral, which was begun for the same ray v.
 * Returns how many nodes, words or columns were looked at. */
int32_t tyni_ray_row(const tyni_finder *finder, float p, const tyni_lamp *lamp, const tyni_integral *integral,
                     const tyni_sight *v, float *light);

/* True where columns are so coarse for this ray that their thresholds would show (near the epipole): walk instead. */
int tyni_ray_coarse(const tyni_finder *finder, const tyni_integral *integral, const tyni_sight *v);

/* The columns first .. last of a piece that a ray crosses, and where it enters and leaves in step coordinates; 0 if none. */
int tyni_ray_columns(const tyni_row *row, const tyni_piece *piece, const tyni_integral *integral, const tyni_sight *v,
                     int32_t *first, int32_t *last, float *from, float *to);

/* ---- many rays of a white sun at once ---- */

#define TYNI_RAY_BUNDLE 16 /* rays, a whole vector of the widest ISA */
/* Edges of a ray at a time: there it goes into the light or out of it. An even number: then it is back outside. A bundle in
 * which a ray has more is gone through again: of those among leaves 13 % have more than 38, but 1 % more than these. */
#define TYNI_RAY_EDGES 94
#define TYNI_RAY_SPARE 64 /* behind them, for who writes more than there are */

/* Columns, the one behind the last too, and samples fit 16 bits. */
typedef char ray_columns_fit[2 * (TYN_MAX_SHADOW + 4) <= 65535 && TYN_MAX_SIZE <= 65536 ? 1 : -1];

/* All zeros before its first use: where rays have fewer edges than their neighbours, what is there is read and dropped.
 * Rays from t = 0 to `to`; all arrays are per ray. */
typedef struct tyni_bundle {
    int32_t count;
    uint32_t coarse;                  /* bit n: columns are too coarse for ray n: it goes from texel to texel */
    uint16_t sample[TYNI_RAY_BUNDLE]; /* in, the first `count` */
    uint16_t position[TYNI_RAY_BUNDLE];
    float visible[2][TYNI_RAY_BUNDLE]; /* out, by channel */
    float to[TYNI_RAY_BUNDLE];
    float texels[TYNI_RAY_BUNDLE]; /* columns crossed, in steps */
    /* of the piece at hand: r = c + t d and w alike; the steps where the ray comes in and leaves; its next and last column */
    float rc[TYNI_RAY_BUNDLE], rd[TYNI_RAY_BUNDLE], wc[TYNI_RAY_BUNDLE], wd[TYNI_RAY_BUNDLE];
    float from[TYNI_RAY_BUNDLE], until[TYNI_RAY_BUNDLE];
    uint16_t next[TYNI_RAY_BUNDLE], last[TYNI_RAY_BUNDLE];            /* next > last: none */
    uint16_t edges[TYNI_RAY_BUNDLE];                                  /* that wait for their integrals */
    uint16_t edge[TYNI_RAY_BUNDLE * TYNI_RAY_EDGES + TYNI_RAY_SPARE]; /* ray after ray: where it changes, as the row has it */
} tyni_bundle;

/* From `count` and `sample` all the rest. depth: of the slice's samples; most: the frame's max_distance, 0: none; sigma: of the
 * two channels, the larger one second. Returns what was looked at of the row. */
int32_t tyni_ray_bundle(tyni_bundle *bundle, const tyni_finder *finder, const tyni_slice *slice, const tyni_view *view,
                        const float *depth, float most, const tyni_lamp *lamp, const float sigma[2]);

#endif
