/* rectify.c - public calls for Klehm et al.'s projective rectification (section 4.2): shadow maps whose rows are view rays.
 *
 * Seen along a directional light, the view is a wedge with its tip at the camera. Let x run along the wedge's middle, y across
 * it and h towards the light. Divided by x, all view rays are parallel: y / x tells the row (the epipolar slice), h / x the
 * depth, and both are constant along a ray, while x runs from left to right. Of all perspectives this is the one with the
 * camera as its centre and x as its axis; it exists while no view ray is parallel to the light. */
#include "tyndall.h"

#include <math.h>

#include "base.h"
#include "check.h"
#include "fit.h"
#include "num.h"
#include "vec.h"

/* Of the cosine of half the wedge's angle: below the first, texels get too uneven to be of use; from the second on, these maps
 * are better than a fitted one by enough to be taken alone. */
#define LEAST_OPENING 0.2f
#define FULL_OPENING 0.4f
#define MARGIN 2.0f /* texels at each end of a row's range */

typedef struct wedge {
    tyni_vec3 x, y, h;
    float opening;         /* cosine of half its angle; <= 0: all around */
    float least, most;     /* x of the window's corners at depth 1 */
    float side, low, high; /* largest |y / x|; range of h / x */
} wedge;

static void wedge_set(wedge *w, const tyn_light *light, const tyn_camera *c)
{
    tyni_vec3 d, a, b, corner[4], flat[4];
    float worst = 2.0f;
    int32_t first = 0, second = 1;
    memset(w, 0, sizeof *w);
    tyni_fit_axes(tyni_vec_load(light->direction), &d, &a, &b);
    w->h = tyni_vec_scale(d, -1.0f);
    for (int32_t i = 0; i < 4; i++) {
        float u = i & 1 ? c->left_edge : c->right_edge, v = i & 2 ? c->bottom_edge : c->top_edge;
        corner[i] = tyni_vec_mad(tyni_vec_mad(tyni_vec_load(c->forward), u, tyni_vec_load(c->right)), v, tyni_vec_load(c->up));
        flat[i] = tyni_vec_normalise(tyni_vec_mad(corner[i], -tyni_vec_dot(corner[i], w->h), w->h));
    }
    /* the two corners that are farthest apart as the light sees them; the middle between them */
    for (int32_t i = 0; i < 4; i++)
        for (int32_t k = 0; k < i; k++)
            if (tyni_vec_dot(flat[i], flat[k]) < worst) {
                worst = tyni_vec_dot(flat[i], flat[k]);
                first = i;
                second = k;
            }
    w->x = tyni_vec_normalise(tyni_vec_add(flat[first], flat[second]));
    w->y = tyni_vec_cross(w->h, w->x);
    w->opening = 1.0f;
    for (int32_t i = 0; i < 4; i++) {
        float x = tyni_vec_dot(corner[i], w->x), y = tyni_vec_dot(corner[i], w->y), h = tyni_vec_dot(corner[i], w->h);
        w->opening = tyni_minf(w->opening, tyni_vec_dot(flat[i], w->x));
        if (!(w->opening > LEAST_OPENING))
            return;
        w->least = i ? tyni_minf(w->least, x) : x;
        w->most = i ? tyni_maxf(w->most, x) : x;
        w->side = i ? tyni_maxf(w->side, tyni_absf(y / x)) : tyni_absf(y / x);
        w->low = i ? tyni_minf(w->low, h / x) : h / x;
        w->high = i ? tyni_maxf(w->high, h / x) : h / x;
    }
}

static void row(float *m, tyni_vec3 axis, tyni_vec3 position)
{
    m[0] = axis.x;
    m[1] = axis.y;
    m[2] = axis.z;
    m[3] = -tyni_vec_dot(axis, position);
}

