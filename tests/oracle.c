/* oracle.c - see oracle.h */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void subtract(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] - b[k];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double length(const double a[3])
{
    return sqrt(dot(a, a));
}

static void along(const double origin[3], const double v[3], double t, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = origin[k] + t * v[k];
}

/* The plane through `point`, turned such that `inside` is. 0: `inside` lies in it. */
static int make_plane(oracle_plane *plane, double n[3], const double point[3], const double inside[3])
{
    double size = length(n), side;
    if (!(size > 0.0))
        return 0;
    for (int k = 0; k < 3; k++)
        plane->n[k] = n[k] / size;
    plane->d = dot(plane->n, point);
    side = dot(plane->n, inside) - plane->d;
    if (side < 0.0) {
        for (int k = 0; k < 3; k++)
            plane->n[k] = -plane->n[k];
        plane->d = -plane->d;
    }
    return fabs(side) > 1e-12 * (1.0 + fabs(plane->d));
}

/* Everything behind the polygon: a plane through each edge and the light, and the polygon's own. */
static void make_volume(const oracle_polygon *p, const oracle_light *light, oracle_volume *volume)
{
    double centre[3] = {0.0, 0.0, 0.0}, behind[3], n[3], edge[3], way[3];
    volume->planes = 0;
    for (int i = 0; i < p->corners; i++)
        for (int k = 0; k < 3; k++)
            centre[k] += p->corner[i][k] / p->corners;
    if (light->kind == ORACLE_DIRECTIONAL)
        memcpy(way, light->direction, sizeof way);
    else
        subtract(centre, light->position, way);
    along(centre, way, 1.0, behind);
    memcpy(n, p->normal, sizeof n);
    if (!make_plane(&volume->plane[0], n, p->corner[0], behind))
        return;
    for (int i = 0; i < p->corners; i++) {
        subtract(p->corner[(i + 1) % p->corners], p->corner[i], edge);
        if (light->kind != ORACLE_DIRECTIONAL)
            subtract(p->corner[i], light->position, way);
        cross(edge, way, n);
        if (!make_plane(&volume->plane[i + 1], n, p->corner[i], centre))
            return;
    }
    volume->planes = p->corners + 1;
}

/* Texel coordinates of a point, and the planes of the texture's four edges. */
static void make_texture(oracle_light *light)
{
    oracle_texture *texture = &light->texture;
    double right[3], up[3], half[2], size;
    const double *forward = light->direction, *origin = light->position;
    cross(forward, texture->up, right);
    size = length(right);
    for (int k = 0; k < 3; k++)
        right[k] /= size;
    cross(right, forward, up);
    half[0] = half[1] = sqrt(1.0 - light->cosine * light->cosine) / light->cosine;
    if (light->kind == ORACLE_DIRECTIONAL) {
        half[0] = texture->extent[0] / 2;
        half[1] = texture->extent[1] / 2;
    }
    for (int k = 0; k < 3; k++) {
        /* (x / w + 1) / 2 * width with x = right . (p - origin) / half */
        texture->w[k] = light->kind == ORACLE_SPOT ? forward[k] : 0.0;
        texture->x[k] = 0.5 * texture->width * (right[k] / half[0] + texture->w[k]);
        texture->y[k] = 0.5 * texture->height * (-up[k] / half[1] + texture->w[k]);
    }
    texture->w[3] = light->kind == ORACLE_SPOT ? -dot(texture->w, origin) : 1.0;
    texture->x[3] = light->kind == ORACLE_SPOT ? -dot(texture->x, origin) : 0.5 * texture->width;
    texture->y[3] = light->kind == ORACLE_SPOT ? -dot(texture->y, origin) : 0.5 * texture->height;
    for (int k = 0; k < 4; k++)
        for (int i = 0; i < 4; i++) {
            const double *low = i < 2 ? texture->x : texture->y;
            double most = i < 2 ? texture->width : texture->height;
            double value = i % 2 ? most * texture->w[k] - low[k] : low[k];
            if (k < 3)
                texture->edge[i].n[k] = value;
            else
                texture->edge[i].d = -value;
        }
}

static double affine(const double row[4], const double p[3])
{
    return dot(row, p) + row[3];
}

