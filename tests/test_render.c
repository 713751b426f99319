/* test_render.c - tyn_render at its door and in its pixels: statuses, bands, formats, in place, odd input. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "rig.h"
#include "stock.h"
#include "test.h"

/* ---- statuses ------------------------------------------------------------------------------------------------------- */

/* What a case may spoil. */
typedef struct spoiled {
    tyn_frame frame;
    tyn_light light[2];
    tyn_medium medium[1];
    tyn_executor executor;
} spoiled;

static void run_nothing(void *context, tyn_job job, void *argument, int32_t count)
{
    (void)context, (void)job, (void)argument, (void)count;
}

/* Spoils case n; its status, or TYN_OK after the last. */
static tyn_status spoil(spoiled *s, int n)
{
    static float matrix_nan = (float)NAN;
    tyn_frame *f = &s->frame;
    switch (n) {
#define CASE(n, status, change)                                                                                                \
    case n:                                                                                                                    \
        change;                                                                                                                \
        return status;
        CASE(0, TYN_E_NULL, f->depth.pixels = NULL)
        CASE(1, TYN_E_IMAGE, f->depth.format = TYN_RGB_F32)
        CASE(2, TYN_E_IMAGE, f->depth.width = 0)
        CASE(3, TYN_E_IMAGE, f->depth.height = -4)
        CASE(4, TYN_E_IMAGE, f->depth.stride = 4)
        CASE(5, TYN_E_ALIGN, f->depth.stride = 4 * f->depth.width + 2)
        CASE(6, TYN_E_ALIGN, f->depth.pixels = (char *)f->depth.pixels + 1)
        CASE(7, TYN_E_IMAGE, f->target.width--)
        CASE(8, TYN_E_IMAGE, f->target.format = TYN_DEPTH_F32)
        CASE(9, TYN_E_IMAGE, f->target.format = TYN_RGB16_LINEAR)
        CASE(10, TYN_E_IMAGE, f->target.format = TYN_FORMAT_NONE)
        CASE(11, TYN_E_IMAGE, f->target.stride = 4 * f->target.width - 4)
        CASE(12, TYN_E_IMAGE, f->colour.height++)
        CASE(13, TYN_E_IMAGE, f->colour.format = TYN_MASK8)
        CASE(14, TYN_E_ALIGN, f->colour.pixels = (char *)f->colour.pixels + 2)
        CASE(15, TYN_E_IMAGE, f->scatter.format = TYN_RGBA8_SRGB)
        CASE(16, TYN_E_IMAGE, f->scatter.width--)
        CASE(17, TYN_E_ALIGN, f->scatter.stride += 2)
        CASE(18, TYN_E_CAMERA, f->camera.position[1] = (float)NAN)
        CASE(19, TYN_E_CAMERA, f->camera.forward[0] += 0.1f)
        CASE(20, TYN_E_CAMERA, memset(f->camera.up, 0, sizeof f->camera.up))
        CASE(21, TYN_E_CAMERA, memcpy(f->camera.up, f->camera.right, sizeof f->camera.up))
        CASE(22, TYN_E_CAMERA, f->camera.left_edge = f->camera.right_edge)
        CASE(23, TYN_E_CAMERA, f->camera.top_edge = (float)INFINITY)
        CASE(24, TYN_E_CAMERA, f->camera.bottom_edge = f->camera.top_edge + 1)
        CASE(25, TYN_E_CAMERA, f->camera.near_depth = 0)
        CASE(26, TYN_E_CAMERA, f->camera.far_depth = f->camera.near_depth)
        CASE(27, TYN_E_CAMERA, f->camera.far_depth = (float)INFINITY)
        CASE(28, TYN_E_NULL, f->lights = NULL)
        CASE(29, TYN_E_LIMIT, f->light_count = 3)
        CASE(30, TYN_E_LIGHT, s->light[0].direction[0] = 2)
        CASE(31, TYN_E_LIGHT, s->light[0].direction[1] = (float)NAN)
        CASE(32, TYN_E_LIGHT, s->light[0].colour[2] = -1)
        CASE(33, TYN_E_LIGHT, s->light[0].colour[0] = (float)INFINITY)
        CASE(34, TYN_E_LIGHT, s->light[0].kind = (tyn_light_kind)3)
        CASE(35, TYN_E_LIGHT, s->light[1].angle = 0)
        CASE(36, TYN_E_LIGHT, s->light[1].angle = 2.9671f)
        CASE(37, TYN_E_LIGHT, s->light[1].position[2] = (float)NAN)
        CASE(38, TYN_E_LIGHT, s->light[0].shadow.size = 0)
        CASE(39, TYN_E_LIMIT, s->light[0].shadow.size = 65)
        CASE(40, TYN_E_LIGHT, s->light[1].shadow.matrix[5] = matrix_nan)
        CASE(41, TYN_E_NULL, f->media = NULL)
        CASE(42, TYN_E_MEDIUM, s->medium[0].scatter[1] = -1)
        CASE(43, TYN_E_MEDIUM, s->medium[0].absorb[0] = (float)NAN)
        CASE(44, TYN_E_MEDIUM, s->medium[0].phase = (tyn_phase)3)
        CASE(45, TYN_E_MEDIUM, s->medium[0].g = 1)
        CASE(46, TYN_E_MEDIUM, s->medium[0].g = -1)
        CASE(47, TYN_E_MEDIUM, s->medium[0].g = (float)NAN)
        CASE(48, TYN_E_LIMIT, f->medium_count = TYN_MAX_MEDIA + 1)
        CASE(49, TYN_E_DISPLAY, f->display.exposure = -1)
        CASE(50, TYN_E_DISPLAY, f->display.exposure = (float)NAN)
        CASE(51, TYN_E_DISPLAY, f->display.tone = (tyn_tone)7)
        CASE(52, TYN_E_LIMIT, f->depth.width = f->colour.width = f->target.width = f->scatter.width = 65)
        CASE(53, TYN_E_LIMIT, f->depth.height = f->colour.height = f->target.height = f->scatter.height = 49)
        CASE(54, TYN_E_EXECUTOR, s->executor.run = NULL; f->executor = &s->executor)
        CASE(55, TYN_E_EXECUTOR, s->executor.workers = 0; f->executor = &s->executor)
        CASE(56, TYN_E_EXECUTOR, s->executor.workers = 2; f->executor = &s->executor)
        CASE(57, TYN_E_LIMIT, f->light_count = -1)
        CASE(58, TYN_E_LIMIT, f->medium_count = -1)
        CASE(59, TYN_E_IMAGE, f->depth.width = TYN_MAX_SIZE + 1)
        CASE(60, TYN_E_IMAGE, f->depth.format = (tyn_format)-1)
        CASE(61, TYN_E_DISPLAY, f->debug = (tyn_debug)99)
        CASE(62, TYN_E_NULL, s->light[0].more_count = 1)
        CASE(63, TYN_E_LIMIT, s->light[0].more = &s->light[1].shadow; s->light[0].more_count = -1)
        CASE(64, TYN_E_LIMIT, s->light[0].more = &s->light[1].shadow; s->light[0].more_count = 2)
        CASE(65, TYN_E_LIGHT, s->light[0].outside = (tyn_outside)3)
        CASE(66, TYN_E_LIGHT, s->light[1].kind = TYN_LIGHT_POINT; s->light[1].position[0] = (float)NAN)
#undef CASE
    default:
        return TYN_OK;
    }
}

