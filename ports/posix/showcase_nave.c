/* showcase_nave.c - the inside of a church: sun through its windows. */
#include "showcase_scenes.h"

#include <math.h>

#include "noise.h"
#include "shapes.h"

#define BAY 5.0f    /* from column to column */
#define BAYS 10     /* in front of the camera */
#define HALF 4.4f   /* the nave's half width */
#define OUTER 8.8f  /* the outer walls */
#define SPRING 4.6f /* where the arcade's arches start */
#define UPPER 8.2f  /* where the upper wall with its windows starts */
#define VAULT 12.8f /* where the vault starts */
#define ENTRY 10.0f /* z of the end behind the camera */
#define END (ENTRY - BAY * (BAYS + 2))

static void paint_stone(float u, float v, float rgb[3])
{
    static const float dark[3] = {0.42f, 0.36f, 0.29f}, light[3] = {0.72f, 0.66f, 0.56f};
    /* Courses of ashlar, every second one shifted by half a block. */
    float row = floorf(v * 8), x = u * 4 + (fmodf(row, 2) > 0 ? 0.5f : 0), across = x - floorf(x), up = v * 8 - row;
    float joint = shapes_step(0, 0.03f, fminf(across, 1 - across)) * shapes_step(0, 0.07f, fminf(up, 1 - up));
    float block = noise_unit((int32_t)floorf(x) % 4, (int32_t)row, 5);
    float grain = noise_sum(u * 12, v * 12, 5, 12, 3), stain = noise_sum(u * 3, v * 3, 3, 3, 9);
    shapes_mix(rgb, dark, light, 0.5f + 0.35f * grain + 0.5f * stain + 0.45f * (block - 0.5f));
    for (int i = 0; i < 3; i++) {
        rgb[i] *= 0.72f + 0.28f * joint;
    }
}

static void paint_floor(float u, float v, float rgb[3])
{
    static const float dark[3] = {0.13f, 0.12f, 0.12f}, light[3] = {0.58f, 0.52f, 0.44f};
    float x = u * 4, y = v * 4, cx = x - floorf(x), cy = y - floorf(y);
    int32_t column = (int32_t)floorf(x), row = (int32_t)floorf(y);
    float joint = shapes_step(0, 0.025f, fminf(fminf(cx, 1 - cx), fminf(cy, 1 - cy)));
    float vein = noise_sum(u * 8 + (float)column * 3, v * 8, 4, 8, (uint32_t)(column * 7 + row));
    shapes_mix(rgb, dark, light, ((column + row) % 2 == 0 ? 0.82f : 0.12f) + 0.22f * vein);
    for (int i = 0; i < 3; i++) {
        rgb[i] *= (0.6f + 0.4f * joint) * (0.85f + 0.3f * noise_unit(column, row, 8));
    }
}

static void paint_wood(float u, float v, float rgb[3])
{
    static const float dark[3] = {0.06f, 0.033f, 0.018f}, light[3] = {0.25f, 0.14f, 0.07f};
    shapes_mix(rgb, dark, light, 0.5f + 0.7f * noise_sum(u * 4, v * 32, 4, 4, 21) + 0.3f * noise_sum(u * 4, v * 4, 2, 4, 22));
}

/* Light that comes from the sunny right and from the floor: dark in the aisles' corners and high in the vault. */
static float shade_stone(const float p[3], const float n[3])
{
    float shade = 0.62f - 0.14f * fabsf(n[1]) + 0.06f * n[2];
    shade *= 0.55f + 0.45f * shapes_step(0, 1.2f, p[1]);
    shade *= 1 - 0.45f * shapes_step(VAULT, VAULT + 4.5f, p[1]);
    if (fabsf(p[0]) > HALF + 0.5f) {
        shade *= 0.75f;
    }
    return shade;
}

static float shade_floor(const float p[3], const float n[3])
{
    (void)n;
    float edge = fminf(fabsf(fabsf(p[0]) - HALF), fabsf(fabsf(p[0]) - OUTER));
    return 0.7f + 0.3f * shapes_step(0, 1.5f, edge);
}

