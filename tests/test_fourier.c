/* test_fourier.c - prefiltered rows: their columns, their memory, and their pictures against the exact march. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fourier.h"
#include "rig.h"
#include "stock.h"
#include "test.h"

static const tyn_method methods[2] = {TYN_METHOD_PREFILTERED, TYN_METHOD_HYBRID};

/* ---- columns -------------------------------------------------------------------------------------------------------- */

/* All of 0 .. end in rising runs, whatever the light, and the thresholds are the row's. */
static void test_columns(void)
{
    static uint16_t threshold[2 * 6 * 260], edge[2 * 6 * 260];
    static tyni_lamp lamp;
    static tyni_row row;
    TEST("columns in a row");
    for (int n = 0; n < stock_count; n++) {
        rig *r = rig_stock(stock_list[n].name, 64, 48, 256);
        tyni_view view;
        tyni_slices slices;
        tyni_view_camera(&view, &r->camera, 64, 48);
        tyni_view_lamp(&lamp, &r->light[0], &view);
        memset(&slices, 0, sizeof slices);
        tyni_slice_layout(&slices, &lamp, 64, 48, 64, 1);
        for (int32_t i = 0; i < slices.count; i++) {
            tyni_slice slice;
            tyni_columns c;
            float end = lamp.kind == TYN_LIGHT_DIRECTIONAL ? 20.0f : 3.14159f, at = 0.0f, from, to, x[2] = {0.0f, end};
            uint32_t q;
            int runs = 0, inside = 1;
            tyni_slice_line(&slice, &slices, &lamp, &view, i);
            if (slice.first > slice.last)
                continue;
            tyni_row_build(&row, TYN_ISA_SCALAR, threshold, edge, 6 * 260, &slice, &lamp, &view, end);
            tyni_columns_begin(&c, &row, &slice, &lamp, end);
            while (tyni_columns_next(&c, &from, &to, &q)) {
                inside &= from == at && to > from && to <= end && q <= 65535;
                at = to;
                runs++;
            }
            CHECK(inside && at == end && runs <= 2 * 6 * 260 + TYNI_ROW_PIECES + 1);
            tyni_columns_volume(&slice, &lamp, x);
            CHECK(x[0] >= 0.0f && x[1] <= end);
        }
        rig_free(r);
    }
}

/* ---- memory --------------------------------------------------------------------------------------------------------- */

static void test_memory(void)
{
    tyn_config c;
    size_t bytes;
    TEST("memory of prefiltered rows is what the macros say");
    for (int n = 0; n < 200; n++) {
        size_t sets, samples;
        CHECK(tyn_config_preset(&c, TYN_PRESET_BALANCED, (int32_t)(1 + test_random() % 700),
                                (int32_t)(1 + test_random() % 500)) == TYN_OK);
        c.bases = 4 * (int32_t)(1 + test_random() % 32);
        c.columns = (int32_t)(4 + test_random() % 300);
        c.references = (int32_t)(1 + test_random() % 4);
        c.weights = test_random() % 3 ? TYN_WEIGHTS_TRANSMITTANCE : TYN_WEIGHTS_AVERAGE;
        c.textured = test_random() % 2;
        c.lights = (int32_t)(1 + test_random() % 2);
        c.workers = (int32_t)(1 + test_random() % 4);
        c.maps = (int32_t)(1 + test_random() % 6);
        sets = (size_t)(c.weights == TYN_WEIGHTS_AVERAGE ? 1 : c.references) * (c.textured ? 3 : 1);
        samples = (size_t)c.samples;
        c.method = TYN_METHOD_HYBRID;
        CHECK(tyn_measure(&c, &bytes) == TYN_OK &&
              bytes == TYN_MEMORY_FULL((size_t)c.width, (size_t)c.height, (size_t)c.slices, samples, (size_t)c.shadow_size,
                                       c.lights, (size_t)c.workers, (size_t)c.maps, c.textured) +
                           TYN_MEMORY_HYBRID(c.bases, c.columns, sets, c.workers));
        c.method = TYN_METHOD_PREFILTERED;
        CHECK(tyn_measure(&c, &bytes) == TYN_OK &&
              bytes == TYN_MEMORY_PREFILTERED((size_t)c.width, (size_t)c.height, (size_t)c.slices, samples,
                                              (size_t)c.shadow_size, c.lights, (size_t)c.workers, (size_t)c.maps, c.bases,
                                              c.columns, sets));
    }
}

/* ---- pictures ------------------------------------------------------------------------------------------------------- */

enum { W = 96, H = 72 };
static float exact[3 * W * H];

static int finite_picture(const float *v, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!(v[i] >= 0.0f && v[i] <= 3.4e38f))
            return 0;
    return 1;
}

