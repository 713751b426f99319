/* test_accuracy.c - the methods against the oracle, and against the library's own exact march of the same shadow map. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "stock.h"
#include "test.h"

#define WIDTH 128 /* 4 : 3, as stock.c's borders are */
#define HEIGHT 96
#define SHADOW 1024

/* A method, and the relative L1 of L_scat that it may have: for a scene, over all, and for a scene with a light texture, which
 * is the hardest there is. Measured, plus a quarter. */
typedef struct way {
    const char *name;
    tyn_method method;
    tyn_rays rays;
    tyn_preset preset;
    double worst, mean, textured;
    double sum;
    int count;
} way;

static way ways[] = {
    {"march", TYN_METHOD_MARCH, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 0.0035, 0.0010, 0.0065, 0, 0},
    {"march in steps", TYN_METHOD_MARCH, TYN_RAYS_STEPS, TYN_PRESET_QUALITY, 0.0210, 0.0027, 0.0195, 0, 0},
    {"epipolar", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_QUALITY, 0.0033, 0.0014, 0.0220, 0, 0},
    {"epipolar balanced", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_BALANCED, 0.0200, 0.0052, 0.2170, 0, 0},
    {"epipolar handheld", TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS, TYN_PRESET_HANDHELD, 0.0365, 0.0080, 0.6200, 0, 0},
    {"epipolar in steps", TYN_METHOD_EPIPOLAR, TYN_RAYS_STEPS, TYN_PRESET_QUALITY, 0.0210, 0.0029, 0.0225, 0, 0},
    {"subsample", TYN_METHOD_SUBSAMPLE, TYN_RAYS_WORDS, TYN_PRESET_BALANCED, 0.0315, 0.0055, 0.2010, 0, 0},
};
enum { WAYS = (int)(sizeof ways / sizeof *ways) };

static int finite_picture(const float *v, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(v[i] >= 0.0f && v[i] <= 3.4e38f))
            return 0;
    return 1;
}

static void check_scene(const stock *s, int say)
{
    static float truth[3 * WIDTH * HEIGHT];
    static uint8_t exact[4 * WIDTH * HEIGHT];
    const size_t pixels = (size_t)WIDTH * HEIGHT;
    oracle_scene *scene = stock_new(s->name, WIDTH, HEIGHT);
    rig *r = scene ? rig_new(scene, SHADOW) : NULL;
    double light = 0;
    test_begin(s->name);
    CHECK(r && oracle_prepare(scene));
    if (!r || !scene->scratch)
        goto done;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        oracle_pixel pixel;
        oracle_trace(scene, i % WIDTH + 0.5, i / WIDTH + 0.5, &pixel);
        for (int k = 0; k < 3; k++) {
            truth[3 * i + k] = (float)pixel.scatter[k];
            light += pixel.scatter[k];
        }
    }
    CHECK(s->air > 0 ? light > 0 : light == 0);
    for (int i = 0; i < WAYS; i++) {
        way *w = &ways[i];
        tyn_config config;
        tyn_frame frame = rig_frame(r);
        double gap;
        CHECK(tyn_config_preset(&config, w->preset, WIDTH, HEIGHT) == TYN_OK);
        rig_fill(r, &config);
        config.method = w->method;
        config.rays = w->rays;
        config.steps = 200;
        memset(r->scatter, 0xff, pixels * 3 * sizeof *r->scatter);
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(finite_picture(r->scatter, 3 * pixels));
        gap = rig_l1(r->scatter, truth, 3 * pixels);
        if (say)
            printf("  %-30s %-18s L1 %.4f, rays %.1f %%\n", s->name, w->name, gap, (double)r->stats.rays_percent);
        CHECK_NEAR(gap, 0, s->textured ? w->textured : w->worst);
        w->sum += s->textured ? 0 : gap;
        w->count += !s->textured;
        if (i == 0)
            memcpy(exact, r->target, sizeof exact);
        if (w->method == TYN_METHOD_EPIPOLAR && w->rays == TYN_RAYS_WORDS && w->preset == TYN_PRESET_QUALITY) {
            double psnr = rig_psnr(r->target, exact, pixels);
            if (say)
                printf("  %-30s %-18s %.1f dB to the march\n", s->name, w->name, psnr);
            CHECK(psnr > 54);
        }
    }