static void test_statuses(void)
{
    rig *r = rig_stock("sun ahead", 64, 48, 64);
    guard target = guard_new(64, 48, TYN_RGBA8_SRGB, 0), scatter = guard_new(64, 48, TYN_RGB_F32, 0);
    tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
    tyn_context *context;
    tyn_stats stats, before;
    tyn_status want = TYN_E_NULL;
    TEST("tyn_render: every status, and nothing written with it");
    config.lights = 2;
    config.maps = 2;
    config.slices = 32;
    context = rig_context(&config);
    memset(&stats, 0x5a, sizeof stats);
    before = stats;
    CHECK(tyn_render(NULL, NULL) == TYN_E_NULL && tyn_render(context, NULL) == TYN_E_NULL);
    for (int n = 0; want != TYN_OK; n++) {
        spoiled s;
        tyn_status got;
        memset(&s, 0, sizeof s);
        s.frame = rig_frame(r);
        CHECK(tyn_render(NULL, &s.frame) == TYN_E_NULL);
        s.light[0] = r->light[0];
        s.light[1] = r->light[0];
        s.light[1].kind = TYN_LIGHT_SPOT;
        s.light[1].angle = 1;
        s.medium[0] = r->medium[0];
        s.executor.run = run_nothing;
        s.executor.workers = 1;
        s.frame.lights = s.light;
        s.frame.light_count = 2;
        s.frame.media = s.medium;
        s.frame.medium_count = 1;
        s.frame.target = target.image;
        s.frame.scatter = scatter.image;
        s.frame.stats = &stats;
        want = spoil(&s, n);
        got = context ? tyn_render(context, &s.frame) : TYN_E_MEMORY;
        if (got != want)
            printf("  case %d: %s, not %s\n", n, tyn_status_name(got), tyn_status_name(want));
        CHECK(got == want);
        if (want != TYN_OK) {
            CHECK(guard_untouched(&target) && guard_untouched(&scatter) && memcmp(&stats, &before, sizeof stats) == 0);
        } else {
            CHECK(n == 67 && guard_intact(&target) && !guard_untouched(&target) && guard_intact(&scatter));
        }
        guard_reset(&target);
        guard_reset(&scatter);
        stats = before;
    }
    free(context);
    guard_free(&target);
    guard_free(&scatter);
    rig_free(r);
}