/* Error of L_scat to the march that is in `exact`. */
static double gap_of(rig *r, const tyn_config *config)
{
    tyn_frame frame = rig_frame(r);
    memset(r->scatter, 0xff, sizeof exact);
    CHECK(rig_render(r, config, &frame) == TYN_OK);
    CHECK(finite_picture(r->scatter, 3 * W * H));
    return rig_l1(r->scatter, exact, 3 * W * H);
}

static void march(rig *r)
{
    tyn_config config = rig_config(r, TYN_METHOD_MARCH, TYN_RAYS_WORDS);
    gap_of(r, &config);
    memcpy(exact, r->scatter, sizeof exact);
}

/* Every kind of light, wherever it is. */
static void test_accuracy_of_all(void)
{
    double sum[2] = {0, 0};
    int count = 0, say = getenv("TYN_SAY") != NULL;
    TEST("prefiltered and hybrid against the march");
    for (int n = 0; n < stock_count; n++) {
        oracle_scene *scene = stock_new(stock_list[n].name, W, H); /* has the textures */
        rig *r = scene ? rig_new(scene, 512) : NULL;
        CHECK(r != NULL);
        if (!r)
            return;
        march(r);
        for (int m = 0; m < 2; m++) {
            tyn_config config = rig_config(r, methods[m], TYN_RAYS_WORDS);
            double gap = gap_of(r, &config);
            if (say)
                printf("  %-30s %s L1 %.4f, rejected %d\n", stock_list[n].name, m ? "hybrid     " : "prefiltered", gap,
                       (int)r->stats.rejected);
            /* 0.13: a slide whose light is blocked nearly everywhere, so that what rings in the dark is much of all light */
            CHECK_NEAR(gap, 0, stock_list[n].textured ? 0.13 : 0.03);
            sum[m] += stock_list[n].textured ? 0 : gap;
        }
        count += !stock_list[n].textured;
        rig_free(r);
        model_free(scene);
    }
    printf("  mean relative L1 to the march: prefiltered %.4f, hybrid %.4f\n", sum[0] / count, sum[1] / count);
    CHECK(sum[0] / count < 0.006 && sum[1] / count < 0.006);
}

/* No shadow map at all, the sun's own pixel on the screen, and air so thick that weights underflow. */
static void test_no_map(void)
{
    static const char *const scenes[] = {"sun ahead", "thick air", "lamp in view", "bulb in view"};
    TEST("prefiltered rows without a shadow map");
    for (int n = 0; n < 4; n++) {
        rig *r = rig_stock(scenes[n], W, H, 64);
        r->light[0].shadow.depth = NULL;
        r->light[0].shadow.size = 0;
        r->light[0].more_count = 0;
        r->light[0].more = NULL;
        march(r);
        for (int m = 0; m < 2; m++) {
            tyn_config config = rig_config(r, methods[m], TYN_RAYS_WORDS);
            CHECK_NEAR(gap_of(r, &config), 0, 2e-3);
        }
        rig_free(r);
    }
}

/* Without a blocker nothing is approximated: all columns are lit for all rays. */
static void test_unshadowed(void)
{
    static const char *const scenes[] = {"sun ahead", "sun off the left", "lamp in view", "bulb off the right", "thick air"};
    TEST("without blockers prefiltered rows are exact");
    for (int n = 0; n < 5; n++) {
        rig *r = rig_stock(scenes[n], W, H, 64);
        size_t texels = 64 * 64 * (r->light[0].kind == TYN_LIGHT_POINT ? 6 : 1);
        memset(r->map[0], 0, texels * sizeof(float));
        march(r);
        for (int m = 0; m < 2; m++) {
            tyn_config config = rig_config(r, methods[m], TYN_RAYS_WORDS);
            CHECK_NEAR(gap_of(r, &config), 0, r->light[0].kind == TYN_LIGHT_DIRECTIONAL ? 1e-4 : 2e-3);
        }
        rig_free(r);
    }
}