done:
    rig_free(r);
    model_free(scene);
}

/* Where the truth is infinite the picture must still be a picture. */
static void check_lamp_at_camera(void)
{
    oracle_scene *scene = stock_new("lamp behind the camera", 64, 48);
    rig *r;
    TEST("lamp at the camera");
    memcpy(scene->light[0].position, scene->camera.position, sizeof scene->camera.position);
    memcpy(scene->light[0].direction, scene->camera.forward, sizeof scene->camera.forward);
    r = rig_new(scene, 256);
    CHECK(r != NULL);
    for (int i = 0; r && i < WAYS; i++) {
        tyn_config config = rig_config(r, ways[i].method, ways[i].rays);
        tyn_frame frame = rig_frame(r);
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(finite_picture(r->scatter, 3 * 64 * 48));
    }
    rig_free(r);
    model_free(scene);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The sun goes once around the camera at each of three heights, over the screen, its borders and its corners, and behind the
 * camera: no frame is much worse than the others. The error is relative, to the exact march of the same map. */
static void check_path(int say)
{
    enum { W = 64, H = 48, TURNS = 24, HEIGHTS = 3, FRAMES = TURNS * HEIGHTS };
    static const double heights[HEIGHTS] = {0.12, 0.5773502691896258, 1.2};
    static float exact[3 * W * H];
    double gaps[FRAMES], sorted[FRAMES];
    TEST("the sun on a path around the camera");
    for (int n = 0; n < FRAMES; n++) {
        double turn = 6.283185307179586 * (n % TURNS) / TURNS;
        oracle_scene *scene = stock_new("sun ahead", W, H);
        oracle_camera *c = &scene->camera;
        rig *r;
        scene->lights = 0;
        for (int k = 0; k < 3; k++)
            exact[k] = (float)(-sin(turn) * c->right[k] - heights[n / TURNS] * c->up[k] - cos(turn) * c->forward[k]);
        model_sun(scene, (double)exact[0], (double)exact[1], (double)exact[2], 8);
        r = rig_new(scene, 512);
        CHECK(r != NULL);
        gaps[n] = 0;
        if (r) {
            tyn_config config = rig_config(r, TYN_METHOD_MARCH, TYN_RAYS_WORDS);
            tyn_frame frame = rig_frame(r);
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            memcpy(exact, r->scatter, sizeof exact);
            config.method = TYN_METHOD_EPIPOLAR;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            CHECK(finite_picture(r->scatter, 3 * W * H));
            gaps[n] = rig_l1(r->scatter, exact, 3 * W * H);
        }
        rig_free(r);
        model_free(scene);
    }
    for (int n = 0; n < FRAMES; n++) {
        sorted[n] = gaps[n];
        if (say)
            printf("  turn %5.1f height %.2f: %.5f\n", 360.0 * (n % TURNS) / TURNS, heights[n / TURNS], gaps[n]);
    }
    qsort(sorted, FRAMES, sizeof *sorted, by_size);
    printf("  path of %d frames: error to the march median %.5f, worst %.5f\n", (int)FRAMES, sorted[FRAMES / 2],
           sorted[FRAMES - 1]);
    CHECK(sorted[FRAMES / 2] < 0.0022);
    CHECK(sorted[FRAMES - 1] < 0.012);
}

void test_accuracy(void)
{
    int say = getenv("TYN_SAY") != NULL;
    for (int i = 0; i < stock_count; i++)
        check_scene(&stock_list[i], say);
    check_lamp_at_camera();
    check_path(say);
    TEST("mean error over all scenes");
    for (int i = 0; i < WAYS; i++) {
        printf("  %-18s mean relative L1 %.4f\n", ways[i].name, ways[i].sum / ways[i].count);
        CHECK_NEAR(ways[i].sum / ways[i].count, 0, ways[i].mean);
    }
}
