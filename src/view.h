/* view.h - the camera, the light and its shadow map as seen from the camera, and the epipole.
 *
 * Everything inside is relative to the camera's position: large world coordinates cost precision only once, here. */
#ifndef TYNI_VIEW_H
#define TYNI_VIEW_H

#include "door.h"
#include "slide.h"
#include "vec.h"

#include "base.h"

/* A point (px, py) of the pixel plane is origin + px * dx + py * dy: at depth 1, the direction of its ray (perspective), or at
 * depth 0, where its ray starts (orthographic). Pixel centres are at 0.5. */
typedef struct tyni_view {
    int orthographic;
    tyni_vec3 position;
    tyni_vec3 right, up, forward;
    tyni_vec3 origin, dx, dy;
    float left, top, scale_x, scale_y; /* pixel = (tangent - left) * scale_x, (top - tangent) * scale_y */
    float near_depth, far_depth;
    int32_t width, height;
} tyni_view;

void tyni_view_camera(tyni_view *view, const tyn_camera *camera, int32_t width, int32_t height);

/* A view ray: o + t * d, |d| = 1, t in metres from the camera (perspective) or from its plane (orthographic: o differs). */
typedef struct tyni_sight {
    tyni_vec3 o, d;
} tyni_sight;

static inline tyni_vec3 tyni_sight_at(const tyni_sight *v, float t)
{
    return tyni_vec_mad(v->o, t, v->d);
}

static inline tyni_vec3 tyni_view_plane(const tyni_view *view, float px, float py)
{
    return tyni_vec_mad(tyni_vec_mad(view->origin, px, view->dx), py, view->dy);
}

/* The ray through a point of the pixel plane; returns its length per depth. */
static inline float tyni_view_sight(const tyni_view *view, float px, float py, tyni_sight *v)
{
    tyni_vec3 d = tyni_view_plane(view, px, py);
    float length;
    if (view->orthographic) {
        v->o = d;
        v->d = view->forward;
        return 1.0f;
    }
    length = tyni_vec_length(d);
    v->o = tyni_vec(0.0f, 0.0f, 0.0f);
    v->d = tyni_vec_scale(d, 1.0f / length);
    return length;
}

/* The point of a pixel at a depth. */
static inline tyni_vec3 tyni_view_point(const tyni_view *view, float px, float py, float depth)
{
    tyni_vec3 d = tyni_view_plane(view, px, py);
    return view->orthographic ? tyni_vec_mad(d, depth, view->forward) : tyni_vec_scale(d, depth);
}

/* A depth buffer's value as the length of its ray in depths: 0 .. far; NaN and infinity are far. */
static inline float tyni_view_depth(const tyni_view *view, float depth)
{
    if (!(depth < view->far_depth))
        return view->far_depth;
    return depth > 0.0f ? depth : 0.0f;
}

/* A shadow map as the camera sees it: u and v in texels. */
typedef struct tyni_map {
    tyni_texels texels;
    tyni_form u, v, z, w;
    const tyn_image *tint; /* NULL: none */
} tyni_map;

/* A light as the camera sees it. */
typedef struct tyni_lamp {
    tyn_light_kind kind;
    float colour[3];
    tyni_vec3 to_light; /* unit vector from the camera */
    float distance;     /* spot, point: to the light */
    tyni_vec3 position; /* spot, point: relative to the camera */
    float radius; /* spot, point: 1 / r^2 grows no further inside it; a hundredth of the near depth, or 1e-4 of the distance */
    tyni_vec3 axis; /* the way the light travels, of length 1 */
    float cos_half; /* spot: of half the cone's angle */
    int no_epipole; /* the light is where the camera is, or an orthographic camera looks along it */
    /* Epipole in homogeneous pixel coordinates with w >= 0. `behind`: it is the antipode's image, and slopes grow along a line
     * away from it instead of falling. */
    float ex, ey, ew;
    int behind;
    /* Shadow maps: a point belongs to the first that covers it. `outside`: whether what none covers is lit. */
    float lift; /* what comes back of the light that shadows take: 0 by physics, else set by art.h */
    int32_t slide_count;
    tyni_slide slides[6];
    int coloured; /* slides or tints: the light's colour differs from column to column */
    int outside;
    int32_t map_count;
    tyni_map maps[TYN_MAX_MAPS];
} tyni_lamp;

/* What a build may have left out. */
static inline tyn_light_kind tyni_view_kind(const tyni_lamp *lamp)
{
    return TYNI_HAS(TYN_PART_LAMPS) ? lamp->kind : TYN_LIGHT_DIRECTIONAL;
}
static inline int32_t tyni_view_slides(const tyni_lamp *lamp)
{
    return TYNI_HAS(TYN_PART_SLIDES) ? lamp->slide_count : 0;
}
static inline int tyni_view_coloured(const tyni_lamp *lamp)
{
    return TYNI_HAS(TYN_PART_SLIDES) && lamp->coloured;
}

void tyni_view_lamp(tyni_lamp *lamp, const tyn_light *light, const tyni_view *view);

/* The part t0 .. t1 of a ray inside the volume that the light reaches: a spot's cone, or the frustum or
 * column of its slide. 0 if there is none. */
int tyni_view_clip(const tyni_lamp *lamp, const tyni_sight *v, float *t0, float *t1);

/* True if that is not all space. */
static inline int tyni_view_bounded(const tyni_lamp *lamp)
{
    return tyni_view_kind(lamp) == TYN_LIGHT_SPOT || (tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL && tyni_view_slides(lamp));
}

/* Slides and tints at a point relative to the camera. */
void tyni_view_colour(const tyni_lamp *lamp, tyni_vec3 p, float rgb[3]);

#endif
