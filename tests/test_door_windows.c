/* test_door_windows.c - maps that cover a part of what another does: cascades, windows, atlases. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "stock.h"
#include "test.h"

enum { W = 40, H = 30, PIXELS = W * H, MAP = 128 };

/* A window of a map as a map of its own: the same texels, where they lie. */
static tyn_shadow window(const tyn_shadow *from, int x, int y, int width, int height)
{
    tyn_shadow s = *from;
    const float n = (float)from->size;
    for (int i = 0; i < 4; i++) {
        s.matrix[i] = (from->matrix[i] * n - (float)x * from->matrix[12 + i]) / (float)width;
        s.matrix[4 + i] = (from->matrix[4 + i] * n - (float)y * from->matrix[12 + i]) / (float)height;
    }
    s.depth = (const float *)from->depth + (ptrdiff_t)y * from->size + x;
    s.stride = (ptrdiff_t)from->size * (ptrdiff_t)sizeof(float);
    s.size = width;
    s.height = height;
    return s;
}

/* Pixels of which a channel is further off than `close`, in parts of the brightest. */
static int pixels_apart(const float *a, const float *b, double close)
{
    double most = 0;
    int apart = 0;
    for (int i = 0; i < 3 * PIXELS; i++)
        most = (double)b[i] > most ? (double)b[i] : most;
    for (int i = 0; i < 3 * PIXELS; i += 3) {
        int off = 0;
        for (int c = 0; c < 3; c++)
            off |= fabs((double)a[i + c] - (double)b[i + c]) > close * most;
        apart += off;
    }
    return apart;
}

static void check_windows(rig *r, tyn_shadow *maps, int count, double tolerance)
{
    static float one[3 * PIXELS];
    for (int way = 0; way < RIG_WAYS - 1; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        tyn_light light = r->light[0];
        double close;
        int apart;
        config.steps = 40;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        memcpy(one, r->scatter, sizeof one);
        config.maps = count;
        light.shadow = maps[0];
        light.more = maps + 1;
        light.more_count = count - 1;
        frame.lights = &light;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        /* in what order columns come hangs on the pieces: prefiltered sums round in other places */
        close = config.method >= TYN_METHOD_PREFILTERED ? 2 * tolerance : tolerance;
        apart = pixels_apart(r->scatter, one, close);
        /* A pixel in a thousand, of a coarse picture if there is one: a line that runs along a border between texels may be on
         * its other side in a map cut from the other, and ED10's lines are not stretched: at a lamp in view they have many
         * samples to a pixel, and which of these rays cross so few columns that they are walked hangs on how many pieces the
         * columns are in. */
        CHECK(apart <= (config.downscale > 1 ? config.downscale * config.downscale : 1));
        CHECK_NEAR(rig_worst(r->scatter, one, 3 * PIXELS), 0, config.gather == TYN_GATHER_ED10 ? 0.04 : 5 * tolerance);
    }
}

/* Maps that overlap, tile or nest, all with the texels of one: no border shows, whatever lies where. */
static void test_windows(void)
{
    static const char *const names[] = {"sun off the left", "sun behind the camera", "lamp off the left", "lamp in view"};
    TEST("up to 8 overlapping maps are as the one they were cut from");
    for (int n = 0; n < 4; n++) {
        rig *r = rig_stock(names[n], W, H, MAP);
        const tyn_shadow *big = &r->light[0].shadow;
        tyn_shadow maps[8];
        for (int turn = 0; turn < 6; turn++) { /* anywhere */
            int count = 2 + (int)(test_random() % 7);
            for (int i = 0; i < count - 1; i++) {
                int w = 1 + (int)(test_random() % MAP), h = 1 + (int)(test_random() % MAP);
                maps[i] = window(big, (int)(test_random() % (uint32_t)(MAP + 1 - w)),
                                 (int)(test_random() % (uint32_t)(MAP + 1 - h)), w, h);
            }
            maps[count - 1] = *big;
            check_windows(r, maps, count, 2e-3);
        }
        for (int i = 0; i < 7; i++) /* nested: each way has most pieces */
            maps[i] = window(big, 56 - 8 * i, 56 - 8 * i, 16 + 16 * i, 16 + 16 * i);
        maps[7] = *big;
        check_windows(r, maps, 8, 2e-3);
        for (int i = 0; i < 8; i++) /* tiles, wider than high */
            maps[i] = window(big, 64 * (i & 1), 32 * (i >> 1), 64, 32);
        check_windows(r, maps, 8, 2e-3);
        rig_free(r);
    }
}

