/* fit.c - see fit.h
 *
 * A directional light's map is worth as much as it is small: at equal texels, error in the shafts is in proportion to its
 * width. It has to cover points that are seen (on a view ray, before its surface) and can be shadowed (a caster lies on their
 * way to the light); both sets are measured in 32 directions across the light, and the smallest of 16 rectangles around their
 * common part wins. */
#include "fit.h"

#include <math.h>

#include "base.h"
#include "check.h"
#include "num.h"
#include "slide.h"
#include "vec.h"
#include "view.h"

/* Texels of margin on each side: a nearest-texel look-up at the rim must find what lies there. */
#define MARGIN 2.0f
#define TURNS 32     /* directions over half a circle */
#define TILE 8       /* pixels; the farthest depth of a tile bounds what is seen through it */
#define QUESTIONS 64 /* large triangles that are held against the pixels */
#define COARSE 32    /* tiles across without a depth buffer */

/* Extents of a set of points, relative to the camera. */
typedef struct extent {
    float low[TURNS], high[TURNS]; /* across the light */
    float box_low[3], box_high[3]; /* along the world's axes */
    float near_end, far_end;       /* along the light */
} extent;

typedef struct fit {
    tyni_vec3 d, a, b; /* the light's direction and two axes across */
    float c[TURNS], s[TURNS];
    tyni_view view;
    const tyn_image *depth;
} fit;

static void extent_clear(extent *e)
{
    for (int32_t i = 0; i < TURNS; i++) {
        e->low[i] = 1e30f;
        e->high[i] = -1e30f;
    }
    for (int32_t i = 0; i < 3; i++) {
        e->box_low[i] = 1e30f;
        e->box_high[i] = -1e30f;
    }
    e->near_end = 1e30f;
    e->far_end = -1e30f;
}

static void extent_add(extent *e, const fit *f, tyni_vec3 p)
{
    const float v[3] = {p.x, p.y, p.z};
    float x = tyni_vec_dot(p, f->a), y = tyni_vec_dot(p, f->b), z = tyni_vec_dot(p, f->d);
    for (int32_t i = 0; i < TURNS; i++) {
        float t = f->c[i] * x + f->s[i] * y;
        e->low[i] = tyni_minf(e->low[i], t);
        e->high[i] = tyni_maxf(e->high[i], t);
    }
    for (int32_t i = 0; i < 3; i++) {
        e->box_low[i] = tyni_minf(e->box_low[i], v[i]);
        e->box_high[i] = tyni_maxf(e->box_high[i], v[i]);
    }
    e->near_end = tyni_minf(e->near_end, z);
    e->far_end = tyni_maxf(e->far_end, z);
}

/* True if points in [low, high] can lie behind something in [box_low, box_high], as the light goes. Within a slack: what is
 * seen of a floor lies on it, and a floor shadows nothing above itself. */
static int behind(const fit *f, const float low[3], const float high[3], const float box_low[3], const float box_high[3],
                  float slack)
{
    const float d[3] = {f->d.x, f->d.y, f->d.z};
    for (int32_t i = 0; i < 3; i++) {
        if (d[i] >= 0.0f && high[i] <= box_low[i] + slack)
            return 0;
        if (d[i] <= 0.0f && low[i] >= box_high[i] - slack)
            return 0;
    }
    return 1;
}

