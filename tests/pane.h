/* pane.h - a quad before an easel's camera, and the light on it by formulas in double precision. */
#ifndef TYN_TEST_PANE_H
#define TYN_TEST_PANE_H

#include "easel.h"

#define PANE_PI 3.14159265358979

/* A parallelogram p + s a + t b as two triangles. */
typedef struct pane {
    double p[3], a[3], b[3];
    float corner[12], coord[8];
    tyn_mesh mesh;
} pane;

/* Corners and mesh, from p, a and b. */
void pane_set(pane *q);

/* Texture coordinates u0 + s du, v0 + t dv. */
void pane_map(pane *q, float u0, float du, float v0, float dv);

/* Where a pixel's ray from the origin meets the quad's plane: the point, s and t. 0 outside 0 .. 1 less a margin. */
int pane_hit(const pane *q, const easel *e, int32_t x, int32_t y, double point[3], double *s, double *t);

/* Fills most of the view, leaning. */
void pane_lean(pane *q, double depth);

/* Towards the camera, which is at the origin. */
void pane_normal(const pane *q, double n[3]);

/* Anywhere, of any colour; without a map. */
tyn_light pane_light(tyn_light_kind kind);

/* What the light gives at a point of normal n, without shadows, per channel; *edge: how far from the cone's edge, radians. */
void pane_add_light(const tyn_light *l, const double point[3], const double n[3], const double sigma[3], double sum[3],
                    double *edge);

#endif