/* ---- formats, sizes, strides ---------------------------------------------------------------------------------------- */

/* A picture of one pixel up to odd sizes, with padded and negative strides: what lies around stays as it is, and the pixels are
 * those of a picture without strides. */
static void test_sizes(void)
{
    static const int sizes[][2] = {{1, 1}, {2, 1}, {1, 9}, {3, 2}, {31, 17}, {33, 9}, {64, 1}, {1, 2}};
    TEST("tyn_render: any size and stride");
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        int w = sizes[i][0], h = sizes[i][1];
        size_t pixels = (size_t)w * (size_t)h;
        rig *r = rig_stock(i % 2 ? "lamp in view" : "sun ahead", w, h, 64);
        for (int way = 0; way < RIG_WAYS; way++)
            for (int upside_down = 0; upside_down < 2; upside_down++) {
                tyn_config config = rig_way_config(r, &rig_ways[way]);
                tyn_frame frame = rig_frame(r);
                guard target = guard_new(w, h, TYN_RGBA8_SRGB, upside_down),
                      scatter = guard_new(w, h, TYN_RGB_F32, !upside_down);
                guard depth = guard_new(w, h, TYN_DEPTH_F32, upside_down), colour = guard_new(w, h, TYN_RGB_F32, upside_down);
                CHECK(rig_render(r, &config, &frame) == TYN_OK);
                for (int y = 0; y < h; y++) {
                    memcpy((char *)depth.image.pixels + y * depth.image.stride, r->depth + y * w, 4 * (size_t)w);
                    memcpy((char *)colour.image.pixels + y * colour.image.stride, r->colour + 3 * y * w, 12 * (size_t)w);
                }
                frame.target = target.image;
                frame.scatter = scatter.image;
                frame.depth = depth.image;
                frame.colour = colour.image;
                CHECK(rig_render(r, &config, &frame) == TYN_OK);
                CHECK(guard_intact(&target) && guard_intact(&scatter) && guard_intact(&depth) && guard_intact(&colour));
                for (int y = 0; y < h; y++) {
                    CHECK(memcmp((char *)target.image.pixels + y * target.image.stride, r->target + 4 * y * w, 4 * (size_t)w) ==
                          0);
                    CHECK(memcmp((char *)scatter.image.pixels + y * scatter.image.stride, r->scatter + 3 * y * w,
                                 12 * (size_t)w) == 0);
                    CHECK(memcmp((char *)depth.image.pixels + y * depth.image.stride, r->depth + y * w, 4 * (size_t)w) == 0);
                }
                CHECK(r->stats.pixels == (int64_t)pixels);
                CHECK(r->stats.looked_per_ray >= 0 && r->stats.looked_per_ray <= (float)r->stats.looked); /* all may be walks */
                guard_free(&target);
                guard_free(&scatter);
                guard_free(&depth);
                guard_free(&colour);
            }
        rig_free(r);
    }
}

