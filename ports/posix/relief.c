/* relief.c */
#include "relief.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- depths --------------------------------------------------------------------------------------------------------- */

/* The point at depth 1 of a pixel's ray, from the camera along its axes; orthographic: the ray's offset. */
static void ray_of(const tyn_camera *c, int32_t width, int32_t height, int32_t x, int32_t y, double out[2])
{
    double u = (x + 0.5) / width, v = (y + 0.5) / height;
    out[0] = (double)c->left_edge + u * ((double)c->right_edge - (double)c->left_edge);
    out[1] = (double)c->top_edge + v * ((double)c->bottom_edge - (double)c->top_edge);
}

/* As the manual of tyn_depth_coding has it; infinity for sky. */
static double decode(const foreign *f, double stored, const double ray[2])
{
    const tyn_depth_coding *c = &f->coding;
    int orthographic = f->camera.kind == TYN_CAMERA_ORTHOGRAPHIC;
    double scale = c->scale > 0.0f ? (double)c->scale : 1.0, near, far, t;
    if (c->kind == TYN_CODING_VIEW)
        return stored * scale;
    if (c->kind == TYN_CODING_DISTANCE)
        return orthographic ? stored * scale : stored * scale / sqrt(1.0 + ray[0] * ray[0] + ray[1] * ray[1]);
    if (f->depth.format == TYN_DEPTH_U16)
        stored /= 65535.0;
    near = (double)(c->near_depth > 0.0f ? c->near_depth : f->camera.near_depth);
    far = (double)(c->near_depth > 0.0f ? c->far_depth : f->camera.far_depth);
    t = (stored - (double)c->at_near) / ((double)c->at_far - (double)c->at_near);
    if (orthographic)
        return near + t * (far - near);
    t = 1.0 - t * (1.0 - near / far); /* near / depth; far may be infinite */
    return t > 0.0 ? near / t : HUGE_VAL;
}

static int is_value(double a, float b)
{
    return !(a < (double)b || a > (double)b) && a - a == 0.0;
}

/* One level of the pyramid below: half as wide, each value the mean of the known ones among its four. */
typedef struct level {
    float *value;
    uint8_t *known;
    int32_t width, height;
} level;

static void reduce(const level *from, level *to)
{
    for (int32_t y = 0; y < to->height; y++)
        for (int32_t x = 0; x < to->width; x++) {
            float sum = 0.0f;
            int count = 0;
            for (int k = 0; k < 4; k++) {
                int32_t fx = 2 * x + (k & 1), fy = 2 * y + (k >> 1);
                size_t at = (size_t)fy * (size_t)from->width + (size_t)fx;
                if (fx >= from->width || fy >= from->height || !from->known[at])
                    continue;
                sum += from->value[at];
                count++;
            }
            to->value[(size_t)y * (size_t)to->width + (size_t)x] = count ? sum / (float)count : 0.0f;
            to->known[(size_t)y * (size_t)to->width + (size_t)x] = count > 0;
        }
}

/* Unknown values from the coarser level, bilinearly. */
static void expand(level *to, const level *from)
{
    for (int32_t y = 0; y < to->height; y++)
        for (int32_t x = 0; x < to->width; x++) {
            size_t at = (size_t)y * (size_t)to->width + (size_t)x;
            int32_t x0 = x / 2, y0 = y / 2, x1 = x & 1 ? x0 + 1 : x0 - 1, y1 = y & 1 ? y0 + 1 : y0 - 1;
            const float *v = from->value;
            size_t w = (size_t)from->width;
            if (to->known[at])
                continue;
            x1 = x1 < 0 ? 0 : x1 < from->width ? x1 : from->width - 1;
            y1 = y1 < 0 ? 0 : y1 < from->height ? y1 : from->height - 1;
            to->value[at] = 0.5625f * v[(size_t)y0 * w + (size_t)x0] + 0.1875f * v[(size_t)y0 * w + (size_t)x1] +
                            0.1875f * v[(size_t)y1 * w + (size_t)x0] + 0.0625f * v[(size_t)y1 * w + (size_t)x1];
        }
}

/* Fills what is unknown, from coarse to fine; 1 / depth, since that is linear on planes in the picture. */
static int fill(float *value, uint8_t *known, int32_t width, int32_t height)
{
    level levels[20];
    int count = 1, result = 0;
    levels[0] = (level){value, known, width, height};
    while ((levels[count - 1].width > 1 || levels[count - 1].height > 1) && result == 0) {
        level *l = &levels[count], *finer = &levels[count - 1];
        size_t size;
        l->width = (finer->width + 1) / 2;
        l->height = (finer->height + 1) / 2;
        size = (size_t)l->width * (size_t)l->height;
        l->value = malloc(size * sizeof(float));
        l->known = malloc(size);
        count++;
        if (l->value && l->known)
            reduce(finer, l);
        else
            result = -1;
    }
    for (int i = count - 2; i >= 0 && result == 0; i--)
        expand(&levels[i], &levels[i + 1]);
    for (int i = 1; i < count; i++) {
        free(levels[i].value);
        free(levels[i].known);
    }
    return result;
}

