/* fit.h - the shadow map's matrix for a light and what a camera sees. */
#ifndef TYNI_FIT_H
#define TYNI_FIT_H

#include "base.h"

/* low NULL: no box. All arguments checked. */
void tyni_fit_directional(float matrix[16], const tyn_light *light, const tyn_camera *camera, const float low[3],
                          const float high[3]);
void tyni_fit_spot(float matrix[16], const tyn_light *light, const tyn_camera *camera, const float low[3], const float high[3]);

#endif