/* A block full of NaN and one of zeros give the same picture: lines that miss a lamp's cone, and points of a coarse picture
 * that lie beside the screen. */
static void test_blocks(void)
{
    static const char *const names[] = {"sun ahead", "sun off the bottom", "lamp in view", "lamp off the left", "bulb in view"};
    enum { W = 43, H = 30, PIXELS = W * H };
    static float light[3 * PIXELS];
    TEST("tyn_render: whatever the block held before");
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        rig *r = rig_stock(names[i], W, H, 32);
        r->light[0].angle *= 0.2f; /* a lamp's beam, narrower than what is between two lines */
        for (int way = 0; way < 3 * RIG_WAYS; way++) {
            tyn_config config = rig_way_config(r, &rig_ways[way % RIG_WAYS]);
            tyn_frame frame = rig_frame(r);
            int64_t rejected = 0;
            size_t bytes;
            uint8_t *block;
            config.slices = 12; /* far apart */
            if (way >= RIG_WAYS)
                config.downscale = way < 2 * RIG_WAYS ? 4 : 8;
            CHECK(tyn_measure(&config, &bytes) == TYN_OK);
            block = rig_block(bytes);
            for (int value = 0; block && value < 256; value += 255) {
                tyn_context *context;
                memset(block, value, bytes);
                CHECK(tyn_init(&context, &config, block, bytes) == TYN_OK && tyn_render(context, &frame) == TYN_OK);
                if (value)
                    CHECK(memcmp(light, r->scatter, sizeof light) == 0 && rejected == r->stats.rejected);
                memcpy(light, r->scatter, sizeof light);
                rejected = r->stats.rejected;
            }
            free(block);
        }
        rig_free(r);
    }
}

