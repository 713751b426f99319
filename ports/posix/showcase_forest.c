/* showcase_forest.c - a wood in the morning: the sun is in the picture, behind trunks and leaves. */
#include "showcase_scenes.h"

#include <math.h>

#include "noise.h"
#include "shapes.h"

struct wood {
    struct clay bark, leaf, ground, fern;
    uint32_t dice;
};

static void paint_bark(float u, float v, float rgb[3])
{
    static const float dark[3] = {0.035f, 0.027f, 0.02f}, light[3] = {0.20f, 0.155f, 0.11f}, moss[3] = {0.13f, 0.18f, 0.05f};
    float bend = 0.06f * noise_sum(u * 4, v * 4, 2, 4, 31);
    float ridge = 1 - 2.2f * fabsf(noise_gradient((u + bend) * 16, v * 4, 4 * 4, 32, NULL));
    shapes_mix(rgb, dark, light, 0.2f + 0.6f * ridge + 0.4f * noise_sum(u * 16, v * 16, 3, 16, 33));
    shapes_mix(rgb, rgb, moss, 0.9f * shapes_step(0.05f, 0.5f, noise_sum(u * 3, v * 3, 4, 3, 34)));
}

static void paint_ground(float u, float v, float rgb[3])
{
    static const float soil[3] = {0.08f, 0.06f, 0.035f}, litter[3] = {0.26f, 0.17f, 0.08f}, moss[3] = {0.12f, 0.21f, 0.045f};
    float near, second;
    uint32_t which = 0;
    float warp = noise_sum(u * 24, v * 24, 2, 24, 45);
    noise_cells((u + 0.01f * warp) * 96, (v - 0.01f * warp) * 72, 0, 41, &near, &second, &which);
    shapes_mix(rgb, soil, litter, (float)(which & 255) / 255.0f * shapes_step(0, 0.35f, second - near));
    float patch = noise_sum(u * 5, v * 5, 5, 5, 42);
    shapes_mix(rgb, rgb, moss, shapes_step(-0.25f, 0.2f, patch) * (0.75f + 0.25f * noise_sum(u * 64, v * 64, 2, 64, 43)));
    float grain = 1 + 0.5f * noise_sum(u * 96, v * 96, 2, 96, 44);
    for (int i = 0; i < 3; i++) {
        rgb[i] *= grain;
    }
}

static void paint_leaf(float u, float v, float rgb[3])
{
    static const float young[3] = {0.30f, 0.42f, 0.07f}, old[3] = {0.10f, 0.22f, 0.04f};
    shapes_mix(rgb, old, young, 0.5f + 0.6f * noise_sum(u * 5, v * 5, 3, 5, 51));
}

/* A spray of leaves: ellipses that point away from the twig, which enters at the bottom. */
static void mask_leaves(float u, float v, float rgb[3])
{
    rgb[0] = fabsf(u - 0.5f) < 0.012f && v < 0.6f ? 1.0f : 0.0f;
    for (int32_t i = 0; i < 26; i++) {
        float x = 0.5f + 0.74f * (noise_unit(i, 0, 61) - 0.5f), y = 0.12f + 0.76f * noise_unit(i, 1, 61);
        float angle = atan2f(x - 0.5f, y + 0.1f) + 1.2f * (noise_unit(i, 2, 61) - 0.5f),
              size = 0.07f + 0.05f * noise_unit(i, 3, 61);
        float along = ((u - x) * sinf(angle) + (v - y) * cosf(angle)) / size;
        float across = ((u - x) * cosf(angle) - (v - y) * sinf(angle)) / (0.5f * size);
        if (along * along + fabsf(across) < 1) {
            rgb[0] = 1;
        }
    }
}

/* One frond: a stem with leaflets that grow shorter towards the tip. */
static void mask_fern(float u, float v, float rgb[3])
{
    float x = fabsf(u - 0.5f) * 2, wide = 0.95f * (1 - v) * shapes_step(0.02f, 0.25f, v) + 0.03f;
    float tooth = (v - 0.25f * x) * 18;
    tooth -= floorf(tooth);
    rgb[0] = x < 0.035f || (x < wide && fabsf(tooth - 0.5f) < 0.36f * (1.15f - x / wide)) ? 1.0f : 0.0f;
}

static float ground_height(float x, float z)
{
    return 0.55f * noise_sum(x * 0.11f, z * 0.11f, 4, 0, 71) + 0.001f * x * x;
}

