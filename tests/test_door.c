/* test_door.c - frames and shadow maps as others store them: every format and coding gives one picture. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "rig.h"
#include "stock.h"
#include "test.h"

enum { W = 40, H = 30, PIXELS = W * H };

static const tyn_format depth_formats[3] = {TYN_DEPTH_F32, TYN_DEPTH_U16, TYN_DEPTH_U24};

/* ---- scene depth, written and read again in double precision ---------------------------------------------------------- */

static void planes(const tyn_depth_coding *coding, const tyn_camera *camera, double plane[2])
{
    plane[0] = (double)(coding->near_depth > 0 ? coding->near_depth : camera->near_depth);
    plane[1] = (double)(coding->far_depth > 0 ? coding->far_depth : camera->far_depth);
}

static double length_of(const tyn_camera *c, int i)
{
    double x = (double)c->left_edge + (double)(c->right_edge - c->left_edge) * (i % W + 0.5) / W;
    double y = (double)c->top_edge + (double)(c->bottom_edge - c->top_edge) * (i / W + 0.5) / H;
    return c->kind == TYN_CAMERA_ORTHOGRAPHIC ? 1 : sqrt(1 + x * x + y * y);
}

/* What is stored for a depth: not yet rounded; of integers in their own steps. */
static double encode(const tyn_depth_coding *coding, tyn_format format, const tyn_camera *camera, int i, double depth)
{
    double plane[2], n, a = (double)coding->at_near, b = (double)coding->at_far;
    double scale = coding->scale > 0 ? (double)coding->scale : 1;
    if (coding->kind == TYN_CODING_VIEW)
        return depth / scale;
    if (coding->kind == TYN_CODING_DISTANCE)
        return depth * length_of(camera, i) / scale;
    planes(coding, camera, plane);
    b = a == 0 && b == 0 ? 1 : b;
    if (camera->kind == TYN_CAMERA_ORTHOGRAPHIC)
        n = (depth - plane[0]) / (plane[1] - plane[0]);
    else
        n = (1 / depth - 1 / plane[0]) / (1 / plane[1] - 1 / plane[0]);
    return (a + n * (b - a)) * (rig_levels(format) > 0 ? rig_levels(format) : 1);
}

static double decode(const tyn_depth_coding *coding, tyn_format format, const tyn_camera *camera, int i, double value)
{
    double plane[2], n, a = (double)coding->at_near, b = (double)coding->at_far;
    double scale = coding->scale > 0 ? (double)coding->scale : 1;
    if (coding->kind == TYN_CODING_VIEW)
        return value * scale;
    if (coding->kind == TYN_CODING_DISTANCE)
        return value * scale / length_of(camera, i);
    planes(coding, camera, plane);
    b = a == 0 && b == 0 ? 1 : b;
    n = (value / (rig_levels(format) > 0 ? rig_levels(format) : 1) - a) / (b - a);
    if (camera->kind == TYN_CAMERA_ORTHOGRAPHIC)
        return plane[0] + n * (plane[1] - plane[0]);
    return 1 / (1 / plane[0] + n * (1 / plane[1] - 1 / plane[0]));
}

/* Stores a value in pixel i; returns what it became. */
static double put(const tyn_image *image, int i, double value)
{
    char *row = (char *)image->pixels + image->stride * (i / W);
    double levels = rig_levels(image->format);
    uint32_t bits;
    if (levels <= 0)
        return (double)(((float *)(void *)row)[i % W] = (float)value);
    bits = (uint32_t)(value < 0 ? 0 : value > levels ? levels : value + 0.5);
    if (image->format == TYN_DEPTH_U16)
        ((uint16_t *)(void *)row)[i % W] = (uint16_t)bits;
    else
        ((uint32_t *)(void *)row)[i % W] = bits | (test_random() & 0xff000000u);
    return (double)bits;
}

