/* trace.h - rays along slices and on grids: from depth to finished lines of visibility. Jobs of tyni_jobs_run; the argument is
 * a tyni_pass. */
#ifndef TYNI_TRACE_H
#define TYNI_TRACE_H

#include "pass.h"
#include "ray.h"
#include "tree.h"

#include "base.h"

/* Lays out the slices. */
void tyni_trace_layout(tyni_pass *pass);

/* A slice: depth along its line -> breaks -> ray samples -> row of thresholds -> visibility at the rays, refined
 * -> interpolation -> the finished line. */
void tyni_trace_slice(void *pass, int32_t index, int32_t worker);

/* TYN_METHOD_PREFILTERED: a slice's depth and row of thresholds -> its prefiltered rows. */
void tyni_trace_shelf(void *pass, int32_t index, int32_t worker);

/* The first half of that, for those who look at rows: up to the row and what finds its lit columns; 0 where there is none. */
int tyni_trace_row(const tyni_pass *pass, int32_t index, tyni_slice *slice, tyni_scratch *scratch, tyni_finder *finder,
                   tyni_tree *tree);

/* TYN_METHOD_SUBSAMPLE: lays out a grid of about config.budget points. */
void tyni_trace_spread(tyni_pass *pass);

/* Lays out the coarse picture of config.downscale. */
void tyni_trace_coarse(tyni_pass *pass);

/* A row of the grid: each point by a ray of its own, or from the slices, where there are any. */
void tyni_trace_grid(void *pass, int32_t index, int32_t worker);

#endif
