/* test_quad.c - pixels four at a time: near those without, the same bytes however they are asked for, and only where they say
 * so.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "stock.h"
#include "test.h"

enum { W = 161, H = 121, PIXELS = W * H, PITCH = 4 * W + 12 }; /* a column and a row are left over */

static const char *const suns[] = {"sun ahead",
                                   "sun off the left",
                                   "sun off the bottom",
                                   "sun behind the camera",
                                   "sun parallel to the picture",
                                   "sun in the corner of the view"};
enum { SUNS = (int)(sizeof suns / sizeof *suns) };

typedef struct picture {
    uint8_t bytes[PITCH * H]; /* rows have a gap behind them */
} picture;

/* A sun's scene with 8-bit colours. */
typedef struct given {
    rig *r;
    tyn_config config;
    tyn_frame frame;
    picture colour;
    float scatter[3 * PIXELS], transmittance[3 * PIXELS];
} given;

static void colour_as(given *g, tyn_format format)
{
    const tyn_display plain = {1, TYN_TONE_CLAMP, 0};
    tyn_image linear = {g->r->colour, W, H, 0, TYN_RGB_F32};
    g->frame.colour.pixels = g->colour.bytes;
    g->frame.colour.format = format;
    g->frame.colour.stride = PITCH;
    CHECK(tyn_encode(&linear, &plain, &g->frame.colour) == TYN_OK);
}

static given *given_new(int sun)
{
    given *g = calloc(1, sizeof *g);
    if (!g)
        abort();
    g->r = rig_stock(suns[sun], W, H, 128);
    CHECK(tyn_config_preset(&g->config, TYN_PRESET_HANDHELD, W, H) == TYN_OK);
    rig_fill(g->r, &g->config);
    g->frame = rig_frame(g->r);
    g->frame.scatter.pixels = NULL;
    g->frame.display.tone = TYN_TONE_CLAMP;
    g->frame.target.stride = PITCH;
    colour_as(g, TYN_RGBA8_SRGB);
    return g;
}

static void given_free(given *g)
{
    rig_free(g->r);
    free(g);
}

static void render(given *g, int quads, picture *out)
{
    int behind = 0;
    memset(out, 0x5c, sizeof *out);
    g->config.quads = quads;
    g->frame.target.pixels = out->bytes;
    CHECK(rig_render(g->r, &g->config, &g->frame) == TYN_OK);
    for (int y = 0; y < H; y++)
        for (int i = W * tyn_format_bytes(g->frame.target.format); i < PITCH; i++)
            behind += out->bytes[y * PITCH + i] != 0x5c;
    CHECK(behind == 0); /* nothing is written between rows */
}

