/* test_encode.c - bytes of the formats: tyn_encode, dither, sRGB both ways. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "composite.h"
#include "guard.h"
#include "rig.h"
#include "test.h"

#define BIG_NAN ((float)NAN)

static void test_refused(void)
{
    float linear[3 * 12] = {0};
    guard target = guard_new(4, 3, TYN_RGBA8_SRGB, 0);
    tyn_image from = {linear, 4, 3, 0, TYN_RGB_F32}, image, to;
    tyn_display display = {1, TYN_TONE_CLAMP, 0}, odd;
    TEST("tyn_encode refuses");
#define REFUSED(status, a, b, c) CHECK(tyn_encode(a, b, c) == (status) && guard_untouched(&target))
    to = target.image;
    REFUSED(TYN_E_NULL, NULL, &display, &to);
    REFUSED(TYN_E_NULL, &from, NULL, &to);
    REFUSED(TYN_E_NULL, &from, &display, NULL);
    image = from, image.pixels = NULL;
    REFUSED(TYN_E_NULL, &image, &display, &to);
    image = from, image.width = 3;
    REFUSED(TYN_E_IMAGE, &image, &display, &to);
    image = from, image.height = 0;
    REFUSED(TYN_E_IMAGE, &image, &display, &to);
    image = from, image.format = TYN_DEPTH_F32;
    REFUSED(TYN_E_IMAGE, &image, &display, &to);
    image = from, image.stride = 44;
    REFUSED(TYN_E_IMAGE, &image, &display, &to);
    image = from, image.stride = 49;
    REFUSED(TYN_E_ALIGN, &image, &display, &to);
    image = from, image.pixels = (char *)linear + 2;
    REFUSED(TYN_E_ALIGN, &image, &display, &to);
    image = to, image.format = TYN_DEPTH_F32;
    REFUSED(TYN_E_IMAGE, &from, &display, &image);
    image = to, image.format = TYN_RGB8_LINEAR;
    REFUSED(TYN_E_IMAGE, &from, &display, &image);
    image = to, image.format = (tyn_format)99;
    REFUSED(TYN_E_IMAGE, &from, &display, &image);
    image = to, image.width = TYN_MAX_SIZE + 1;
    REFUSED(TYN_E_IMAGE, &from, &display, &image);
    image = to, image.stride = -15;
    REFUSED(TYN_E_IMAGE, &from, &display, &image);
    odd = display, odd.exposure = -1;
    REFUSED(TYN_E_DISPLAY, &from, &odd, &to);
    odd = display, odd.exposure = BIG_NAN;
    REFUSED(TYN_E_DISPLAY, &from, &odd, &to);
    odd = display, odd.tone = (tyn_tone)2;
    REFUSED(TYN_E_DISPLAY, &from, &odd, &to);
#undef REFUSED
    guard_free(&target);
}

static double srgb(double x)
{
    x = x < 0 ? 0 : x > 1 ? 1 : x;
    return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
}

/* Values through every format, size, stride and tone curve, against the definition in double. */
static void test_encode_values(void)
{
    static const int32_t sizes[][2] = {{1, 1}, {2, 1}, {1, 5}, {33, 7}, {67, 3}};
    static const tyn_format formats[] = {TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    TEST("tyn_encode writes what the formats say, and only there");
    for (int s = 0; s < 5; s++)
        for (int f = 0; f < 4; f++)
            for (int variant = 0; variant < 8; variant++) {
                int32_t w = sizes[s][0], h = sizes[s][1];
                float linear[3 * 33 * 7];
                tyn_image from = {linear, w, h, 0, TYN_RGB_F32};
                tyn_display display = {variant & 1 ? 1.5f : 0.0f, variant & 2 ? TYN_TONE_FILM : TYN_TONE_CLAMP, 0};
                guard to = guard_new(w, h, formats[f], variant & 4);
                double exposure = variant & 1 ? 1.5 : 1.0;
                for (int i = 0; i < 3 * w * h; i++)
                    linear[i] = test_random() & 3 ? test_random_float(0, 1.2f) : test_random_float(0, 0.01f);
                CHECK(tyn_encode(&from, &display, &to.image) == TYN_OK);
                CHECK(guard_intact(&to));
                for (int i = 0; i < w * h; i++) {
                    const uint8_t *at =
                        (const uint8_t *)to.image.pixels + (i / w) * to.image.stride + (i % w) * tyn_format_bytes(formats[f]);
                    uint16_t word;
                    memcpy(&word, at, sizeof word);
                    for (int k = 0; k < 3; k++) {
                        double x = (double)linear[3 * i + k] * exposure, shown = srgb(display.tone ? 1 - exp(-x) : x);
                        float got;
                        if (formats[f] == TYN_RGB_F32) {
                            memcpy(&got, at + 4 * k, sizeof got);
                            CHECK_NEAR(got, x, 1e-6 * x);
                        } else if (formats[f] == TYN_RGB565_SRGB) {
                            int top = k == 1 ? 63 : 31, step = word >> (k == 0 ? 11 : k == 1 ? 5 : 0) & top;
                            CHECK_NEAR(step, shown * top, 0.52);
                        } else {
                            CHECK_NEAR(at[formats[f] == TYN_BGRA8_SRGB ? 2 - k : k], shown * 255, 0.52);
                        }
                    }
                    if (formats[f] == TYN_RGBA8_SRGB || formats[f] == TYN_BGRA8_SRGB)
                        CHECK(at[3] == 255);
                }
                guard_free(&to);
            }
}

/* On a flat field the mean of a dithered block of 8x8 is the value itself, and no pixel is more than a step away. */
static void test_dither(void)
{
    TEST("dither keeps the mean");
    for (int n = 0; n < 40; n++) {
        float linear[3 * 64], value = test_random_float(0.01f, 0.9f);
        uint8_t bytes[4 * 64];
        tyn_image from = {linear, 8, 8, 0, TYN_RGB_F32}, to = {bytes, 8, 8, 0, TYN_RGBA8_SRGB};
        tyn_display display = {1, TYN_TONE_CLAMP, 1};
        double sum = 0, shown = 255 * srgb((double)value);
        for (int i = 0; i < 3 * 64; i++)
            linear[i] = value;
        CHECK(tyn_encode(&from, &display, &to) == TYN_OK);
        for (int i = 0; i < 64; i++) {
            sum += bytes[4 * i] / 64.0;
            CHECK_NEAR(bytes[4 * i], shown, 1.02);
        }
        CHECK_NEAR(sum, shown, 0.05);
    }
}

/* Black and white are whole in every format, whatever is added to tell steps apart, and so is what is brighter. */
static void test_ends(void)
{
    static const tyn_format formats[] = {TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    static const float values[] = {0, 1, 1e9f};
    TEST("black and white under dither");
    for (int f = 0; f < 3; f++)
        for (int v = 0; v < 3; v++) {
            float linear[3 * 64];
            uint8_t bytes[4 * 64];
            tyn_image from = {linear, 8, 8, 0, TYN_RGB_F32}, to = {bytes, 8, 8, 0, formats[f]};
            tyn_display display = {1, TYN_TONE_CLAMP, 1};
            for (int i = 0; i < 3 * 64; i++)
                linear[i] = values[v];
            CHECK(tyn_encode(&from, &display, &to) == TYN_OK);
            for (int i = 0; i < 64 * tyn_format_bytes(formats[f]); i++)
                CHECK(bytes[i] == (v ? 255 : 0) || (f < 2 && i % 4 == 3 && bytes[i] == 255));
        }
}

/* Each byte means what the standard says, to a 300th of a step of it. */
static void test_decode(void)
{
    TEST("bytes of sRGB");
    for (int i = 0; i < 256; i++) {
        double root = (double)((float)tyni_composite_srgb[i] * TYNI_COMPOSITE_ROOT), x = i / 255.0;
        CHECK_NEAR(255 * srgb(root * root), i, 0.0034);
        CHECK_NEAR(root * root, x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4), 1e-4 * root + 1e-6);
    }
}

/* What no light touches comes back as it was, dithered or not. */
static void test_untouched(void)
{
    enum { W = 64, H = 32 };
    static float depth[W * H];
    static uint8_t colour[4 * W * H], target[4 * W * H];
    static const float from[3] = {0, 0, 0}, to[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    TEST("pixels without air are as they were");
    for (int i = 0; i < W * H; i++) {
        depth[i] = 5;
        for (int c = 0; c < 4; c++)
            colour[4 * i + c] = (uint8_t)(c == 3 ? 255 : (i / 8 + 64 * c) & 255); /* each byte under each place of the dither */
    }
    for (int n = 0; n < 4; n++) {
        tyn_config config;
        tyn_context *context;
        tyn_frame frame;
        CHECK(tyn_config_preset(&config, TYN_PRESET_HANDHELD, W, H) == TYN_OK);
        config.quads = 0;
        config.isa = n & 2 ? TYN_ISA_SCALAR : 0;
        context = rig_context(&config);
        CHECK(context != NULL);
        if (!context)
            return;
        memset(&frame, 0, sizeof frame);
        CHECK(tyn_camera_look(&frame.camera, from, to, up, 1, 0.1f, 100, W, H) == TYN_OK);
        frame.depth.pixels = depth;
        frame.colour.pixels = colour;
        frame.target.pixels = target;
        frame.depth.width = frame.colour.width = frame.target.width = W;
        frame.depth.height = frame.colour.height = frame.target.height = H;
        frame.depth.format = TYN_DEPTH_F32;
        frame.colour.format = frame.target.format = TYN_RGBA8_SRGB;
        frame.display.dither = n & 1;
        CHECK(tyn_render(context, &frame) == TYN_OK);
        CHECK(memcmp(colour, target, sizeof target) == 0);
        free(context);
    }
}

void test_encode(void)
{
    test_refused();
    test_encode_values();
    test_dither();
    test_ends();
    test_decode();
    test_untouched();
}
