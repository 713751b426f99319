/* showcase_terrain.c - mountains at sunrise, tens of kilometres of air. */
#include "showcase_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "noise.h"
#include "shapes.h"

/* The grid is a fan around the camera, finest near it, so that triangles are of one size on the screen. */
#define COLUMNS 1000
#define ROWS 860
#define FAN 0.68f /* radians to either side: a little more than is seen */
#define NEAREST 1500.0f
#define FARTHEST 32000.0f

/* Ridges whose finer octaves fade on slopes, as if water had carried the rubble down. */
static float land_height(float x, float z)
{
    float px = x / 5200 + 3.1f, pz = z / 5200 + 1.7f, sum = 0, tall = 1, dx = 0, dz = 0;
    for (uint32_t octave = 0; octave < 12; octave++) {
        float slope[2], n = noise_gradient(px, pz, 0, 900 + octave, slope);
        if (octave < 4) { /* a crease has no slope that could fade anything */
            n = 0.8f - 2.3f * sqrtf(n * n + 0.0006f);
        } else {
            dx += slope[0] * 0.8f;
            dz += slope[1] * 0.8f;
        }
        sum += tall * n / (1 + 0.22f * (dx * dx + dz * dz));
        tall *= octave < 2 ? 0.5f : octave == 3 ? 0.62f : 0.5f;
        float turned = 1.6f * px + 1.2f * pz;
        pz = 1.6f * pz - 1.2f * px;
        px = turned;
    }
    /* A wide basin around the camera, a range behind it, and lower land beyond, so that light comes through the gaps. */
    float away = sqrtf(x * x + z * z) * (1 + 0.25f * noise_gradient(x / 3000, z / 3000, 0, 240, NULL));
    float lift = 0.16f + 0.84f * shapes_step(2800, 8600, away) - 0.45f * shapes_step(10500, 15500, away);
    float height = 0.62f + 0.62f * sum;
    return 300 + 2300 * lift * (height < 0 ? 0 : height * sqrtf(height));
}

static void paint_land(float height, float slope, float light, float x, float z, float rgb[3])
{
    static const float rock[3] = {0.21f, 0.185f, 0.165f}, pale[3] = {0.36f, 0.33f, 0.29f}, grass[3] = {0.17f, 0.18f, 0.06f};
    static const float woods[3] = {0.035f, 0.06f, 0.025f}, snow[3] = {0.86f, 0.88f, 0.92f};
    float patch = noise_sum(x / 700, z / 700, 5, 0, 231), fine = noise_sum(x / 90, z / 90, 4, 0, 232);
    shapes_mix(rgb, rock, pale, 0.45f + 0.22f * sinf(height / 40 + 9 * patch) + 0.8f * fine);
    float green = shapes_step(1.0f, 0.6f, slope + 0.3f * fine) * shapes_step(1850, 1250, height + 350 * patch);
    shapes_mix(rgb, rgb, grass, green);
    shapes_mix(rgb, rgb, woods,
               shapes_step(1400, 850, height + 500 * patch) * shapes_step(1.2f, 0.7f, slope) * (0.7f + 0.6f * fine));
    float cover = shapes_step(1420, 1900, height + 300 * patch) * shapes_step(1.05f, 0.6f, slope + 0.25f * fine);
    shapes_mix(rgb, rgb, snow, cover);
    for (int i = 0; i < 3; i++) {
        rgb[i] *= light;
    }
}

static void land_point(int32_t column, int32_t row, float *x, float *z)
{
    float angle = FAN * (2 * (float)column / (COLUMNS - 1) - 1);
    float distance = NEAREST * powf(FARTHEST / NEAREST, (float)row / (ROWS - 1));
    *x = distance * sinf(angle);
    *z = -distance * cosf(angle);
}

static const float *grid_point(const float *positions, int32_t column, int32_t row)
{
    return positions + 3 * ((size_t)row * COLUMNS + (size_t)column);
}