static void build_column(struct clay *stone, float x, float z)
{
    static const float foot[][2] = {{0.70f, 0.34f}, {0.78f, 0.40f}, {0.78f, 0.48f}, {0.66f, 0.56f}, {0.62f, 0.62f}};
    static const float shaft[][2] = {{0.56f, 0.62f}, {0.57f, 1.6f}, {0.53f, 2.8f}, {0.49f, 3.8f}};
    static const float head[][2] = {{0.50f, 3.78f}, {0.58f, 3.82f}, {0.58f, 3.90f}, {0.50f, 3.95f},
                                    {0.54f, 4.1f},  {0.66f, 4.26f}, {0.82f, 4.38f}};
    clay_place(stone, x, 0, z, 0);
    clay_box(stone, -0.85f, 0, -0.85f, 0.85f, 0.34f, 0.85f);
    clay_lathe(stone, foot, 5, 32, 0, 0);
    clay_lathe(stone, shaft, 4, 64, 16, 0.07f);
    clay_lathe(stone, head, 7, 32, 0, 0);
    clay_box(stone, -0.85f, 4.38f, -0.85f, 0.85f, SPRING + 0.02f, 0.85f);
}

/* One side: arcade, upper wall, aisle with its roof and outer wall. side 1: right, towards the sun. */
static void build_side(struct clay *stone, float side)
{
    static const struct clay_arch arcade = {BAY, UPPER - SPRING, 0.9f, BAY - 1.5f, 0, 0.02f, 1.25f, 14};
    static const struct clay_arch upper = {BAY, VAULT - UPPER + 0.4f, 0.9f, 2.3f, 0.7f, 2.7f, 1.3f, 10};
    static const struct clay_arch outer = {BAY, 7.0f, 0.7f, 2.9f, 0.9f, 4.0f, 1.3f, 12};
    float turn = -side * 0.5f * SHAPES_PI;
    for (int bay = 0; bay < BAYS + 2; bay++) {
        float z = ENTRY - BAY * ((float)bay + 0.5f);
        clay_place(stone, side * (HALF - 0.45f), SPRING, z, turn);
        clay_arch(stone, &arcade);
        clay_place(stone, side * (HALF - 0.45f), UPPER, z, turn);
        clay_arch(stone, &upper);
        clay_place(stone, side * OUTER, 0, z, turn);
        clay_arch(stone, &outer);
        build_column(stone, side * HALF, z - 0.5f * BAY);
        /* A shaft of the wall that carries the vault's rib. */
        clay_place(stone, side * (HALF - 0.45f), 0, z - 0.5f * BAY, 0);
        const float low[3] = {0, SPRING, 0}, high[3] = {0, VAULT, 0};
        clay_tube(stone, low, high, 0.2f, 0.2f, 16);
    }
    clay_place(stone, 0, 0, 0, 0);
    float inner = side * (HALF - 0.5f), rim = side * (OUTER + 0.8f);
    for (int layer = 0; layer < 2; layer++) { /* the aisle's roof is thick, or the sun would creep in at its edges */
        float y = 0.35f * (float)layer, out = rim + side * y;
        const float a[3] = {inner, UPPER + y, ENTRY}, b[3] = {inner, UPPER + y, END};
        const float c[3] = {out, 6.7f + y, END}, d[3] = {out, 6.7f + y, ENTRY};
        clay_quad(stone, a, b, c, d);
    }
    clay_box(stone, side * (HALF - 0.55f), UPPER - 0.12f, END, side * (HALF - 0.3f), UPPER + 0.12f, ENTRY);
}

/* The vault's cross-section: pointed. t from 0 (right wall) to 1 (left wall). */
static void vault_point(float t, float scale, float *x, float *y)
{
    float half = HALF - 0.45f, radius = half * 1.3f, end = acosf((radius - half) / radius);
    float angle = end * (t < 0.5f ? t : 1 - t) * 2;
    *x = (half - radius + radius * cosf(angle)) * (t < 0.5f ? scale : -scale);
    *y = VAULT + radius * sinf(angle) * scale;
}

