/* ray.h - one view ray against a slice's row of thresholds: its lit intervals and their light.
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

#endif
