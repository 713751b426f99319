/* art.h - controls that bend physics on request: what they mean, in one place for all methods. Zeros are physics, to the bit.
 */
#ifndef TYNI_ART_H
#define TYNI_ART_H

#include "view.h"

#include "base.h"

/* A factor as the public structs hold it: 0 means 1, below 0 means 0. */
static inline float tyni_art_factor(float control)
{
    return control > 0.0f ? control : control < 0.0f ? 0.0f : 1.0f;
}

/* Scale and tint of a light's scattered light, and the frame's contrast of shadows, into a lamp that is set. */
void tyni_art_lamp(tyni_lamp *lamp, const tyn_light *light, const tyn_frame *frame);

/* Extinction of surfaces. */
void tyni_art_fog(float fog[3], const float sigma[3], const tyn_frame *frame);

/* The length of a ray beyond which nothing scatters or is attenuated: s, or less. */
static inline float tyni_art_reach(const tyn_frame *frame, float s)
{
    return frame->max_distance > 0.0f ? tyni_minf(frame->max_distance, s) : s;
}

/* The frame's controls at the door; a light's are its own (check.h). */
tyn_status tyni_art_check(const tyn_frame *frame);

#endif
