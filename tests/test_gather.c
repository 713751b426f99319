/* test_gather.c - every combination of rays, lines and down-scaling against the exact march of the same shadow map, and that
 * more work never makes it worse. */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "entry.h"
#include "gather.h"
#include "rig.h"
#include "stock.h"
#include "test.h"

enum { W = 64, H = 48, PIXELS = W * H, SHADOW = 384, GATHERS = 3, SCALES = 4 };

static const char *const gathers[GATHERS] = {"shear", "IVB", "ED10"};

/* White lights of every kind and place, then a slide, which is the hardest. */
static const char *const names[] = {"sun ahead",    "sun off the left", "sun parallel to the picture",
                                    "lamp in view", "bulb in view",     "slide in a lamp"};
enum { NAMES = (int)(sizeof names / sizeof *names), WHITE = NAMES - 1 };

/* Rigs and their exact marches, drawn once. */
static oracle_scene *scenes[NAMES]; /* a slide's pixels are the model's */
static rig *rigs[NAMES];
static float *truths[NAMES];

static int set_up(void)
{
    for (int n = 0; n < NAMES; n++) {
        tyn_config config;
        tyn_frame frame;
        scenes[n] = stock_new(names[n], W, H);
        rigs[n] = rig_new(scenes[n], SHADOW);
        truths[n] = malloc(3 * PIXELS * sizeof *truths[n]);
        CHECK(rigs[n] && truths[n]);
        if (!rigs[n] || !truths[n])
            return 0;
        config = rig_config(rigs[n], TYN_METHOD_MARCH, TYN_RAYS_WORDS);
        frame = rig_frame(rigs[n]);
        frame.scatter.pixels = truths[n];
        CHECK(rig_render(rigs[n], &config, &frame) == TYN_OK);
    }
    return 1;
}

static void tear_down(void)
{
    for (int n = 0; n < NAMES; n++) {
        rig_free(rigs[n]);
        free(truths[n]);
        model_free(scenes[n]);
    }
}

/* Relative L1 of L_scat to the march. */
static double error_of(int n, const tyn_config *config)
{
    tyn_frame frame = rig_frame(rigs[n]);
    tyn_config own = *config;
    rig_fill(rigs[n], &own);
    CHECK(rig_render(rigs[n], &own, &frame) == TYN_OK);
    for (int i = 0; i < 3 * PIXELS; i++)
        if (!(rigs[n]->scatter[i] >= 0 && rigs[n]->scatter[i] < 1e30f))
            return 1e9;
    return rig_l1(rigs[n]->scatter, truths[n], 3 * PIXELS);
}

/* Over the first three: ladders have many rungs. */
static double mean_of(const tyn_config *config)
{
    return (error_of(0, config) + error_of(1, config) + error_of(2, config)) / 3;
}

static tyn_config quality(void)
{
    tyn_config config;
    CHECK(tyn_config_preset(&config, TYN_PRESET_QUALITY, W, H) == TYN_OK);
    return config;
}

/* Measured, plus a quarter: the worst and the mean of the white lights, and the slide. A coarse picture loses what is finer
 * than its pixels: of a slide, whose beams meet in the lamp, most. */
static const struct {
    double worst, mean, slide;
} bounds[2][SCALES] = {{{0.0068, 0.0039, 0.0235}, {0.013, 0.0063, 0.233}, {0.0325, 0.0135, 0.23}, {0.048, 0.0224, 0.34}},
                       {{0.0118, 0.005, 0.0235}, {0.0135, 0.0072, 0.233}, {0.033, 0.0155, 0.23}, {0.049, 0.0245, 0.34}}};

static void test_combinations(int say)
{
    for (int steps = 0; steps < 2; steps++)
        for (int scale = 0; scale < SCALES; scale++)
            for (int gather = 0; gather < GATHERS; gather++) {
                tyn_config config = quality();
                double sum = 0, worst = 0, slide, e;
                char text[80];
                snprintf(text, sizeof text, "%s%s, down-scaled by %d: error to the march", gathers[gather],
                         steps ? " in steps" : "", 1 << scale);
                test_begin(text);
                config.rays = steps ? TYN_RAYS_STEPS : TYN_RAYS_WORDS;
                config.steps = 200;
                config.gather = (tyn_gather)gather;
                config.downscale = 1 << scale;
                for (int n = 0; n < WHITE; n++) {
                    sum += e = error_of(n, &config);
                    worst = e > worst ? e : worst;
                }
                slide = error_of(WHITE, &config);
                if (say)
                    printf("  %-40s mean %.4f worst %.4f slide %.4f\n", text, sum / WHITE, worst, slide);
                CHECK_NEAR(worst, 0, bounds[steps][scale].worst);
                CHECK_NEAR(sum / WHITE, 0, bounds[steps][scale].mean);
                CHECK_NEAR(slide, 0, bounds[steps][scale].slide);
            }
}