static int same(const picture *a, const picture *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

static double psnr(const picture *a, const picture *b)
{
    double sum = 0;
    for (int y = 0; y < H; y++)
        for (int i = 0; i < 4 * W; i++)
            sum += pow(a->bytes[y * PITCH + i] - b->bytes[y * PITCH + i], 2);
    return sum > 0 ? 10 * log10(255.0 * 255 * 3 * PIXELS / sum) : 99;
}

/* Up to 50 dB within 2 of what pixels one by one are: beyond that the steps of tables show. */
static void test_near_march(void)
{
    TEST("quads: about as near to the march as pixels one by one");
    for (int sun = 0; sun < SUNS; sun++)
        for (int tone = 0; tone < 2; tone++) {
            static picture quads, plain, march;
            given *g = given_new(sun);
            double with, without;
            g->frame.display.tone = (tyn_tone)tone;
            render(g, 1, &quads);
            render(g, 0, &plain);
            g->config.method = TYN_METHOD_MARCH;
            render(g, 0, &march);
            with = psnr(&quads, &march);
            without = psnr(&plain, &march);
            printf("  %-28s to the march %.1f dB, one by one %.1f; to each other %.1f\n", suns[sun], with, without,
                   psnr(&quads, &plain));
            CHECK(!same(&quads, &plain));
            CHECK(with > fmin(without, 50) - 2);
            given_free(g);
        }
}

/* The light and the transmittance that may be asked for are those of the picture, and change nothing in it. */
static void test_apart(void)
{
    TEST("quads: what else is wanted does not change the picture");
    for (int sun = 0; sun < SUNS; sun++) {
        static picture alone, together;
        static float scatter[3 * PIXELS], transmittance[3 * PIXELS];
        given *g = given_new(sun);
        render(g, 1, &alone);
        g->frame.scatter.pixels = g->scatter;
        g->frame.transmittance = g->frame.scatter;
        g->frame.transmittance.pixels = g->transmittance;
        render(g, 1, &together);
        CHECK(same(&alone, &together));
        memcpy(scatter, g->scatter, sizeof scatter);
        memcpy(transmittance, g->transmittance, sizeof transmittance);
        render(g, 0, &together);
        CHECK_NEAR(rig_l1(scatter, g->scatter, 3 * PIXELS), 0, 0.02);
        CHECK_NEAR(rig_l1(transmittance, g->transmittance, 3 * PIXELS), 0, 0.006);
        given_free(g);
    }
}

/* Formats in and out, in place, and 16-bit depth. */
static void test_formats(void)
{
    static picture rgba, other;
    given *g = given_new(0);
    int other_way = 0, far_step = 0;
    TEST("quads: one picture in every format");
    render(g, 1, &rgba);
    g->frame.target.format = TYN_BGRA8_SRGB;
    render(g, 1, &other);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const uint8_t *a = rgba.bytes + y * PITCH + 4 * x, *b = other.bytes + y * PITCH + 4 * x;
            other_way += a[0] != b[2] || a[1] != b[1] || a[2] != b[0] || a[3] != 255 || b[3] != 255;
        }
    g->frame.target.format = TYN_RGB565_SRGB;
    render(g, 1, &other);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const uint8_t *a = rgba.bytes + y * PITCH + 4 * x;
            uint16_t v;
            memcpy(&v, other.bytes + y * PITCH + 2 * x, 2);
            far_step += fabs((v >> 11) * 255.0 / 31 - a[0]) > 4.7 || fabs((v >> 5 & 63) * 255.0 / 63 - a[1]) > 2.6 ||
                        fabs((v & 31) * 255.0 / 31 - a[2]) > 4.7;
        }
    CHECK(other_way == 0 && far_step == 0);
    for (int in = 0; in < 2; in++) { /* in place */
        g->frame.target.format = in ? TYN_RGB565_SRGB : TYN_BGRA8_SRGB;
        colour_as(g, g->frame.target.format);
        render(g, 1, &rgba);
        g->frame.target.pixels = g->colour.bytes;
        CHECK(rig_render(g->r, &g->config, &g->frame) == TYN_OK);
        for (int y = 0; y < H; y++)
            CHECK(memcmp(g->colour.bytes + y * PITCH, rgba.bytes + y * PITCH,
                         (size_t)(W * tyn_format_bytes(g->frame.target.format))) == 0);
    }
    given_free(g);
}

static void test_depths(void)
{
    static picture odd, bare;
    given *g = given_new(0);
    float *depth = g->r->depth;
    TEST("quads: odd depths");
    for (int i = 0; i < PIXELS; i++) {
        const float strange[] = {0, -1, NAN, INFINITY, -INFINITY, 1e-30f, 1e30f};
        if (i % 3 == 0)
            depth[i] = strange[i / 3 % 7];
    }
    render(g, 1, &odd);
    g->config.method = TYN_METHOD_NONE;
    g->frame.medium_count = 0;
    render(g, 1, &bare);
    for (int i = 0; i < PIXELS; i += 3) {
        const uint8_t *a = odd.bytes + i / W * PITCH + 4 * (i % W), *b = bare.bytes + i / W * PITCH + 4 * (i % W);
        const int kind = i / 3 % 7;
        if (kind < 2 || kind == 4 || kind == 5) /* nothing lies before them */
            CHECK(memcmp(a, b, 4) == 0);
    }
    given_free(g);
}