/* What the matrix goes through: the same scale for all formats would be no use, so each has its own. */
static const struct {
    tyn_depth_coding coding;
    float scale[3];
    double tolerance[3]; /* to the picture from float metres */
} matrix[] = {
    {{TYN_CODING_VIEW, 0, 0, 0, 0, 0, 0, 0}, {0, 0.001f, 4e-6f}, {0, 1e-3, 1e-4}},
    {{TYN_CODING_VIEW, 0, 0, 0, 0, 0, 0, 0}, {2, 0.01f, 1e-5f}, {1e-6, 3e-3, 1e-4}},
    {{TYN_CODING_PROJECTED, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 0}, {1e-4, 5e-3, 1e-4}},
    {{TYN_CODING_PROJECTED, 0, 1, 0, 0, 0, 0, 0}, {0, 0, 0}, {1e-4, 5e-3, 1e-4}},
    {{TYN_CODING_PROJECTED, 0, -1, 1, 0, 0, 0, 0}, {0, 0, 0}, {1e-4, 1e9, 1e9}},
    {{TYN_CODING_PROJECTED, 0, 1, 0, 0.02f, 300, 0, 0}, {0, 0, 0}, {1e-4, 3e-2, 1e-3}},
    {{TYN_CODING_PROJECTED, 0, 0, 1, 0.5f, HUGE_VALF, 0, 0}, {0, 0, 0}, {1e-4, 5e-3, 1e-4}},
    {{TYN_CODING_PROJECTED, 0, 1, 0, 0.5f, HUGE_VALF, 0, 0}, {0, 0, 0}, {1e-4, 5e-3, 1e-4}},
    {{TYN_CODING_DISTANCE, 0, 0, 0, 0, 0, 0, 0}, {0, 0.001f, 4e-6f}, {1e-4, 1e-3, 1e-4}},
};
enum { CODINGS = (int)(sizeof matrix / sizeof *matrix) };

/* One cell: the picture from the coded depth is that from the same depth in metres, to rounding, and near the original. */
static void check_coding(rig *r, int n, int f, int upside_down, const tyn_image *colour, const rig_way *way)
{
    static float metres[PIXELS], plain[3 * PIXELS], original[3 * PIXELS];
    tyn_config config = rig_way_config(r, way);
    tyn_frame frame = rig_frame(r);
    guard depth = guard_new(W, H, depth_formats[f], upside_down);
    tyn_depth_coding coding = matrix[n].coding;
    coding.scale = matrix[n].scale[f];
    /* an integer has no values below 0: only floats hold all of -1 .. 1 */
    if (f > 0 && coding.at_near < 0)
        coding.at_near = 0;
    for (int i = 0; i < PIXELS; i++) {
        double value = put(&depth.image, i, encode(&coding, depth.image.format, &r->camera, i, (double)r->depth[i]));
        metres[i] = (float)decode(&coding, depth.image.format, &r->camera, i, value);
    }
    frame.colour = *colour;
    config.steps = 40;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(original, r->scatter, sizeof original);
    frame.depth.pixels = metres;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(plain, r->scatter, sizeof plain);
    frame.depth = depth.image;
    frame.depth_coding = coding;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK_NEAR(rig_l1(r->scatter, plain, 3 * PIXELS), 0, 2e-4);
    CHECK_NEAR(rig_l1(r->scatter, original, 3 * PIXELS), 0, matrix[n].tolerance[f]);
    guard_free(&depth);
}