static void build_vault(struct clay *stone)
{
    for (int i = 0; i < 24; i++) {
        float x0, y0, x1, y1;
        for (int shell = 0; shell < 2; shell++) { /* the outer one keeps the sun off the ribs */
            float scale = shell == 0 ? 1.0f : 1.12f;
            vault_point((float)i / 24, scale, &x0, &y0);
            vault_point((float)(i + 1) / 24, scale, &x1, &y1);
            for (int bay = 0; bay < (BAYS + 2) * 2; bay++) {
                float z0 = ENTRY - 0.5f * BAY * (float)bay, z1 = z0 - 0.5f * BAY;
                const float a[3] = {x0, y0, z0}, b[3] = {x0, y0, z1}, c[3] = {x1, y1, z1}, d[3] = {x1, y1, z0};
                clay_quad(stone, a, b, c, d);
            }
        }
        vault_point((float)i / 24, 0.985f, &x0, &y0);
        vault_point((float)(i + 1) / 24, 0.985f, &x1, &y1);
        for (int bay = 0; bay < BAYS + 2; bay++) {
            float z = ENTRY - BAY * (float)(bay + 1);
            const float a[3] = {x0, y0, z}, b[3] = {x1, y1, z};
            clay_tube(stone, a, b, 0.19f, 0.19f, 8);
        }
    }
}

static void build_lancets(struct clay *stone)
{
    static const struct clay_arch lancet = {HALF * 0.66f + 0.1f, 19, 0.9f, 1.9f, 2.6f, 9.5f, 1.3f, 12};
    for (int i = -1; i <= 1; i++) {
        clay_place(stone, (float)i * (HALF * 0.66f + 0.1f), 0, END, 0);
        clay_arch(stone, &lancet);
    }
    clay_place(stone, 0, 0, 0, 0);
}

/* Tracery: 1 is stone. A rose of twelve petals around a ring of twelve circles around a star. */
static void mask_rose(float u, float v, float rgb[3])
{
    float x = 2 * u - 1, y = 2 * v - 1, radius = sqrtf(x * x + y * y), twelfth = SHAPES_PI / 6;
    float angle = atan2f(x, y) + SHAPES_PI, part = angle - floorf(angle / twelfth) * twelfth - 0.5f * twelfth;
    float across = radius * sinf(part), along = radius * cosf(part);
    float wide = 0.228f * (along - 0.45f) / 0.3f * 0.62f + 0.055f;
    int petal = along > 0.46f && along < 0.77f && fabsf(across) < wide;
    petal |= across * across + (along - 0.77f) * (along - 0.77f) < 0.176f * 0.176f && along >= 0.77f;
    int circle = across * across + (along - 0.345f) * (along - 0.345f) < 0.066f * 0.066f;
    float sixth = angle * 0.5f / twelfth + 0.25f;
    sixth -= floorf(sixth) + 0.5f;
    int star = radius < 0.245f - 0.3f * fabsf(sixth) && radius > 0.07f;
    rgb[0] = petal || circle || star || radius < 0.045f ? 0.0f : 1.0f;
}

/* The wall with the rose, two layers of tracery in it, and small lancets below. */
static void build_rose(struct clay *stone, struct clay *rose)
{
    static const struct clay_arch lancet = {1.62f, 5.6f, 0.8f, 0.85f, 1.8f, 4.0f, 1.3f, 10};
    const struct clay_hole inner = {-HALF, 5.6f, HALF, 19, END, 0, 11.3f, 3.6f};
    struct clay_hole outer = inner;
    outer.z = END - 0.8f;
    clay_hole(stone, &inner);
    clay_hole(stone, &outer);
    for (int i = -2; i <= 2; i++) {
        clay_place(stone, 1.62f * (float)i, 0, END, 0);
        clay_arch(stone, &lancet);
    }
    clay_place(stone, 0, 0, 0, 0);
    for (int layer = 0; layer < 2; layer++) {
        float r = inner.radius * 1.01f, z = END - 0.25f - 0.25f * (float)layer, y = inner.y;
        const float a[3] = {-r, y - r, z}, b[3] = {r, y - r, z}, c[3] = {r, y + r, z}, d[3] = {-r, y + r, z};
        clay_quad_uv(rose, a, b, c, d);
    }
    for (int k = 0; k < 64; k++) { /* mouldings around it */
        float a0 = 2 * SHAPES_PI * (float)k / 64, a1 = 2 * SHAPES_PI * (float)(k + 1) / 64;
        for (int ring = 0; ring < 3; ring++) {
            float r = inner.radius + 0.32f * (float)ring - 0.05f, z = END - (ring == 0 ? 0.1f : 0);
            const float a[3] = {r * sinf(a0), inner.y + r * cosf(a0), z}, b[3] = {r * sinf(a1), inner.y + r * cosf(a1), z};
            clay_tube(stone, a, b, 0.12f, 0.12f, 8);
        }
    }
}

