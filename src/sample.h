/* sample.h - samples along a slice's line (ED10 section 4.2, IVB section 6.2): depth, break bits, ray samples, and the two
 * sources of every other sample. Bits are packed 32 to a word; bit j of a line is bit j % 32 of word j / 32. */
#ifndef TYNI_SAMPLE_H
#define TYNI_SAMPLE_H

#include "door.h"
#include "slice.h"
#include "view.h"

#include "base.h"

static inline int32_t tyni_sample_words(int32_t samples)
{
    return (samples + 31) / 32;
}
static inline int tyni_sample_bit(const uint32_t *words, int32_t j)
{
    return (int)(words[j >> 5] >> (j & 31) & 1u);
}

/* Arrays over samples have room for whole vectors. isa: of tyni_lanes_choose. */

/* depth[j] for first .. last: view-space depth of the pixel under each sample (the nearest on the screen), 0 .. far; and 0
 * before the first, as far back as breaks are looked for in whole words. */
void tyni_sample_depths(float *depth, int32_t isa, const tyni_slice *slice, const tyni_view *view, const tyni_door *door);

/* How far from the axis origin - light the rays of a line get: a ray's end is its depth times the point of the pixel plane
 * (perspective) or beyond it (orthographic), and both are linear along the line. A hair more, since rays end elsewhere in
 * floats. */
float tyni_sample_reach(const float *depth, int32_t isa, const tyni_slice *slice, const tyni_view *view);

/* Sets bit j where depth jumps between j and j + 1 by more than `threshold` of the nearer one; clears all others. Returns how
 * many. Samples off the screen are no part of first .. last, so the ends of a line need no breaks. */
int32_t tyni_sample_breaks(uint32_t *breaks, int32_t isa, const float *depth, int32_t first, int32_t last, float threshold);

/* The same near a lamp: also sets the bits where depth jumps by more than `threshold` of the nearer one's distance to it. What
 * a ray gathers there changes with that, not with the way from the camera. Returns how many more. */
int32_t tyni_sample_breaks_at(uint32_t *breaks, const float *depth, const tyni_slice *slice, const tyni_view *view,
                              tyni_vec3 lamp, float threshold);

/* Sets the bits of the ray samples: every `step`th, every quarter of that near the epipole, both sides of every break, the
 * first and the last. Returns how many. */
int32_t tyni_sample_rays(uint32_t *rays, const uint32_t *breaks, const tyni_slice *slice, int32_t step);

/* The next set bit at or after j, at most last; last + 1 if there is none. */
int32_t tyni_sample_next(const uint32_t *words, int32_t j, int32_t last);

/* Refinement on light (method.md section 4): where the middle of three neighbouring rays lies off the line through the outer
 * two by more than `tolerance` in any of `values` values, both halves get a ray in the middle; so does a stretch between breaks
 * that has no rays but its ends. Nothing is computed just to be tested. `fresh`: the rays since the last call, at first all;
 * it gets the bits of the new ones, `rays` too. A stretch of `least` samples or fewer, least > 0, gets none. Returns how many;
 * call again with their values until it is 0. */
int32_t tyni_sample_refine(uint32_t *fresh, uint32_t *rays, const uint32_t *breaks, int32_t isa, float *const value[3],
                           int32_t count, int32_t first, int32_t last, float tolerance, int32_t least);

/* Fills the samples between ray samples by linear interpolation of their sources, which are the ray samples on either side: a
 * break has rays on both sides, so that no pair of sources ever spans one. */
void tyni_sample_interpolate(float *const value[3], int32_t count, int32_t isa, const uint32_t *rays, int32_t first,
                             int32_t last);

#endif
