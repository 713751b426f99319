/* view.c - see view.h */
#include "view.h"

#include <math.h>

#include "base.h"
#include "num.h"

void tyni_view_camera(tyni_view *view, const tyn_camera *camera, int32_t width, int32_t height)
{
    view->position = tyni_vec_load(camera->position);
    view->right = tyni_vec_load(camera->right);
    view->up = tyni_vec_load(camera->up);
    view->forward = tyni_vec_load(camera->forward);
    view->left = camera->left_edge;
    view->top = camera->top_edge;
    view->scale_x = (float)width / (camera->right_edge - camera->left_edge);
    view->scale_y = (float)height / (camera->top_edge - camera->bottom_edge);
    view->near_depth = camera->near_depth;
    view->far_depth = camera->far_depth;
    view->width = width;
    view->height = height;
    view->dx = tyni_vec_scale(view->right, 1.0f / view->scale_x);
    view->dy = tyni_vec_scale(view->up, -1.0f / view->scale_y);
    view->orthographic = camera->kind == TYN_CAMERA_ORTHOGRAPHIC;
    view->origin = tyni_vec_mad(tyni_vec_scale(view->right, view->left), view->top, view->up);
    if (!view->orthographic)
        view->origin = tyni_vec_add(view->origin, view->forward);
}

/* IVB section 6.1: the light projected homogeneously. A point behind the camera has w < 0; both signs of (x, y, w) are one line
 * bundle, so w is made positive and the direction remembered. An orthographic camera sees a direction at infinity (w = 0) and a
 * position, wherever it is, as if in front: light always falls away from it on the screen. */
static void epipole(tyni_lamp *lamp, const tyni_view *view)
{
    tyni_vec3 at = view->orthographic && tyni_view_kind(lamp) != TYN_LIGHT_DIRECTIONAL ? lamp->position : lamp->to_light;
    float a = tyni_vec_dot(at, view->right), b = tyni_vec_dot(at, view->up), w = tyni_vec_dot(at, view->forward);
    if (view->orthographic)
        w = tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL ? 0.0f : 1.0f;
    lamp->ex = (a - view->left * w) * view->scale_x;
    lamp->ey = (view->top * w - b) * view->scale_y;
    lamp->ew = w;
    lamp->behind = w < 0.0f;
    if (lamp->behind) {
        lamp->ex = -lamp->ex;
        lamp->ey = -lamp->ey;
        lamp->ew = -w;
    }
    if (view->orthographic)
        lamp->no_epipole = w == 0.0f && a * a + b * b < 1e-10f;
    /* So far off that a float could not tell its lines from parallel ones: parallel they are. */
    else if (lamp->ew * 1e6f * (float)(view->width + view->height) < tyni_absf(lamp->ex) + tyni_absf(lamp->ey))
        lamp->ew = 0.0f;
}

static tyni_form form(const float row[4], const tyni_view *view, float scale)
{
    tyni_form f;
    f.v = tyni_vec_scale(tyni_vec_load(row), scale);
    f.c = (row[3] + tyni_vec_dot(tyni_vec_load(row), view->position)) * scale;
    return f;
}

static void shadow_map(tyni_lamp *lamp, const tyn_shadow *shadow, const tyni_view *view)
{
    tyni_map *map = &lamp->maps[lamp->map_count];
    float size = 0.0f, scale, z[4];
    if (!shadow->depth)
        return;
    /* A common factor of the matrix is free; make w's row of the order of 1. */
    for (int32_t i = 12; i < 16; i++)
        size = tyni_maxf(size, tyni_absf(shadow->matrix[i]));
    if (!(size > 0.0f))
        return;
    scale = 1.0f / size;
    tyni_door_map(&map->texels, z, shadow, shadow->bias);
    map->u = form(shadow->matrix, view, (float)map->texels.width * scale);
    map->v = form(shadow->matrix + 4, view, (float)map->texels.height * scale);
    map->z = form(z, view, scale);
    map->w = form(shadow->matrix + 12, view, scale);
    map->tint = shadow->tint;
    lamp->coloured |= shadow->tint != NULL;
    lamp->map_count++;
}

void tyni_view_lamp(tyni_lamp *lamp, const tyn_light *light, const tyni_view *view)
{
    const float origin[3] = {view->position.x, view->position.y, view->position.z};
    float sine;
    memset(lamp, 0, sizeof *lamp);
    lamp->kind = light->kind;
    for (int32_t c = 0; c < 3; c++)
        lamp->colour[c] = light->colour[c];
    lamp->axis = tyni_vec_normalise(tyni_vec_load(light->direction));
    if (tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL) {
        lamp->to_light = tyni_vec_scale(lamp->axis, -1.0f);
    } else {
        lamp->position = tyni_vec_sub(tyni_vec_load(light->position), view->position);
        lamp->distance = tyni_vec_length(lamp->position);
        lamp->to_light = tyni_vec_normalise(lamp->position);
        if (tyni_view_kind(lamp) == TYN_LIGHT_SPOT)
            tyni_num_sincos(0.5f * light->angle, &sine, &lamp->cos_half);
        lamp->radius = tyni_maxf(1e-2f * view->near_depth, 1e-4f * lamp->distance);
        lamp->no_epipole = lamp->distance <= 1e-4f * view->near_depth;
    }
    epipole(lamp, view);
    lamp->slide_count = TYNI_HAS(TYN_PART_SLIDES) ? tyni_slide_set(lamp->slides, light, origin) : 0;
    lamp->coloured = tyni_view_slides(lamp) > 0;
    shadow_map(lamp, &light->shadow, view);
    for (int32_t i = 0; i < light->more_count; i++)
        shadow_map(lamp, &light->more[i], view);
    lamp->outside = !lamp->map_count || light->outside == TYN_OUTSIDE_LIT ||
                    (light->outside == TYN_OUTSIDE_DEFAULT && tyni_view_kind(lamp) == TYN_LIGHT_DIRECTIONAL);
}