/* What no opening is in: the aisles' ends and the wall behind the camera. */
static void build_ends(struct clay *stone)
{
    clay_box(stone, -OUTER - 1, 0, END - 1, -HALF, 13, END);
    clay_box(stone, HALF, 0, END - 1, OUTER + 1, 13, END);
    clay_box(stone, -OUTER - 1, 0, ENTRY, OUTER + 1, 19, ENTRY + 1);
}

static void build_pews(struct clay *wood)
{
    for (int side = -1; side <= 1; side += 2) {
        for (int row = 0; row < 34; row++) {
            float z = -4 - 1.15f * (float)row, x0 = (float)side * 1.25f, x1 = (float)side * 3.3f;
            clay_box(wood, x0, 0.42f, z - 0.4f, x1, 0.47f, z);
            clay_box(wood, x0, 0.42f, z, x1, 0.95f, z + 0.05f);
            clay_box(wood, x0, 0, z - 0.45f, x0 + (float)side * 0.06f, 1.02f, z + 0.08f);
            clay_box(wood, x1, 0, z - 0.45f, x1 - (float)side * 0.06f, 1.02f, z + 0.08f);
        }
    }
}

/* The same church for both pictures: `rose` tells which end it has. */
static int build_church(scene *s, int rose)
{
    struct clay stone, floor, wood, tracery;
    clay_start(&stone, 0.95f, 0.95f, 0.95f, shapes_texture(s, 512, 512, paint_stone), 0.28f);
    clay_start(&floor, 0.9f, 0.9f, 0.9f, shapes_texture(s, 512, 512, paint_floor), 0.25f);
    clay_start(&wood, 1, 1, 1, shapes_texture(s, 256, 256, paint_wood), 0.5f);
    clay_start(&tracery, 0.3f, 0.27f, 0.23f, NULL, 1);
    tracery.mask = shapes_mask(s, 1024, mask_rose);
    stone.shade = shade_stone;
    floor.shade = shade_floor;
    build_side(&stone, -1);
    build_side(&stone, 1);
    build_vault(&stone);
    build_ends(&stone);
    if (rose) {
        build_rose(&stone, &tracery);
    } else {
        build_lancets(&stone);
        build_pews(&wood);
    }
    clay_field(&floor, -OUTER, END, OUTER, ENTRY, 40, NULL);
    int status = clay_finish(&stone, s) | clay_finish(&floor, s) | clay_finish(&wood, s) | clay_finish(&tracery, s);
    return status == 0 && s->image_count == 4 ? 0 : -1;
}

int scene_pillars(scene *s)
{
    static const float position[3] = {-2.9f, 1.7f, 6}, target[3] = {1.6f, 5.1f, -9}, sun[3] = {-0.72f, -0.66f, 0.2f};
    static const float warm[3] = {34, 24.5f, 14.5f}, ambient[3] = {0.6f, 0.75f, 1.05f}, sky[3] = {2.6f, 2.5f, 2.3f};
    static const float dust[3] = {0.027f, 0.0275f, 0.028f}, none[3] = {0, 0, 0};
    stage_camera(s, position, target, 66, 0.1f, 80);
    stage_colours(s, ambient, sky);
    if (stage_sun(s, sun, warm) != 0 || stage_medium(s, dust, none, TYN_PHASE_HG, 0.6f) != 0) {
        return -1;
    }
    return build_church(s, 0);
}

int scene_rose(scene *s)
{
    static const float position[3] = {2.7f, 1.6f, END + 18.5f}, target[3] = {-1.0f, 6.0f, END}, sun[3] = {-0.16f, -0.6f, 0.74f};
    static const float warm[3] = {34, 25, 15}, ambient[3] = {0.5f, 0.65f, 0.95f}, sky[3] = {2.2f, 2.4f, 2.7f};
    static const float dust[3] = {0.03f, 0.03f, 0.03f}, none[3] = {0, 0, 0};
    stage_camera(s, position, target, 64, 0.1f, 60);
    stage_colours(s, ambient, sky);
    if (stage_sun(s, sun, warm) != 0 || stage_medium(s, dust, none, TYN_PHASE_HG, 0.5f) != 0) {
        return -1;
    }
    return build_church(s, 1);
}