static void spray(struct wood *w, const float at[3], float size)
{
    float turn = noise_next(&w->dice, 0, 2 * SHAPES_PI), lean = noise_next(&w->dice, -0.6f, 1.3f);
    float side[3] = {cosf(turn), noise_next(&w->dice, -0.5f, 0.5f), sinf(turn)};
    float up[3] = {-sinf(turn) * cosf(lean), sinf(lean), cosf(turn) * cosf(lean)}, corner[4][3];
    for (int i = 0; i < 3; i++) {
        corner[0][i] = at[i] - 0.5f * size * side[i];
        corner[1][i] = at[i] + 0.5f * size * side[i];
        corner[2][i] = corner[1][i] + size * up[i];
        corner[3][i] = corner[0][i] + size * up[i];
    }
    w->leaf.dim = noise_next(&w->dice, 0.35f, 1);
    clay_quad_uv(&w->leaf, corner[0], corner[1], corner[2], corner[3]);
}

/* A branch in `parts` bending steps, with sprays along its outer half and smaller branches if depth is left. */
static void branch(struct wood *w, const float from[3], const float way[3], float length, float radius, int depth)
{
    float a[3] = {from[0], from[1], from[2]}, b[3], d[3] = {way[0], way[1], way[2]};
    const int parts = depth > 0 ? 4 : 2;
    for (int k = 0; k < parts; k++) {
        for (int i = 0; i < 3; i++) {
            d[i] += noise_next(&w->dice, -0.28f, 0.28f) + (i == 1 ? 0.05f : 0);
        }
        float norm = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), step = length / (float)parts;
        float thick = radius * (1 - (float)k / (float)parts), thin = radius * (1 - (float)(k + 1) / (float)parts) + 0.004f;
        for (int i = 0; i < 3; i++) {
            d[i] /= norm;
            b[i] = a[i] + step * d[i];
        }
        clay_tube(&w->bark, a, b, thick, thin, depth > 0 ? 6 : 3);
        if (depth > 0 && k > 0) {
            for (int n = 0; n < 2; n++) {
                float turn = noise_next(&w->dice, 0, 2 * SHAPES_PI);
                float side[3] = {0.6f * d[0] + cosf(turn), 0.6f * d[1] + noise_next(&w->dice, -0.3f, 0.6f),
                                 0.6f * d[2] + sinf(turn)};
                branch(w, b, side, length * 0.42f, thin * 0.6f + 0.005f, 0);
            }
        }
        if (depth == 0) {
            for (int n = 0; n < 3; n++) {
                float at[3];
                for (int i = 0; i < 3; i++) {
                    at[i] = b[i] + noise_next(&w->dice, -0.25f, 0.25f);
                }
                spray(w, at, noise_next(&w->dice, 0.45f, 0.85f));
            }
        }
        for (int i = 0; i < 3; i++) {
            a[i] = b[i];
        }
    }
}

static void tree(struct wood *w, float x, float z, float height, float radius, float bare)
{
    float a[3] = {x, ground_height(x, z) - 0.2f, z}, b[3];
    float lean[2] = {noise_next(&w->dice, -0.05f, 0.05f), noise_next(&w->dice, -0.05f, 0.05f)};
    const int parts = 10;
    int sides = radius > 0.2f ? 20 : 10;
    for (int k = 0; k < parts; k++) {
        float t = (float)(k + 1) / (float)parts, flare = k == 0 ? 1.45f : 1;
        float thick = radius * (1 - 0.85f * (t - 0.1f)) * flare, thin = radius * (1 - 0.85f * t);
        b[0] = a[0] + lean[0] * height / (float)parts + noise_next(&w->dice, -0.1f, 0.1f);
        b[1] = a[1] + height / (float)parts;
        b[2] = a[2] + lean[1] * height / (float)parts + noise_next(&w->dice, -0.1f, 0.1f);
        if (k == 0) { /* the roots' flare is short */
            float foot[3] = {a[0], a[1] + 0.7f, a[2]};
            clay_tube(&w->bark, a, foot, thick, radius, sides);
            thick = radius;
            a[1] = foot[1];
        }
        a[1] -= 0.15f * thick; /* tubes overlap, or a gap would open where the trunk bends */
        clay_tube(&w->bark, a, b, thick, thin, sides);
        for (int n = 0; n < 3 && t > bare; n++) {
            float turn = noise_next(&w->dice, 0, 2 * SHAPES_PI), rise = noise_next(&w->dice, 0.1f, 0.8f);
            float way[3] = {cosf(turn), rise, sinf(turn)};
            branch(w, b, way, height * (0.34f - 0.2f * t) * noise_next(&w->dice, 0.8f, 1.3f), thin * 0.4f, 1);
        }
        for (int i = 0; i < 3; i++) {
            a[i] = b[i];
        }
    }
}

