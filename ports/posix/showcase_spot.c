/* showcase_spot.c - two lamps in smoke: one behind a fan that looks at the camera, one above a grating. */
#include "showcase_scenes.h"

#include <math.h>

#include "noise.h"
#include "shapes.h"

#define ROOM 4.6f    /* half width */
#define CEILING 5.0f /* height */
#define BACK (-8.0f) /* the wall with the fan */
#define FRONT 6.0f
#define FAN_X 0.5f
#define FAN_Y 2.55f
#define FAN_R 1.95f

static void paint_concrete(float u, float v, float rgb[3])
{
    static const float dark[3] = {0.16f, 0.16f, 0.165f}, light[3] = {0.44f, 0.43f, 0.42f};
    float x = u * 2 - floorf(u * 2), y = v * 2 - floorf(v * 2);
    float joint = shapes_step(0, 0.012f, fminf(fminf(x, 1 - x), fminf(y, 1 - y)));
    float drip = shapes_step(0.1f, 0.7f, noise_sum(u * 12, v * 1, 3, 1, 103)) * 0.3f;
    float pour = noise_unit((int32_t)(u * 2), (int32_t)(v * 2), 104) * 0.25f;
    shapes_mix(rgb, dark, light, 0.35f + pour + 0.5f * noise_sum(u * 6, v * 6, 6, 6, 101) - drip);
    for (int i = 0; i < 3; i++) {
        rgb[i] *= 0.45f + 0.55f * joint;
    }
}

static void paint_floor(float u, float v, float rgb[3])
{
    static const float dark[3] = {0.10f, 0.10f, 0.105f}, light[3] = {0.40f, 0.39f, 0.37f};
    float near, second;
    uint32_t which = 0;
    noise_cells(u * 5 + 0.3f * noise_sum(u * 8, v * 8, 3, 8, 114), v * 5, 5, 112, &near, &second, &which);
    float crack = shapes_step(0, 0.02f, second - near);
    shapes_mix(rgb, dark, light, 0.45f + 0.7f * noise_sum(u * 7, v * 7, 6, 7, 111));
    for (int i = 0; i < 3; i++) {
        rgb[i] *= 0.6f + 0.4f * crack;
    }
}

static void paint_metal(float u, float v, float rgb[3])
{
    static const float steel[3] = {0.20f, 0.21f, 0.22f}, rust[3] = {0.26f, 0.11f, 0.045f};
    shapes_mix(rgb, steel, rust, shapes_step(0.0f, 0.55f, noise_sum(u * 5, v * 5, 6, 5, 121)));
    float grain = 1 + 0.35f * noise_sum(u * 24, v * 24, 3, 24, 122);
    for (int i = 0; i < 3; i++) {
        rgb[i] *= grain;
    }
}

static float shade_room(const float p[3], const float n[3])
{
    float corner = fminf(fminf(ROOM - fabsf(p[0]), CEILING - p[1]), fminf(p[1] + 0.5f, p[2] - BACK + 0.5f));
    return (0.75f + 0.25f * fabsf(n[1])) * (0.5f + 0.5f * shapes_step(-0.1f, 1.4f, corner));
}

/* The back wall around the fan's hole, and the hole's rim. */
static void build_back(struct clay *wall, struct clay *metal)
{
    static const struct clay_hole hole = {-ROOM, 0, ROOM, CEILING, BACK, FAN_X, FAN_Y, FAN_R};
    clay_hole(wall, &hole);
    static const float rim[][2] = {{2.0f, 0.0f}, {2.15f, 0.0f}, {2.15f, 0.14f}, {1.95f, 0.14f}, {1.9f, 0.06f}, {1.9f, -0.9f}};
    /* The lathe turns about +y: lay it down, so that its axis points at the camera. */
    clay_place(metal, FAN_X, FAN_Y, BACK, 0);
    metal->y[1] = 0;
    metal->y[2] = 1;
    metal->z[1] = 1;
    metal->z[2] = 0;
    clay_lathe(metal, rim, 6, 64, 0, 0);
    static const float hub[][2] = {{0.0f, -0.12f}, {0.22f, -0.12f}, {0.34f, -0.2f}, {0.34f, -0.6f}, {0.0f, -0.6f}};
    clay_lathe(metal, hub, 5, 32, 0, 0);
    clay_place(metal, 0, 0, 0, 0);
    for (int k = 0; k < 24; k++) {
        float angle = 2 * SHAPES_PI * (float)k / 24, x = FAN_X + 2.07f * cosf(angle), y = FAN_Y + 2.07f * sinf(angle);
        clay_box(metal, x - 0.035f, y - 0.035f, BACK + 0.1f, x + 0.035f, y + 0.035f, BACK + 0.18f);
    }
}

