/* draw.c - see draw.h */
#include "draw.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"
#include "test.h"

double draw_between(double low, double high)
{
    return low + (high - low) * (double)test_random_float(0, 1);
}

uint32_t draw_one_of(uint32_t count)
{
    return test_random() % count;
}

static void add_light(oracle_scene *scene)
{
    double x = draw_between(-8, 8), y = draw_between(2, 9), z = draw_between(-12, 6);
    uint32_t kind = draw_one_of(3);
    if (kind == 0) {
        model_sun(scene, draw_between(-1, 1), draw_between(-1, -0.1), draw_between(-1, 1), draw_between(1, 9));
        return;
    }
    model_spot(scene, x, y, z, x + draw_between(-3, 3), 0, z + draw_between(-3, 3), draw_between(20, 120),
               draw_between(20, 200));
    if (kind == 2)
        scene->light[scene->lights - 1].kind = ORACLE_POINT;
}

static oracle_scene *random_scene(void)
{
    oracle_scene *scene = model_new(20 + (int)draw_one_of(44), 16 + (int)draw_one_of(30));
    uint32_t boxes = 1 + draw_one_of(8), media = 1 + draw_one_of(3), lights = 1 + draw_one_of(2);
    if (!scene)
        abort();
    model_camera(scene, draw_between(-2, 2), draw_between(0.5, 4), draw_between(2, 6), draw_between(-3, 3), draw_between(-1, 5),
                 -4, draw_between(25, 100), 0.1, draw_between(15, 60));
    if (draw_one_of(8))
        model_box(scene, -40, -1, -40, 40, 0, 40, 0.5);
    for (uint32_t i = 0; i < boxes; i++) {
        double x = draw_between(-6, 5), y = draw_between(-0.5, 3), z = draw_between(-12, 2);
        model_box(scene, x, y, z, x + draw_between(0.05, 2), y + draw_between(0.05, 3), z + draw_between(0.05, 2), 0.4);
    }
    for (uint32_t i = 0; i < lights; i++)
        add_light(scene);
    for (uint32_t i = 0; i < media; i++)
        model_medium(scene, exp(draw_between(-7, 0)), draw_one_of(2) ? 0 : exp(draw_between(-7, -1)), draw_between(0.7, 2),
                     (tyn_phase)draw_one_of(3), draw_between(-0.9, 0.9));
    for (int k = 0; k < 3; k++)
        scene->background[k] = scene->ambient[k] = draw_between(0, 0.5);
    return scene;
}

drawn draw_one(void)
{
    const char *given = getenv("TYN_SCENE");
    drawn d;
    oracle_scene *scene;
    memset(&d, 0, sizeof d);
    d.seed = given ? (uint32_t)strtoul(given, NULL, 0) : test_random();
    test_seed(d.seed);
    scene = random_scene();
    d.r = rig_new(scene, 40 + (int32_t)draw_one_of(120));
    model_free(scene);
    if (!d.r)
        abort();
    d.way = &rig_ways[draw_one_of(RIG_WAYS - 1)]; /* the last has no light */
    d.config = rig_way_config(d.r, d.way);
    d.config.slices = draw_one_of(2) ? 0 : 8 + (int32_t)draw_one_of(100);
    d.config.samples = draw_one_of(2) ? 0 : 8 + (int32_t)draw_one_of(60);
    d.config.steps = 30;
    d.config.downscale = d.config.method == TYN_METHOD_PREFILTERED || draw_one_of(3) ? d.config.downscale : 1 << draw_one_of(4);
    d.config.quads = (int32_t)draw_one_of(2);
    d.frame = rig_frame(d.r);
    d.count = 3 * (size_t)d.r->width * (size_t)d.r->height;
    return d;
}

void draw_render(const drawn *d)
{
    CHECK(rig_render(d->r, &d->config, &d->frame) == TYN_OK);
}

void draw_done(drawn *d, int holds)
{
    if (!holds)
        printf("  scene 0x%x, %s (TYN_SCENE)\n", (unsigned)d->seed, d->way->name);
    CHECK(holds);
    test_seed(d->seed ^ 0x9e3779b9u);
    rig_free(d->r);
}

int draw_rounds(int count)
{
    const char *given = getenv("TYN_ROUNDS");
    int times = given ? atoi(given) : 1;
    return getenv("TYN_SCENE") ? 1 : count * (times > 0 ? times : 1);
}

float *draw_copy(const float *from, size_t count)
{
    float *to = malloc(count * sizeof *to);
    if (!to)
        abort();
    memcpy(to, from, count * sizeof *to);
    return to;
}
