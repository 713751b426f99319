/* pane.c - see pane.h */
#include "pane.h"

#include <math.h>
#include <string.h>

#include "test.h"

static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};

void pane_set(pane *q)
{
    for (int i = 0; i < 4; i++)
        for (int c = 0; c < 3; c++)
            q->corner[3 * i + c] = (float)(q->p[c] + (i == 1 || i == 2 ? q->a[c] : 0) + (i >= 2 ? q->b[c] : 0));
    memset(&q->mesh, 0, sizeof q->mesh);
    q->mesh.positions = q->corner;
    q->mesh.indices = order;
    q->mesh.vertices = 4;
    q->mesh.triangles = 2;
    for (int c = 0; c < 3; c++)
        q->mesh.material.albedo[c] = 0.25f * (float)(c + 1);
}

void pane_map(pane *q, float u0, float du, float v0, float dv)
{
    for (int i = 0; i < 4; i++) {
        q->coord[2 * i] = u0 + (i == 1 || i == 2 ? du : 0);
        q->coord[2 * i + 1] = v0 + (i >= 2 ? dv : 0);
    }
    q->mesh.texcoords = q->coord;
}

int pane_hit(const pane *q, const easel *e, int32_t x, int32_t y, double point[3], double *s, double *t)
{
    double ray[3], normal[3], w, side[3], d[3];
    easel_ray(&e->surface.camera, e->depth.image.width, e->depth.image.height, x, y, ray);
    ray[2] = -1;
    easel_cross(q->a, q->b, normal);
    w = easel_dot(normal, q->p) / easel_dot(normal, ray);
    for (int c = 0; c < 3; c++) {
        point[c] = w * ray[c];
        d[c] = point[c] - q->p[c];
    }
    easel_cross(d, q->b, side);
    *s = easel_dot(side, normal) / easel_dot(normal, normal);
    easel_cross(q->a, d, side);
    *t = easel_dot(side, normal) / easel_dot(normal, normal);
    return w > 0 && *s > 0.01 && *s < 0.99 && *t > 0.01 && *t < 0.99;
}

void pane_lean(pane *q, double depth)
{
    for (int c = 0; c < 3; c++) {
        q->a[c] = (c == 0 ? 2 * depth : 0) + (double)test_random_float(-0.4f, 0.4f) * depth;
        q->b[c] = (c == 1 ? 2 * depth : 0) + (double)test_random_float(-0.4f, 0.4f) * depth;
        q->p[c] = (c == 2 ? -depth : 0) - 0.5 * (q->a[c] + q->b[c]);
    }
    pane_set(q);
}

void pane_normal(const pane *q, double n[3])
{
    double length;
    easel_cross(q->a, q->b, n);
    length = sqrt(easel_dot(n, n)) * (easel_dot(n, q->p) > 0 ? -1 : 1);
    for (int c = 0; c < 3; c++)
        n[c] /= length;
}

/* ---- light on it --------------------------------------------------------------------------------------------------- */

tyn_light pane_light(tyn_light_kind kind)
{
    tyn_light l;
    double d[3], length;
    memset(&l, 0, sizeof l);
    l.kind = kind;
    for (int c = 0; c < 3; c++) {
        d[c] = (double)test_random_float(-1, 1) - (c == 2 && kind == TYN_LIGHT_SPOT ? 1.2 : 0);
        l.position[c] = test_random_float(-2, 2);
        l.colour[c] = test_random_float(0, 10);
    }
    length = sqrt(easel_dot(d, d));
    for (int c = 0; c < 3; c++)
        l.direction[c] = (float)(d[c] / length);
    l.angle = test_random_float(0.3f, 2.9f);
    return l;
}

void pane_add_light(const tyn_light *l, const double point[3], const double n[3], const double sigma[3], double sum[3],
                    double *edge)
{
    double to[3], r = 1, cosine = 0;
    for (int c = 0; c < 3; c++)
        to[c] = l->kind == TYN_LIGHT_DIRECTIONAL ? -(double)l->direction[c] : (double)l->position[c] - point[c];
    r = sqrt(easel_dot(to, to));
    for (int c = 0; c < 3; c++)
        cosine -= to[c] * (double)l->direction[c] / r;
    if (l->kind == TYN_LIGHT_SPOT) {
        const double off = acos(cosine > 1 ? 1 : cosine) - 0.5 * (double)l->angle;
        *edge = fabs(off) < *edge ? fabs(off) : *edge;
        if (off > 0)
            return;
    }
    for (int c = 0; c < 3; c++) {
        const double dim = l->kind == TYN_LIGHT_DIRECTIONAL ? 1 : exp(-sigma[c] * r) / (r * r);
        const double facing = easel_dot(n, to) / r;
        sum[c] += (double)l->colour[c] * dim * (facing > 0 ? facing : 0);
    }
}