static void build_fan(struct clay *metal)
{
    const int blades = 5, parts = 10;
    for (int blade = 0; blade < blades; blade++) {
        for (int k = 0; k < parts; k++) {
            float corner[4][3];
            for (int i = 0; i < 4; i++) {
                float t = (float)(k + (i >= 2)) / (float)parts, radius = 0.3f + 1.57f * t;
                float middle = 2 * SHAPES_PI * ((float)blade + 0.21f) / (float)blades + 0.25f * t;
                float half = (0.34f + 0.05f * sinf(3 * t)) * (1 - 0.25f * t * t), side = i == 1 || i == 2 ? half : -half;
                corner[i][0] = FAN_X + radius * cosf(middle + side);
                corner[i][1] = FAN_Y + radius * sinf(middle + side);
                corner[i][2] = BACK - 0.4f + side * (0.55f - 0.3f * t);
            }
            clay_quad(metal, corner[0], corner[1], corner[2], corner[3]);
        }
    }
    for (int k = 0; k < 3; k++) {
        float angle = SHAPES_PI * ((float)k + 0.5f) / 3, c = FAN_R * cosf(angle), s = FAN_R * sinf(angle);
        const float a[3] = {FAN_X - c, FAN_Y - s, BACK - 0.75f}, b[3] = {FAN_X + c, FAN_Y + s, BACK - 0.75f};
        clay_tube(metal, a, b, 0.05f, 0.05f, 8);
    }
}

/* The ceiling with a hole, slats in it, and what hangs and stands about. */
static void build_room(struct clay *wall, struct clay *metal)
{
    const float x0 = -3.7f, x1 = -1.9f, z0 = -5.4f, z1 = -2.6f;
    clay_box(wall, -ROOM, CEILING, BACK, x0, CEILING + 0.3f, FRONT);
    clay_box(wall, x1, CEILING, BACK, ROOM, CEILING + 0.3f, FRONT);
    clay_box(wall, x0, CEILING, BACK, x1, CEILING + 0.3f, z0);
    clay_box(wall, x0, CEILING, z1, x1, CEILING + 0.3f, FRONT);
    for (int k = 0; k < 9; k++) {
        float z = z0 + (z1 - z0) * ((float)k + 0.5f) / 9;
        clay_box(metal, x0, CEILING - 0.02f, z - 0.07f, x1, CEILING + 0.1f, z + 0.07f);
    }
    clay_box(metal, 0.5f * (x0 + x1) - 0.06f, CEILING - 0.04f, z0, 0.5f * (x0 + x1) + 0.06f, CEILING + 0.1f, z1);
    for (int side = -1; side <= 1; side += 2) {
        for (int k = 0; k < 5; k++) { /* walls of panels between ribs */
            float za = FRONT - 2.8f * (float)k, zb = za - 2.8f, x = (float)side * ROOM;
            const float a[3] = {x, 0, za}, b[3] = {x, 0, zb}, c[3] = {x, CEILING, zb}, d[3] = {x, CEILING, za};
            clay_quad(wall, a, b, c, d);
            clay_box(wall, x - (float)side * 0.28f, 0, zb - 0.2f, x, CEILING, zb + 0.2f);
        }
    }
    for (int k = 0; k < 4; k++) {
        float y = 3.5f + 0.3f * (float)k, radius = 0.06f + 0.035f * (float)(k & 1);
        const float a[3] = {ROOM - 0.42f, y, FRONT}, b[3] = {ROOM - 0.42f, y, BACK};
        clay_tube(metal, a, b, radius, radius, 14);
    }
    for (int k = 0; k < 5; k++) { /* beams under the ceiling */
        float z = FRONT - 2.8f * (float)(k + 1);
        clay_box(metal, -ROOM, CEILING - 0.35f, z - 0.1f, ROOM, CEILING - 0.05f, z + 0.1f);
    }
}

/* A cable that hangs between two points. */
static void build_cable(struct clay *metal, const float from[3], const float to[3], float sag, float radius)
{
    float a[3] = {from[0], from[1], from[2]}, b[3];
    for (int k = 1; k <= 16; k++) {
        float t = (float)k / 16;
        for (int i = 0; i < 3; i++) {
            b[i] = from[i] + (to[i] - from[i]) * t - (i == 1 ? 4 * sag * t * (1 - t) : 0);
        }
        clay_tube(metal, a, b, radius, radius, 6);
        for (int i = 0; i < 3; i++) {
            a[i] = b[i];
        }
    }
}

static void build_barrel(struct clay *metal, float x, float z)
{
    static const float barrel[][2] = {{0.0f, 0.88f},   {0.27f, 0.88f}, {0.29f, 0.9f},   {0.3f, 0.88f},
                                      {0.285f, 0.86f}, {0.285f, 0.6f}, {0.3f, 0.585f},  {0.285f, 0.57f},
                                      {0.285f, 0.3f},  {0.3f, 0.285f}, {0.285f, 0.27f}, {0.285f, 0}};
    clay_place(metal, x, 0, z, 0);
    clay_lathe(metal, barrel, 12, 28, 0, 0);
    clay_place(metal, 0, 0, 0, 0);
}