/* With T = t - (closest approach) the point is T v - h, h at right angles to v, and the double cone
 *     (T v.a - h.a)^2 >= k^2 (T^2 + h^2)
 * is a quadratic in T without the cancellation of the usual form. */
static int clip_cone(const tyni_lamp *lamp, const tyni_sight *v, float *t0, float *t1)
{
    float tc, va, ha, k2, a, c, disc, root, b, r1, r2, swap;
    tyni_vec3 to = tyni_vec_sub(lamp->position, v->o), h;
    tc = tyni_vec_dot(v->d, to);
    h = tyni_vec_mad(to, -tc, v->d);
    va = tyni_vec_dot(v->d, lamp->axis);
    ha = tyni_vec_dot(h, lamp->axis);
    k2 = lamp->cos_half * lamp->cos_half;
    a = va * va - k2;
    c = ha * ha - k2 * tyni_vec_dot(h, h);
    disc = ha * ha + a * tyni_vec_dot(h, h);
    if (disc <= 0.0f && a <= 0.0f)
        return 0;
    root = lamp->cos_half * sqrtf(disc > 0.0f ? disc : 0.0f);
    b = va * ha; /* a T^2 - 2 b T + c >= 0 */
    r2 = b >= 0.0f ? b + root : b - root;
    r1 = r2 != 0.0f ? c / r2 : 0.0f;
    /* a near 0: one root is far away; any large number of the right sign serves */
    r2 = tyni_absf(a) > 1e-9f ? r2 / a : (r2 >= 0.0f) == (a >= 0.0f) ? 1e30f : -1e30f;
    if (r1 > r2) {
        swap = r1;
        r1 = r2;
        r2 = swap;
    }
    if (a < 0.0f) { /* between the roots, on one nappe: the front one? */
        if (0.5f * (tyni_maxf(r1, -1e18f) + tyni_minf(r2, 1e18f)) * va < ha)
            return 0;
        *t0 = tyni_maxf(*t0, tc + r1);
        *t1 = tyni_minf(*t1, tc + r2);
    } else if (va > 0.0f) {
        *t0 = tyni_maxf(*t0, tc + r2);
    } else {
        *t1 = tyni_minf(*t1, tc + r1);
    }
    return *t0 < *t1;
}

/* Narrows t0 .. t1 to where a.p * x + b.p >= 0 along a ray. */
static void clip_form(const tyni_form *a, float x, const tyni_form *b, const tyni_sight *v, float *t0, float *t1)
{
    float c = tyni_form_at(a, v->o) * x + tyni_form_at(b, v->o), d = tyni_vec_dot(a->v, v->d) * x + tyni_vec_dot(b->v, v->d);
    if (d > 0.0f)
        *t0 = tyni_maxf(*t0, -c / d);
    else if (d < 0.0f)
        *t1 = tyni_minf(*t1, -c / d);
    else if (c < 0.0f)
        *t1 = *t0;
}

static int clip_slide(const tyni_slide *slide, const tyni_sight *v, float *t0, float *t1)
{
    clip_form(&slide->w, 0.0f, &slide->s, v, t0, t1);
    clip_form(&slide->w, 0.0f, &slide->t, v, t0, t1);
    clip_form(&slide->s, -1.0f / (float)slide->image->width, &slide->w, v, t0, t1);
    clip_form(&slide->t, -1.0f / (float)slide->image->height, &slide->w, v, t0, t1);
    return *t0 < *t1;
}

int tyni_view_clip(const tyni_lamp *lamp, const tyni_sight *v, float *t0, float *t1)
{
    if (tyni_view_slides(lamp) && tyni_view_kind(lamp) != TYN_LIGHT_POINT)
        return clip_slide(&lamp->slides[0], v, t0, t1);
    return tyni_view_kind(lamp) == TYN_LIGHT_SPOT ? clip_cone(lamp, v, t0, t1) : *t0 < *t1;
}

static void tint(const tyni_lamp *lamp, tyni_vec3 p, float rgb[3])
{
    for (int32_t i = 0; i < lamp->map_count; i++) {
        const tyni_map *map = &lamp->maps[i];
        float w = tyni_form_at(&map->w, p), u, v, own[3];
        float width = (float)map->texels.width, height = (float)map->texels.height;
        if (!(w > 0.0f))
            continue;
        u = tyni_form_at(&map->u, p) / w;
        v = tyni_form_at(&map->v, p) / w;
        if (!(u >= 0.0f && v >= 0.0f && u <= width && v <= height))
            continue;
        if (map->tint) {
            tyni_slide_sample(map->tint, u / width * (float)map->tint->width, v / height * (float)map->tint->height, own);
            for (int32_t c = 0; c < 3; c++)
                rgb[c] *= own[c];
        }
        return;
    }
}

void tyni_view_colour(const tyni_lamp *lamp, tyni_vec3 p, float rgb[3])
{
    rgb[0] = rgb[1] = rgb[2] = 1.0f;
    if (tyni_view_slides(lamp))
        tyni_slide_colour(lamp->slides, tyni_view_slides(lamp), p, rgb);
    tint(lamp, p, rgb);
}