static void ferns(struct wood *w, float x, float z, float size)
{
    for (int k = 0; k < 7; k++) {
        float turn = 2 * SHAPES_PI * ((float)k + noise_next(&w->dice, -0.3f, 0.3f)) / 7, y = ground_height(x, z) - 0.05f;
        float c = cosf(turn), s = sinf(turn), h = size * noise_next(&w->dice, 0.7f, 1.1f), half = 0.16f * size;
        w->fern.dim = noise_next(&w->dice, 0.45f, 1);
        const float a[3] = {x + half * s, y, z - half * c}, b[3] = {x - half * s, y, z + half * c};
        const float d[3] = {a[0] + h * c, y + 0.75f * h, a[2] + h * s}, e[3] = {b[0] + h * c, y + 0.75f * h, b[2] + h * s};
        clay_quad_uv(&w->fern, a, b, e, d);
    }
}

/* Trees where no other one is near, and none on the path that leads the eye towards the sun. */
static void plant(struct wood *w)
{
    float stood[120][2];
    int count = 0;
    tree(w, -3.4f, -5.2f, 17, 0.42f, 0.45f);
    tree(w, 4.6f, -7.5f, 18, 0.36f, 0.4f);
    tree(w, 1.5f, -13.5f, 16, 0.33f, 0.38f);
    for (int tries = 0; tries < 1500 && count < 110; tries++) {
        float z = -8 - 62 * noise_next(&w->dice, 0, 1), x = noise_next(&w->dice, -1, 1) * (10 - 0.75f * z);
        float path = 0.09f * -z + 1.1f * sinf(z * 0.15f);
        int free_place = fabsf(x - path) > 1.6f + 0.02f * -z;
        for (int i = 0; i < count; i++) {
            float dx = x - stood[i][0], dz = z - stood[i][1];
            free_place = free_place && dx * dx + dz * dz > 2.6f * 2.6f;
        }
        if (free_place) {
            stood[count][0] = x;
            stood[count++][1] = z;
            tree(w, x, z, noise_next(&w->dice, 11, 18), noise_next(&w->dice, 0.12f, 0.32f), noise_next(&w->dice, 0.35f, 0.6f));
        }
    }
    for (int i = 0; i < 420; i++) {
        float z = 0.5f - 30 * noise_next(&w->dice, 0, 1), x = noise_next(&w->dice, -1, 1) * (3.5f - 0.7f * z);
        if (fabsf(x - 0.09f * -z - 1.1f * sinf(z * 0.15f)) > 1.0f) {
            ferns(w, x, z, noise_next(&w->dice, 0.35f, 0.85f));
        }
    }
}

int scene_forest(scene *s)
{
    static const float position[3] = {0, 1.55f, 3}, target[3] = {-1.5f, 3.4f, -12}, sun[3] = {-0.10f, -0.34f, 0.93f};
    static const float warm[3] = {19, 13.2f, 6.6f}, ambient[3] = {0.8f, 1.2f, 1.15f}, sky[3] = {0.9f, 1.05f, 1.1f};
    static const float fog[3] = {0.0145f, 0.0165f, 0.0185f}, glow[3] = {0.005f, 0.005f, 0.005f}, none[3] = {0, 0, 0};
    struct wood w;
    stage_camera(s, position, target, 56, 0.1f, 75);
    stage_colours(s, ambient, sky);
    if (stage_sun(s, sun, warm) != 0 || stage_medium(s, fog, none, TYN_PHASE_HG, 0.65f) != 0 ||
        stage_medium(s, glow, none, TYN_PHASE_HG, 0.85f) != 0) {
        return -1;
    }
    w.dice = 1;
    clay_start(&w.bark, 1, 1, 1, shapes_texture(s, 256, 256, paint_bark), 0.5f);
    clay_start(&w.leaf, 1, 1, 1, shapes_texture(s, 64, 64, paint_leaf), 1);
    clay_start(&w.fern, 0.9f, 1, 0.8f, w.leaf.texture, 1);
    clay_start(&w.ground, 1, 1, 1, shapes_texture(s, 1024, 1024, paint_ground), 0.2f);
    w.leaf.mask = shapes_mask(s, 128, mask_leaves);
    w.fern.mask = shapes_mask(s, 256, mask_fern);
    plant(&w);
    clay_field(&w.ground, -70, -90, 70, 20, 220, ground_height);
    int status = clay_finish(&w.bark, s) | clay_finish(&w.leaf, s) | clay_finish(&w.fern, s) | clay_finish(&w.ground, s);
    return status == 0 && s->image_count == 5 ? 0 : -1;
}