/* Draws the rig's scene into maps. */
static void draw(const rig *r, tyn_shadow *maps, int count)
{
    tyn_raster_config config = {MAP, MAP, 0, 0, 0};
    tyn_raster *raster = NULL;
    size_t bytes = 0;
    void *block;
    CHECK(tyn_raster_measure(&config, &bytes) == TYN_OK);
    block = rig_block(bytes);
    CHECK(block && tyn_raster_init(&raster, &config, block, bytes) == TYN_OK);
    for (int i = 0; i < count; i++) {
        float *texels = calloc(MAP * MAP, sizeof *texels);
        maps[i].depth = texels;
        CHECK(texels && tyn_raster_shadow(raster, &maps[i], texels, r->mesh, r->meshes, NULL, NULL, NULL, NULL) == TYN_OK);
    }
    free(block);
}

/* To the oracle, relative. */
static double miss(const rig *r, const double *truth)
{
    double gap = 0, sum = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        gap += fabs((double)r->scatter[i] - truth[i]);
        sum += truth[i];
    }
    return gap / sum;
}

/* Cascades with texels of their own, each half as wide as the next: nearer to the truth than the widest alone. And maps that
 * are not square. */
static void test_cascades(void)
{
    static const char *const names[] = {"sun off the left", "lamp off the left"};
    static double truth[3 * PIXELS];
    TEST("8 cascades, and a map that is not square, against the oracle");
    for (int n = 0; n < 2; n++) {
        oracle_scene *scene = stock_new(names[n], W, H);
        rig *r = rig_stock(names[n], W, H, MAP);
        tyn_shadow maps[8];
        CHECK(scene && oracle_prepare(scene));
        for (int i = 0; i < PIXELS; i++) {
            oracle_pixel pixel;
            oracle_trace(scene, i % W + 0.5, i / W + 0.5, &pixel);
            memcpy(truth + 3 * i, pixel.scatter, sizeof pixel.scatter);
        }
        for (int i = 0; i < 8; i++) {
            float width = MAP;
            for (int k = i; k < 7; k++)
                width *= 0.75f;
            maps[i] =
                window(&r->light[0].shadow, (int)(0.5f * (MAP - width)), (int)(0.5f * (MAP - width)), (int)width, (int)width);
            maps[i].size = MAP;
            maps[i].height = MAP;
            maps[i].stride = 0;
        }
        draw(r, maps, 8);
        for (int way = 0; way < RIG_WAYS - 1; way++) {
            tyn_config config = rig_way_config(r, &rig_ways[way]);
            tyn_frame frame = rig_frame(r);
            tyn_light light = r->light[0];
            double one;
            config.steps = 200;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            one = miss(r, truth);
            frame.lights = &light;
            config.maps = 8;
            light.shadow = maps[0];
            light.more = maps + 1;
            light.more_count = 7;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            /* prefiltered rows ring a little differently with every threshold */
            CHECK_NEAR(miss(r, truth), 0, config.method >= TYN_METHOD_PREFILTERED ? one + 0.0007 : one);
        }
        for (int i = 0; i < 8; i++)
            free((void *)(uintptr_t)maps[i].depth);
        maps[0] = maps[1] = r->light[0].shadow;
        maps[0].height = MAP / 2;
        maps[1].size = MAP / 2;
        maps[1].height = MAP;
        draw(r, maps, 2);
        for (int k = 0; k < 2; k++)
            for (int way = 0; way < RIG_WAYS - 1; way++) {
                tyn_config config = rig_way_config(r, &rig_ways[way]);
                tyn_frame frame = rig_frame(r);
                tyn_light light = r->light[0];
                double one;
                config.steps = 200;
                CHECK(rig_render(r, &config, &frame) == TYN_OK);
                one = miss(r, truth);
                light.shadow = maps[k];
                frame.lights = &light;
                CHECK(rig_render(r, &config, &frame) == TYN_OK);
                CHECK_NEAR(miss(r, truth), 0, 2.5 * one + 1e-3);
            }
        free((void *)(uintptr_t)maps[0].depth);
        free((void *)(uintptr_t)maps[1].depth);
        rig_free(r);
        oracle_release(scene);
        model_free(scene);
    }
}

void test_door_windows(void)
{
    test_windows();
    test_cascades();
}
