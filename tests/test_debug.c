/* test_debug.c - the debug views, and times by stage. */
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "test.h"

enum { W = 64, H = 48, PIXELS = W * H, VIEWS = TYN_DEBUG_TREE + 1 };

static int count_colour(const rig *r, int red, int green, int blue)
{
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        const uint8_t *p = r->target + 4 * i;
        count +=
            (p[0] > 200) == red && (p[1] > 200) == green && (p[2] > 200) == blue && (p[0] > 200 || p[1] > 200 || p[2] > 200);
    }
    return count;
}

/* Each is drawn, is the picture of no other, fills every pixel, and is the same again. */
static void test_views(void)
{
    TEST("tyn_render: the debug views, with every layout of lines");
    for (int gather = 0; gather <= (int)TYN_GATHER_ED10; gather++) {
        rig *r = rig_stock("sun ahead", W, H, 128);
        tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_TREE);
        uint64_t seen[VIEWS];
        config.gather = (tyn_gather)gather;
        config.slices = 40;
        for (int debug = 0; debug < VIEWS; debug++) {
            tyn_frame frame = rig_frame(r);
            frame.debug = (tyn_debug)debug;
            memset(r->target, 0, 4 * PIXELS);
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            seen[debug] = rig_hash(r->target, 4 * PIXELS);
            for (int i = 0; i < PIXELS; i++)
                CHECK(r->target[4 * i + 3] == 255);
            for (int before = 0; before < debug; before++)
                CHECK(seen[debug] != seen[before]);
            CHECK(rig_render(r, &config, &frame) == TYN_OK && rig_hash(r->target, 4 * PIXELS) == seen[debug]);
        }
        rig_free(r);
    }
}

/* Marks are where the counts say: rays white, breaks green, refined ones blue; none of them without lines. */
static void test_marks(void)
{
    rig *r = rig_stock("sun off the left", W, H, 256);
    tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
    tyn_frame frame = rig_frame(r);
    int white, blue;
    TEST("tyn_render: marks of samples and breaks");
    config.slices = 24;
    config.initial_step = 16;
    frame.debug = TYN_DEBUG_SAMPLES;
    CHECK(rig_render(r, &config, &frame) == TYN_OK && r->stats.rays > r->stats.initial);
    white = count_colour(r, 1, 1, 1);
    blue = count_colour(r, 0, 0, 1);
    CHECK(white > 20 && blue > 0 && count_colour(r, 0, 1, 0) > 0);
    CHECK(blue <= 4 * (r->stats.rays - r->stats.initial));
    config.tolerance = 1;
    CHECK(rig_render(r, &config, &frame) == TYN_OK && r->stats.rays == r->stats.initial);
    CHECK(count_colour(r, 1, 1, 1) == white && count_colour(r, 0, 0, 1) == 0);
    frame.debug = TYN_DEBUG_BREAKS;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK(count_colour(r, 0, 1, 0) > 0 && count_colour(r, 1, 1, 1) == 0);
    rig_free(r);
}

/* Rejected pixels are as many as the count; those of the pass after up-scaling are yellow. */
static void test_rejected(void)
{
    rig *r = rig_stock("sun ahead", W, H, 128);
    tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
    tyn_frame frame = rig_frame(r);
    TEST("tyn_render: rejected pixels are drawn");
    config.slices = 16;
    frame.debug = TYN_DEBUG_REJECTED;
    CHECK(rig_render(r, &config, &frame) == TYN_OK && r->stats.rejected > 0);
    CHECK(count_colour(r, 1, 0, 0) == r->stats.rejected);
    config.downscale = 4;
    CHECK(rig_render(r, &config, &frame) == TYN_OK && r->stats.corrected > 0);
    CHECK(count_colour(r, 1, 1, 0) == r->stats.corrected);
    rig_free(r);
}

