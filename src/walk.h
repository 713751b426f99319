/* walk.h - one view ray against the shadow maps themselves.
 *
 * light[n]: one value for each channel of the integral, which was begun for the same ray v. */
#ifndef TYNI_WALK_H
#define TYNI_WALK_H

#include "medium.h"
#include "view.h"

#include "base.h"

/* Exact on the map: a walk over its texels, each a box from its depth away from the light; enters and leaves shadows inside
 * texels as well. The library's own truth. `pace` above 1: of so many texels along the map's longer axis one stands for all,
 * where a picture is as coarse as that. */
void tyni_walk_ray(int32_t isa, const tyni_lamp *lamp, const tyni_integral *integral, const tyni_sight *v, int32_t pace,
                   float *light);

/* ED10's march: `steps` equal steps inside the light's frustum, the shadow map sampled in the middle of each. All three
 * channels. */
void tyni_walk_steps(int32_t isa, const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float t0, float t1,
                     int32_t steps, float light[3]);

/* L_scat of a ray of length s by a ray of its own: all channels, colour and phase function included. */
void tyni_walk_pixel(int32_t isa, const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float s, int32_t pace,
                     float light[3]);
void tyni_walk_pixel_steps(int32_t isa, const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float s,
                           int32_t steps, float light[3]);

#endif