/* Colours of the grid's points, from their heights. */
static void colour_land(const float *positions, const tyn_image *image)
{
    for (int32_t row = 0; row < ROWS; row++) {
        uint8_t *line = (uint8_t *)image->pixels + (size_t)(ROWS - 1 - row) * COLUMNS * 3;
        for (int32_t column = 0; column < COLUMNS; column++) {
            int32_t side = column + 1 < COLUMNS ? 1 : -1, ahead = row + 1 < ROWS ? COLUMNS : -COLUMNS;
            const float *p = grid_point(positions, column, row), *q = p + 3 * side, *r = p + 3 * ahead;
            float e[3], f[3], rgb[3];
            for (int i = 0; i < 3; i++) {
                e[i] = q[i] - p[i];
                f[i] = r[i] - p[i];
            }
            float n[3] = {e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0]};
            float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) * (n[1] < 0 ? -1.0f : 1.0f) + 1e-9f;
            float slope = sqrtf(n[0] * n[0] + n[2] * n[2]) / (fabsf(n[1]) + 1e-6f);
            /* The renderer's sky is the same from everywhere; a real one is brighter above and on one side. */
            float sky = 0.42f + (-0.36f * n[0] + 0.52f * n[1] + 0.30f * n[2]) / length;
            /* Lower than what lies around: a hollow, which sees less of it. */
            int32_t left = column < 6 ? 0 : column - 6, right = column + 6 < COLUMNS ? column + 6 : COLUMNS - 1;
            int32_t below = row < 6 ? 0 : row - 6, above = row + 6 < ROWS ? row + 6 : ROWS - 1;
            const float *around[4] = {grid_point(positions, left, row), grid_point(positions, right, row),
                                      grid_point(positions, column, below), grid_point(positions, column, above)};
            float rise = p[1] - 0.25f * (around[0][1] + around[1][1] + around[2][1] + around[3][1]);
            float hollow = 0.85f + 60 * rise / (NEAREST + fabsf(p[2]));
            hollow = hollow < 0.5f ? 0.5f : hollow > 1.1f ? 1.1f : hollow;
            paint_land(p[1], slope, hollow * (sky < 0.15f ? 0.15f : sky), p[0], p[2], rgb);
            for (int i = 0; i < 3; i++) {
                line[3 * column + i] = (uint8_t)(rgb[i] <= 0 ? 0 : rgb[i] >= 1 ? 255 : rgb[i] * 255 + 0.5f);
            }
        }
    }
}

static int build_land(scene *s)
{
    const size_t points = (size_t)COLUMNS * ROWS, triangles = (size_t)(COLUMNS - 1) * (ROWS - 1) * 2;
    float *positions = malloc(points * 3 * sizeof(float)), *texcoords = malloc(points * 2 * sizeof(float));
    uint32_t *indices = malloc(triangles * 3 * sizeof *indices), *next = indices;
    tyn_image *image = scene_add_image(s, COLUMNS, ROWS, TYN_RGB8_LINEAR);
    if (positions == NULL || texcoords == NULL || indices == NULL || image == NULL) {
        free(positions);
        free(texcoords);
        free(indices);
        return -1;
    }
    for (int32_t row = 0; row < ROWS; row++) {
        for (int32_t column = 0; column < COLUMNS; column++) {
            size_t at = (size_t)row * COLUMNS + (size_t)column;
            land_point(column, row, &positions[3 * at], &positions[3 * at + 2]);
            positions[3 * at + 1] = land_height(positions[3 * at], positions[3 * at + 2]);
            texcoords[2 * at] = ((float)column + 0.5f) / COLUMNS;
            texcoords[2 * at + 1] = ((float)row + 0.5f) / ROWS;
            if (row + 1 < ROWS && column + 1 < COLUMNS) {
                uint32_t a = (uint32_t)at, b = a + 1, c = a + COLUMNS, d = c + 1;
                const uint32_t both[6] = {a, b, d, a, d, c};
                memcpy(next, both, sizeof both);
                next += 6;
            }
        }
    }
    colour_land(positions, image);
    tyn_material material = {{1, 1, 1}, image, NULL};
    return scene_take_mesh(s, positions, texcoords, (uint32_t)points, indices, (uint32_t)triangles, &material);
}

int scene_terrain(scene *s)
{
    static const float sun[3] = {-0.107f, -0.296f, 1}, warm[3] = {20, 15.6f, 10.8f};
    static const float ambient[3] = {1.9f, 2.8f, 4.3f}, sky[3] = {0.8f, 1.4f, 2.8f}, none[3] = {0, 0, 0};
    static const float air[3] = {5.8e-6f, 13.5e-6f, 33.1e-6f}, haze[3] = {3.0e-5f, 3.0e-5f, 3.0e-5f};
    float position[3] = {0, 0, 0}, target[3] = {0, 0, -12000};
    position[1] = 1600;
    target[1] = 2900;
    stage_camera(s, position, target, 38, 5, 31000);
    stage_colours(s, ambient, sky);
    if (stage_sun(s, sun, warm) != 0 || stage_medium(s, air, none, TYN_PHASE_RAYLEIGH, 0) != 0 ||
        stage_medium(s, haze, none, TYN_PHASE_HG, 0.72f) != 0) {
        return -1;
    }
    return build_land(s);
}
