/* cascade.c - public calls that cut the view into shadow maps by depth, and that keep maps from crawling. */
#include "tyndall.h"

#include <math.h>

#include "base.h"
#include "check.h"
#include "fit.h"
#include "num.h"
#include "vec.h"

/* Texels at each side of a snapped map beyond what it must cover: two as every fit has (fit.c), on one side one more for the
 * rounding to the grid. */
#define RIM 2
#define LEAST 16 /* texels of a snapped map */

/* Light and camera, and the depth to cover: 0 is the far end, as is anything beyond it. */
static tyn_status check(const tyn_light *light, const tyn_camera *camera, float *distance)
{
    tyn_light bare;
    if (!light || !camera)
        return TYN_E_NULL;
    if (tyni_check_camera(camera) != TYN_OK)
        return TYN_E_CAMERA;
    if (!tyni_finite(*distance) || *distance < 0.0f || (*distance > 0.0f && *distance <= camera->near_depth))
        return TYN_E_CAMERA;
    *distance = *distance > 0.0f ? tyni_minf(*distance, camera->far_depth) : camera->far_depth;
    bare = *light;
    bare.shadow.depth = NULL; /* matrices are what is asked for, whatever they hold now */
    bare.more_count = 0;
    if (light->kind != TYN_LIGHT_DIRECTIONAL)
        return TYN_E_LIGHT;
    return tyni_check_lights(&bare, 1, TYN_MAX_SHADOW, TYN_MAX_MAPS);
}

/* ---- a map on a fixed grid ----------------------------------------------------------------------------------------- */

/* A ball around what the camera can see up to a depth, by the window alone: its size does not change as the camera moves and
 * turns. Returns the radius; the centre is relative to the camera. */
static float ball(const tyn_camera *c, float distance, tyni_vec3 *centre)
{
    float x = 0.5f * (c->left_edge + c->right_edge), y = 0.5f * (c->bottom_edge + c->top_edge), along = 0.0f, r2 = 0.0f;
    int flat = c->kind == TYN_CAMERA_ORTHOGRAPHIC;
    if (flat) {
        along = 0.5f * distance;
    } else {
        /* as far from the apex as from the farthest corner, but not beyond the far end */
        for (int32_t i = 0; i < 4; i++) {
            float u = i & 1 ? c->left_edge : c->right_edge, v = i & 2 ? c->bottom_edge : c->top_edge;
            along = tyni_maxf(along, 0.5f * distance * (u * u + v * v + 1.0f) / tyni_maxf(u * x + v * y + 1.0f, 0.5f));
        }
        along = tyni_minf(along, distance);
        x *= along;
        y *= along;
    }
    for (int32_t i = 0; i < 8; i++) {
        float depth = i & 4 ? distance : 0.0f, scale = flat ? 1.0f : depth;
        float u = (i & 1 ? c->left_edge : c->right_edge) * scale - x, v = (i & 2 ? c->bottom_edge : c->top_edge) * scale - y;
        r2 = tyni_maxf(r2, u * u + v * v + (depth - along) * (depth - along));
    }
    *centre = tyni_vec_mad(tyni_vec_mad(tyni_vec_scale(tyni_vec_load(c->right), x), y, tyni_vec_load(c->up)), along,
                           tyni_vec_load(c->forward));
    return sqrtf(r2);
}

/* (axis . p - origin) * scale, the origin a whole number of texels. */
static void row(float *m, tyni_vec3 axis, float scale, float offset)
{
    m[0] = axis.x * scale;
    m[1] = axis.y * scale;
    m[2] = axis.z * scale;
    m[3] = offset;
}

static void snap(tyn_shadow *shadow, const tyn_light *light, const tyn_camera *camera, float distance)
{
    tyni_vec3 centre, d, a, b;
    float radius = ball(camera, distance, &centre), size = (float)shadow->size, texel, deep, scale;
    texel = 2.0f * radius / (size - (float)(2 * RIM + 1));
    scale = 1.0f / (texel * size);
    tyni_fit_axes(tyni_vec_load(light->direction), &d, &a, &b);
    centre = tyni_vec_add(centre, tyni_vec_load(camera->position));
    row(shadow->matrix, a, scale, -(floorf((tyni_vec_dot(a, centre) - radius) / texel) - (float)RIM) / size);
    row(shadow->matrix + 4, b, scale, -(floorf((tyni_vec_dot(b, centre) - radius) / texel) - (float)RIM) / size);
    /* z = 1 at the near end, which is on the grid too: a caster keeps its depth */
    deep = floorf((tyni_vec_dot(d, centre) - radius) / texel) - (float)RIM;
    row(shadow->matrix + 8, d, -scale, 1.0f + deep / size);
    row(shadow->matrix + 12, tyni_vec(0.0f, 0.0f, 0.0f), 0.0f, 1.0f);
}

tyn_status tyn_shadow_snap(tyn_shadow *shadow, const tyn_light *light, const tyn_camera *camera, float distance)
{
    tyn_status status = check(light, camera, &distance);
    if (!shadow)
        return TYN_E_NULL;
    if (status != TYN_OK)
        return status;
    if (shadow->size < LEAST || shadow->size > TYN_MAX_SHADOW)
        return TYN_E_LIGHT;
    snap(shadow, light, camera, distance);
    return TYN_OK;
}

/* ---- cascades ------------------------------------------------------------------------------------------------------ */

/* Where cascade i of `count` ends: between equal ratios and equal lengths (Zhang et al. 2006, practical split scheme). */
static float split(const tyn_camera *camera, float distance, float lambda, int32_t i, int32_t count)
{
    float near = camera->near_depth, x = (float)(i + 1) / (float)count;
    if (i + 1 == count)
        return distance;
    return lambda * near * tyni_num_exp(x * tyni_num_log(distance / near)) + (1.0f - lambda) * (near + (distance - near) * x);
}

tyn_status tyn_shadow_fit_cascades(tyn_shadow *cascades, int32_t count, const tyn_light *light, const tyn_camera *camera,
                                   const float bounds_min[3], const float bounds_max[3], float distance, float lambda,
                                   int32_t snapped)
{
    tyni_fit_casters casters = {NULL, 0, NULL, NULL};
    tyn_status status = check(light, camera, &distance);
    tyn_camera part;
    tyn_light own;
    if (!cascades)
        return TYN_E_NULL;
    if (status != TYN_OK)
        return status;
    if (count < 1 || count > TYN_MAX_MAPS)
        return TYN_E_LIMIT;
    if (!(lambda >= 0.0f && lambda <= 1.0f))
        return TYN_E_CONFIG;
    status = tyni_check_bounds(bounds_min, bounds_max);
    if (status != TYN_OK)
        return status;
    for (int32_t i = 0; i < count; i++)
        if (cascades[i].size < (snapped ? LEAST : 0) || cascades[i].size > TYN_MAX_SHADOW)
            return TYN_E_LIGHT;
    casters.low = bounds_min;
    casters.high = bounds_max;
    part = *camera;
    own = *light;
    /* each reaches from the camera on, not from where the one before ends: no holes, and near the camera there is little of it
     */
    for (int32_t i = 0; i < count; i++) {
        part.far_depth = split(camera, distance, lambda, i, count);
        own.shadow.size = cascades[i].size;
        if (snapped)
            snap(&cascades[i], light, camera, part.far_depth);
        else
            tyni_fit_directional(cascades[i].matrix, &own, &part, NULL, &casters);
    }
    return TYN_OK;
}