static void test_depths(void)
{
    static const tyn_format colours[] = {TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    rig *r = rig_stock("sun off the left", W, H, 128);
    tyn_image from = {r->colour, W, H, 0, TYN_RGB_F32};
    tyn_display display = {1, TYN_TONE_CLAMP, 0};
    TEST("every format and coding of the scene's depth, with every format of colour");
    for (int n = 0; n < CODINGS; n++)
        for (int f = 0; f < 3; f++)
            for (int c = 0; c < 4; c++) {
                guard colour = guard_new(W, H, colours[c], c & 1);
                CHECK(tyn_encode(&from, &display, &colour.image) == TYN_OK);
                check_coding(r, n, f, c & 1, &colour.image, &rig_ways[0]);
                guard_free(&colour);
            }
    for (int n = 0; n < CODINGS; n++)
        for (int way = 1; way < RIG_WAYS - 1; way++)
            check_coding(r, n, n % 3, n & 1, &from, &rig_ways[way]);
    /* the same numbers as an orthographic camera's: another scene, as good as any */
    r->camera.kind = TYN_CAMERA_ORTHOGRAPHIC;
    for (int n = 0; n < CODINGS; n++)
        for (int f = 0; f < 3 && matrix[n].coding.far_depth != HUGE_VALF; f++)
            check_coding(r, n, f, f & 1, &from, &rig_ways[0]);
    rig_free(r);
}

/* ---- depth that is none ------------------------------------------------------------------------------------------------ */

/* A value, and the depth that it stands for: byte by byte the same picture, in which nothing but its own pixels differs from
 * one with sky there. */
static void check_odd(rig *r, const tyn_depth_coding *coding, tyn_format format, double odd, int sky, const rig_way *way)
{
    static float first[3 * PIXELS], metres[PIXELS];
    guard depth = guard_new(W, H, format, 0);
    tyn_config config = rig_way_config(r, way);
    tyn_frame frame = rig_frame(r);
    test_seed(7);
    for (int i = 0; i < PIXELS; i++) {
        int hit = test_random() % 11 == 0;
        double value = put(&depth.image, i, encode(coding, format, &r->camera, i, (double)r->depth[i]));
        metres[i] = hit ? (sky ? r->camera.far_depth : 0) : (float)decode(coding, format, &r->camera, i, value);
        if (hit)
            put(&depth.image, i, odd);
    }
    frame.depth.pixels = metres;
    config.steps = 40;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(first, r->scatter, sizeof first);
    frame.depth = depth.image;
    frame.depth_coding = *coding;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    /* the decoded neighbours differ by rounding from those decoded here */
    for (int i = 0; i < 3 * PIXELS; i++)
        CHECK(r->scatter[i] >= 0 && r->scatter[i] < 1e6f);
    CHECK_NEAR(rig_l1(r->scatter, first, 3 * PIXELS), 0, 1e-4);
    guard_free(&depth);
}

static void test_odd(void)
{
    rig *r = rig_stock("sun ahead", W, H, 64);
    tyn_depth_coding coding;
    TEST("depth that is none: NaN, infinity, 0, negative, marked");
    for (int way = 0; way < RIG_WAYS - 1; way += 2) {
        for (int n = 0; n < CODINGS; n++) {
            int projected = matrix[n].coding.kind == TYN_CODING_PROJECTED;
            coding = matrix[n].coding;
            coding.scale = matrix[n].scale[0];
            check_odd(r, &coding, TYN_DEPTH_F32, (double)NAN, 1, &rig_ways[way]);
            check_odd(r, &coding, TYN_DEPTH_F32, HUGE_VAL, 1, &rig_ways[way]);
            check_odd(r, &coding, TYN_DEPTH_F32, -HUGE_VAL, projected, &rig_ways[way]);
            if (!projected) {
                check_odd(r, &coding, TYN_DEPTH_F32, 0, 0, &rig_ways[way]);
                check_odd(r, &coding, TYN_DEPTH_F32, -3, 0, &rig_ways[way]);
                check_odd(r, &coding, TYN_DEPTH_F32, 1e30, 1, &rig_ways[way]);
            }
            coding.has_sky = 1;
            coding.sky = -7;
            check_odd(r, &coding, TYN_DEPTH_F32, -7, 1, &rig_ways[way]);
        }
        for (int f = 1; f < 3; f++) { /* depth cameras: 0 is "unknown", or all ones is */
            memset(&coding, 0, sizeof coding);
            coding.scale = matrix[0].scale[f];
            check_odd(r, &coding, depth_formats[f], 0, 0, &rig_ways[way]);
            coding.has_sky = 1;
            check_odd(r, &coding, depth_formats[f], 0, 1, &rig_ways[way]);
            coding.sky = (float)rig_levels(depth_formats[f]);
            check_odd(r, &coding, depth_formats[f], rig_levels(depth_formats[f]), 1, &rig_ways[way]);
        }
        /* at and beyond the planes */
        memset(&coding, 0, sizeof coding);
        coding.kind = TYN_CODING_PROJECTED;
        check_odd(r, &coding, TYN_DEPTH_U16, 65535, 1, &rig_ways[way]);
        check_odd(r, &coding, TYN_DEPTH_U24, 16777215, 1, &rig_ways[way]);
        check_odd(r, &coding, TYN_DEPTH_F32, 1, 1, &rig_ways[way]);
        check_odd(r, &coding, TYN_DEPTH_F32, 7, 1, &rig_ways[way]);
        check_odd(r, &coding, TYN_DEPTH_F32, -3e38, 0, &rig_ways[way]);
        coding.at_near = 1;
        coding.far_depth = HUGE_VALF;
        check_odd(r, &coding, TYN_DEPTH_F32, 0, 1, &rig_ways[way]);
        check_odd(r, &coding, TYN_DEPTH_U24, 0, 1, &rig_ways[way]);
    }
    rig_free(r);
}

/* With a ray for each pixel, a pixel is nobody's neighbour. */
static void test_alone(void)
{
    rig *r = rig_stock("sun ahead", W, H, 64);
    static float first[3 * PIXELS], odd[PIXELS];
    static const float values[] = {(float)NAN, HUGE_VALF, -HUGE_VALF, 0, -1};
    tyn_config config = rig_config(r, TYN_METHOD_MARCH, TYN_RAYS_WORDS);
    tyn_frame frame = rig_frame(r);
    TEST("depth that is none, in its own pixel only");
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(first, r->scatter, sizeof first);
    for (int i = 0; i < PIXELS; i++)
        odd[i] = i % 3 == 0 ? values[i / 3 % 5] : r->depth[i];
    frame.depth.pixels = odd;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    for (int i = 0; i < PIXELS; i++)
        CHECK(i % 3 == 0 || memcmp(r->scatter + 3 * i, first + 3 * i, 3 * sizeof *first) == 0);
    rig_free(r);
}

static void test_transmittance(void)
{
    static float whole[3 * PIXELS], share[3 * PIXELS];
    rig *r = rig_stock("sun off the left", W, H, 128);
    TEST("scatter and transmittance alone give the picture");
    for (int way = 0; way < RIG_WAYS; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        guard out = guard_new(W, H, TYN_RGB_F32, way & 1);
        frame.target.pixels = whole;
        frame.target.format = TYN_RGB_F32;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        frame.colour.pixels = NULL;
        frame.target.pixels = NULL;
        frame.transmittance = out.image;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        CHECK(guard_intact(&out));
        for (int y = 0; y < H; y++)
            memcpy(share + 3 * W * y, (char *)out.image.pixels + out.image.stride * y, 3 * W * sizeof *share);
        for (int i = 0; i < 3 * PIXELS; i++) {
            CHECK(share[i] > 0 && share[i] <= 1);
            CHECK_NEAR(share[i] * r->colour[i] + r->scatter[i], whole[i], 1e-6 + 1e-6 * (double)whole[i]);
        }
        guard_free(&out);
    }
    rig_free(r);
}

/* ---- statuses ------------------------------------------------------------------------------------------------------------ */

static tyn_status spoil(tyn_frame *f, tyn_shadow *m, int n)
{
    tyn_depth_coding *c = &f->depth_coding;
    switch (n) {
#define CASE(n, status, change)                                                                                                \
    case n:                                                                                                                    \
        change;                                                                                                                \
        return status;
        CASE(0, TYN_E_IMAGE, c->kind = (tyn_depth_kind)3)
        CASE(1, TYN_E_IMAGE, c->kind = (tyn_depth_kind)-1)
        CASE(2, TYN_E_IMAGE, c->scale = -1)
        CASE(3, TYN_E_IMAGE, c->scale = (float)NAN)
        CASE(4, TYN_E_IMAGE, c->scale = HUGE_VALF)
        CASE(5, TYN_E_IMAGE, c->kind = TYN_CODING_PROJECTED; c->at_near = c->at_far = 1)
        CASE(6, TYN_E_IMAGE, c->kind = TYN_CODING_PROJECTED; c->at_near = (float)NAN)
        CASE(7, TYN_E_IMAGE, c->kind = TYN_CODING_PROJECTED; c->at_far = HUGE_VALF)
        CASE(8, TYN_E_IMAGE, c->kind = TYN_CODING_PROJECTED; c->near_depth = -1)
        CASE(9, TYN_E_IMAGE, c->kind = TYN_CODING_PROJECTED; c->near_depth = (float)NAN)
        CASE(10, TYN_E_IMAGE, c->kind = TYN_CODING_PROJECTED; c->near_depth = c->far_depth = 3)
        CASE(11, TYN_E_IMAGE, c->kind = TYN_CODING_PROJECTED; c->far_depth = f->camera.near_depth)
        CASE(12, TYN_E_IMAGE, c->kind = TYN_CODING_PROJECTED; c->near_depth = f->camera.far_depth)
        CASE(13, TYN_E_IMAGE, f->depth.format = TYN_RGB16_LINEAR)
        CASE(14, TYN_E_IMAGE, f->depth.format = (tyn_format)11)
        CASE(15, TYN_E_ALIGN, f->depth.format = TYN_DEPTH_U16; f->depth.pixels = (char *)f->depth.pixels + 1)
        CASE(16, TYN_E_ALIGN, f->depth.format = TYN_DEPTH_U24; f->depth.pixels = (char *)f->depth.pixels + 2)
        CASE(17, TYN_E_ALIGN, f->depth.format = TYN_DEPTH_U16; f->depth.stride = 2 * W + 1)
        CASE(18, TYN_E_IMAGE, f->depth.format = TYN_DEPTH_U16; f->depth.stride = 2 * W - 2)
        CASE(19, TYN_E_IMAGE, f->depth.format = TYN_DEPTH_U24; f->depth.stride = 4 - 4 * W)
        CASE(20, TYN_E_IMAGE, f->transmittance.format = TYN_RGBA8_SRGB)
        CASE(21, TYN_E_IMAGE, f->transmittance.width++)
        CASE(22, TYN_E_ALIGN, f->transmittance.pixels = (char *)f->transmittance.pixels + 1)
        CASE(23, TYN_E_IMAGE, f->target.format = TYN_DEPTH_U16)
        CASE(24, TYN_E_IMAGE, f->colour.format = TYN_DEPTH_U24)
        CASE(25, TYN_E_LIGHT, m->format = TYN_DEPTH_U24)
        CASE(26, TYN_E_LIGHT, m->format = (tyn_format)-1)
        CASE(27, TYN_E_LIGHT, m->coding = (tyn_map_coding)3)
        CASE(28, TYN_E_LIGHT, m->height = -1)
        CASE(29, TYN_E_LIGHT, m->height = TYN_MAX_SHADOW + 1)
        CASE(30, TYN_E_LIMIT, m->height = 65)
        CASE(31, TYN_E_LIGHT, m->stride = 4 * 64 - 4)
        CASE(32, TYN_E_LIGHT, m->stride = 4 - 4 * 64)
        CASE(33, TYN_E_LIGHT, m->stride = 4 * 64 + 2)
        CASE(34, TYN_E_LIGHT, m->depth = (const char *)m->depth + 2)
        CASE(35, TYN_E_LIGHT, m->format = TYN_DEPTH_U16; m->depth = (const char *)m->depth + 1)
        CASE(36, TYN_E_LIGHT, m->format = TYN_DEPTH_U16; m->stride = 2 * 64 + 1)
        CASE(37, TYN_E_LIGHT, m->coding = TYN_MAP_PROJECTED; m->at_near = m->at_far = 2)
        CASE(38, TYN_E_LIGHT, m->coding = TYN_MAP_PROJECTED; m->at_near = (float)NAN)
        CASE(39, TYN_E_LIGHT, m->coding = TYN_MAP_PROJECTED; m->at_far = HUGE_VALF)
        CASE(40, TYN_E_LIGHT, m->coding = TYN_MAP_LINEAR; m->scale = -1)
        CASE(41, TYN_E_LIGHT, m->coding = TYN_MAP_LINEAR; m->scale = (float)NAN)
        CASE(42, TYN_E_LIGHT, m->coding = TYN_MAP_LINEAR; m->at_far = (float)NAN)
        CASE(43, TYN_E_LIGHT, m->bias = -0.1f)
        CASE(44, TYN_E_LIGHT, m->bias = (float)NAN)
        CASE(45, TYN_E_LIGHT, m->bias = 65)
        CASE(46, TYN_E_IMAGE, f->camera.kind = TYN_CAMERA_ORTHOGRAPHIC; f->depth_coding.kind = TYN_CODING_PROJECTED;
             f->depth_coding.far_depth = HUGE_VALF)
        CASE(47, TYN_E_IMAGE, f->depth.stride = PTRDIFF_MIN)
        CASE(48, TYN_E_IMAGE, f->depth.stride = PTRDIFF_MAX / 4 * 4)
        CASE(49, TYN_E_LIGHT, m->stride = PTRDIFF_MIN)
#undef CASE
    default:
        return TYN_OK;
    }
}

static void test_statuses(void)
{
    rig *r = rig_stock("sun ahead", W, H, 64);
    tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
    tyn_status expected;
    int n = 0;
    TEST("each status, and nothing written");
    do {
        tyn_frame frame = rig_frame(r);
        guard target = guard_new(W, H, TYN_RGBA8_SRGB, 0), share = guard_new(W, H, TYN_RGB_F32, 0);
        guard scatter = guard_new(W, H, TYN_RGB_F32, 0);
        tyn_light light = r->light[0];
        frame.target = target.image;
        frame.scatter = scatter.image;
        frame.transmittance = share.image;
        frame.lights = &light;
        expected = spoil(&frame, &light.shadow, n++);
        CHECK(rig_render(r, &config, &frame) == expected);
        CHECK((expected == TYN_OK) ^ (guard_untouched(&target) && guard_untouched(&share) && guard_untouched(&scatter)));
        guard_free(&target);
        guard_free(&share);
        guard_free(&scatter);
    } while (expected != TYN_OK);
    CHECK(n == 51);
    rig_free(r);
}

void test_door(void)
{
    test_depths();
    test_odd();
    test_alone();
    test_transmittance();
    test_statuses();
}