/* One number of the config from little work to much: the mean error falls, or stays within noise, and is `gain` times smaller
 * in the end. */
typedef struct ladder {
    const char *name;
    size_t field;      /* of int32_t in tyn_config */
    int32_t values[8]; /* 0 ends them */
    double gain;
} ladder;

static const ladder ladders[] = {{"lines", offsetof(tyn_config, slices), {16, 32, 64, 128, 256}, 4},
                                 {"samples", offsetof(tyn_config, samples), {8, 16, 32, 64}, 2},
                                 {"initial step", offsetof(tyn_config, initial_step), {64, 16, 4, 1}, 1.2},
                                 {"down-scaling", offsetof(tyn_config, downscale), {8, 4, 2, 1}, 3},
                                 {"steps", offsetof(tyn_config, steps), {8, 32, 128, 512}, 8},
                                 {"rays of sub-sampling", offsetof(tyn_config, budget), {50, 200, 800, 4800}, 20}};
enum { LADDERS = (int)(sizeof ladders / sizeof *ladders) };

static void climb(const ladder *l, tyn_config config, const char *name, int say)
{
    double before = 1e9, first = 0, e = 0;
    for (int i = 0; l->values[i]; i++) {
        memcpy((char *)&config + l->field, &l->values[i], sizeof l->values[i]);
        e = mean_of(&config);
        if (say)
            printf("  %-8s %-22s %6d: %.5f\n", name, l->name, (int)l->values[i], e);
        CHECK(e <= 1.03 * before + 1e-5);
        first = i ? first : e;
        before = e;
    }
    CHECK(e * l->gain <= first);
}

static void test_monotone(int say)
{
    for (int i = 0; i < LADDERS; i++)
        for (int gather = 0; gather < GATHERS; gather++) {
            tyn_config config = quality();
            char text[80];
            if (gather && ladders[i].field == offsetof(tyn_config, budget))
                continue; /* it has no lines */
            snprintf(text, sizeof text, "%s, %s: more is never worse", gathers[gather], ladders[i].name);
            test_begin(text);
            config.gather = (tyn_gather)gather;
            config.slices = 256;
            if (ladders[i].field == offsetof(tyn_config, initial_step))
                config.tolerance = 1; /* by depth alone */
            if (ladders[i].field == offsetof(tyn_config, steps))
                config.rays = TYN_RAYS_STEPS;
            if (ladders[i].field == offsetof(tyn_config, budget))
                config.method = TYN_METHOD_SUBSAMPLE;
            climb(&ladders[i], config, gathers[gather], say);
        }
}

/* Refinement on light: a smaller tolerance costs rays and never accuracy. */
static void test_tolerance(int say)
{
    static const float tolerances[] = {1.0f, 0.1f, 0.03f, 0.01f, 0.003f, 0.001f};
    double before = 1e9, first = 0;
    int64_t rays = 0;
    TEST("tolerance: smaller is never worse, and takes more rays");
    for (size_t i = 0; i < sizeof tolerances / sizeof *tolerances; i++) {
        tyn_config config = quality();
        int64_t now = 0;
        double e = 0;
        config.initial_step = 16;
        config.tolerance = tolerances[i];
        for (int n = 0; n < WHITE; n++) {
            e += error_of(n, &config) / WHITE;
            now += rigs[n]->stats.rays;
        }
        if (say)
            printf("  tolerance %.3f: %.5f with %ld rays\n", (double)tolerances[i], e, (long)now);
        CHECK(e <= 1.03 * before + 1e-5 && now >= rays);
        first = i ? first : e;
        before = e;
        rays = now;
    }
    CHECK(1.15 * before <= first); /* near lamps, depth alone knows most of it */
}

