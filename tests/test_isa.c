/* test_isa.c - whole frames are the same bytes on every ISA of this machine: every light, method and format. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rig.h"
#include "slice.h"
#include "stock.h"
#include "test.h"

enum { W = 45, H = 31, PIXELS = W * H }; /* no multiple of any vector */

static const tyn_format targets[] = {TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB, TYN_RGB_F32};

typedef struct picture {
    float scatter[3 * PIXELS], transmittance[3 * PIXELS], target[3 * PIXELS];
} picture;

/* With the light and what is left of the surfaces in images of their own; the picture must be the one without those. */
static void draw(rig *r, tyn_config *config, int isa, int n, picture *out)
{
    static float alone[3 * PIXELS];
    static uint8_t colour[4 * PIXELS];
    tyn_frame frame = rig_frame(r);
    for (int i = 0; i < 4 * PIXELS; i++)
        colour[i] = (uint8_t)(i * 37 + i / 256);
    if (n % 3 < 2) {
        frame.colour.pixels = colour;
        frame.colour.format = n % 3 ? TYN_RGBA8_SRGB : TYN_BGRA8_SRGB;
    }
    memset(out, 0x77, sizeof *out);
    config->isa = isa;
    frame.scatter.pixels = out->scatter;
    frame.transmittance = frame.scatter;
    frame.transmittance.pixels = out->transmittance;
    frame.target.pixels = out->target;
    frame.target.format = targets[n % 4];
    frame.display.dither = n & 1;
    frame.display.tone = n & 2 ? TYN_TONE_FILM : TYN_TONE_CLAMP;
    frame.fog_scale = n % 5 == 4 ? 0.5f : 0;
    frame.max_distance = n % 5 == 3 ? 9.0f : 0;
    CHECK(rig_render(r, config, &frame) == TYN_OK);
    memset(alone, 0x77, sizeof alone);
    frame.scatter.pixels = frame.transmittance.pixels = NULL;
    frame.target.pixels = alone;
    CHECK(rig_render(r, config, &frame) == TYN_OK);
    CHECK(memcmp(alone, out->target, sizeof alone) == 0);
}

static void test_one(int32_t isa)
{
    char text[80];
    snprintf(text, sizeof text, "frames by %s are the scalar ones", tyn_isa_name(isa));
    test_begin(text);
    if (!(tyn_isa_available() & isa)) {
        test_skip(tyn_isa_built() & isa ? "this machine lacks it" : "it is not built in");
        return;
    }
    for (int n = 0; n < stock_count; n++) {
        static picture scalar, other;
        oracle_scene *scene = stock_new(stock_list[n].name, W, H);
        rig *r = rig_new(scene, 120);
        for (int way = n % 4; r && way < RIG_WAYS; way += 4) {
            tyn_config config = rig_way_config(r, &rig_ways[way]);
            config.samples = n % 3 == 2 ? 40 : 0; /* each second column */
            draw(r, &config, TYN_ISA_SCALAR, n + way, &scalar);
            draw(r, &config, isa, n + way, &other);
            if (memcmp(&scalar, &other, sizeof scalar) != 0)
                printf("  %s, %s\n", stock_list[n].name, rig_ways[way].name);
            CHECK(memcmp(&scalar, &other, sizeof scalar) == 0);
        }
        rig_free(r);
        model_free(scene);
    }
}

/* Pictures wide enough for two of the widest vectors and for tiles, of lines with just as many samples as they need. Returns
 * how many pixels had rays of their own. */
static int64_t draw_wide(int32_t isa, const char *name, int stride)
{
    enum { WIDE = 333, HIGH = 75 };
    static float scatter[3 * WIDE * HIGH];
    int64_t rejected;
    rig *r = rig_stock(name, WIDE, HIGH, 120);
    tyn_config config = rig_config(r, TYN_METHOD_EPIPOLAR, TYN_RAYS_WORDS);
    tyn_frame frame = rig_frame(r);
    config.slices = 64; /* far enough apart that pixels fit none */
    config.samples = tyni_slice_points(WIDE, stride);
    config.isa = TYN_ISA_SCALAR;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(scatter, r->scatter, sizeof scatter);
    config.isa = isa;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK(memcmp(scatter, r->scatter, sizeof scatter) == 0);
    rejected = r->stats.rejected;
    rig_free(r);
    return rejected;
}

static void test_wide(int32_t isa)
{
    static const char *const names[] = {"sun ahead", "sun off the top", "sun off the left", "sun in the upper right corner"};
    char text[80];
    int64_t rejected = 0;
    if (!(tyn_isa_available() & isa))
        return;
    snprintf(text, sizeof text, "wide frames by %s are the scalar ones", tyn_isa_name(isa));
    test_begin(text);
    for (int i = 0; i < 4; i++)
        for (int stride = 1; stride <= 8; stride *= 2)
            rejected += draw_wide(isa, names[i], stride);
    CHECK(rejected > 0 && rejected < 24600); /* 23976; with one outer line to either side, and nothing along it, 25365 */
}

void test_isa(void)
{
    for (int32_t isa = TYN_ISA_SSE2; isa <= TYN_ISA_WASM; isa *= 2)
        test_one(isa);
    for (int32_t isa = TYN_ISA_SCALAR; isa <= TYN_ISA_WASM; isa *= 2)
        test_wide(isa);
}