int relief_depths(const foreign *f, float *depth, uint8_t *known)
{
    int32_t width = f->s.width, height = f->s.height;
    size_t count = (size_t)width * (size_t)height, measured = 0;
    double far = (double)f->camera.far_depth, least = far * 1e-6;
    for (size_t i = 0; i < count; i++) {
        double stored = f->depth.format == TYN_DEPTH_U16 ? ((const uint16_t *)f->depth.pixels)[i]
                                                         : (double)((const float *)f->depth.pixels)[i];
        double ray[2], z;
        ray_of(&f->camera, width, height, (int32_t)(i % (size_t)width), (int32_t)(i / (size_t)width), ray);
        z = (f->coding.has_sky && is_value(stored, f->coding.sky)) || stored != stored ? far : decode(f, stored, ray);
        z = z < far ? z : far;
        known[i] = !(f->has_unknown && is_value(stored, f->unknown));
        measured += known[i];
        depth[i] = (float)(1.0 / (z > least ? z : least));
    }
    if (measured == 0) /* nothing to go by: all of it is sky */
        for (size_t i = 0; i < count; i++)
            depth[i] = (float)(1.0 / far);
    else if (measured < count && fill(depth, known, width, height) != 0)
        return -1;
    for (size_t i = 0; i < count; i++)
        depth[i] = 1.0f / depth[i];
    return 0;
}

/* ---- triangles ------------------------------------------------------------------------------------------------------ */

typedef struct sculptor {
    const foreign *f;
    const float *depth;
    const uint8_t *known;
    float jump, thickness, sky;
    int32_t width, height;
    float *positions;
    uint32_t *indices;
    uint32_t triangles, layer; /* layer: vertices from the front to the back side's */
} sculptor;

static void place(const sculptor *s, int32_t x, int32_t y, double depth, float out[3])
{
    const tyn_camera *c = &s->f->camera;
    double ray[2], size = c->kind == TYN_CAMERA_ORTHOGRAPHIC ? 1.0 : depth;
    ray_of(c, s->width, s->height, x, y, ray);
    for (int i = 0; i < 3; i++)
        out[i] = (float)((double)c->position[i] + size * (ray[0] * (double)c->right[i] + ray[1] * (double)c->up[i]) +
                         depth * (double)c->forward[i]);
}

static int hangs(const sculptor *s, uint32_t a, uint32_t b)
{
    float p = s->depth[a], q = s->depth[b], nearer = p < q ? p : q;
    return fabsf(p - q) <= s->jump * nearer;
}

static int solid(const sculptor *s, uint32_t a)
{
    return s->known[a] && s->depth[a] < s->sky;
}

static void triangle(sculptor *s, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *to = s->indices + 3 * (size_t)s->triangles++;
    to[0] = a;
    to[1] = b;
    to[2] = c;
}

/* The strip from an edge of the surface to its back. */
static void wall(sculptor *s, uint32_t a, uint32_t b)
{
    triangle(s, a, b, a + s->layer);
    triangle(s, b, b + s->layer, a + s->layer);
}

/* The two triangles between four pixels, or the one that three of them make. */
static void cell(sculptor *s, uint32_t corner)
{
    uint32_t w = (uint32_t)s->width, p[4] = {corner, corner + 1, corner + w + 1, corner + w};
    int use[4], edge[4], count = 0;
    for (int i = 0; i < 4; i++)
        count += use[i] = solid(s, p[i]);
    for (int i = 0; i < 4; i++)
        edge[i] = use[i] && use[(i + 1) % 4] && hangs(s, p[i], p[(i + 1) % 4]);
    if (count == 4 && edge[0] + edge[1] + edge[2] + edge[3] == 4) {
        triangle(s, p[0], p[1], p[2]);
        triangle(s, p[0], p[2], p[3]);
        return;
    }
    for (int i = 0; i < 4; i++) /* i is the corner between two edges */
        if (edge[i] && edge[(i + 3) % 4] && hangs(s, p[(i + 1) % 4], p[(i + 3) % 4])) {
            triangle(s, p[(i + 3) % 4], p[i], p[(i + 1) % 4]);
            if (s->layer)
                wall(s, p[(i + 1) % 4], p[(i + 3) % 4]);
            return;
        }
    if (s->layer)
        for (int i = 0; i < 4; i++)
            if (edge[i])
                wall(s, p[i], p[(i + 1) % 4]);
}

static int carve(sculptor *s)
{
    uint32_t w = (uint32_t)s->width, h = (uint32_t)s->height, count = w * h;
    for (uint32_t i = 0; i < count; i++) {
        place(s, (int32_t)(i % w), (int32_t)(i / w), (double)s->depth[i], s->positions + 3 * (size_t)i);
        if (s->layer)
            place(s, (int32_t)(i % w), (int32_t)(i / w), (double)s->depth[i] + (double)s->thickness,
                  s->positions + 3 * ((size_t)i + count));
    }
    for (uint32_t y = 0; y + 1 < h; y++)
        for (uint32_t x = 0; x + 1 < w; x++)
            cell(s, y * w + x);
    return 0;
}

int relief_mesh(foreign *f, const float *depth, const uint8_t *known, float jump, float thickness)
{
    sculptor s;
    tyn_material material;
    size_t count = (size_t)f->s.width * (size_t)f->s.height, vertices = thickness > 0.0f ? 2 * count : count;
    memset(&s, 0, sizeof s);
    memset(&material, 0, sizeof material);
    if (vertices > UINT32_MAX / 16 || vertices > SIZE_MAX / 128)
        return -1;
    s.f = f;
    s.depth = depth;
    s.known = known;
    s.jump = jump;
    s.thickness = thickness;
    s.sky = f->camera.far_depth * 0.99999f;
    s.width = f->s.width;
    s.height = f->s.height;
    s.layer = thickness > 0.0f ? (uint32_t)count : 0;
    s.positions = malloc(3 * vertices * sizeof(float));
    s.indices = malloc((thickness > 0.0f ? 18u : 6u) * count * sizeof(uint32_t)); /* of a cell two triangles, or three walls */
    if (!s.positions || !s.indices || carve(&s) != 0) {
        free(s.positions);
        free(s.indices);
        return -1;
    }
    return scene_take_mesh(&f->s, s.positions, NULL, (uint32_t)vertices, s.indices, s.triangles, &material);
}