/* From a tolerance of 0.01 on short stretches are left as they are. */
static void test_short_stretches(void)
{
    int64_t rays[2] = {0, 0};
    TEST("tolerance: from 0.01 on an eighth of the initial step is not split");
    for (int i = 0; i < 2; i++) {
        tyn_config config = quality();
        config.initial_step = 64;
        config.tolerance = i ? 0.00999f : 0.01f;
        for (int n = 0; n < WHITE; n++) {
            error_of(n, &config);
            rays[i] += rigs[n]->stats.rays;
        }
    }
    CHECK(rays[0] > 0 && (double)rays[1] > 1.05 * (double)rays[0]);
}

/* ED10's weights and taps: another choice is another picture, none is much worse. */
static void test_kernels(int say)
{
    TEST("ED10: kernels and taps");
    for (int kernel = 0; kernel <= (int)TYN_KERNEL_THRESHOLD; kernel++)
        for (int32_t taps = 3; taps <= 5; taps++) {
            tyn_config config = quality();
            double e;
            config.gather = TYN_GATHER_ED10;
            config.kernel = (tyn_kernel)kernel;
            config.taps = taps;
            e = mean_of(&config);
            if (say)
                printf("  kernel %d, %d taps: %.5f\n", kernel, (int)taps, e);
            CHECK_NEAR(e, 0, 0.004);
        }
}

/* Sub-sampling takes about as many rays as it is told to, for comparison at equal cost, and is worse than slices with as many.
 */
static void test_budget(int say)
{
    double slices = 0, grid = 0;
    TEST("sub-sampling with the rays of slices");
    for (int n = 0; n < WHITE; n++) {
        tyn_config config = quality();
        int64_t rays;
        config.initial_step = 16;
        config.slices = 96;
        config.tolerance = 0.03f;
        slices += error_of(n, &config);
        rays = rigs[n]->stats.rays + rigs[n]->stats.rejected;
        config.method = TYN_METHOD_SUBSAMPLE;
        config.budget = (int32_t)rays;
        grid += error_of(n, &config);
        CHECK_NEAR((double)rigs[n]->stats.rays / (double)rays, 1, 0.02);
    }
    if (say)
        printf("  slices %.5f, grid %.5f\n", slices / WHITE, grid / WHITE);
    CHECK(grid > 1.5 * slices);
}

/* Points of a coarse picture lie up to a step beside the screen: they take the end of their own line, which is bright, and not
 * the beginning of the next one. */
static void test_beside(void)
{
    enum { SIZE = 24, LINES = 32 };
    static uint32_t entries[LINES * SIZE];
    static float scales[LINES];
    static const float inverse[2] = {1.0f, 1.0f};
    tyni_gather gather = {TYN_GATHER_SHEAR, TYN_KERNEL_GAUSSIAN, 3};
    tyni_field field = {entries, NULL, {scales, scales, scales}, SIZE, 0.06f};
    tyni_slices slices;
    tyni_lamp lamp;
    TEST("gather: points beside the screen");
    for (int32_t i = 0; i < LINES * SIZE; i++)
        entries[i] = tyni_entry_pack(i % SIZE < SIZE / 2 ? 0.0f : 1.0f, 1.0f, inverse, 0.5f);
    for (int32_t i = 0; i < LINES; i++)
        scales[i] = 1.0f;
    for (int down = 0; down < 2; down++) {
        memset(&slices, 0, sizeof slices);
        memset(&lamp, 0, sizeof lamp);
        lamp.ew = 1.0f;
        lamp.ex = down ? SIZE / 2 : -900.0f;
        lamp.ey = down ? -900.0f : SIZE / 2;
        tyni_slice_layout(&slices, &lamp, SIZE, SIZE, LINES, 1);
        for (int32_t i = 0; i < 4 * SIZE; i++) {
            float along = (float)SIZE - 0.5f + (float)(i % 4) * 2.0f, across = (float)(i / 4) + 0.5f, value[3] = {0};
            CHECK(
                tyni_gather_lines(&gather, &field, &slices, down ? across : along, down ? along : across, 0.5f, 0.06f, value) &&
                value[0] > 0.99f);
        }
    }
}

void test_gather(void)
{
    int say = getenv("TYN_SAY") != NULL;
    test_beside();
    TEST("the exact march");
    if (set_up()) {
        test_combinations(say);
        test_monotone(say);
        test_tolerance(say);
        test_short_stretches();
        test_kernels(say);
        test_budget(say);
    }
    tear_down();
}
