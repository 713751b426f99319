/* test_path.c - lights on a path across the screen, over its borders and corners, behind the camera and back: no pop, no
 * streak, no black box. Every kind of light, seen by perspective and by orthographic cameras, against the march of the same
 * shadow maps. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "test.h"
#include "tyndall.h"

enum { WIDTH = 64, HEIGHT = 64, PIXELS = WIDTH * HEIGHT, MAP = 256, FACES = 6, FRAMES = 32, BOXES = 14 };

typedef struct stage {
    float corner[BOXES * 8 + 4][3];
    uint32_t index[BOXES * 36 + 6];
    tyn_mesh mesh;
    tyn_camera camera;
    float depth[PIXELS], light[2][2][3 * PIXELS]; /* light: epipolar and march, this frame and the last */
    float map[FACES][MAP * MAP];
    tyn_raster *raster;
    tyn_context *context[2];
    void *memory[3];
} stage;

static void add_box(stage *s, int box, float x, float z, float half, float height)
{
    static const uint32_t sides[36] = {0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1,
                                       2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3};
    for (int i = 0; i < 8; i++) {
        s->corner[8 * box + i][0] = x + (i & 1 ? half : -half);
        s->corner[8 * box + i][1] = i & 2 ? height : 0.0f;
        s->corner[8 * box + i][2] = z + (i & 4 ? half : -half);
    }
    for (int i = 0; i < 36; i++)
        s->index[36 * box + i] = (uint32_t)(8 * box) + sides[i];
}

/* A ring of posts around the camera, so that no direction of the light is easier than another, on a floor. */
static stage *stage_new(void)
{
    const float eye[3] = {0, 1.6f, 0}, ahead[3] = {0, 1.6f, -1}, up[3] = {0, 1, 0};
    stage *s = calloc(1, sizeof *s);
    tyn_raster_config raster = {.width = MAP, .height = MAP};
    tyn_config config;
    size_t bytes = 0;
    if (!s)
        return NULL;
    for (int i = 0; i < BOXES; i++) {
        float turn = 6.2831853f * (float)i / (float)BOXES, far = 5.0f + (float)(i % 3);
        add_box(s, i, far * sinf(turn), -far * cosf(turn), 0.25f, 2.0f + 0.4f * (float)(i % 4));
    }
    for (uint32_t i = 0; i < 4; i++) {
        static const float floor[4][3] = {{-20, 0, -20}, {20, 0, -20}, {20, 0, 20}, {-20, 0, 20}};
        memcpy(s->corner[BOXES * 8 + i], floor[i], sizeof floor[i]);
    }
    for (uint32_t i = 0; i < 6; i++) {
        static const uint32_t fan[6] = {0, 1, 2, 0, 2, 3};
        s->index[BOXES * 36 + i] = BOXES * 8 + fan[i];
    }
    s->mesh = (tyn_mesh){&s->corner[0][0], NULL, s->index, BOXES * 8 + 4, BOXES * 12 + 2, {{0.5f, 0.5f, 0.5f}, NULL, NULL}};
    CHECK(tyn_camera_look(&s->camera, eye, ahead, up, 1.0f, 0.1f, 25.0f, WIDTH, HEIGHT) == TYN_OK);
    CHECK(tyn_raster_measure(&raster, &bytes) == TYN_OK);
    s->memory[2] = malloc(bytes + TYN_ALIGNMENT);
    CHECK(tyn_raster_init(&s->raster, &raster, test_aligned(s->memory[2]), bytes) == TYN_OK);
    CHECK(tyn_config_preset(&config, TYN_PRESET_QUALITY, WIDTH, HEIGHT) == TYN_OK);
    config.maps = FACES;
    for (int i = 0; i < 2; i++) {
        config.method = i ? TYN_METHOD_MARCH : TYN_METHOD_EPIPOLAR;
        CHECK(tyn_measure(&config, &bytes) == TYN_OK);
        s->memory[i] = malloc(bytes + TYN_ALIGNMENT);
        CHECK(tyn_init(&s->context[i], &config, test_aligned(s->memory[i]), bytes) == TYN_OK);
    }
    return s;
}

