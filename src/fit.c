/* fit.c - see fit.h */
#include "fit.h"

#include <math.h>

#include "base.h"
#include "num.h"
#include "vec.h"

/* Texels of margin on each side: a nearest-texel look-up at the rim must find what lies there. */
#define MARGIN 2.0f
#define MOST 24 /* corners of a polygon: 5 of the view, cut by at most 8 edges of the box, and room */

typedef struct point {
    float x, y;
} point;

typedef struct polygon {
    point p[MOST];
    int32_t n;
} polygon;

/* Two axes across a direction. */
static void axes(tyni_vec3 d, tyni_vec3 *a, tyni_vec3 *b)
{
    tyni_vec3 other = tyni_absf(d.y) < 0.9f ? tyni_vec(0.0f, 1.0f, 0.0f) : tyni_vec(1.0f, 0.0f, 0.0f);
    *a = tyni_vec_normalise(tyni_vec_cross(d, other));
    *b = tyni_vec_cross(*a, d);
}

static float turn(point a, point b, point c)
{
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Convex hull by gift wrapping, counter-clockwise; n is 8 at most. */
static void hull(polygon *out, const point *p, int32_t n)
{
    int32_t start = 0, at, next;
    for (int32_t i = 1; i < n; i++)
        if (p[i].x < p[start].x || (p[i].x == p[start].x && p[i].y < p[start].y))
            start = i;
    at = start;
    out->n = 0;
    do {
        out->p[out->n++] = p[at];
        next = at == 0 ? 1 : 0;
        for (int32_t i = 0; i < n; i++) {
            float side = turn(p[at], p[next], p[i]);
            float di = (p[i].x - p[at].x) * (p[i].x - p[at].x) + (p[i].y - p[at].y) * (p[i].y - p[at].y);
            float dn = (p[next].x - p[at].x) * (p[next].x - p[at].x) + (p[next].y - p[at].y) * (p[next].y - p[at].y);
            if (i != at && (side < 0.0f || (side == 0.0f && di > dn)))
                next = i;
        }
        at = next;
    } while (at != start && out->n < n);
}

/* Cuts a convex polygon to the left of the line a - b. */
static void cut(polygon *poly, point a, point b)
{
    polygon in = *poly;
    poly->n = 0;
    for (int32_t i = 0; i < in.n; i++) {
        point p = in.p[i], q = in.p[i + 1 < in.n ? i + 1 : 0];
        float fp = turn(a, b, p), fq = turn(a, b, q);
        if (fp >= 0.0f && poly->n < MOST)
            poly->p[poly->n++] = p;
        if ((fp >= 0.0f) != (fq >= 0.0f) && poly->n < MOST) {
            float f = fp / (fp - fq);
            poly->p[poly->n].x = p.x + f * (q.x - p.x);
            poly->p[poly->n++].y = p.y + f * (q.y - p.y);
        }
    }
}

/* The smallest rectangle around a polygon over turns of a quarter circle: its axis (cosine, sine) and ranges. */
typedef struct rectangle {
    float c, s, x0, x1, y0, y1;
} rectangle;

static void smallest(rectangle *best, const polygon *poly)
{
    float least = 0.0f;
    for (int32_t i = 0; i < 64; i++) {
        rectangle r = {0.0f, 0.0f, 1e30f, -1e30f, 1e30f, -1e30f};
        float area;
        tyni_num_sincos((float)i * (0.5f * TYNI_PI / 64.0f), &r.s, &r.c);
        for (int32_t k = 0; k < poly->n; k++) {
            float x = r.c * poly->p[k].x + r.s * poly->p[k].y, y = r.c * poly->p[k].y - r.s * poly->p[k].x;
            r.x0 = tyni_minf(r.x0, x);
            r.x1 = tyni_maxf(r.x1, x);
            r.y0 = tyni_minf(r.y0, y);
            r.y1 = tyni_maxf(r.y1, y);
        }
        area = (r.x1 - r.x0) * (r.y1 - r.y0);
        if (i == 0 || area < least) {
            least = area;
            *best = r;
        }
    }
}

/* Where view rays can be: the apex and the far corners, relative to the camera. */
static void view_corners(tyni_vec3 corner[5], const tyn_camera *camera)
{
    tyni_vec3 right = tyni_vec_load(camera->right), up = tyni_vec_load(camera->up), forward = tyni_vec_load(camera->forward);
    corner[0] = tyni_vec(0.0f, 0.0f, 0.0f);
    for (int32_t i = 0; i < 4; i++) {
        tyni_vec3 d = tyni_vec_mad(forward, i & 1 ? camera->right_edge : camera->left_edge, right);
        corner[i + 1] = tyni_vec_scale(tyni_vec_mad(d, i & 2 ? camera->top_edge : camera->bottom_edge, up), camera->far_depth);
    }
}

static void box_corners(tyni_vec3 corner[8], const tyn_camera *camera, const float low[3], const float high[3])
{
    for (int32_t i = 0; i < 8; i++)
        corner[i] = tyni_vec((i & 1 ? high : low)[0] - camera->position[0], (i & 2 ? high : low)[1] - camera->position[1],
                             (i & 4 ? high : low)[2] - camera->position[2]);
}

static void range_along(const tyni_vec3 *p, int32_t n, tyni_vec3 d, float *low, float *high)
{
    *low = 1e30f;
    *high = -1e30f;
    for (int32_t i = 0; i < n; i++) {
        float t = tyni_vec_dot(p[i], d);
        *low = tyni_minf(*low, t);
        *high = tyni_maxf(*high, t);
    }
}

/* A row of the matrix: (axis . (p - camera) - origin) * scale + offset. */
static void row(float *m, tyni_vec3 axis, float origin, float scale, const tyn_camera *camera)
{
    float at = axis.x * camera->position[0] + axis.y * camera->position[1] + axis.z * camera->position[2];
    m[0] = axis.x * scale;
    m[1] = axis.y * scale;
    m[2] = axis.z * scale;
    m[3] = -(at + origin) * scale;
}

static void project(point *out, const tyni_vec3 *p, int32_t n, tyni_vec3 a, tyni_vec3 b)
{
    for (int32_t i = 0; i < n; i++) {
        out[i].x = tyni_vec_dot(p[i], a);
        out[i].y = tyni_vec_dot(p[i], b);
    }
}

void tyni_fit_directional(float matrix[16], const tyn_light *light, const tyn_camera *camera, const float low[3],
                          const float high[3])
{
    tyni_vec3 d = tyni_vec_normalise(tyni_vec_load(light->direction)), a, b, x, y, view[5], box[8];
    float z0, z1, b0, b1, sx, sy, margin;
    polygon poly, edge;
    rectangle r;
    point p[8];
    axes(d, &a, &b);
    view_corners(view, camera);
    project(p, view, 5, a, b);
    hull(&poly, p, 5);
    range_along(view, 5, d, &z0, &z1);
    if (low) {
        polygon whole = poly;
        box_corners(box, camera, low, high);
        project(p, box, 8, a, b);
        hull(&edge, p, 8);
        for (int32_t i = 0; i < edge.n; i++)
            cut(&poly, edge.p[i], edge.p[i + 1 < edge.n ? i + 1 : 0]);
        if (poly.n < 3)
            poly = whole; /* nothing shadows anything in view; any map will do */
        /* nothing beyond the box casts; nothing before what is seen needs more than to be clamped to the near end */
        range_along(box, 8, d, &b0, &b1);
        z0 = tyni_maxf(z0, b0);
        z1 = b1;
    }
    smallest(&r, &poly);
    margin = MARGIN / (float)tyni_maxi(light->shadow.size, 64);
    sx = tyni_maxf((r.x1 - r.x0) * (1.0f + 2.0f * margin), 1e-6f);
    sy = tyni_maxf((r.y1 - r.y0) * (1.0f + 2.0f * margin), 1e-6f);
    x = tyni_vec_mad(tyni_vec_scale(a, r.c), r.s, b);
    y = tyni_vec_mad(tyni_vec_scale(b, r.c), -r.s, a);
    row(matrix, x, r.x0 - margin * (r.x1 - r.x0), 1.0f / sx, camera);
    row(matrix + 4, y, r.y0 - margin * (r.y1 - r.y0), 1.0f / sy, camera);
    margin = tyni_maxf((z1 - z0) * 1e-3f, 1e-6f);
    z0 -= margin;
    z1 = tyni_maxf(z1, z0) + margin;
    /* 1 at z0, 0 at z1 */
    row(matrix + 8, d, z1, -1.0f / (z1 - z0), camera);
    matrix[12] = matrix[13] = matrix[14] = 0.0f;
    matrix[15] = 1.0f;
}

void tyni_fit_spot(float matrix[16], const tyn_light *light, const tyn_camera *camera, const float low[3], const float high[3])
{
    tyni_vec3 d = tyni_vec_normalise(tyni_vec_load(light->direction)), a, b, from, corner[8];
    float sine, cosine, half, reach = camera->far_depth;
    axes(d, &a, &b);
    from = tyni_vec_sub(tyni_vec_load(light->position), tyni_vec_load(camera->position));
    tyni_num_sincos(0.5f * light->angle, &sine, &cosine);
    half = sine / cosine * (1.0f + 2.0f * MARGIN / (float)tyni_maxi(light->shadow.size, 64));
    if (low) {
        box_corners(corner, camera, low, high);
        reach = 0.0f;
        for (int32_t i = 0; i < 8; i++)
            reach = tyni_maxf(reach, tyni_vec_length(tyni_vec_sub(corner[i], from)));
    }
    /* w = depth from the light; u = 1/2 + (x / w) / (2 half); z = near / w with a near end close enough not to be met */
    for (int32_t i = 0; i < 3; i++) {
        const float da[3] = {a.x, a.y, a.z}, db[3] = {b.x, b.y, b.z}, dd[3] = {d.x, d.y, d.z};
        matrix[i] = 0.5f * (da[i] / half + dd[i]);
        matrix[4 + i] = 0.5f * (db[i] / half + dd[i]);
        matrix[8 + i] = 0.0f;
        matrix[12 + i] = dd[i];
    }
    for (int32_t r = 0; r < 4; r++)
        matrix[4 * r + 3] = -(matrix[4 * r] * light->position[0] + matrix[4 * r + 1] * light->position[1] +
                              matrix[4 * r + 2] * light->position[2]);
    matrix[11] = tyni_maxf(reach * 1e-3f, 1e-6f);
}
