/* shapes.c - a stage, textures, and clay that is formed into meshes. */
#include "shapes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the stage ----------------------------------------------------------------------------------------------------- */

static void copy3(float to[3], const float from[3])
{
    memcpy(to, from, 3 * sizeof(float));
}

static void unit(float v[3])
{
    float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3 && length > 0; i++) {
        v[i] /= length;
    }
}

void stage_camera(scene *s, const float position[3], const float target[3], float fov, float near, float far)
{
    copy3(s->camera.position, position);
    copy3(s->camera.target, target);
    s->camera.fov_y = fov * (SHAPES_PI / 180);
    s->camera.near_depth = near;
    s->camera.far_depth = far;
    s->width = 1280;
    s->height = 720;
}

void stage_colours(scene *s, const float ambient[3], const float background[3])
{
    copy3(s->ambient, ambient);
    copy3(s->background, background);
}

int stage_sun(scene *s, const float direction[3], const float irradiance[3])
{
    scene_light light;
    memset(&light, 0, sizeof light);
    light.light.kind = TYN_LIGHT_DIRECTIONAL;
    copy3(light.light.direction, direction);
    unit(light.light.direction);
    copy3(light.light.colour, irradiance);
    return scene_add_light(s, &light);
}

int stage_spot(scene *s, const float position[3], const float target[3], float angle, const float intensity[3])
{
    scene_light light;
    memset(&light, 0, sizeof light);
    light.light.kind = TYN_LIGHT_SPOT;
    copy3(light.light.position, position);
    for (int i = 0; i < 3; i++) {
        light.light.direction[i] = target[i] - position[i];
    }
    unit(light.light.direction);
    copy3(light.light.colour, intensity);
    light.light.angle = angle * (SHAPES_PI / 180);
    return scene_add_light(s, &light);
}

int stage_medium(scene *s, const float scatter[3], const float absorb[3], tyn_phase phase, float g)
{
    tyn_medium medium;
    memset(&medium, 0, sizeof medium);
    copy3(medium.scatter, scatter);
    copy3(medium.absorb, absorb);
    medium.phase = phase;
    medium.g = g;
    return scene_add_medium(s, &medium);
}

/* ---- textures ------------------------------------------------------------------------------------------------------ */

void shapes_mix(float rgb[3], const float a[3], const float b[3], float t)
{
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    for (int i = 0; i < 3; i++) {
        rgb[i] = a[i] + (b[i] - a[i]) * t;
    }
}