static float largest(const float low[3], const float high[3])
{
    return tyni_maxf(tyni_maxf(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

/* Narrows t[0] .. t[1] to where n . p >= c along a ray. */
static void clip_plane(const tyni_sight *v, tyni_vec3 n, float c, float t[2])
{
    float rate = tyni_vec_dot(n, v->d);
    c -= tyni_vec_dot(n, v->o);
    if (rate > 1e-20f)
        t[0] = tyni_maxf(t[0], c / rate);
    else if (rate < -1e-20f)
        t[1] = tyni_minf(t[1], c / rate);
    else if (c > 0.0f)
        t[1] = t[0] - 1.0f;
}

/* True if a view ray passes through the triangle's shadow. Every second pixel of every second row is asked: enough for what is
 * large. */
static int shades(const fit *f, const tyni_vec3 p[3], float slack)
{
    tyni_vec3 n = tyni_vec_normalise(tyni_vec_cross(tyni_vec_sub(p[1], p[0]), tyni_vec_sub(p[2], p[0]))), side[3];
    float edge[3];
    if (tyni_vec_dot(n, f->d) < 0.0f)
        n = tyni_vec_scale(n, -1.0f); /* now the way that its shadow falls */
    for (int32_t i = 0; i < 3; i++) {
        tyni_vec3 inner = p[(i + 2) % 3];
        side[i] = tyni_vec_cross(f->d, tyni_vec_sub(p[(i + 1) % 3], p[i]));
        if (tyni_vec_dot(side[i], tyni_vec_sub(inner, p[i])) < 0.0f)
            side[i] = tyni_vec_scale(side[i], -1.0f);
        edge[i] = tyni_vec_dot(side[i], p[i]);
    }
    for (int32_t y = 0; y < f->view.height; y += 2) {
        const float *row = tyni_image_row(f->depth, y);
        for (int32_t x = 0; x < f->view.width; x += 2) {
            tyni_sight v;
            float length = tyni_view_sight(&f->view, (float)x + 0.5f, (float)y + 0.5f, &v);
            float t[2] = {0.0f, tyni_view_depth(&f->view, row[x]) * length};
            clip_plane(&v, n, tyni_vec_dot(n, p[0]) + slack, t);
            for (int32_t i = 0; i < 3; i++)
                clip_plane(&v, side[i], edge[i], t);
            if (t[0] < t[1])
                return 1;
        }
    }
    return 0;
}

/* A caster as large as a fair part of the scene decides the map's size: worth asking the pixels themselves. */
static int large(const tyni_vec3 p[3], float size)
{
    for (int32_t i = 0; i < 3; i++)
        if (tyni_vec_length(tyni_vec_sub(p[i], p[(i + 1) % 3])) > size)
            return 1;
    return 0;
}

static void cast_mesh(extent *casters, const fit *f, const tyn_mesh *mesh, const extent *seen, int32_t *questions)
{
    float size = largest(seen->box_low, seen->box_high);
    float slack = 1e-4f * size;
    for (uint32_t i = 0; i < mesh->triangles; i++) {
        tyni_vec3 p[3];
        extent box;
        for (int32_t k = 0; k < 3; k++)
            p[k] = tyni_vec_sub(tyni_vec_load(mesh->positions + 3 * (size_t)mesh->indices[3 * (size_t)i + (size_t)k]),
                                f->view.position);
        if (!tyni_vec_finite(p[0]) || !tyni_vec_finite(p[1]) || !tyni_vec_finite(p[2]))
            continue;
        for (int32_t k = 0; k < 3; k++) {
            const float q[3][3] = {{p[0].x, p[1].x, p[2].x}, {p[0].y, p[1].y, p[2].y}, {p[0].z, p[1].z, p[2].z}};
            box.box_low[k] = tyni_minf(tyni_minf(q[k][0], q[k][1]), q[k][2]);
            box.box_high[k] = tyni_maxf(tyni_maxf(q[k][0], q[k][1]), q[k][2]);
        }
        if (!behind(f, seen->box_low, seen->box_high, box.box_low, box.box_high, slack))
            continue;
        if (f->depth && *questions > 0 && large(p, 0.2f * size)) {
            --*questions;
            if (!shades(f, p, slack))
                continue;
        }
        for (int32_t k = 0; k < 3; k++)
            extent_add(casters, f, p[k]);
    }
}

/* 0: nothing can cast on what is seen. */
static int cast_all(extent *casters, const fit *f, const tyni_fit_casters *c, const extent *seen)
{
    int32_t questions = QUESTIONS;
    extent_clear(casters);
    for (int32_t i = 0; i < c->mesh_count; i++)
        cast_mesh(casters, f, &c->meshes[i], seen, &questions);
    if (c->low) {
        for (int32_t i = 0; i < 8; i++)
            extent_add(casters, f,
                       tyni_vec_sub(tyni_vec((i & 1 ? c->high : c->low)[0], (i & 2 ? c->high : c->low)[1],
                                             (i & 4 ? c->high : c->low)[2]),
                                    f->view.position));
    }
    return casters->near_end <= casters->far_end;
}

/* Narrows a ray's part t[0] .. t[1] to where the casters' box can shadow it. */
static void clip_ray(const fit *f, const tyni_sight *v, float slack, const extent *casters, float t[2])
{
    const float d[3] = {f->d.x, f->d.y, f->d.z};
    for (int32_t i = 0; i < 3; i++) {
        tyni_vec3 n = tyni_vec(i == 0 ? 1.0f : 0.0f, i == 1 ? 1.0f : 0.0f, i == 2 ? 1.0f : 0.0f);
        if (d[i] > 0.0f) /* only beyond the low side */
            clip_plane(v, n, casters->box_low[i] - slack, t);
        else if (d[i] < 0.0f) /* only below the high side */
            clip_plane(v, tyni_vec_scale(n, -1.0f), -(casters->box_high[i] + slack), t);
    }
}

/* Also widens box_low .. box_high by the very points that are seen: by a tile's corners a floor would seem to be seen from
 * below. */
static float tile_depth(const fit *f, int32_t x, int32_t y, float low[3], float high[3])
{
    int32_t x1 = tyni_mini(x + TILE, f->view.width), y1 = tyni_mini(y + TILE, f->view.height);
    float most = 0.0f;
    for (; y < y1; y++) {
        const float *row = tyni_image_row(f->depth, y);
        for (int32_t i = x; i < x1; i++) {
            float depth = tyni_view_depth(&f->view, row[i]);
            tyni_vec3 p = tyni_view_point(&f->view, (float)i + 0.5f, (float)y + 0.5f, depth);
            const float v[3] = {p.x, p.y, p.z};
            most = tyni_maxf(most, depth);
            for (int32_t k = 0; k < 3; k++) {
                low[k] = tyni_minf(low[k], v[k]);
                high[k] = tyni_maxf(high[k], v[k]);
            }
        }
    }
    return most;
}

/* What is seen, tile by tile; with casters only what they can shadow. */
static void see(extent *seen, const fit *f, const extent *casters)
{
    int32_t step_x = f->depth ? TILE : (f->view.width + COARSE - 1) / COARSE;
    int32_t step_y = f->depth ? TILE : (f->view.height + COARSE - 1) / COARSE;
    float tile = tyni_maxf((float)step_x * tyni_vec_length(f->view.dx), (float)step_y * tyni_vec_length(f->view.dy));
    float low[3] = {0.0f, 0.0f, 0.0f}, high[3] = {0.0f, 0.0f, 0.0f};
    extent_clear(seen);
    for (int32_t y = 0; y < f->view.height; y += step_y)
        for (int32_t x = 0; x < f->view.width; x += step_x) {
            float depth = f->depth ? tile_depth(f, x, y, low, high) : f->view.far_depth;
            for (int32_t i = 0; i < 4; i++) {
                tyni_sight v;
                float length = tyni_view_sight(&f->view, (float)(i & 1 ? x + step_x : x), (float)(i & 2 ? y + step_y : y), &v);
                float t[2] = {0.0f, depth * length};
                if (casters)
                    clip_ray(f, &v, f->view.orthographic ? tile : tile * depth, casters, t);
                if (t[0] > t[1])
                    continue;
                extent_add(seen, f, tyni_sight_at(&v, t[0]));
                extent_add(seen, f, tyni_sight_at(&v, t[1]));
            }
        }
    if (f->depth) {
        memcpy(seen->box_low, low, sizeof low);
        memcpy(seen->box_high, high, sizeof high);
    }
}

void tyni_fit_axes(tyni_vec3 direction, tyni_vec3 *d, tyni_vec3 *a, tyni_vec3 *b)
{
    tyni_vec3 other;
    *d = tyni_vec_normalise(direction);
    other = tyni_absf(d->y) < 0.9f ? tyni_vec(0.0f, 1.0f, 0.0f) : tyni_vec(1.0f, 0.0f, 0.0f);
    *a = tyni_vec_normalise(tyni_vec_cross(*d, other));
    *b = tyni_vec_cross(*a, *d);
}

static void fit_begin(fit *f, const tyn_light *light, const tyn_camera *camera, const tyn_image *depth)
{
    tyni_fit_axes(tyni_vec_load(light->direction), &f->d, &f->a, &f->b);
    for (int32_t i = 0; i < TURNS; i++)
        tyni_num_sincos((float)i * (TYNI_PI / (float)TURNS), &f->s[i], &f->c[i]);
    tyni_view_camera(&f->view, camera, depth ? depth->width : 1024, depth ? depth->height : 1024);
    f->depth = depth;
}

/* The rectangle of least area; its axes are the directions i and i + TURNS / 2. */
static int32_t smallest(const extent *e)
{
    int32_t best = 0;
    float least = 0.0f;
    for (int32_t i = 0; i < TURNS / 2; i++) {
        int32_t j = i + TURNS / 2;
        float area = tyni_maxf(e->high[i] - e->low[i], 0.0f) * tyni_maxf(e->high[j] - e->low[j], 0.0f);
        if (i == 0 || area < least) {
            least = area;
            best = i;
        }
    }
    return best;
}

/* A row of the matrix: (axis . (p - camera) - origin) * scale. */
static void row(float *m, tyni_vec3 axis, float origin, float scale, tyni_vec3 camera)
{
    m[0] = axis.x * scale;
    m[1] = axis.y * scale;
    m[2] = axis.z * scale;
    m[3] = -(tyni_vec_dot(axis, camera) + origin) * scale;
}

static void side(float *m, const fit *f, const extent *e, int32_t turn, int32_t texels)
{
    float width = tyni_maxf(e->high[turn] - e->low[turn], 1e-6f), rim = width * MARGIN / (float)tyni_maxi(texels, 64);
    tyni_vec3 axis = tyni_vec_mad(tyni_vec_scale(f->a, f->c[turn]), f->s[turn], f->b);
    row(m, axis, e->low[turn] - rim, 1.0f / (width + 2.0f * rim), f->view.position);
}

void tyni_fit_directional(float matrix[16], const tyn_light *light, const tyn_camera *camera, const tyn_image *depth,
                          const tyni_fit_casters *c)
{
    extent seen, casters;
    float z0, z1, rim;
    fit f;
    int32_t best;
    fit_begin(&f, light, camera, depth);
    see(&seen, &f, NULL);
    z0 = seen.near_end;
    z1 = seen.far_end;
    if ((c->mesh_count || c->low) && cast_all(&casters, &f, c, &seen)) {
        extent shaded;
        see(&shaded, &f, &casters);
        if (shaded.near_end <= shaded.far_end) {
            seen = shaded;
            /* nothing beyond the casters casts, and nothing in front of what is seen needs more than the near end */
            z0 = tyni_maxf(shaded.near_end, casters.near_end);
            z1 = tyni_maxf(casters.far_end, z0);
            for (int32_t i = 0; i < TURNS; i++) {
                seen.low[i] = tyni_maxf(seen.low[i], casters.low[i]);
                seen.high[i] = tyni_minf(seen.high[i], casters.high[i]);
            }
        }
    }
    best = smallest(&seen);
    side(matrix, &f, &seen, best, light->shadow.size);
    side(matrix + 4, &f, &seen, best + TURNS / 2, tyni_shadow_height(&light->shadow));
    rim = tyni_maxf((z1 - z0) * 1e-3f, 1e-6f);
    row(matrix + 8, f.d, z1 + rim, -1.0f / (z1 - z0 + 2.0f * rim), f.view.position);
    matrix[12] = matrix[13] = matrix[14] = 0.0f;
    matrix[15] = 1.0f;
}

static float farthest(const tyn_light *light, const tyn_camera *camera, const tyni_fit_casters *c)
{
    tyni_vec3 from = tyni_vec_load(light->position);
    float reach = 0.0f;
    for (int32_t i = 0; i < c->mesh_count; i++)
        for (uint32_t k = 0; k < c->meshes[i].vertices && c->meshes[i].triangles; k++) {
            tyni_vec3 p = tyni_vec_sub(tyni_vec_load(c->meshes[i].positions + 3 * (size_t)k), from);
            if (tyni_vec_finite(p))
                reach = tyni_maxf(reach, tyni_vec_length(p));
        }
    for (int32_t i = 0; i < 8 && c->low; i++) {
        tyni_vec3 p = tyni_vec((i & 1 ? c->high : c->low)[0], (i & 2 ? c->high : c->low)[1], (i & 4 ? c->high : c->low)[2]);
        reach = tyni_maxf(reach, tyni_vec_length(tyni_vec_sub(p, from)));
    }
    return reach > 0.0f ? tyni_minf(reach, TYN_MAX_LENGTH) : camera->far_depth; /* the square of a length may be infinite */
}

/* Looks along d from a point, over a square of tangents -half .. half along a and b. w is the depth from the light, u = 1/2 +
 * (x / w) / (2 half) and v alike, z = near / w with a near end too close to be met. */
static void frustum(float matrix[16], const float position[3], tyni_vec3 d, tyni_vec3 a, tyni_vec3 b, float half,
                    int32_t texels, float reach)
{
    tyni_vec3 from = tyni_vec_load(position);
    half *= 1.0f + 2.0f * MARGIN / (float)tyni_maxi(texels, 64);
    row(matrix, tyni_vec_mad(tyni_vec_scale(d, 0.5f), 0.5f / half, a), 0.0f, 1.0f, from);
    row(matrix + 4, tyni_vec_mad(tyni_vec_scale(d, 0.5f), 0.5f / half, b), 0.0f, 1.0f, from);
    matrix[8] = matrix[9] = matrix[10] = 0.0f;
    matrix[11] = tyni_maxf(reach * 1e-3f, 1e-6f);
    row(matrix + 12, d, 0.0f, 1.0f, from);
}

void tyni_fit_spot(float matrix[16], const tyn_light *light, const tyn_camera *camera, const tyni_fit_casters *casters)
{
    float sine, cosine;
    fit f;
    fit_begin(&f, light, camera, NULL);
    if (light->texture_count) /* its square is the slide's */
        tyni_slide_axes(f.d, tyni_vec_load(light->up), &f.a, &f.b);
    tyni_num_sincos(0.5f * light->angle, &sine, &cosine);
    frustum(matrix, light->position, f.d, f.a, f.b, sine / cosine,
            tyni_mini(light->shadow.size, tyni_shadow_height(&light->shadow)), farthest(light, camera, casters));
}

void tyni_fit_face(float matrix[16], const float position[3], int32_t face, float reach, int32_t texels)
{
    tyni_vec3 d, right, down;
    tyni_slide_face(face, &d, &right, &down);
    frustum(matrix, position, d, right, down, 1.0f, texels, reach);
}
