/* The built-in scenes: whole, the same each time, and the benchmark's sun where its figures say. */
#include "showcase.h"
#include "test.h"

#include <math.h>
#include <string.h>

/* terrain and forest are left out: they are the same code, and slow under valgrind. */
static const char *const names[] = {"pillars", "rose", "spot", "simple-on", "simple-off", "leafy-on", "leafy-off"};
#define NAMES (sizeof names / sizeof names[0])

static int same(const scene *a, const scene *b)
{
    int equal = a->mesh_count == b->mesh_count;
    for (int32_t i = 0; equal && i < a->mesh_count; i++) {
        const tyn_mesh *m = &a->meshes[i], *n = &b->meshes[i];
        equal = m->vertices == n->vertices && m->triangles == n->triangles &&
                memcmp(m->positions, n->positions, (size_t)m->vertices * 3 * sizeof(float)) == 0;
    }
    return equal;
}

static int64_t triangles(const scene *s)
{
    int64_t sum = 0;
    for (int32_t i = 0; i < s->mesh_count; i++) {
        sum += s->meshes[i].triangles;
    }
    return sum;
}

static void test_scenes(void)
{
    TEST("built-in scenes are whole and the same twice");
    for (size_t i = 0; i < NAMES; i++) {
        scene a, b;
        tyn_camera camera;
        float min[3], max[3];
        scene_init(&a);
        scene_init(&b);
        CHECK(showcase_scene(names[i], &a) == 0);
        CHECK(showcase_scene(names[i], &b) == 0);
        CHECK(a.light_count > 0 && a.medium_count > 0 && triangles(&a) > 1000);
        CHECK(scene_camera_make(&a, a.width, a.height, &camera) == TYN_OK);
        CHECK(scene_bounds(&a, min, max) != 0);
        for (int k = 0; k < 3; k++) {
            CHECK(isfinite(min[k]) && isfinite(max[k]) && min[k] < max[k]);
        }
        CHECK(same(&a, &b));
        scene_free(&a);
        scene_free(&b);
    }
    scene s;
    scene_init(&s);
    CHECK(showcase_scene("no such scene", &s) == 1);
    scene_free(&s);
}

static void test_epipoles(void)
{
    TEST("the benchmark's sun is on the pixels that its figures were measured at");
    const float at[2][2] = {{1120, 256}, {3385, -973}};
    for (size_t i = 3; i < NAMES; i++) {
        const float *expected = at[(i - 3) & 1];
        scene s;
        tyn_camera c = {0};
        float to[3] = {0, 0, 0};
        scene_init(&s);
        CHECK(showcase_scene(names[i], &s) == 0 && scene_camera_make(&s, 1920, 1080, &c) == TYN_OK);
        for (int k = 0; k < 3; k++) { /* the way to the sun, in the camera's axes */
            to[0] -= c.right[k] * s.lights[0].light.direction[k];
            to[1] -= c.up[k] * s.lights[0].light.direction[k];
            to[2] -= c.forward[k] * s.lights[0].light.direction[k];
        }
        CHECK_NEAR(1920 * (to[0] / to[2] - c.left_edge) / (c.right_edge - c.left_edge), expected[0], 0.5);
        CHECK_NEAR(1080 * (c.top_edge - to[1] / to[2]) / (c.top_edge - c.bottom_edge), expected[1], 0.5);
        scene_free(&s);
    }
}

void test_showcase(void);
void test_showcase(void)
{
    test_scenes();
    test_epipoles();
}