/* The map of what lies between x = near and x = far. */
static void map_of(float matrix[16], const tyn_shadow *shadow, const wedge *w, const tyn_camera *c, float near, float far)
{
    float width = shadow->size ? (float)shadow->size : 1e6f, height = shadow->height ? (float)shadow->height : width;
    float side = w->side / (1.0f - tyni_minf(2.0f * MARGIN / height, 0.5f));
    float rim = 0.01f * (w->high - w->low) + 1e-6f, deep = w->high - w->low + 2.0f * rim, scale = far / (far - near);
    tyni_vec3 position = tyni_vec_load(c->position);
    row(matrix, tyni_vec_scale(w->x, scale), position);
    matrix[3] -= near * scale;
    row(matrix + 4, tyni_vec_mad(tyni_vec_scale(w->x, 0.5f), 0.5f / side, w->y), position);
    row(matrix + 8, tyni_vec_scale(tyni_vec_mad(w->h, rim - w->low, w->x), 1.0f / deep), position);
    row(matrix + 12, w->x, position);
}

static tyn_status check(const tyn_light *light, const tyn_camera *camera)
{
    tyn_light bare;
    if (!light || !camera)
        return TYN_E_NULL;
    if (tyni_check_camera(camera) != TYN_OK || camera->kind != TYN_CAMERA_PERSPECTIVE)
        return TYN_E_CAMERA;
    bare = *light;
    bare.shadow.depth = NULL;
    bare.more_count = 0;
    if (light->kind != TYN_LIGHT_DIRECTIONAL)
        return TYN_E_LIGHT;
    return tyni_check_lights(&bare, 1, TYN_MAX_SHADOW, TYN_MAX_MAPS);
}

float tyn_shadow_rectifiable(const tyn_light *light, const tyn_camera *camera)
{
    float at;
    wedge w;
    if (check(light, camera) != TYN_OK)
        return 0.0f;
    wedge_set(&w, light, camera);
    at = tyni_clampf((w.opening - LEAST_OPENING) / (FULL_OPENING - LEAST_OPENING), 0.0f, 1.0f);
    return at * at * (3.0f - 2.0f * at);
}

tyn_status tyn_shadow_fit_rectified(tyn_shadow *maps, int32_t count, const tyn_light *light, const tyn_camera *camera,
                                    float from, float distance)
{
    tyn_status status = check(light, camera);
    float near, far, at, next, ratio, matrix[TYN_MAX_MAPS][16];
    wedge w;
    if (!maps)
        return TYN_E_NULL;
    if (status != TYN_OK)
        return status;
    if (count < 1 || count > TYN_MAX_MAPS)
        return TYN_E_LIMIT;
    distance = distance > 0.0f ? tyni_minf(distance, camera->far_depth) : distance == 0.0f ? camera->far_depth : -1.0f;
    from = from == 0.0f ? camera->near_depth : from;
    if (!(from >= 1.0f / TYN_MAX_LENGTH && from < distance))
        return TYN_E_CAMERA;
    for (int32_t i = 0; i < count; i++)
        if (maps[i].size < 0 || maps[i].size > TYN_MAX_SHADOW || maps[i].height < 0 || maps[i].height > TYN_MAX_SHADOW)
            return TYN_E_LIGHT;
    wedge_set(&w, light, camera);
    if (!(w.opening > LEAST_OPENING))
        return TYN_E_LIGHT;
    near = from * w.least;
    far = distance * w.most * 1.001f;
    ratio = tyni_num_log(far / near) / (float)count;
    for (int32_t i = 0; i < count; i++) {
        at = i ? near * tyni_num_exp(ratio * (float)i) : near;
        next = i + 1 < count ? near * tyni_num_exp(ratio * (float)(i + 1)) : far;
        map_of(matrix[i], &maps[i], &w, camera, at, next);
        for (int32_t k = 0; k < 16; k++)
            if (!tyni_finite(matrix[i][k])) /* nothing is between the two, or one is too far away for floats */
                return TYN_E_CAMERA;
    }
    for (int32_t i = 0; i < count; i++)
        memcpy(maps[i].matrix, matrix[i], sizeof matrix[i]);
    return TYN_OK;
}