/* The mean of the dithered picture is that of one in finer steps, here of the undithered one. */
static void test_dither(void)
{
    static picture plain, dithered;
    given *g = given_new(1);
    double sum = 0;
    int most = 0;
    TEST("quads: dither");
    render(g, 1, &plain);
    g->frame.display.dither = 1;
    render(g, 1, &dithered);
    for (int i = 0; i < PITCH * H; i++) {
        sum += dithered.bytes[i] - plain.bytes[i];
        most = abs(dithered.bytes[i] - plain.bytes[i]) > most ? abs(dithered.bytes[i] - plain.bytes[i]) : most;
    }
    CHECK(most == 1 && fabs(sum) / (3 * PIXELS) < 0.05);
    given_free(g);
}

/* Frames for which it is said that they are drawn as without. */
static void test_others(void)
{
    enum { KINDS = 11 };
    TEST("quads: not for other frames");
    for (int kind = 0; kind < KINDS; kind++) {
        static picture with, without;
        static float wide[2][3 * PIXELS];
        given *g = given_new(0);
        tyn_light two[2];
        two[0] = two[1] = g->r->light[0];
        g->config.lights = 2;
        g->config.method = kind == 0 ? TYN_METHOD_MARCH : kind == 1 ? TYN_METHOD_HYBRID : TYN_METHOD_EPIPOLAR;
        g->config.gather = kind == 2 ? TYN_GATHER_IVB : TYN_GATHER_SHEAR;
        g->config.downscale = kind == 3 ? 2 : 1;
        g->config.rays = kind == 4 ? TYN_RAYS_STEPS : TYN_RAYS_WORDS;
        g->config.samples = kind == 5 ? W / 4 + 1 : g->config.samples;
        g->frame.fog_scale = kind == 6 ? 0.5f : 0;
        g->frame.max_distance = kind == 7 ? 20.0f : 0;
        g->frame.lights = two;
        g->frame.light_count = kind == 8 ? 2 : kind == 9 ? 0 : 1;
        if (kind == 10) {
            g->frame.colour.pixels = g->r->colour;
            g->frame.colour.format = TYN_RGB_F32;
            g->frame.colour.stride = 0;
        }
        render(g, 1, &with);
        render(g, 0, &without);
        if (!same(&with, &without))
            printf("  kind %d\n", kind);
        CHECK(same(&with, &without));
        if (kind == 0) { /* a target of floats */
            g->config.method = TYN_METHOD_EPIPOLAR;
            g->frame.target.format = TYN_RGB_F32;
            g->frame.target.stride = 0;
            for (int quads = 0; quads < 2; quads++) {
                g->config.quads = quads;
                g->frame.target.pixels = wide[quads];
                CHECK(rig_render(g->r, &g->config, &g->frame) == TYN_OK);
            }
            CHECK(memcmp(wide[0], wide[1], sizeof wide[0]) == 0);
        }
        given_free(g);
    }
}

/* Jobs from the last to the first, by three workers in turn. */
static void backwards(void *context, tyn_job job, void *argument, int32_t count)
{
    (void)context;
    for (int32_t i = count - 1; i >= 0; i--)
        job(argument, i, i % 3);
}

static void test_machines(void)
{
    const tyn_executor executor = {backwards, NULL, 3};
    TEST("quads: the same bytes on every ISA, and by any workers");
    for (int sun = 0; sun < SUNS; sun++) {
        static picture first, other;
        given *g = given_new(sun);
        g->config.workers = 3;
        g->config.isa = TYN_ISA_SCALAR;
        render(g, 1, &first);
        g->frame.executor = &executor;
        render(g, 1, &other);
        CHECK(same(&first, &other));
        for (int32_t isa = TYN_ISA_SSE2; isa <= TYN_ISA_WASM; isa *= 2)
            if (tyn_isa_available() & isa) {
                g->config.isa = isa;
                render(g, 1, &other);
                CHECK(same(&first, &other));
            }
        given_free(g);
    }
}

/* A sun in the middle of a quad of a small and wide picture, in air that scatters hardly but straight on: from row to row what
 * shines there falls by ten orders of magnitude. */