/* More of anything is no worse, and what departs from the paper is better than the paper. */
static void test_settings(void)
{
    rig *r = rig_stock("sun off the left", W, H, 512);
    tyn_config config = rig_config(r, TYN_METHOD_PREFILTERED, TYN_RAYS_WORDS), c;
    double plain, last = 1;
    march(r);
    plain = gap_of(r, &config);
    TEST("settings of prefiltered rows");
    for (int32_t m = 4; m <= 128; m *= 2) {
        double gap;
        c = config;
        c.bases = m;
        gap = gap_of(r, &c);
        CHECK(gap < 1.02 * last);
        last = gap;
    }
    c = config;
    c.columns = 16;
    CHECK(gap_of(r, &c) > plain);
    c = config;
    c.references = 1;
    CHECK(gap_of(r, &c) > plain);
    c.reference = TYN_REFERENCE_GEOMETRIC;
    CHECK(gap_of(r, &c) > plain);
    c = config;
    c.weights = TYN_WEIGHTS_AVERAGE;
    CHECK(gap_of(r, &c) > plain);
    c = config;
    c.window = 1;
    CHECK(gap_of(r, &c) > plain && gap_of(r, &c) < 4 * plain);
    for (int32_t bit = 1; bit <= 8; bit *= 2) {
        c = config;
        c.paper = bit;
        CHECK(bit == TYN_PAPER_RANGE ? gap_of(r, &c) < 2 * plain : gap_of(r, &c) >= plain);
    }
    rig_free(r);
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The sun goes once around the camera at each of three heights, over the screen, its borders and its corners, and behind the
 * camera: no frame is much worse than the others. */
static void test_path(void)
{
    enum { TURNS = 24, HEIGHTS = 3, FRAMES = TURNS * HEIGHTS };
    static const double heights[HEIGHTS] = {0.12, 0.5773502691896258, 1.2};
    double gaps[FRAMES];
    int say = getenv("TYN_SAY") != NULL;
    TEST("prefiltered: the sun on a path around the camera");
    for (int n = 0; n < FRAMES; n++) {
        double turn = 6.283185307179586 * (n % TURNS) / TURNS, d[3];
        oracle_scene *scene = stock_new("sun ahead", W, H);
        oracle_camera *c = &scene->camera;
        rig *r;
        scene->lights = 0;
        for (int k = 0; k < 3; k++)
            d[k] = -sin(turn) * c->right[k] - heights[n / TURNS] * c->up[k] - cos(turn) * c->forward[k];
        model_sun(scene, d[0], d[1], d[2], 8);
        r = rig_new(scene, 512);
        CHECK(r != NULL);
        gaps[n] = 0;
        if (r) {
            tyn_config config = rig_config(r, TYN_METHOD_PREFILTERED, TYN_RAYS_WORDS);
            march(r);
            gaps[n] = gap_of(r, &config);
            if (say)
                printf("  turn %5.1f height %.2f: %.5f\n", 360.0 * (n % TURNS) / TURNS, heights[n / TURNS], gaps[n]);
        }
        rig_free(r);
        model_free(scene);
    }
    qsort(gaps, FRAMES, sizeof *gaps, by_size);
    printf("  path of %d frames: error to the march median %.5f, worst %.5f\n", (int)FRAMES, gaps[FRAMES / 2],
           gaps[FRAMES - 1]);
    CHECK(gaps[FRAMES / 2] < 0.004 && gaps[FRAMES - 1] < 0.006);
}

/* Art: contrast of shafts is linear in what the rows hold. */
static void test_contrast(void)
{
    static const float contrasts[] = {-1.0f, 0.5f, 1.0f, 1.6f};
    rig *r = rig_stock("sun off the left", W, H, 256);
    TEST("contrast in prefiltered rows");
    for (int i = 0; i < 4; i++) {
        tyn_frame frame = rig_frame(r);
        tyn_config config = rig_config(r, TYN_METHOD_MARCH, TYN_RAYS_WORDS);
        frame.shaft_contrast = contrasts[i];
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        memcpy(exact, r->scatter, sizeof exact);
        for (int m = 0; m < 2; m++) {
            config.method = methods[m];
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            CHECK_NEAR(rig_l1(r->scatter, exact, 3 * W * H), 0, 0.02);
        }
    }
    rig_free(r);
}

/* An orthographic camera's rays do not start in one column: other methods take over, and no view of the rows is drawn. */
static void test_elsewhere(void)
{
    rig *r = rig_stock("sun off the left", W, H, 256);
    tyn_config config = rig_config(r, TYN_METHOD_PREFILTERED, TYN_RAYS_WORDS);
    tyn_frame frame = rig_frame(r);
    TEST("prefiltered: orthographic cameras and debug views");
    frame.debug = TYN_DEBUG_LINES;
    CHECK(rig_render(r, &config, &frame) == TYN_E_DISPLAY);
    frame.debug = TYN_DEBUG_BASIS;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    frame.camera.kind = TYN_CAMERA_ORTHOGRAPHIC;
    frame.camera.left_edge *= 6;
    frame.camera.right_edge *= 6;
    frame.camera.bottom_edge *= 6;
    frame.camera.top_edge *= 6;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    frame.debug = TYN_DEBUG_NONE;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(exact, r->scatter, sizeof exact);
    config.method = TYN_METHOD_MARCH;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK(memcmp(exact, r->scatter, sizeof exact) == 0);
    config.method = TYN_METHOD_HYBRID;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(exact, r->scatter, sizeof exact);
    config.method = TYN_METHOD_EPIPOLAR;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK(memcmp(exact, r->scatter, sizeof exact) == 0);
    config.method = TYN_METHOD_HYBRID;
    frame = rig_frame(r);
    frame.debug = TYN_DEBUG_BASIS;
    CHECK(rig_render(r, &config, &frame) == TYN_E_DISPLAY);
    rig_free(r);
}

void test_fourier(void)
{
    test_columns();
    test_memory();
    test_accuracy_of_all();
    test_no_map();
    test_unshadowed();
    test_settings();
    test_path();
    test_contrast();
    test_elsewhere();
}
