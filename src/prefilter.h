/* prefilter.h - prefiltered rows in a frame: TYN_METHOD_PREFILTERED keeps the rows of all slices and looks up every pixel in
 * the two beside it; TYN_METHOD_HYBRID has one slice's rows at a time, in the place of its exact rays. */
#ifndef TYNI_PREFILTER_H
#define TYNI_PREFILTER_H

#include "lookup.h"
#include "slice.h"
#include "view.h"

#include "base.h"

static inline int tyni_prefilter_kept(tyn_method method)
{
    return TYNI_HAS(TYN_PART_PREFILTERED) && method == TYN_METHOD_PREFILTERED;
}
static inline int tyni_prefilter_hybrid(tyn_method method)
{
    return TYNI_HAS(TYN_PART_PREFILTERED) && method == TYN_METHOD_HYBRID;
}
static inline int tyni_prefilter_method(tyn_method method)
{
    return tyni_prefilter_kept(method) || tyni_prefilter_hybrid(method);
}

/* Sets of rows that a config has room for: coloured light needs one a channel. */
int32_t tyni_prefilter_sets(const tyn_config *config);

/* Bytes of a slice's rows, a multiple of 8, and of a worker's scratch. */
size_t tyni_prefilter_bytes(const tyn_config *config);
size_t tyni_prefilter_scratch(const tyn_config *config);

void tyni_prefilter_begin(tyni_fourier *f, const tyn_config *config, const tyni_lamp *lamp, const tyni_medium *medium,
                          const tyni_view *view);

/* A slice's rows. `depth` of its samples, clamped to where the light reaches; 0: no ray. */
void tyni_prefilter_slice(const tyni_fourier *f, tyni_shelf *shelf, void *scratch, const tyni_row *row, const tyni_slice *slice,
                          const tyni_view *view, const float *depth);

/* The light of a ray without shadows, that its visibility multiplies: closer than tyni_integral_norm, which
 * may be a stand-in. */
void tyni_prefilter_light(const tyni_fourier *f, const tyni_sight *v, float t0, float t1, float light[3]);

/* Visibility of a ray at p of the line of a slice, in all three channels. 0: it wants a ray of its own. */
int tyni_prefilter_ray(const tyni_fourier *f, const tyni_shelf *shelf, float p, const tyni_sight *v, float t0, float t1,
                       float value[3]);

#endif