static void test_peaks(void)
{
    enum { WIDE = 8, HIGH = 24 };
    static const float eye[3] = {0, 0, 0}, ahead[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    static float depth[WIDE * HIGH], texels[16];
    static uint8_t colour[4 * WIDE * HIGH], first[4 * WIDE * HIGH];
    TEST("quads: a narrow peak of the phase function leaves no light below 0");
    memset(colour, 255, sizeof colour);
    for (int row = 1; row < HIGH; row += 8) {
        tyn_medium medium = {{0.02f, 0.02f, 0.02f}, {0, 0, 0}, TYN_PHASE_HG, 0.9999f};
        tyn_light sun;
        tyn_frame f;
        tyn_config c;
        tyn_context *context;
        float d[3], length, y;
        int dark = 0;
        memset(&sun, 0, sizeof sun);
        memset(&f, 0, sizeof f);
        for (int i = 0; i < WIDE * HIGH; i++)
            depth[i] = (float)(20 + i % 3 * 20);
        CHECK(tyn_camera_look(&f.camera, eye, ahead, up, 2.9f, 0.1f, 100, WIDE, HIGH) == TYN_OK);
        y = f.camera.top_edge - (f.camera.top_edge - f.camera.bottom_edge) * (float)row / HIGH;
        for (int i = 0; i < 3; i++)
            d[i] = f.camera.forward[i] + y * f.camera.up[i];
        length = sqrtf(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        for (int i = 0; i < 3; i++) {
            sun.direction[i] = -d[i] / length;
            sun.colour[i] = 1000.0f + 10.0f * (float)(i + row); /* roundings of all kinds */
        }
        sun.shadow.size = 4;
        CHECK(tyn_shadow_fit(&sun, &f.camera, NULL, NULL) == TYN_OK);
        sun.shadow.depth = texels;
        f.depth.pixels = depth;
        f.depth.format = TYN_DEPTH_F32;
        f.colour.pixels = colour;
        f.colour.format = TYN_RGBA8_SRGB;
        f.depth.width = f.colour.width = WIDE;
        f.depth.height = f.colour.height = HIGH;
        f.target = f.colour;
        f.target.pixels = first;
        f.lights = &sun;
        f.media = &medium;
        f.light_count = f.medium_count = 1;
        CHECK(tyn_config_preset(&c, TYN_PRESET_HANDHELD, WIDE, HIGH) == TYN_OK);
        c.shadow_size = 4;
        context = rig_context(&c);
        CHECK(c.quads && context && tyn_render(context, &f) == TYN_OK);
        for (size_t i = 0; i < sizeof first; i++)
            dark += first[i] == 0; /* a third and more is left of white */
        CHECK(dark == 0);
        free(context);
    }
}

/* Depths that no neighbour has: many pixels go by rays of their own. */
static void test_extremes(void)
{
    given *g = given_new(0);
    static picture out;
    tyn_light sun = *g->frame.lights;
    tyn_stats stats = {0};
    int wrong = 0;
    TEST("quads: the brightest sun at the greatest exposure leaves light finite");
    for (int i = 0; i < PIXELS; i++)
        g->r->depth[i] = g->frame.camera.far_depth * (float)(test_random() % 1000 + 1) / 1000.0f;
    sun.colour[0] = sun.colour[1] = sun.colour[2] = TYN_MAX_COLOUR;
    g->frame.lights = &sun;
    g->frame.display.exposure = 1e12f;
    g->frame.scatter.pixels = g->scatter;
    g->frame.stats = &stats;
    render(g, 1, &out);
    CHECK(stats.rejected > 0);
    for (int i = 0; i < 3 * PIXELS; i++)
        wrong += !(g->scatter[i] >= 0 && g->scatter[i] <= FLT_MAX);
    CHECK(wrong == 0);
    given_free(g);
}

void test_quad(void)
{
    test_near_march();
    test_apart();
    test_formats();
    test_depths();
    test_dither();
    test_others();
    test_machines();
    test_peaks();
    test_extremes();
}