/* Somebody in a coat and a hat, for scale. */
static void build_figure(struct clay *cloth, float x, float z)
{
    static const float coat[][2] = {{0.30f, 0.42f}, {0.27f, 0.7f},  {0.22f, 1.0f},  {0.215f, 1.15f}, {0.25f, 1.36f},
                                    {0.24f, 1.45f}, {0.15f, 1.52f}, {0.08f, 1.55f}, {0.075f, 1.6f}};
    static const float head[][2] = {{0.0f, 1.56f}, {0.07f, 1.58f},  {0.10f, 1.66f}, {0.105f, 1.74f}, {0.2f, 1.755f},
                                    {0.2f, 1.77f}, {0.115f, 1.78f}, {0.11f, 1.88f}, {0.06f, 1.9f},   {0.0f, 1.89f}};
    clay_place(cloth, x, 0, z, 0.25f);
    cloth->z[0] *= 0.7f; /* broader than deep */
    cloth->z[2] *= 0.7f;
    clay_lathe(cloth, coat, 9, 24, 12, 0.06f);
    clay_place(cloth, x, 0, z, 0.25f);
    clay_lathe(cloth, head, 10, 24, 0, 0);
    for (int side = -1; side <= 1; side += 2) {
        float m = (float)side;
        const float hip[3] = {m * 0.10f, 0.6f, 0}, foot[3] = {m * 0.15f, 0.02f, m * 0.06f},
                    toe[3] = {m * 0.17f, 0.04f, m * 0.06f - 0.18f};
        const float shoulder[3] = {m * 0.235f, 1.43f, 0}, elbow[3] = {m * 0.33f, 1.14f, 0.04f},
                    hand[3] = {m * 0.30f, 0.86f, -0.05f};
        clay_tube(cloth, hip, foot, 0.10f, 0.065f, 10);
        clay_tube(cloth, foot, toe, 0.06f, 0.04f, 8);
        clay_tube(cloth, shoulder, elbow, 0.085f, 0.07f, 10);
        clay_tube(cloth, elbow, hand, 0.07f, 0.05f, 10);
    }
}

int scene_spot(scene *s)
{
    static const float position[3] = {-0.9f, 1.35f, 4.6f}, target[3] = {0.1f, 2.15f, -8};
    static const float ambient[3] = {0.05f, 0.065f, 0.085f}, black[3] = {0.002f, 0.003f, 0.004f}, none[3] = {0, 0, 0};
    static const float lamp[3] = {0.95f, 3.3f, -14.5f}, lamp_at[3] = {0.1f, 1.0f, 0}, cold[3] = {330, 620, 760};
    static const float upper[3] = {-3.0f, 8.2f, -4.4f}, upper_at[3] = {-2.5f, 0, -3.6f}, hot[3] = {900, 360, 90};
    static const float smoke[3] = {0.045f, 0.045f, 0.045f};
    struct clay wall, floor, metal, cloth;
    stage_camera(s, position, target, 50, 0.1f, 24);
    stage_colours(s, ambient, black);
    if (stage_spot(s, lamp, lamp_at, 44, cold) != 0 || stage_spot(s, upper, upper_at, 46, hot) != 0 ||
        stage_medium(s, smoke, none, TYN_PHASE_HG, 0.35f) != 0) {
        return -1;
    }
    clay_start(&wall, 1, 1, 1, shapes_texture(s, 512, 512, paint_concrete), 0.25f);
    clay_start(&floor, 1, 1, 1, shapes_texture(s, 512, 512, paint_floor), 0.2f);
    clay_start(&metal, 1, 1, 1, shapes_texture(s, 512, 512, paint_metal), 0.4f);
    clay_start(&cloth, 0.05f, 0.05f, 0.055f, NULL, 1);
    wall.shade = floor.shade = shade_room;
    build_back(&wall, &metal);
    build_fan(&metal);
    build_room(&wall, &metal);
    build_barrel(&metal, 3.5f, -4.5f);
    build_barrel(&metal, 3.95f, -5.3f);
    build_barrel(&metal, 3.3f, -5.4f);
    build_barrel(&metal, -4.0f, -6.6f);
    for (int k = 0; k < 4; k++) {
        float z = -6.8f + 1.5f * (float)k, low = 0.45f + 0.3f * (float)(k & 1);
        const float from[3] = {-ROOM, CEILING - 0.5f, z - 0.6f}, to[3] = {ROOM - 0.4f, CEILING - 0.25f, z + 0.5f};
        build_cable(&metal, from, to, low, 0.03f + 0.012f * (float)(k & 1));
    }
    build_figure(&cloth, 0.85f, -2.6f);
    clay_field(&floor, -ROOM, BACK - 4, ROOM, FRONT, 30, NULL);
    int status = clay_finish(&wall, s) | clay_finish(&floor, s) | clay_finish(&metal, s) | clay_finish(&cloth, s);
    return status == 0 && s->image_count == 3 ? 0 : -1;
}
