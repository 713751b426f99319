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

/* A row, and how its lit columns are found. */
typedef struct tyni_finder {
    const tyni_row *row;
    int32_t isa;
    tyn_rays rays;           /* not TYN_RAYS_STEPS */
    const tyni_tree *tree;   /* of the row, for TYN_RAYS_TREE */
    const tyni_sweep *sweep; /* for TYN_RAYS_SWEEP: it stands at the ray's sample */
} tyni_finder;

/* p: of the ray on the slice's line. light[n]: one value for each channel of the integral, which was begun for the same ray v.
 * Returns how many nodes, words or columns were looked at. */
int32_t tyni_ray_row(const tyni_finder *finder, float p, const tyni_lamp *lamp, const tyni_integral *integral,
                     const tyni_sight *v, float *light);

/* True where columns are so coarse for this ray that their thresholds would show (near the epipole): walk instead. */
int tyni_ray_coarse(const tyni_row *row, const tyni_integral *integral, const tyni_sight *v);

/* The columns first .. last of a piece that a ray crosses, and where it enters and leaves in step coordinates; 0 if none. */
int tyni_ray_columns(const tyni_piece *piece, const tyni_integral *integral, const tyni_sight *v, int32_t *first, int32_t *last,
                     float *from, float *to);

/* ---- many rays of a white sun at once ---- */

#define TYNI_RAY_BUNDLE 16 /* rays, a whole vector of the widest ISA */
#define TYNI_RAY_EDGES 64  /* places where rays go into or out of the light, that are waiting for their integrals */

/* Rays from 0 to `to` along d; all arrays are per ray. */
typedef struct tyni_bundle {
    int32_t count;
    float p[TYNI_RAY_BUNDLE], depth[TYNI_RAY_BUNDLE];   /* in: places on the slice's line, depths; to the end repeat the last */
    float d[3][TYNI_RAY_BUNDLE], o[3][TYNI_RAY_BUNDLE]; /* the ray, and where it starts */
    float to[TYNI_RAY_BUNDLE];
    float all[2][TYNI_RAY_BUNDLE]; /* the integral over all of the ray, by channel */
    float sum[2][TYNI_RAY_BUNDLE]; /* of what differs from `outside` */
    float texels[TYNI_RAY_BUNDLE]; /* columns crossed, in steps */
    /* of the piece at hand: r = c + t d and w alike; the steps where the ray comes in and leaves */
    float rc[TYNI_RAY_BUNDLE], rd[TYNI_RAY_BUNDLE], wc[TYNI_RAY_BUNDLE], wd[TYNI_RAY_BUNDLE];
    float from[TYNI_RAY_BUNDLE], until[TYNI_RAY_BUNDLE];
    int32_t edges;
    float t[TYNI_RAY_EDGES], value[2][TYNI_RAY_EDGES];
    uint8_t ray[TYNI_RAY_EDGES], on[TYNI_RAY_EDGES];
} tyni_bundle;

/* Sets all but the counts of edges from p and depth; `most`: the frame's max_distance, 0: none. */
void tyni_ray_bundle(tyni_bundle *bundle, int32_t isa, const tyni_slice *slice, const tyni_view *view, float most,
                     const float sigma[2]);

/* Visibility of ray `n` is then 1 - sum / all of it, or sum / all where all else is dark, unless columns are too coarse for
 * it: tyni_ray_bundle_coarse. `channels`: 1 or 2. For TYN_RAYS_SWEEP the bundle has one ray. Returns what was looked at. */
int32_t tyni_ray_bundle_row(tyni_bundle *bundle, const tyni_finder *finder, int outside, const float sigma[2],
                            int32_t channels);

static inline int tyni_ray_bundle_coarse(const tyni_bundle *b, int32_t n, float sigma)
{
    return tyni_maxf(1.0f, sigma * b->to[n]) > 0.05f * b->texels[n];
}

#endif
