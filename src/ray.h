/* ray.h - one view ray against the shadows: its lit intervals and their light.
 *
 * All of these add up integral(end) - integral(start) over the lit intervals (IVB eq. 15 and 16), or sample it in fixed steps.
 * The integral was begun for the same ray v. light[n]: one value for each channel of the integral. */
#ifndef TYNI_RAY_H
#define TYNI_RAY_H

#include "medium.h"
#include "row.h"
#include "vec.h"
#include "view.h"

#include "base.h"

/* Exact on the map: a walk over its texels, each a box from its depth away from the light; enters and leaves shadows inside
 * texels as well. The library's own truth. */
void tyni_ray_walk(const tyni_lamp *lamp, const tyni_integral *integral, const tyni_sight *v, float *light);

/* Against a row of thresholds: 32 columns a time become a word of visibility, and its transitions are found by bit scans. p: of
 * the ray on the slice's line. */
void tyni_ray_row(const tyni_row *row, float p, const tyni_lamp *lamp, const tyni_integral *integral, const tyni_sight *v,
                  float *light);

/* True where columns are so coarse for this ray that their thresholds would show (near the epipole): walk instead. */
int tyni_ray_coarse(const tyni_row *row, const tyni_integral *integral, const tyni_sight *v);

/* ED10's march: `steps` equal steps, the shadow map sampled in the middle of each. All three channels. */
void tyni_ray_steps(const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float t0, float t1, int32_t steps,
                    float light[3]);

/* L_scat of a ray of length s by a ray of its own: all channels, colour and phase function included. steps 0: exact. */
void tyni_ray_pixel(const tyni_lamp *lamp, const tyni_medium *medium, const tyni_sight *v, float s, int32_t steps,
                    float light[3]);

#endif