/* The row and the tree: of the pixel asked for; refused where there is none. */
static void test_charts(void)
{
    rig *r = rig_stock("sun off the left", W, H, 256);
    tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_TREE);
    tyn_frame frame = rig_frame(r);
    uint64_t middle;
    TEST("tyn_render: a slice's row and tree");
    for (int view = TYN_DEBUG_ROW; view <= (int)TYN_DEBUG_TREE; view++) {
        frame.debug = (tyn_debug)view;
        frame.debug_x = frame.debug_y = 0;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        middle = rig_hash(r->target, 4 * PIXELS);
        frame.debug_x = 0.5f * W;
        frame.debug_y = 0.5f * H;
        CHECK(rig_render(r, &config, &frame) == TYN_OK && rig_hash(r->target, 4 * PIXELS) == middle);
        frame.debug_x = 3.5f;
        CHECK(rig_render(r, &config, &frame) == TYN_OK && rig_hash(r->target, 4 * PIXELS) != middle);
        frame.debug_x = -1e6f; /* beside the picture: the nearest there is */
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        frame.debug_x = 0.0f / (frame.debug_y - 0.5f * H);
        CHECK(rig_render(r, &config, &frame) == TYN_E_DISPLAY);
    }
    frame.debug_x = 1;
    config.rays = TYN_RAYS_WORDS;
    CHECK(rig_render(r, &config, &frame) == TYN_E_DISPLAY); /* no tree */
    frame.debug = TYN_DEBUG_ROW;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    config.method = TYN_METHOD_MARCH; /* nothing to show, and no crash */
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    frame.debug = (tyn_debug)VIEWS;
    CHECK(rig_render(r, &config, &frame) == TYN_E_DISPLAY);
    frame.debug = TYN_DEBUG_ROW;
    config.method = TYN_METHOD_PREFILTERED; /* keeps no lines */
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    frame.debug_x = frame.debug_y = 0; /* and a picture of one pixel has no chart */
    frame.depth.width = frame.depth.height = frame.target.width = frame.target.height = 1;
    frame.colour.width = frame.colour.height = frame.scatter.width = frame.scatter.height = 1;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    rig_free(r);
}

/* A clock that moves by one each time it is asked. */
static uint64_t tick(void *context)
{
    return ++*(uint64_t *)context;
}

/* Stages have times where they have work, and not without a clock. */
static void test_times(void)
{
    TEST("tyn_render: times by stage");
    for (int way = 0; way < RIG_WAYS; way++) {
        rig *r = rig_stock("sun ahead", W, H, 128);
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        const tyn_stats *s = &r->stats;
        int lines = config.method == TYN_METHOD_EPIPOLAR || config.method == TYN_METHOD_HYBRID,
            coarse = lines && config.downscale > 1;
        uint64_t time = 0;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(!s->slice_ns && !s->gather_ns && !s->total_ns && !s->sample_ns && !s->row_ns && !s->ray_ns && !s->line_ns);
        CHECK(!s->unwarp_ns && !s->correct_ns && !s->upscale_ns && !s->composite_ns);
        frame.clock = tick;
        frame.clock_context = &time;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(s->total_ns == s->slice_ns + s->gather_ns && s->gather_ns > 0 && s->composite_ns > 0);
        CHECK((s->correct_ns > 0) == (config.method == TYN_METHOD_MARCH || s->rejected + s->corrected > 0));
        int rows = lines || config.method == TYN_METHOD_PREFILTERED;
        CHECK((s->sample_ns > 0) == rows && (s->row_ns > 0) == rows && (s->line_ns > 0) == rows);
        CHECK((s->ray_ns > 0) == (lines || config.method == TYN_METHOD_SUBSAMPLE));
        CHECK((s->upscale_ns > 0) == (coarse || config.method == TYN_METHOD_SUBSAMPLE));
        CHECK((s->unwarp_ns > 0) == (config.method != TYN_METHOD_SUBSAMPLE));
        /* one thread: the stages are inside the whole */
        CHECK(s->sample_ns + s->row_ns + s->ray_ns + s->line_ns + s->unwarp_ns + s->correct_ns + s->upscale_ns +
                  s->composite_ns <=
              s->total_ns);
        rig_free(r);
    }
}

/* Slices beside a spot's cone are culled and cost no rays. */
static void test_culled(void)
{
    TEST("tyn_render: slices outside the light's volume");
    for (int gather = 0; gather <= (int)TYN_GATHER_ED10; gather++) {
        rig *r = rig_stock("lamp above", W, H, 128);
        tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
        tyn_frame frame = rig_frame(r);
        int64_t all;
        config.gather = (tyn_gather)gather;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        all = r->stats.slices + r->stats.culled;
        r->light[0].angle = 0.2f;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(r->stats.culled > all / 3 && r->stats.slices > 0 && r->stats.slices + r->stats.culled == all);
        rig_free(r);
    }
}

void test_debug(void)
{
    test_views();
    test_marks();
    test_rejected();
    test_charts();
    test_times();
    test_culled();
}