static void stage_free(stage *s)
{
    for (int i = 0; i < 3; i++)
        free(s->memory[i]);
    free(s);
}

/* The rasterizer draws no orthographic views, but a parallel shadow map is one. The camera looks level: nothing behind it is in
 * its way. */
static void see_parallel(stage *s)
{
    tyn_camera *c = &s->camera;
    tyn_shadow view = {.size = WIDTH};
    const float half = 3.0f, scale[3] = {0.5f / half, -0.5f / half, -1.0f / c->far_depth}, at[3] = {0.5f, 0.5f, 1.0f};
    const float *axis[3];
    axis[0] = c->right;
    axis[1] = c->up;
    axis[2] = c->forward;
    c->kind = TYN_CAMERA_ORTHOGRAPHIC;
    c->left_edge = c->bottom_edge = -half;
    c->right_edge = c->top_edge = half;
    for (int r = 0; r < 3; r++) {
        view.matrix[4 * r + 3] = at[r];
        for (int k = 0; k < 3; k++) {
            view.matrix[4 * r + k] = axis[r][k] * scale[r];
            view.matrix[4 * r + 3] -= axis[r][k] * c->position[k] * scale[r];
        }
    }
    view.matrix[15] = 1.0f;
    CHECK(tyn_raster_shadow(s->raster, &view, s->depth, &s->mesh, 1, NULL, NULL, NULL, NULL) == TYN_OK);
    for (int i = 0; i < PIXELS; i++)
        s->depth[i] = s->depth[i] > 0.0f && s->depth[i] < 1.0f ? (1.0f - s->depth[i]) * c->far_depth : c->far_depth;
}

static void see(stage *s)
{
    tyn_surface surface = {.camera = s->camera, .meshes = &s->mesh, .mesh_count = 1};
    surface.depth = (tyn_image){s->depth, WIDTH, HEIGHT, 0, TYN_DEPTH_F32};
    CHECK(tyn_raster_surface(s->raster, &surface) == TYN_OK);
}

/* Once around: sideways through the view, and up and down on the way, so that borders are crossed slantwise. */
static void place(const stage *s, tyn_light *light, tyn_shadow faces[FACES], int frame)
{
    float turn = 6.2831853f * ((float)frame + 0.37f) / (float)FRAMES, x = sinf(turn), z = -cosf(turn),
          y = 0.25f + 0.2f * sinf(3.0f * turn);
    float length = sqrtf(x * x + y * y + z * z);
    const float way[3] = {x / length, y / length, z / length};
    for (int k = 0; k < 3; k++) {
        light->position[k] = s->camera.position[k] + 3.5f * way[k];
        light->direction[k] = -way[k];
    }
    for (int i = 0; i < FACES; i++)
        faces[i].size = MAP;
    if (light->kind == TYN_LIGHT_POINT) {
        CHECK(tyn_shadow_fit_cube(faces, light->position, 40.0f) == TYN_OK);
    } else {
        light->shadow.size = MAP;
        light->shadow.depth = NULL;
        CHECK(tyn_shadow_fit_scene(light, &s->camera, NULL, &s->mesh, 1) == TYN_OK);
        faces[0] = light->shadow;
    }
}

static void shine(stage *s, tyn_light *light, tyn_shadow faces[FACES])
{
    int count = light->kind == TYN_LIGHT_POINT ? FACES : 1;
    for (int i = 0; i < count; i++) {
        CHECK(tyn_raster_shadow(s->raster, &faces[i], s->map[i], &s->mesh, 1, NULL, NULL, NULL, NULL) == TYN_OK);
        faces[i].depth = s->map[i];
    }
    light->shadow = faces[0];
    light->more = count > 1 ? faces + 1 : NULL;
    light->more_count = count - 1;
}