static void texture_at(const oracle_texture *t, const double p[3], double out[3])
{
    double w = affine(t->w, p), at[2] = {affine(t->x, p) / w - 0.5, affine(t->y, p) / w - 0.5};
    int size[2] = {t->width, t->height}, low[2], high[2];
    for (int i = 0; i < 2; i++) {
        at[i] = fmin(fmax(at[i], 0.0), size[i] - 1.0);
        low[i] = (int)at[i];
        high[i] = low[i] + 1 < size[i] ? low[i] + 1 : low[i];
        at[i] -= low[i];
    }
    for (int k = 0; k < 3; k++) {
        double a = (double)t->rgb[3 * (low[1] * t->width + low[0]) + k],
               b = (double)t->rgb[3 * (low[1] * t->width + high[0]) + k];
        double c = (double)t->rgb[3 * (high[1] * t->width + low[0]) + k],
               d = (double)t->rgb[3 * (high[1] * t->width + high[0]) + k];
        out[k] = (a + (b - a) * at[0]) * (1 - at[1]) + (c + (d - c) * at[0]) * at[1];
    }
}

int oracle_prepare(oracle_scene *scene)
{
    size_t count = (size_t)scene->polygons + 1;
    int ready;
    scene->scratch = malloc(2 * count * sizeof *scene->scratch);
    ready = scene->scratch != NULL;
    for (int i = 0; i < scene->polygons; i++) {
        oracle_polygon *p = &scene->polygon[i];
        double a[3], b[3], size;
        subtract(p->corner[1], p->corner[0], a);
        subtract(p->corner[2], p->corner[0], b);
        cross(a, b, p->normal);
        size = length(p->normal);
        for (int k = 0; k < 3; k++)
            p->normal[k] /= size;
    }
    for (int l = 0; l < scene->lights; l++) {
        if (scene->light[l].texture.rgb)
            make_texture(&scene->light[l]);
        scene->light[l].volume = malloc(count * sizeof *scene->light[l].volume);
        ready = ready && scene->light[l].volume;
        for (int i = 0; ready && i < scene->polygons; i++)
            make_volume(&scene->polygon[i], &scene->light[l], &scene->light[l].volume[i]);
    }
    if (!ready)
        oracle_release(scene);
    return ready;
}

void oracle_release(oracle_scene *scene)
{
    free(scene->scratch);
    scene->scratch = NULL;
    for (int l = 0; l < scene->lights; l++) {
        free(scene->light[l].volume);
        scene->light[l].volume = NULL;
        free(scene->light[l].texture.rgb);
        scene->light[l].texture.rgb = NULL;
    }
}

/* Shrinks a .. b to where the ray is inside of the plane; 0 when nothing is left. */
static int clip(const oracle_plane *plane, const double c[3], const double v[3], double *a, double *b)
{
    double height = dot(plane->n, c) - plane->d, slope = dot(plane->n, v), t;
    if (slope == 0.0)
        return height > 0.0;
    t = -height / slope;
    if (slope > 0.0) {
        if (t > *a)
            *a = t;
    } else if (t < *b)
        *b = t;
    return *a < *b;
}

/* t where the ray meets the polygon; below 0: nowhere in front. */
static double hit(const oracle_polygon *p, const double c[3], const double v[3])
{
    double slope = dot(p->normal, v), to[3], t, point[3];
    subtract(p->corner[0], c, to);
    if (slope == 0.0)
        return -1.0;
    t = dot(p->normal, to) / slope;
    along(c, v, t, point);
    for (int i = 0; i < p->corners; i++) {
        double edge[3], rim[3], side[3];
        subtract(p->corner[(i + 1) % p->corners], p->corner[i], edge);
        subtract(point, p->corner[i], rim);
        cross(edge, rim, side);
        if (dot(side, p->normal) < 0.0)
            return -1.0;
    }
    return t;
}

