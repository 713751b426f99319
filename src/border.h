/* border.h - ED10's and IVB's layout of epipolar lines: through points equidistant along the screen's border.
 *
 * A line's exit is a border point, its entry the epipole where that is on the screen, else the last crossing of the border
 * before the exit (IVB section 6.1, figures 11 and 12). Border points on the side from which the light shines in are no exits:
 * their lines would lie outside, and the slots around the border that they take have none (ED10 section 5.1 masks them by
 * stencil). The border runs through the centres of the outermost pixels. */
#ifndef TYNI_BORDER_H
#define TYNI_BORDER_H

#include "slice.h"
#include "view.h"

#include "base.h"

/* slices->spokes and ->slots have room for `slots`. `stretch`: a line shorter in pixels than it has samples gets its exit moved
 * outwards until one sample is one pixel (IVB figure 14); what then lies off the screen is skipped. Without, short lines are
 * sampled more densely (ED10). samples >= 2. */
void tyni_border_layout(tyni_slices *slices, const tyni_lamp *lamp, int32_t width, int32_t height, int32_t slots,
                        int32_t samples, int stretch);

/* All of slice `index`. */
void tyni_border_line(tyni_slice *slice, const tyni_slices *slices, const tyni_lamp *lamp, const tyni_view *view,
                      int32_t index);

/* The two slots on either side of the line from the epipole through (x, y), the second as far beyond the first as `blend` 0 ..
 * 1 says; 0 at the epipole itself. */
int tyni_border_find(const tyni_slices *slices, float x, float y, int32_t slot[2], float *blend);

/* Slice of a slot, any whole number: the border is a ring. -1: none. */
static inline int32_t tyni_border_slice(const tyni_slices *slices, int32_t slot)
{
    int32_t n = slices->slot_count;
    return n ? slices->slots[slot < 0 ? slot + n : slot >= n ? slot - n : slot] : -1;
}

#endif
