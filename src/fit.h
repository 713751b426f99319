/* fit.h - the shadow map's matrix for a light and what a camera sees. All arguments are checked before. */
#ifndef TYNI_FIT_H
#define TYNI_FIT_H

#include "vec.h"

#include "base.h"

/* What may cast: triangles, or a box, or (mesh_count 0 and low NULL) anything anywhere. */
typedef struct tyni_fit_casters {
    const tyn_mesh *meshes;
    int32_t mesh_count;
    const float *low, *high;
} tyni_fit_casters;

/* depth NULL: as far as the camera can see. */
void tyni_fit_directional(float matrix[16], const tyn_light *light, const tyn_camera *camera, const tyn_image *depth,
                          const tyni_fit_casters *casters);
void tyni_fit_spot(float matrix[16], const tyn_light *light, const tyn_camera *camera, const tyni_fit_casters *casters);

/* A light's direction of length 1 and two axes across it, which depend on it alone. */
void tyni_fit_axes(tyni_vec3 direction, tyni_vec3 *d, tyni_vec3 *a, tyni_vec3 *b);

void tyni_fit_face(float matrix[16], const float position[3], int32_t face, float reach, int32_t texels);

#endif
