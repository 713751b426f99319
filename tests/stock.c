/* stock.c - see stock.h */
#include "stock.h"

#include <stdlib.h>
#include <string.h>

#define SUN(r, u, f) ORACLE_DIRECTIONAL, {r, u, f}, {0, 0, 0}, 0
#define HAZE 0.04
#define LEVEL 1.8

/* The camera stands at (0.2, 1.5, 4) and sees 60 degrees: on the screen |up| < 0.577 forward, |right| < 0.770 forward. */
const stock stock_list[] = {
    {"sun ahead", SUN(-0.1, 0.35, 1), HAZE, 0, LEVEL},
    {"sun in the corner of the view", SUN(0.65, 0.5, 1), HAZE, 0, LEVEL},
    {"sun on the left border", SUN(-0.7698003589195010, 0.3, 1), HAZE, 0, LEVEL},
    {"sun in the upper right corner", SUN(0.7698003589195010, 0.5773502691896258, 1), HAZE, 0, LEVEL},
    {"sun off the left", SUN(-1, 0.35, 0.35), HAZE, 0, LEVEL},
    {"sun off the right", SUN(1, 0.3, 0.4), HAZE, 0, LEVEL},
    {"sun off the top", SUN(0.1, 1, 0.5), HAZE, 0, LEVEL},
    {"sun off the bottom", SUN(0.15, -0.7, 1), HAZE, 0, 14},
    {"sun behind the camera", SUN(0.2, 0.3, -1), HAZE, 0, LEVEL},
    {"sun off behind the left", SUN(-1, 0.5, -0.4), HAZE, 0, LEVEL},
    {"sun parallel to the picture", SUN(1, 0.4, 0), HAZE, 0, LEVEL},
    {"sun almost parallel to it", SUN(-1, 0.4, -1e-5), HAZE, 0, LEVEL},
    {"thin air", SUN(-0.6, 0.5, 0.5), 1e-4, 0, LEVEL},
    {"thick air", SUN(-0.6, 0.5, 0.5), 2.0, 0, LEVEL},
    {"clear air", SUN(-0.6, 0.5, 0.5), 0.0, 0, LEVEL},
    {"lamp in view", ORACLE_SPOT, {-0.5, 2.6, -7}, {0.3, 0.5, 0}, 70, HAZE, 0, LEVEL},
    {"lamp off the left", ORACLE_SPOT, {-6, 3.5, -3}, {1, 1, -5}, 50, HAZE, 0, LEVEL},
    {"lamp above", ORACLE_SPOT, {0.5, 8, -3.5}, {0.4, 0, -4.5}, 60, HAZE, 0, LEVEL},
    {"lamp behind the camera", ORACLE_SPOT, {2, 3, 7}, {0, 1, -5}, 60, HAZE, 0, LEVEL},
    {"lamp behind, on the axis", ORACLE_SPOT, {0.24, 1.44, 6}, {0, 1.8, -6}, 50, HAZE, 0, LEVEL},
    {"lamp shining away", ORACLE_SPOT, {-2, 2, -3}, {-1, 1.5, -12}, 60, HAZE, 0, LEVEL},
    {"lamp in thick air", ORACLE_SPOT, {-3, 4, -6}, {1, 0, -2}, 60, 0.6, 0, LEVEL},
    {"bulb in view", ORACLE_POINT, {-0.6, 1.2, -6.5}, {0, 0, 0}, 0, HAZE, 0, LEVEL},
    {"bulb off the right", ORACLE_POINT, {6, 2.5, -3.5}, {0, 0, 0}, 0, HAZE, 0, LEVEL},
    {"bulb over the camera", ORACLE_POINT, {0.3, 3.2, 4.2}, {0, 0, 0}, 0, HAZE, 0, LEVEL},
    {"bulb behind the camera", ORACLE_POINT, {-1.5, 1.8, 7}, {0, 0, 0}, 0, HAZE, 0, LEVEL},
    {"slide in a lamp", ORACLE_SPOT, {-5, 4, -6}, {0.5, 0.5, -3}, 50, HAZE, 1, LEVEL},
    {"slide in a lamp ahead", ORACLE_SPOT, {0.5, 4, -9}, {0, 0.5, -2}, 50, HAZE, 1, LEVEL},
    {"gobo before the sun", SUN(-0.7, 0.6, 0.4), HAZE, 1, LEVEL},
};
const int stock_count = (int)(sizeof stock_list / sizeof *stock_list);

/* Panes of different colours with lead between them, softened by the bilinear lookup. */
static void add_window(oracle_light *light)
{
    enum { SIZE = 16 };
    oracle_texture *t = &light->texture;
    t->width = t->height = SIZE;
    t->up[1] = 1;
    t->extent[0] = 8;
    t->extent[1] = 6;
    t->rgb = malloc(sizeof(float) * 3 * SIZE * SIZE);
    for (int i = 0; t->rgb && i < SIZE * SIZE; i++) {
        int x = i % SIZE, y = i / SIZE, lead = x % 4 == 3 || y % 5 == 4;
        for (int k = 0; k < 3; k++)
            t->rgb[3 * i + k] = lead ? 0.0f : 0.2f + 0.25f * (float)((x / 4 + y / 5 * (k + 1) + k) % 4);
    }
}

static oracle_scene *make(const stock *s, int width, int height)
{
    const double a[3] = {-3, 0.5, -9}, b[3] = {2, 3.5, -8}, c[3] = {-3, 2.5, -5};
    oracle_scene *scene = model_new(width, height);
    const oracle_camera *camera;
    double way[3];
    if (!scene)
        return NULL;
    model_camera(scene, 0.2, 1.5, 4, 0, s->pitch, -6, 60, 0.1, 40);
    model_box(scene, -40, -1, -40, 40, 0, 40, 0.5);
    for (int i = -3; i <= 3; i++)
        model_box(scene, i * 1.1, 0, -5, i * 1.1 + 0.3, 3, -4.6, 0.4);
    model_box(scene, -4, 3, -5.2, 4, 3.4, -4.4, 0.6);
    model_box(scene, -4.2, 0, -2, -3.4, 1.2, -1.2, 0.3);
    model_quad(scene, a, b, c, 0.5);
    if (s->air > 0) {
        model_medium(scene, s->air, 0.05 * s->air, 1.3, TYN_PHASE_HG, 0.5);
        model_medium(scene, 0.5 * s->air, 0, 2.0, TYN_PHASE_RAYLEIGH, 0);
    }
    for (int k = 0; k < 3; k++) {
        scene->background[k] = 0.2 + 0.1 * k;
        scene->ambient[k] = 0.2;
    }
    if (s->kind != ORACLE_DIRECTIONAL) {
        model_spot(scene, s->light[0], s->light[1], s->light[2], s->target[0], s->target[1], s->target[2], s->angle, 120);
        scene->light[0].kind = s->kind;
        if (s->textured)
            add_window(&scene->light[0]);
        return scene;
    }
    camera = &scene->camera;
    for (int k = 0; k < 3; k++)
        way[k] = s->light[0] * camera->right[k] + s->light[1] * camera->up[k] + s->light[2] * camera->forward[k];
    model_sun(scene, -way[0], -way[1], -way[2], 8);
    if (s->textured)
        add_window(&scene->light[0]);
    return scene;
}

oracle_scene *stock_new(const char *name, int width, int height)
{
    for (int i = 0; i < stock_count; i++)
        if (strcmp(stock_list[i].name, name) == 0)
            return make(&stock_list[i], width, height);
    return NULL;
}