float shapes_step(float low, float high, float x)
{
    float t = (x - low) / (high - low);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

static uint8_t to_byte(float value)
{
    return (uint8_t)(value <= 0 ? 0 : value >= 1 ? 255 : value * 255.0f + 0.5f);
}

const tyn_image *shapes_texture(scene *s, int32_t width, int32_t height, shapes_paint paint)
{
    tyn_image *image = scene_add_image(s, width, height, TYN_RGB8_LINEAR);
    for (int32_t y = 0; image != NULL && y < height; y++) {
        uint8_t *row = (uint8_t *)image->pixels + (size_t)y * (size_t)width * 3;
        for (int32_t x = 0; x < width; x++) {
            float rgb[3];
            paint(((float)x + 0.5f) / (float)width, 1 - ((float)y + 0.5f) / (float)height, rgb);
            for (int i = 0; i < 3; i++) {
                row[3 * x + i] = to_byte(rgb[i]);
            }
        }
    }
    return image;
}

const tyn_image *shapes_mask(scene *s, int32_t size, shapes_paint paint)
{
    tyn_image *image = scene_add_image(s, size, size, TYN_MASK8);
    for (int32_t y = 0; image != NULL && y < size; y++) {
        uint8_t *row = (uint8_t *)image->pixels + (size_t)y * (size_t)size;
        for (int32_t x = 0; x < size; x++) {
            float rgb[3];
            paint(((float)x + 0.5f) / (float)size, 1 - ((float)y + 0.5f) / (float)size, rgb);
            row[x] = rgb[0] >= 0.5f ? 255 : 0;
        }
    }
    return image;
}

/* ---- clay ---------------------------------------------------------------------------------------------------------- */

void clay_start(struct clay *clay, float red, float green, float blue, const tyn_image *texture, float scale)
{
    memset(clay, 0, sizeof *clay);
    clay->albedo[0] = red;
    clay->albedo[1] = green;
    clay->albedo[2] = blue;
    clay->texture = texture;
    clay->scale = scale;
    clay->dim = 1;
    clay_place(clay, 0, 0, 0, 0);
}

void clay_place(struct clay *clay, float x, float y, float z, float turn)
{
    float s = sinf(turn), c = cosf(turn);
    const float frame[4][3] = {{x, y, z}, {c, 0, -s}, {0, 1, 0}, {s, 0, c}};
    memcpy(clay->origin, frame[0], sizeof frame[0]);
    memcpy(clay->x, frame[1], sizeof frame[1]);
    memcpy(clay->y, frame[2], sizeof frame[2]);
    memcpy(clay->z, frame[3], sizeof frame[3]);
}

static void to_world(const struct clay *clay, const float local[3], float world[3])
{
    for (int i = 0; i < 3; i++) {
        world[i] = clay->origin[i] + local[0] * clay->x[i] + local[1] * clay->y[i] + local[2] * clay->z[i];
    }
}

static void face_normal(const float p[3][3], float n[3])
{
    float e[3], f[3];
    for (int i = 0; i < 3; i++) {
        e[i] = p[1][i] - p[0][i];
        f[i] = p[2][i] - p[0][i];
    }
    for (int i = 0; i < 3; i++) {
        n[i] = e[(i + 1) % 3] * f[(i + 2) % 3] - e[(i + 2) % 3] * f[(i + 1) % 3];
    }
    unit(n);
}

static bool part_grow(struct clay_part *part)
{
    if (part->vertices + 3 <= part->room) {
        return true;
    }
    uint32_t room = part->room == 0 ? 384 : part->room * 2;
    float *positions = realloc(part->positions, (size_t)room * 3 * sizeof(float));
    if (positions == NULL) {
        return false;
    }
    part->positions = positions;
    float *texcoords = realloc(part->texcoords, (size_t)room * 2 * sizeof(float));
    if (texcoords == NULL) {
        return false;
    }
    part->texcoords = texcoords;
    part->room = room;
    return true;
}

void clay_triangle(struct clay *clay, const float p[3][3], const float uv[3][2])
{
    float shade = clay->dim;
    if (clay->shade != NULL) {
        float middle[3], normal[3];
        for (int i = 0; i < 3; i++) {
            middle[i] = (p[0][i] + p[1][i] + p[2][i]) / 3;
        }
        face_normal(p, normal);
        shade *= clay->shade(middle, normal);
    }
    shade *= SHAPES_TINTS;
    int32_t tint = shade < 1 ? 0 : shade >= SHAPES_TINTS ? SHAPES_TINTS - 1 : (int32_t)(shade - 0.5f);
    struct clay_part *part = &clay->parts[tint];
    if (clay->broken || !part_grow(part)) {
        clay->broken = true;
        return;
    }
    memcpy(part->positions + 3 * (size_t)part->vertices, p, 9 * sizeof(float));
    memcpy(part->texcoords + 2 * (size_t)part->vertices, uv, 6 * sizeof(float));
    part->vertices += 3;
}

/* Texture coordinates from the position: the plane that the face lies in best. */
static void box_triangle(struct clay *clay, const float *a, const float *b, const float *c)
{
    float p[3][3], uv[3][2], n[3];
    to_world(clay, a, p[0]);
    to_world(clay, b, p[1]);
    to_world(clay, c, p[2]);
    face_normal((const float(*)[3])p, n);
    float x = fabsf(n[0]), y = fabsf(n[1]), z = fabsf(n[2]);
    for (int i = 0; i < 3; i++) {
        uv[i][0] = (x > y && x > z ? p[i][2] : p[i][0]) * clay->scale;
        uv[i][1] = (y >= x && y >= z ? p[i][2] : p[i][1]) * clay->scale;
    }
    clay_triangle(clay, (const float(*)[3])p, (const float(*)[2])uv);
}

void clay_quad(struct clay *clay, const float a[3], const float b[3], const float c[3], const float d[3])
{
    box_triangle(clay, a, b, c);
    box_triangle(clay, a, c, d);
}

static void quad_uv(struct clay *clay, const float *corner[4], float u0, float v0, float u1, float v1)
{
    static const int order[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const float all[4][2] = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
    for (int t = 0; t < 2; t++) {
        float p[3][3], uv[3][2];
        for (int i = 0; i < 3; i++) {
            to_world(clay, corner[order[t][i]], p[i]);
            memcpy(uv[i], all[order[t][i]], sizeof uv[i]);
        }
        clay_triangle(clay, (const float(*)[3])p, (const float(*)[2])uv);
    }
}

void clay_quad_uv(struct clay *clay, const float a[3], const float b[3], const float c[3], const float d[3])
{
    const float *corner[4] = {a, b, c, d};
    quad_uv(clay, corner, 0, 0, 1, 1);
}

void clay_box(struct clay *clay, float x0, float y0, float z0, float x1, float y1, float z1)
{
    static const int face[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    float corner[8][3];
    for (int i = 0; i < 8; i++) {
        corner[i][0] = (i & 1) != 0 ? x1 : x0;
        corner[i][1] = (i & 2) != 0 ? y1 : y0;
        corner[i][2] = (i & 4) != 0 ? z1 : z0;
    }
    for (int i = 0; i < 6; i++) {
        clay_quad(clay, corner[face[i][0]], corner[face[i][1]], corner[face[i][2]], corner[face[i][3]]);
    }
}

void clay_lathe(struct clay *clay, const float (*profile)[2], int32_t points, int32_t segments, int32_t flutes, float depth)
{
    for (int32_t s = 0; s < segments; s++) {
        float ring[2][3]; /* sine, cosine, flute of both sides of the segment */
        for (int i = 0; i < 2; i++) {
            float angle = 2 * SHAPES_PI * (float)((s + i) % segments) / (float)segments;
            ring[i][0] = sinf(angle);
            ring[i][1] = cosf(angle);
            ring[i][2] = flutes > 0 ? 1 - depth * fabsf(cosf(0.5f * angle * (float)flutes)) : 1;
        }
        for (int32_t k = 0; k + 1 < points; k++) {
            float corner[4][3];
            for (int i = 0; i < 4; i++) {
                const float *side = ring[i == 1 || i == 2], *end = profile[k + (i >> 1)];
                corner[i][0] = side[0] * side[2] * end[0];
                corner[i][1] = end[1];
                corner[i][2] = side[1] * side[2] * end[0];
            }
            clay_quad(clay, corner[0], corner[1], corner[2], corner[3]);
        }
    }
}

void clay_tube(struct clay *clay, const float a[3], const float b[3], float ra, float rb, int32_t segments)
{
    float along[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    float length = sqrtf(along[0] * along[0] + along[1] * along[1] + along[2] * along[2]);
    /* Any two directions across it; thin along whichever axis it follows least. */
    float side[3] = {along[1], -along[0], 0}, over[3];
    if (fabsf(along[0]) + fabsf(along[1]) < 0.01f * length) {
        side[0] = length;
        side[1] = 0;
    }
    float norm = sqrtf(side[0] * side[0] + side[1] * side[1]);
    for (int i = 0; i < 3; i++) {
        side[i] /= norm;
    }
    for (int i = 0; i < 3; i++) {
        over[i] = (along[(i + 1) % 3] * side[(i + 2) % 3] - along[(i + 2) % 3] * side[(i + 1) % 3]) / length;
    }
    for (int32_t s = 0; s < segments; s++) {
        float corner[4][3];
        for (int i = 0; i < 4; i++) {
            float angle = 2 * SHAPES_PI * (float)((s + (i == 1 || i == 2)) % segments) / (float)segments;
            const float *end = i < 2 ? a : b;
            float radius = i < 2 ? ra : rb;
            for (int k = 0; k < 3; k++) {
                corner[i][k] = end[k] + radius * (sinf(angle) * side[k] + cosf(angle) * over[k]);
            }
        }
        const float *corners[4] = {corner[0], corner[1], corner[2], corner[3]};
        float u = (float)s / (float)segments;
        quad_uv(clay, corners, u, a[1] * clay->scale, u + 1 / (float)segments, a[1] * clay->scale + length * clay->scale);
    }
}

/* Point i of the opening's right half, counted from the sill upwards to the arch's top. */
static void arch_point(const struct clay_arch *arch, int32_t i, float *x, float *y)
{
    float half = 0.5f * arch->open, radius = half * arch->point;
    if (i == 0) {
        *x = half;
        *y = arch->sill;
        return;
    }
    float end = acosf((radius - half) / radius), angle = end * (float)(i - 1) / (float)arch->segments;
    *x = i - 1 == arch->segments ? 0 : half - radius + radius * cosf(angle);
    *y = arch->spring + radius * sinf(angle);
}

void clay_arch(struct clay *clay, const struct clay_arch *arch)
{
    float far = -arch->thick, edge = 0.5f * arch->width;
    for (int side = -1; side <= 1; side += 2) {
        float m = (float)side;
        for (int32_t i = 0; i <= arch->segments; i++) {
            float x0, y0, x1, y1;
            arch_point(arch, i, &x0, &y0);
            arch_point(arch, i + 1, &x1, &y1);
            /* Beside the straight part: to the wall's edge; above: up to the wall's top. */
            for (int face = 0; face < 2; face++) {
                float z = face == 0 ? 0 : far;
                if (i == 0) {
                    const float a[3] = {m * x0, arch->sill, z}, b[3] = {m * edge, arch->sill, z};
                    const float c[3] = {m * edge, arch->height, z}, d[3] = {m * x0, arch->height, z};
                    clay_quad(clay, a, b, c, d);
                } else {
                    const float a[3] = {m * x1, y1, z}, b[3] = {m * x0, y0, z};
                    const float c[3] = {m * x0, arch->height, z}, d[3] = {m * x1, arch->height, z};
                    clay_quad(clay, a, b, c, d);
                }
            }
            const float a[3] = {m * x0, y0, 0}, b[3] = {m * x0, y0, far}, c[3] = {m * x1, y1, far}, d[3] = {m * x1, y1, 0};
            clay_quad(clay, a, b, c, d);
        }
    }
    if (arch->sill > 0) {
        clay_box(clay, -edge, 0, far, edge, arch->sill, 0);
    }
}

/* From the hole's middle along (c, s) to the wall's edge. */
static float hole_reach(const struct clay_hole *hole, float c, float s)
{
    float across = fabsf(c) < 1e-5f ? 1e5f : (c > 0 ? hole->x1 - hole->x : hole->x0 - hole->x) / c;
    float along = fabsf(s) < 1e-5f ? 1e5f : (s > 0 ? hole->y1 - hole->y : hole->y0 - hole->y) / s;
    return fminf(across, along);
}

void clay_hole(struct clay *clay, const struct clay_hole *hole)
{
    const int segments = 64, rings = 4;
    for (int k = 0; k < segments * rings; k++) {
        float corner[4][3];
        for (int i = 0; i < 4; i++) {
            float angle = 2 * SHAPES_PI * (float)(k % segments + (i == 1 || i == 2)) / (float)segments;
            float c = cosf(angle), s = sinf(angle), part = (float)(k / segments + (i >= 2)) / (float)rings;
            float reach = hole->radius + (hole_reach(hole, c, s) - hole->radius) * part;
            /* The last ring goes a little further: chords between two directions would cut the wall's corners. */
            reach += k / segments == rings - 1 && i >= 2 ? 0.6f : 0;
            corner[i][0] = hole->x + reach * c;
            corner[i][1] = hole->y + reach * s;
            corner[i][2] = hole->z;
        }
        clay_quad(clay, corner[0], corner[1], corner[2], corner[3]);
    }
}

void clay_field(struct clay *clay, float x0, float z0, float x1, float z1, int32_t cells, float (*lift)(float x, float z))
{
    for (int32_t i = 0; i < cells; i++) {
        for (int32_t j = 0; j < cells; j++) {
            float corner[4][3];
            for (int32_t k = 0; k < 4; k++) {
                int32_t column = i + (k == 1 || k == 2), row = j + (k >= 2);
                corner[k][0] = x0 + (x1 - x0) * (float)column / (float)cells;
                corner[k][2] = z0 + (z1 - z0) * (float)row / (float)cells;
                corner[k][1] = lift != NULL ? lift(corner[k][0], corner[k][2]) : 0;
            }
            clay_quad(clay, corner[0], corner[1], corner[2], corner[3]);
        }
    }
}

static bool part_give(struct clay_part *part, scene *s, const tyn_material *material)
{
    uint32_t *indices = malloc((size_t)part->vertices * sizeof *indices);
    for (uint32_t i = 0; indices != NULL && i < part->vertices; i++) {
        indices[i] = i;
    }
    float *positions = part->positions, *texcoords = part->texcoords;
    if (indices == NULL) {
        return false;
    }
    part->positions = part->texcoords = NULL;
    return scene_take_mesh(s, positions, texcoords, part->vertices, indices, part->vertices / 3, material) == 0;
}

int clay_finish(struct clay *clay, scene *s)
{
    bool fine = !clay->broken;
    for (int t = 0; t < SHAPES_TINTS; t++) {
        struct clay_part *part = &clay->parts[t];
        if (fine && part->vertices > 0) {
            float shade = (float)(t + 1) / SHAPES_TINTS;
            tyn_material material = {{shade * clay->albedo[0], shade * clay->albedo[1], shade * clay->albedo[2]}, NULL, NULL};
            material.texture = clay->texture;
            material.mask = clay->mask;
            fine = part_give(part, s, &material);
        }
        free(part->positions);
        free(part->texcoords);
    }
    memset(clay->parts, 0, sizeof clay->parts);
    return fine ? 0 : -1;
}