static double distance(const float *a, const float *b)
{
    double sum = 0;
    for (int i = 0; i < 3 * PIXELS; i++)
        sum += fabs((double)a[i] - (double)b[i]);
    return sum;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The worst frame may be twice the median, or `most` where nearly all of the path has next to no error. */
static void walk(stage *s, tyn_light_kind kind, const char *name, double most)
{
    static const float dark[3 * PIXELS];
    tyn_medium haze = {{0.05f, 0.05f, 0.06f}, {0, 0, 0}, TYN_PHASE_HG, 0.4f};
    tyn_light light = {.kind = kind, .colour = {20, 20, 20}, .angle = 1.2f};
    tyn_shadow faces[FACES];
    tyn_frame frame = {.camera = s->camera, .lights = &light, .light_count = 1, .media = &haze, .medium_count = 1};
    double error[FRAMES], change[2] = {0, 0};
    int bad = 0;
    memset(faces, 0, sizeof faces);
    test_begin(name);
    frame.depth = (tyn_image){s->depth, WIDTH, HEIGHT, 0, TYN_DEPTH_F32};
    for (int f = 0; f < FRAMES; f++) {
        float *now[2], *then[2];
        place(s, &light, faces, f);
        shine(s, &light, faces);
        for (int i = 0; i < 2; i++) {
            now[i] = s->light[i][f & 1];
            then[i] = s->light[i][~f & 1];
            frame.scatter = (tyn_image){now[i], WIDTH, HEIGHT, 0, TYN_RGB_F32};
            CHECK(tyn_render(s->context[i], &frame) == TYN_OK);
            if (f > 0)
                change[i] += distance(now[i], then[i]);
        }
        for (int k = 0; k < 3 * PIXELS; k++)
            bad += !(now[0][k] >= 0.0f && now[0][k] < 1e6f);
        error[f] = distance(now[0], now[1]) / distance(now[1], dark);
    }
    CHECK(bad == 0);
    qsort(error, FRAMES, sizeof *error, by_size);
    printf("  %-24s relative L1 to the march median %.5f, worst %.5f; change per frame %.4f of the march's\n", name,
           error[FRAMES / 2], error[FRAMES - 1], change[0] / change[1]);
    CHECK(error[FRAMES - 1] <= 2 * error[FRAMES / 2] || error[FRAMES - 1] < most);
    CHECK_NEAR(change[0] / change[1], 1, 0.1);
}

/* A sun on the screen over a bare floor: all that one sees is lit. The texel that holds the camera may reach behind it, where
 * its floor is on the other side of the rays; that must darken nothing. */
static void bare(stage *s)
{
    const tyn_mesh all = s->mesh;
    const float low[3] = {-20, 0, -20}, high[3] = {20, 3, 20};
    tyn_medium haze = {{0.05f, 0.05f, 0.06f}, {0, 0, 0}, TYN_PHASE_HG, 0.4f};
    tyn_light light = {.kind = TYN_LIGHT_DIRECTIONAL, .colour = {20, 20, 20}, .shadow = {.size = MAP}};
    tyn_frame frame = {.camera = s->camera, .lights = &light, .light_count = 1, .media = &haze, .medium_count = 1};
    double most = 0;
    TEST("a sun on the screen over a bare floor");
    s->mesh.indices += BOXES * 36;
    s->mesh.triangles = 2;
    see(s);
    frame.depth = (tyn_image){s->depth, WIDTH, HEIGHT, 0, TYN_DEPTH_F32};
    frame.scatter = (tyn_image){NULL, WIDTH, HEIGHT, 0, TYN_RGB_F32};
    for (int f = 0; f < FRAMES; f++) {
        double x = -0.4 + 0.8 * f / FRAMES, y = 0.1 + 0.3 * (f % 5) / 5, length = sqrt(x * x + y * y + 1), sum = 0;
        light.direction[0] = (float)(-x / length);
        light.direction[1] = (float)(-y / length);
        light.direction[2] = (float)(1 / length);
        light.shadow.depth = NULL;
        CHECK(tyn_shadow_fit(&light, &s->camera, low, high) == TYN_OK);
        CHECK(tyn_raster_shadow(s->raster, &light.shadow, s->map[0], &s->mesh, 1, NULL, NULL, NULL, NULL) == TYN_OK);
        light.shadow.depth = s->map[0];
        for (int i = 0; i < 2; i++) {
            frame.scatter.pixels = s->light[0][i];
            CHECK(tyn_render(s->context[i], &frame) == TYN_OK);
        }
        for (int i = 0; i < 3 * PIXELS; i++)
            sum += (double)s->light[0][1][i];
        most = fmax(most, distance(s->light[0][0], s->light[0][1]) / sum);
    }
    printf("  sun over a bare floor    relative L1 to the march at most %.5f\n", most);
    CHECK(most < 0.0008);
    s->mesh = all;
}

/* The camera turns by quarter pixels: what flickers changes by more than the march does. */
static void creep(stage *s)
{
    const tyn_camera still = s->camera;
    tyn_medium haze = {{0.05f, 0.05f, 0.06f}, {0, 0, 0}, TYN_PHASE_HG, 0.4f};
    tyn_light light = {.kind = TYN_LIGHT_DIRECTIONAL, .colour = {20, 20, 20}};
    tyn_shadow faces[FACES];
    tyn_frame frame = {.lights = &light, .light_count = 1, .media = &haze, .medium_count = 1};
    double change[2] = {0, 0};
    TEST("a camera that turns by quarter pixels");
    memset(faces, 0, sizeof faces);
    place(s, &light, faces, 1);
    shine(s, &light, faces);
    frame.depth = (tyn_image){s->depth, WIDTH, HEIGHT, 0, TYN_DEPTH_F32};
    for (int f = 0; f < FRAMES; f++) {
        float turn = 0.25f * (float)f * (still.right_edge - still.left_edge) / WIDTH;
        for (int k = 0; k < 3; k++) {
            s->camera.forward[k] = cosf(turn) * still.forward[k] + sinf(turn) * still.right[k];
            s->camera.right[k] = cosf(turn) * still.right[k] - sinf(turn) * still.forward[k];
        }
        see(s);
        frame.camera = s->camera;
        for (int i = 0; i < 2; i++) {
            frame.scatter = (tyn_image){s->light[i][f & 1], WIDTH, HEIGHT, 0, TYN_RGB_F32};
            CHECK(tyn_render(s->context[i], &frame) == TYN_OK);
            if (f > 0)
                change[i] += distance(s->light[i][f & 1], s->light[i][~f & 1]);
        }
    }
    printf("  camera by quarter pixels change per frame %.4f of the march's\n", change[0] / change[1]);
    CHECK(change[0] <= 1.1 * change[1]);
    s->camera = still;
}

void test_path(void)
{
    stage *s = stage_new();
    if (!s)
        return;
    bare(s);
    creep(s);
    see(s);
    walk(s, TYN_LIGHT_DIRECTIONAL, "path of a sun", 0.002);
    walk(s, TYN_LIGHT_SPOT, "path of a spot", 0.002);
    walk(s, TYN_LIGHT_POINT, "path of a point light", 0.002);
    see_parallel(s);
    /* parallel rays almost along the light: a few texels hold all the difference */
    walk(s, TYN_LIGHT_DIRECTIONAL, "path of a sun, orthographic", 0.02);
    walk(s, TYN_LIGHT_SPOT, "path of a spot, orthographic", 0.004);
    walk(s, TYN_LIGHT_POINT, "path of a point light, orthographic", 0.004);
    stage_free(s);
}