/* A float target encoded by tyn_encode is what tyn_render writes into that format itself. */
static void test_formats(void)
{
    static const tyn_format formats[] = {TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    enum { W = 37, H = 21 };
    static float linear[3 * W * H];
    rig *r = rig_stock("sun off the left", W, H, 128);
    TEST("tyn_render: every target format");
    for (int way = 0; way < RIG_WAYS; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        frame.target.pixels = linear;
        frame.target.format = TYN_RGB_F32;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        for (int f = 0; f < 4; f++)
            for (int variant = 0; variant < 4; variant++) {
                guard target = guard_new(W, H, formats[f], variant & 1), encoded = guard_new(W, H, formats[f], variant & 1);
                tyn_image from = {linear, W, H, 0, TYN_RGB_F32};
                frame = rig_frame(r);
                frame.target = target.image;
                frame.scatter.pixels = NULL;
                frame.display.exposure = variant & 2 ? 1.25f : 1;
                frame.display.tone = variant & 2 ? TYN_TONE_FILM : TYN_TONE_CLAMP;
                frame.display.dither = variant & 1;
                CHECK(rig_render(r, &config, &frame) == TYN_OK);
                CHECK(tyn_encode(&from, &frame.display, &encoded.image) == TYN_OK);
                CHECK(memcmp(target.block, encoded.block, target.size) == 0);
                guard_free(&target);
                guard_free(&encoded);
            }
    }
    rig_free(r);
}

/* Colour read from and written to the same pixels gives what separate ones give, in each format that can. */
static void test_in_place(void)
{
    static const tyn_format formats[] = {TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    enum { W = 35, H = 18 };
    rig *r = rig_stock("lamp off the left", W, H, 128);
    TEST("tyn_render: in place");
    for (int f = 0; f < 4; f++)
        for (int way = 0; way < RIG_WAYS; way++) {
            tyn_config config = rig_way_config(r, &rig_ways[way]);
            tyn_frame frame = rig_frame(r);
            guard colour = guard_new(W, H, formats[f], way & 1), target = guard_new(W, H, formats[f], way & 1);
            tyn_image from = {r->colour, W, H, 0, TYN_RGB_F32};
            tyn_display plain = {1, TYN_TONE_CLAMP, 0};
            CHECK(tyn_encode(&from, &plain, &colour.image) == TYN_OK);
            frame.colour = colour.image;
            frame.target = target.image;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            frame.target = colour.image;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            CHECK(memcmp(target.block, colour.block, target.size) == 0);
            guard_free(&colour);
            guard_free(&target);
        }
    rig_free(r);
}

/* ---- what may be left out ------------------------------------------------------------------------------------------- */

static void test_optional(void)
{
    enum { W = 32, H = 24 };
    rig *r = rig_stock("sun ahead", W, H, 128);
    tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
    tyn_frame frame = rig_frame(r);
    float *whole = calloc(W * H, 3 * sizeof *whole), *black = calloc(W * H, 3 * sizeof *black);
    TEST("tyn_render: without colour, target, scatter, lights, media, shadow map");
    if (!whole || !black)
        abort();
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(whole, r->scatter, W * H * 3 * sizeof *whole);
    frame.target.pixels = NULL;
    memset(r->scatter, 0, W * H * 3 * sizeof *whole);
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK(memcmp(whole, r->scatter, W * H * 3 * sizeof *whole) == 0);
    frame = rig_frame(r); /* black surfaces: the picture is the scattered light alone */
    frame.colour.pixels = NULL;
    frame.target.pixels = black;
    frame.target.format = TYN_RGB_F32;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK(memcmp(black, whole, W * H * 3 * sizeof *whole) == 0);
    frame.scatter.pixels = NULL;
    frame.stats = NULL;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    frame.target.pixels = NULL; /* nothing wanted at all */
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    for (int n = 0; n < 3; n++) { /* nothing that scatters */
        frame = rig_frame(r);
        if (n == 0)
            frame.lights = NULL, frame.light_count = 0;
        else if (n == 1)
            frame.media = NULL, frame.medium_count = 0;
        else
            memset(r->light[0].colour, 0, sizeof r->light[0].colour);
        memset(r->scatter, 0x5a, W * H * 3 * sizeof *whole);
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        for (int i = 0; i < 3 * W * H; i++)
            CHECK(r->scatter[i] == 0.0f);
    }
    free(whole);
    free(black);
    rig_free(r);
}

/* No shadow map: the light of the closed form, pixel by pixel. */
static void test_unshadowed(void)
{
    enum { W = 24, H = 18 };
    oracle_scene *scene = stock_new("sun ahead", W, H);
    rig *r = rig_new(scene, 64);
    TEST("tyn_render: without a shadow map the closed form");
    scene->polygons = 0; /* the depth below stays the rig's */
    CHECK(r && oracle_prepare(scene));
    for (int way = 0; r && way < RIG_WAYS; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        double gap = 0, sum = 0;
        r->light[0].shadow.depth = NULL;
        r->light[0].shadow.size = 0;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        for (int i = 0; i < W * H; i++) {
            double v[3], out[3], cosine = 0;
            oracle_ray(scene, i % W + 0.5, i / W + 0.5, v);
            for (int k = 0; k < 3; k++)
                cosine += v[k] * scene->camera.forward[k];
            oracle_scatter(scene, v, (double)r->depth[i] / cosine, out);
            for (int k = 0; k < 3; k++) {
                gap += fabs(out[k] - (double)r->scatter[3 * i + k]);
                sum += out[k];
            }
        }
        if (rig_ways[way].method == TYN_METHOD_NONE)
            CHECK(gap == sum);
        else
            CHECK_NEAR(gap / sum, 0, rig_ways[way].method == TYN_METHOD_MARCH ? 2e-5 : 3e-3);
    }
    rig_free(r);
    model_free(scene);
}

/* Depth that is no depth: infinity and NaN are far, negative is 0. */
static void test_odd_depth(void)
{
    enum { W = 16, H = 12 };
    const float far_depth = 40;
    rig *r = rig_stock("sun ahead", W, H, 64);
    static float odd[W * H], same[W * H], tiny[W * H], first[3 * W * H];
    TEST("tyn_render: depths that are none");
    for (int i = 0; i < W * H; i++)
        switch (test_random() % 6) {
        case 0:
            odd[i] = (float)NAN, same[i] = far_depth;
            break;
        case 1:
            odd[i] = (float)INFINITY, same[i] = far_depth;
            break;
        case 2:
            odd[i] = 1e30f, same[i] = far_depth;
            break;
        case 3:
            odd[i] = test_random() & 1 ? -1.0f : -(float)INFINITY, same[i] = 0;
            break;
        default:
            odd[i] = same[i] = test_random_float(0, 40);
        }
    for (int way = 0; way < RIG_WAYS; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        frame.depth.pixels = same;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        memcpy(first, r->scatter, sizeof first);
        frame.depth.pixels = odd;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(memcmp(first, r->scatter, sizeof first) == 0);
        for (int i = 0; i < 3 * W * H; i++)
            CHECK(first[i] >= 0.0f && first[i] < 1e6f);
        /* nor too little to divide by */
        for (int i = 0; i < W * H; i++)
            tiny[i] = 1e-40f;
        frame.depth.pixels = tiny;
        config.paper = TYN_PAPER_EPIPOLE;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        for (int i = 0; i < 3 * W * H; i++)
            CHECK(r->scatter[i] >= 0.0f && r->scatter[i] < 1e-30f);
    }
    rig_free(r);
}

/* A matrix that is finite but of no use is refused, or does no harm. */
static void test_odd_matrix(void)
{
    enum { W = 16, H = 12 };
    rig *r = rig_stock("sun ahead", W, H, 64);
    TEST("tyn_render: a shadow matrix that cannot be inverted");
    for (int n = 0; n < 12; n++)
        for (int way = 0; way < RIG_WAYS; way++) {
            tyn_config config = rig_way_config(r, &rig_ways[way]);
            tyn_frame frame = rig_frame(r);
            tyn_light light = r->light[0];
            float *m = light.shadow.matrix;
            tyn_status status;
            if (n < 4)
                memset(m + 4 * n, 0, 4 * sizeof *m);
            else if (n == 4)
                memset(m, 0, sizeof light.shadow.matrix);
            else if (n == 5)
                memcpy(m, m + 4, 4 * sizeof *m);
            else
                for (int i = 0; i < 16; i++)
                    m[i] = n < 9 ? test_random_float(-1, 1) : test_random_float(-1, 1) * (n == 9 ? 1e30f : 1e-30f);
            frame.lights = &light;
            status = rig_render(r, &config, &frame);
            CHECK(status == TYN_OK || status == TYN_E_LIGHT);
            for (int i = 0; status == TYN_OK && i < 3 * W * H; i++)
                CHECK(r->scatter[i] >= 0.0f && r->scatter[i] < 1e6f);
        }
    rig_free(r);
}

/* ---- statistics, maps ---------------------------------------------------------------------------------------------- */

/* The counts are what they say. */
static void test_stats(void)
{
    enum { W = 48, H = 36 };
    rig *r = rig_stock("sun ahead", W, H, 128);
    TEST("tyn_render: the statistics");
    for (int way = 0; way < RIG_WAYS; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        const tyn_stats *s = &r->stats;
        size_t bytes;
        CHECK(tyn_measure(&config, &bytes) == TYN_OK);
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(s->pixels == W * H && s->memory == bytes);
        CHECK_NEAR(s->rays_percent, 100.0 * (double)(s->rays + s->rejected + s->corrected) / (W * H), 1e-4);
        CHECK(s->rejected >= 0 && s->rejected <= W * H && s->walks >= 0 && s->walks <= s->rays && s->breaks <= s->samples);
        CHECK((config.downscale == 1) == (s->corrected == 0) && s->corrected >= 0 && s->corrected < W * H / 4);
        if (config.method >= TYN_METHOD_PREFILTERED) {
            CHECK(s->slices > 8 && s->slices <= 2 * (W + H) && s->columns > 0 && s->breaks > 0);
        } else if (config.method == TYN_METHOD_EPIPOLAR) {
            CHECK(s->slices > 8 && s->slices <= 2 * (W + H) && s->samples >= s->rays && s->breaks > 0);
            CHECK(s->initial > s->slices && s->initial <= s->rays && s->culled >= 0);
            CHECK((s->columns > 0) == (config.rays != TYN_RAYS_STEPS) && (s->looked > 0) == (s->columns > 0));
            if (s->columns > 0)
                CHECK_NEAR(s->looked_per_ray, (double)s->looked / (double)(s->rays - s->walks), 1e-4);
        } else {
            CHECK(s->slices == 0 && s->breaks == 0 && s->initial == 0 && s->columns == 0 && s->looked == 0);
        }
        if (config.method == TYN_METHOD_MARCH)
            CHECK(s->rays == W * H && s->rejected == 0);
        if (config.method == TYN_METHOD_NONE)
            CHECK(s->rays == 0 && s->samples == 0 && s->rejected == 0);
    }
    rig_free(r);
}

/* A map given as two, the right half of the picture's world in one and all in the other, is as the one: cascades change nothing
 * but the texels. And what lies outside of all maps is lit or dark as asked. */
static void test_maps(void)
{
    enum { W = 48, H = 36, COUNT = 3 * W * H };
    rig *r = rig_stock("sun off the left", W, H, 256);
    static float one[COUNT], none[COUNT];
    TEST("tyn_render: cascades, and what is outside of the maps");
    for (int way = 0; way < RIG_WAYS - 1; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        tyn_light light = r->light[0];
        tyn_shadow coarse = light.shadow;
        double lit = 0, dark = 0;
        config.steps = 400;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        memcpy(one, r->scatter, sizeof one);
        config.maps = 2;
        frame.lights = &light;
        light.more = &coarse;
        light.more_count = 1;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK_NEAR(rig_l1(r->scatter, one, COUNT), 0, 1e-6);
        /* the first map pushed aside: nothing is covered by it, the second has all */
        light.shadow.matrix[3] += 50 * light.shadow.matrix[15];
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK_NEAR(rig_l1(r->scatter, one, COUNT), 0, 1e-6);
        /* alone, it leaves all to `outside` */
        light.more_count = 0;
        light.outside = TYN_OUTSIDE_DARK;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        for (int i = 0; i < COUNT; i++)
            dark += (double)r->scatter[i];
        CHECK(dark == 0);
        light.outside = TYN_OUTSIDE_LIT;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        memcpy(none, r->scatter, sizeof none);
        light.outside = TYN_OUTSIDE_DEFAULT;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(memcmp(none, r->scatter, sizeof none) == 0);
        light.shadow.depth = NULL;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK_NEAR(rig_l1(none, r->scatter, COUNT), 0, 1e-3);
        for (int i = 0; i < COUNT; i++)
            lit += (double)(r->scatter[i] - one[i]);
        CHECK(lit > 0);
    }
    rig_free(r);
}

void test_render(void)
{
    test_statuses();
    test_sizes();
    test_blocks();
    test_formats();
    test_in_place();
    test_optional();
    test_unshadowed();
    test_odd_depth();
    test_odd_matrix();
    test_stats();
    test_maps();
}
