/* clip.c - cuts a triangle by the near plane and the four sides of the guard band (Sutherland and Hodgman).
 *
 * Two triangles that share an edge must cut it at the same point, bit for bit, or gaps open. So a cut is always calculated from
 * the vertex inside to the one outside, planes come in a fixed order, and whether a vertex is inside is decided by the same
 * comparison everywhere. */
#include "raster/raster.h"

#define PLANES 5

/* >= 0 inside. */
static float distance(const tyni_raster_view *view, const tyni_raster_vertex *v, int32_t plane)
{
    const float x = view->scale[0] * (v->x - view->middle[0] * v->w);
    const float y = view->scale[1] * (v->y - view->middle[1] * v->w);
    const float guard = TYNI_RASTER_GUARD * v->w;
    switch (plane) {
    case 0:
        return v->w - view->clip;
    case 1:
        return guard - x;
    case 2:
        return guard + x;
    case 3:
        return guard - y;
    default:
        return guard + y;
    }
}

int32_t tyni_raster_outside(const tyni_raster_view *view, const tyni_raster_vertex *v)
{
    int32_t bits = 0;
    for (int32_t plane = 0; plane < PLANES; plane++)
        bits |= (int32_t)(distance(view, v, plane) < 0.0f) << plane;
    return bits;
}

static tyni_raster_vertex cut(const tyni_raster_vertex *in, const tyni_raster_vertex *out, float d_in, float d_out)
{
    const float t = d_in / (d_in - d_out); /* d_in >= 0 > d_out, so 0 <= t <= 1 */
    tyni_raster_vertex v;
    v.x = in->x + t * (out->x - in->x);
    v.y = in->y + t * (out->y - in->y);
    v.value = in->value + t * (out->value - in->value);
    v.w = in->w + t * (out->w - in->w);
    return v;
}

/* One plane adds at most one vertex to a convex polygon; rounding can make it not quite convex, and then a vertex that does
 * not fit is left out rather than written past the end. */
static int32_t clip_plane(const tyni_raster_view *view, int32_t plane, const tyni_raster_vertex *from, int32_t count,
                          tyni_raster_vertex *to)
{
    int32_t n = 0;
    for (int32_t i = 0; i < count; i++) {
        const tyni_raster_vertex *a = &from[i], *b = &from[i + 1 < count ? i + 1 : 0];
        const float da = distance(view, a, plane), db = distance(view, b, plane);
        if (da >= 0.0f && n < TYNI_RASTER_CORNERS)
            to[n++] = *a;
        if ((da >= 0.0f) != (db >= 0.0f) && n < TYNI_RASTER_CORNERS) {
            to[n] = da >= 0.0f ? cut(a, b, da, db) : cut(b, a, db, da);
            if (plane == 0)
                to[n].w = view->clip;
            n++;
        }
    }
    return n;
}

int32_t tyni_raster_clip(const tyni_raster_view *view, tyni_raster_vertex v[TYNI_RASTER_CORNERS])
{
    tyni_raster_vertex other[TYNI_RASTER_CORNERS];
    int32_t count = 3;
    for (int32_t plane = 0; plane < PLANES && count; plane++) {
        count = clip_plane(view, plane, v, count, other);
        memcpy(v, other, (size_t)count * sizeof *v);
    }
    return count < 3 ? 0 : count;
}
