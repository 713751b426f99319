/* showcase_bench.c - the scenes that times are taken of: hills with pillars and arches, or with trees of single leaves.
 *
 * They are those of the prototypes in kind and number, so that figures can be held against each other. */
#include "showcase_scenes.h"

#include <math.h>

#include "noise.h"
#include "shapes.h"

#define WIDTH 1920
#define HEIGHT 1080

static float hill(float x, float z)
{
    return 2.4f * noise_sum(x / 34, z / 34, 4, 0, 301) - 1.6f;
}

static void pillars(struct clay *stone, uint32_t *dice)
{
    for (int k = 0; k < 45; k++) {
        float z = -6 - 96 * noise_next(dice, 0, 1), x = noise_next(dice, -1, 1) * (8 - 0.75f * z);
        float tall = noise_next(dice, 4, 13), thick = noise_next(dice, 0.4f, 1.1f), y = hill(x, z) - 1;
        const float shaft[4][2] = {{thick * 1.3f, 0}, {thick, 1.6f}, {thick * 0.85f, tall}, {0, tall}};
        clay_place(stone, x, y, z, noise_next(dice, 0, SHAPES_PI));
        if (k % 3 != 0) {
            clay_lathe(stone, shaft, 4, 24, 0, 0);
        } else {
            struct clay_arch arch = {4.6f * thick + 3, tall + 2, 1.2f, 3 * thick + 1.2f, 0, tall - 0.5f, 1, 12};
            arch.spring = fmaxf(1, tall - 0.5f * arch.open);
            clay_arch(stone, &arch);
        }
    }
}

static void trees(struct clay *wood, struct clay *leaf, uint32_t *dice)
{
    for (int k = 0; k < 80; k++) {
        float z = -5 - 98 * noise_next(dice, 0, 1), x = noise_next(dice, -1, 1) * (8 - 0.75f * z), y = hill(x, z) - 0.5f;
        float tall = noise_next(dice, 5, 10), crown = noise_next(dice, 1.6f, 2.8f);
        const float foot[3] = {x, y, z}, top[3] = {x, y + tall, z};
        clay_tube(wood, foot, top, 0.3f, 0.12f, 10);
        for (int n = 0; n < 350; n++) {
            float d[3], e[3], f[3], corner[4][3], size = noise_next(dice, 0.08f, 0.19f), norm = 0;
            for (int i = 0; i < 3; i++) { /* three directions that are not quite at right angles: leaves are not either */
                d[i] = noise_next(dice, -1, 1);
                e[i] = noise_next(dice, -1, 1) * size * 1.6f;
                f[i] = noise_next(dice, -1, 1) * size * 1.6f;
                norm += d[i] * d[i];
            }
            float reach = crown * noise_next(dice, 0.5f, 1) / sqrtf(norm + 1e-6f);
            for (int i = 0; i < 3; i++) {
                float at = top[i] + d[i] * reach;
                corner[0][i] = at - e[i] - f[i];
                corner[1][i] = at + e[i] - f[i];
                corner[2][i] = at + e[i] + f[i];
                corner[3][i] = at - e[i] + f[i];
            }
            clay_quad(leaf, corner[0], corner[1], corner[2], corner[3]);
        }
    }
}

int scene_bench(scene *s, int leafy, int on_screen)
{
    static const float position[3] = {0, 3.2f, 0}, target[3] = {0, 3.2f, -10}, warm[3] = {10, 9, 7.5f};
    static const float ambient[3] = {1, 1.2f, 1.5f}, sky[3] = {1, 1.2f, 1.5f}, none[3] = {0, 0, 0};
    static const float air[3] = {3.46e-3f, 8.06e-3f, 19.76e-3f}, haze[3] = {11.94e-3f, 11.94e-3f, 11.94e-3f}; /* green: 0.02 */
    const float fov = 60, focal = 0.5f * HEIGHT / tanf(0.5f * fov * SHAPES_PI / 180);
    const float epipole[2] = {on_screen ? 1120.0f : 3385.0f, on_screen ? 256.0f : -973.0f};
    const float sun[3] = {(0.5f * WIDTH - epipole[0]) / focal, (epipole[1] - 0.5f * HEIGHT) / focal, 1};
    struct clay ground, solid, leaf;
    uint32_t dice = 7;
    stage_camera(s, position, target, fov, 0.1f, 120);
    s->width = WIDTH;
    s->height = HEIGHT;
    stage_colours(s, ambient, sky);
    if (stage_sun(s, sun, warm) != 0 || stage_medium(s, air, none, TYN_PHASE_RAYLEIGH, 0) != 0 ||
        stage_medium(s, haze, none, TYN_PHASE_HG, 0.5f) != 0) {
        return -1;
    }
    clay_start(&ground, 0.25f, 0.3f, 0.15f, NULL, 1);
    clay_start(&solid, 0.5f, 0.45f, 0.4f, NULL, 1);
    clay_start(&leaf, 0.2f, 0.4f, 0.1f, NULL, 1);
    clay_field(&ground, -110, -130, 110, 20, 160, hill);
    if (leafy) {
        trees(&solid, &leaf, &dice);
    } else {
        pillars(&solid, &dice);
    }
    int status = clay_finish(&ground, s) | clay_finish(&solid, s) | clay_finish(&leaf, s);
    return status;
}