double oracle_phase(const oracle_medium *medium, double cosine)
{
    double g = medium->g;
    switch (medium->phase) {
    case TYN_PHASE_RAYLEIGH:
        return 3.0 / (16.0 * PI) * (1.0 + cosine * cosine);
    case TYN_PHASE_HG:
        return (1.0 - g * g) / (4.0 * PI * pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
    default:
        return 1.0 / (4.0 * PI);
    }
}

double oracle_extinction(const oracle_scene *scene, int channel)
{
    double sigma = 0.0;
    for (int m = 0; m < scene->media; m++)
        sigma += scene->medium[m].scatter[channel] + scene->medium[m].absorb[channel];
    return sigma;
}

/* Sum of scatter * phase of all components. */
static double scattering(const oracle_scene *scene, int channel, double cosine)
{
    double sum = 0.0;
    for (int m = 0; m < scene->media; m++)
        sum += scene->medium[m].scatter[channel] * oracle_phase(&scene->medium[m], cosine);
    return sum;
}

static int in_cone(const oracle_light *light, const double point[3])
{
    double to[3];
    for (int i = 0; i < 4 && light->texture.rgb; i++)
        if (dot(light->texture.edge[i].n, point) < light->texture.edge[i].d)
            return 0;
    if (light->kind != ORACLE_SPOT || light->texture.rgb)
        return !light->texture.rgb || affine(light->texture.w, point) > 0.0;
    subtract(point, light->position, to);
    return dot(to, light->direction) >= light->cosine * length(to);
}

double oracle_irradiance(const oracle_light *light, const double point[3], double sigma, int channel)
{
    double to[3], r, tint[3] = {1.0, 1.0, 1.0};
    if (light->texture.rgb)
        texture_at(&light->texture, point, tint);
    if (light->kind == ORACLE_DIRECTIONAL)
        return light->colour[channel] * tint[channel];
    subtract(point, light->position, to);
    r = length(to);
    return light->colour[channel] * tint[channel] * exp(-sigma * r) / (r * r);
}

int oracle_lit(const oracle_scene *scene, const oracle_light *light, const double point[3], int except)
{
    double way[3], far = HUGE_VAL;
    if (!in_cone(light, point))
        return 0;
    if (light->kind == ORACLE_DIRECTIONAL) {
        for (int k = 0; k < 3; k++)
            way[k] = -light->direction[k];
    } else {
        subtract(light->position, point, way);
        far = 1.0;
    }
    for (int i = 0; i < scene->polygons; i++) {
        double t = i == except ? -1.0 : hit(&scene->polygon[i], point, way);
        if (t > 1e-9 && t < far)
            return 0;
    }
    return 1;
}

/* ---- quadrature ----------------------------------------------------------------------------------------------------- */

/* A stretch of a view ray in the light of a lamp: what the integrand needs. */
typedef struct beam {
    const oracle_scene *scene;
    const oracle_light *light;
    const double *v;
    double foot; /* t nearest to the light */
    double h;    /* distance there */
} beam;

static const double node[8] = {0.0950125098376374402, 0.2816035507792589132, 0.4580167776572273863, 0.6178762444026437484,
                               0.7554044083550030339, 0.8656312023878317439, 0.9445750230732325761, 0.9894009349916499326};
static const double weight[8] = {0.1894506104550684963, 0.1826034150449235889, 0.1691565193950025382, 0.1495959888165767321,
                                 0.1246289712555338720, 0.0951585116824927848, 0.0622535239386478929, 0.0271524594117540949};

/* In the angle phi at the light, where t = foot + h tan(phi), dt / rho^2 = d phi / h has no pole (Sun et al. 2005). A sun is
 * integrated in t. */
static void integrand(const beam *b, double at, double out[3])
{
    int sun = b->light->kind == ORACLE_DIRECTIONAL;
    double t = sun ? at : b->foot + b->h * tan(at), rho = sun ? 0.0 : b->h / cos(at), point[3];
    double cosine = sun ? -dot(b->light->direction, b->v) : -sin(at), tint[3] = {1.0, 1.0, 1.0};
    if (b->light->texture.rgb) {
        along(b->scene->camera.position, b->v, t, point);
        texture_at(&b->light->texture, point, tint);
    }
    for (int k = 0; k < 3; k++)
        out[k] =
            tint[k] * exp(-oracle_extinction(b->scene, k) * (t + rho)) * scattering(b->scene, k, cosine) / (sun ? 1.0 : b->h);
}

static void panel(const beam *b, double from, double to, double out[3])
{
    double middle = 0.5 * (from + to), half = 0.5 * (to - from), low[3], high[3];
    out[0] = out[1] = out[2] = 0.0;
    for (int i = 0; i < 8; i++) {
        integrand(b, middle - half * node[i], low);
        integrand(b, middle + half * node[i], high);
        for (int k = 0; k < 3; k++)
            out[k] += half * weight[i] * (low[k] + high[k]);
    }
}

static void adaptive(const beam *b, double from, double to, const double whole[3], int depth, double out[3])
{
    double middle = 0.5 * (from + to), left[3], right[3], gap = 0.0, size = 0.0;
    panel(b, from, middle, left);
    panel(b, middle, to, right);
    for (int k = 0; k < 3; k++) {
        gap = fmax(gap, fabs(left[k] + right[k] - whole[k]));
        size = fmax(size, left[k] + right[k]);
    }
    /* the ends carry rounding errors, which a sliver feels: it would never agree with its halves */
    if (gap <= (1e-11 + 4e-15 / (to - from)) * size || depth == 0) {
        for (int k = 0; k < 3; k++)
            out[k] += left[k] + right[k];
        return;
    }
    adaptive(b, from, middle, left, depth - 1, out);
    adaptive(b, middle, to, right, depth - 1, out);
}

/* Adds the light of a lit stretch from .. to of a ray within which a texture has no kink. */
static void add_smooth(const oracle_scene *scene, const oracle_light *light, const double v[3], double from, double to,
                       double out[3])
{
    double lamp[3], whole[3], sum[3] = {0.0, 0.0, 0.0}, rim[3];
    beam b = {scene, light, v, 0.0, 0.0};
    if (light->kind == ORACLE_DIRECTIONAL && light->texture.rgb) {
        panel(&b, from, to, sum);
        for (int k = 0; k < 3; k++)
            out[k] += light->colour[k] * sum[k];
        return;
    }
    if (light->kind == ORACLE_DIRECTIONAL) {
        for (int k = 0; k < 3; k++) {
            double sigma = oracle_extinction(scene, k), path = to - from;
            double fog = sigma * path > 0.0 ? -expm1(-sigma * path) / sigma : path;
            out[k] += light->colour[k] * scattering(scene, k, -dot(light->direction, v)) * exp(-sigma * from) * fog;
        }
        return;
    }
    subtract(light->position, scene->camera.position, lamp);
    b.foot = dot(lamp, v);
    along(lamp, v, -b.foot, rim);
    /* A ray through the lamp: its integral is infinite unless it ends before; this far off, both come out right. */
    b.h = fmax(length(rim), 1e-9 * (1.0 + fabs(b.foot)));
    from = atan((from - b.foot) / b.h);
    to = atan((to - b.foot) / b.h);
    panel(&b, from, to, whole);
    /* Within a texel little is left to adapt to, and where its light is all but 0 the halves would never agree. */
    adaptive(&b, from, to, whole, light->texture.rgb ? 4 : 40, sum);
    for (int k = 0; k < 3; k++)
        out[k] += light->colour[k] * sum[k];
}

static int by_start(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Adds a lit stretch: cut where the ray crosses the lines between texel centres, since bilinear light has a kink there. */
static void add_lit(const oracle_scene *scene, const oracle_light *light, const double v[3], double from, double to,
                    double out[3])
{
    enum { MOST = 4096 };
    static double cut[MOST];
    const oracle_texture *texture = &light->texture;
    size_t count = 0;
    cut[count++] = from;
    for (int axis = 0; axis < 2 && texture->rgb; axis++) {
        const double *row = axis ? texture->y : texture->x, *c = scene->camera.position;
        int size = axis ? texture->height : texture->width;
        for (int i = 0; i < size && count < MOST - 1; i++) { /* (row . (c + t v)) = (i + 0.5) (w . (c + t v)) */
            double line = i + 0.5, slope = dot(row, v) - line * dot(texture->w, v);
            double t = (line * affine(texture->w, c) - affine(row, c)) / slope;
            if (slope != 0.0 && t > from && t < to)
                cut[count++] = t;
        }
    }
    cut[count++] = to;
    qsort(cut, count, sizeof *cut, by_start);
    for (size_t i = 0; i + 1 < count; i++)
        if (cut[i] < cut[i + 1])
            add_smooth(scene, light, v, cut[i], cut[i + 1], out);
}

/* Shrinks a .. b to the cone; 0 when nothing is left. A cone of less than 180 degrees is convex: one interval. */
static int clip_cone(const oracle_scene *scene, const oracle_light *light, const double v[3], double *a, double *b)
{
    double q[3], qa, va, cc = light->cosine * light->cosine, A, B, C, root[2], mark[4], point[3], first = 0.0, last = -1.0;
    int marks = 0;
    for (int i = 0; i < 4 && light->texture.rgb; i++)
        if (!clip(&light->texture.edge[i], scene->camera.position, v, a, b))
            return 0;
    if (light->kind != ORACLE_SPOT || light->texture.rgb)
        return *a < *b;
    subtract(scene->camera.position, light->position, q);
    qa = dot(q, light->direction);
    va = dot(v, light->direction);
    A = va * va - cc;
    B = qa * va - cc * dot(q, v);
    C = qa * qa - cc * dot(q, q);
    mark[marks++] = *a;
    if (B * B - A * C >= 0.0 && A != 0.0) {
        double r = sqrt(B * B - A * C), s = B >= 0.0 ? -B - r : -B + r;
        root[0] = s / A;
        root[1] = s != 0.0 ? C / s : root[0];
        if (root[0] > root[1]) {
            double swap = root[0];
            root[0] = root[1];
            root[1] = swap;
        }
        for (int i = 0; i < 2; i++)
            if (root[i] > mark[marks - 1] && root[i] < *b)
                mark[marks++] = root[i];
    }
    mark[marks++] = *b;
    for (int i = 0; i + 1 < marks; i++) {
        along(scene->camera.position, v, 0.5 * (mark[i] + mark[i + 1]), point);
        if (!in_cone(light, point))
            continue;
        if (last < 0.0)
            first = mark[i];
        last = mark[i + 1];
    }
    *a = first;
    *b = last;
    return first < last;
}

static void scatter_light(const oracle_scene *scene, const oracle_light *light, const double v[3], double s, double out[3])
{
    double *dark = scene->scratch, start = 0.0, end = s;
    size_t count = 0;
    if (!clip_cone(scene, light, v, &start, &end))
        return;
    for (int i = 0; i < scene->polygons; i++) {
        const oracle_volume *volume = &light->volume[i];
        double a = start, b = end;
        int left = volume->planes > 0;
        for (int j = 0; left && j < volume->planes; j++)
            left = clip(&volume->plane[j], scene->camera.position, v, &a, &b);
        if (left) {
            dark[2 * count] = a;
            dark[2 * count++ + 1] = b;
        }
    }
    qsort(dark, count, 2 * sizeof *dark, by_start);
    for (size_t i = 0; i < count; i++) {
        if (dark[2 * i] > start)
            add_lit(scene, light, v, start, dark[2 * i], out);
        start = fmax(start, dark[2 * i + 1]);
    }
    if (start < end)
        add_lit(scene, light, v, start, end, out);
}

void oracle_scatter(oracle_scene *scene, const double v[3], double s, double out[3])
{
    out[0] = out[1] = out[2] = 0.0;
    for (int l = 0; l < scene->lights; l++)
        scatter_light(scene, &scene->light[l], v, s, out);
}

/* ---- pixels --------------------------------------------------------------------------------------------------------- */

void oracle_ray(const oracle_scene *scene, double x, double y, double v[3])
{
    const oracle_camera *c = &scene->camera;
    double px = c->left_edge + (c->right_edge - c->left_edge) * x / scene->width;
    double py = c->top_edge + (c->bottom_edge - c->top_edge) * y / scene->height, size;
    for (int k = 0; k < 3; k++)
        v[k] = c->forward[k] + px * c->right[k] + py * c->up[k];
    size = length(v);
    for (int k = 0; k < 3; k++)
        v[k] /= size;
}

static void surface(const oracle_scene *scene, const double point[3], const double v[3], int polygon, double out[3])
{
    const oracle_polygon *p = &scene->polygon[polygon];
    double side = dot(p->normal, v) > 0.0 ? -1.0 : 1.0, sum[3], way[3];
    memcpy(sum, scene->ambient, sizeof sum);
    for (int l = 0; l < scene->lights; l++) {
        const oracle_light *light = &scene->light[l];
        double facing;
        if (light->kind == ORACLE_DIRECTIONAL)
            memcpy(way, light->direction, sizeof way);
        else
            subtract(point, light->position, way);
        facing = -side * dot(p->normal, way) / length(way);
        if (facing > 0.0 && oracle_lit(scene, light, point, polygon))
            for (int k = 0; k < 3; k++)
                sum[k] += facing * oracle_irradiance(light, point, oracle_extinction(scene, k), k);
    }
    for (int k = 0; k < 3; k++)
        out[k] = p->albedo[k] / PI * sum[k];
}

void oracle_trace(oracle_scene *scene, double x, double y, oracle_pixel *out)
{
    const oracle_camera *c = &scene->camera;
    double v[3], point[3], cosine, s;
    oracle_ray(scene, x, y, v);
    cosine = dot(v, c->forward);
    s = c->far_depth / cosine;
    out->polygon = -1;
    for (int i = 0; i < scene->polygons; i++) {
        double t = hit(&scene->polygon[i], c->position, v);
        if (t * cosine >= c->near_depth && t < s) {
            s = t;
            out->polygon = i;
        }
    }
    out->depth = s * cosine;
    along(c->position, v, s, point);
    oracle_scatter(scene, v, s, out->scatter);
    for (int k = 0; k < 3; k++)
        out->extinct[k] = exp(-oracle_extinction(scene, k) * s);
    if (out->polygon < 0)
        memcpy(out->surface, scene->background, sizeof out->surface);
    else
        surface(scene, point, v, out->polygon, out->surface);
}
