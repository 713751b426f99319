/* test_properties.c - what holds for any scene, method and setting, on random ones: see draw.h. */
#include <stdlib.h>
#include <string.h>

#include "draw.h"
#include "easel.h"
#include "test.h"

/* ---- light ----------------------------------------------------------------------------------------------------------- */

static int within(const float *v, size_t count, float most)
{
    for (size_t i = 0; i < count; i++)
        if (!(v[i] >= 0 && v[i] <= most))
            return 0;
    return 1;
}

/* Finite, not negative; the medium takes from surfaces and gives them nothing. */
static void check_range(void)
{
    TEST("light in the air is finite and not negative, surfaces only lose");
    for (int n = draw_rounds(12); n--;) {
        drawn d = draw_one();
        float *share = draw_copy(d.r->scatter, d.count), *target = draw_copy(d.r->scatter, d.count);
        int holds;
        d.frame.transmittance = d.frame.target = d.frame.scatter;
        d.frame.transmittance.pixels = share;
        d.frame.target.pixels = target;
        draw_render(&d);
        holds = within(d.r->scatter, d.count, 1e6f) && within(share, d.count, 1);
        for (int i = 0; i < d.r->lights; i++)
            d.r->light[i].scale = -1; /* no shafts: what is left is the surfaces' light */
        draw_render(&d);
        holds &= within(target, d.count, 1e6f);
        for (size_t i = 0; i < d.count; i++)
            holds &= target[i] <= d.r->colour[i];
        free(share);
        free(target);
        draw_done(&d, holds);
    }
}

/* Twice the medium takes no less. */
static void check_denser(void)
{
    TEST("a denser medium lets no more through");
    for (int n = draw_rounds(5); n--;) {
        drawn d = draw_one();
        float *thin = draw_copy(d.r->scatter, d.count);
        int holds = 1;
        d.config.method = TYN_METHOD_NONE;
        d.frame.transmittance = d.frame.scatter;
        d.frame.transmittance.pixels = thin;
        draw_render(&d);
        d.frame.transmittance.pixels = d.r->scatter;
        d.frame.scatter.pixels = NULL;
        for (int i = 0; i < d.r->media; i++)
            for (int k = 0; k < 3; k++)
                d.r->medium[i].scatter[k] *= 2;
        draw_render(&d);
        for (size_t i = 0; i < d.count; i++)
            holds &= d.r->scatter[i] <= thin[i];
        free(thin);
        draw_done(&d, holds);
    }
}

/* Without a medium each target is its colour, in place, bit by bit; 8-bit ones too. */
static void check_clear(void)
{
    static const tyn_format formats[] = {TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    TEST("clear air leaves the picture as it is");
    for (int n = draw_rounds(16); n--;) {
        drawn d = draw_one();
        tyn_image from = {d.r->colour, d.r->width, d.r->height, 0, TYN_RGB_F32};
        guard picture = guard_new(d.r->width, d.r->height, formats[n % 4], n & 4);
        const tyn_display plain = {1, TYN_TONE_CLAMP, 0};
        uint8_t *before = malloc(picture.size);
        if (!before)
            abort();
        CHECK(tyn_encode(&from, &plain, &picture.image) == TYN_OK);
        for (size_t i = 0; n & 8 && formats[n % 4] == TYN_RGB565_SRGB && i < picture.size; i++)
            picture.block[i] = (uint8_t)test_random();
        memcpy(before, picture.block, picture.size);
        memset(d.r->medium, 0, sizeof d.r->medium);
        d.frame.medium_count = n & 16 ? 0 : d.r->media;
        d.frame.colour = d.frame.target = picture.image;
        d.frame.display = plain;
        draw_render(&d);
        draw_done(&d, memcmp(before, picture.block, picture.size) == 0 && within(d.r->scatter, d.count, 0));
        free(before);
        guard_free(&picture);
    }
}

/* All decisions on where rays are weigh light against light, so that another unit changes none. */
static void check_scaled(void)
{
    TEST("scaling the lights scales their light in the air");
    for (int n = draw_rounds(8); n--;) {
        drawn d = draw_one();
        const float factor = n & 1 ? 16.0f : (float)draw_between(0.01, 50);
        float *one;
        draw_render(&d);
        one = draw_copy(d.r->scatter, d.count);
        for (size_t i = 0; i < d.count; i++)
            one[i] *= factor;
        for (int i = 0; i < d.r->lights; i++)
            for (int k = 0; k < 3; k++)
                d.r->light[i].colour[k] *= factor;
        draw_render(&d);
        draw_done(&d, rig_l1(d.r->scatter, one, d.count) < 1e-4);
        free(one);
    }
}

static void check_sum(void)
{
    TEST("the light of several lights is the sum of each one's");
    for (int n = draw_rounds(8); n--;) {
        drawn d = draw_one();
        float *sum = calloc(d.count, sizeof *sum);
        if (!sum)
            abort();
        for (int l = 0; l < d.r->lights; l++) {
            d.frame.lights = &d.r->light[l];
            d.frame.light_count = 1;
            draw_render(&d);
            for (size_t i = 0; i < d.count; i++)
                sum[i] += d.r->scatter[i];
        }
        d.frame = rig_frame(d.r);
        draw_render(&d);
        draw_done(&d, rig_l1(d.r->scatter, sum, d.count) < 1e-5);
        free(sum);
    }
}

/* ---- the same bytes -------------------------------------------------------------------------------------------------- */

enum { BAND = 64 };

/* Somebody else's frame in between: half the size, from another place, its pictures in memory of its own. */
static void render_other(const drawn *d, tyn_context *context)
{
    tyn_frame f = d->frame;
    guard target;
    f.depth.width = (d->r->width + 1) / 2;
    f.depth.height = (d->r->height + 1) / 2;
    f.depth.stride = 4 * (ptrdiff_t)d->r->width;
    target = guard_new(f.depth.width, f.depth.height, TYN_RGB565_SRGB, 1);
    f.camera.position[0] += 0.7f;
    f.colour.pixels = f.scatter.pixels = NULL;
    f.target = target.image;
    f.executor = NULL;
    CHECK(tyn_render(context, &f) == TYN_OK);
    CHECK(guard_intact(&target));
    guard_free(&target);
}

/* One scene by every instruction set and any crew, into pictures of any format and stride; and again after another frame. */
static int same(drawn *d, tyn_format format)
{
    const int32_t sets[] = {TYN_ISA_SCALAR, TYN_ISA_SSE2, TYN_ISA_AVX2, TYN_ISA_AVX512, TYN_ISA_NEON, TYN_ISA_WASM, 0};
    guard target = guard_new(d->r->width, d->r->height, format, (int)draw_one_of(2));
    guard scatter = guard_new(d->r->width, d->r->height, TYN_RGB_F32, (int)draw_one_of(2));
    uint64_t hash[2] = {0, 0};
    int holds = 1;
    d->frame.target = target.image;
    d->frame.scatter = scatter.image;
    for (int i = 0; i < 7; i++) {
        tyn_context *context = NULL;
        easel_crew crew;
        size_t bytes = 0;
        uint8_t *block;
        d->config.isa = sets[i];
        d->config.workers = i ? 1 + (int32_t)draw_one_of(9) : 1;
        if (sets[i] && !(tyn_isa_available() & sets[i]))
            continue;
        easel_hire(&crew, i % 2 ? EASEL_SHUFFLED : EASEL_REVERSED, d->config.workers);
        holds &= tyn_measure(&d->config, &bytes) == TYN_OK;
        block = rig_block(bytes + BAND);
        memset(block, (int)draw_one_of(256), bytes);
        memset(block + bytes, 0x5a, BAND);
        holds &= tyn_init(&context, &d->config, block, bytes) == TYN_OK;
        for (int again = 0; again < 2; again++) {
            uint64_t now[2];
            d->frame.executor = i ? &crew.executor : NULL;
            holds &= tyn_render(context, &d->frame) == TYN_OK && guard_intact(&target) && guard_intact(&scatter);
            now[0] = rig_hash(target.block, target.size);
            now[1] = rig_hash(scatter.block, scatter.size);
            if (hash[0] == 0)
                memcpy(hash, now, sizeof hash);
            holds &= memcmp(hash, now, sizeof hash) == 0;
            render_other(d, context);
        }
        for (size_t k = 0; k < BAND; k++)
            holds &= block[bytes + k] == 0x5a;
        free(block);
    }
    guard_free(&target);
    guard_free(&scatter);
    return holds;
}

static void check_same(void)
{
    static const tyn_format formats[] = {TYN_RGB_F32, TYN_RGBA8_SRGB, TYN_BGRA8_SRGB, TYN_RGB565_SRGB};
    TEST("instruction sets, workers, order, what was rendered before: the same bytes, and none beside them");
    for (int n = draw_rounds(4); n--;) {
        drawn d = draw_one();
        draw_done(&d, same(&d, formats[n % 4]));
    }
}

/* ---- a clock that stands still --------------------------------------------------------------------------------------- */

static uint64_t noon(void *context)
{
    (void)context;
    return 43200;
}

static void check_clock(void)
{
    TEST("a clock that stands still takes no time and changes nothing");
    for (int n = draw_rounds(4); n--;) {
        drawn d = draw_one();
        float *before;
        const tyn_stats *s = &d.r->stats;
        int holds;
        draw_render(&d);
        before = draw_copy(d.r->scatter, d.count);
        d.frame.clock = noon;
        draw_render(&d);
        holds = memcmp(before, d.r->scatter, d.count * sizeof *before) == 0;
        holds &= !s->slice_ns && !s->gather_ns && !s->total_ns && !s->sample_ns && !s->row_ns && !s->ray_ns && !s->line_ns;
        holds &= !s->unwarp_ns && !s->correct_ns && !s->upscale_ns && !s->composite_ns;
        free(before);
        draw_done(&d, holds);
    }
}

void test_properties(void)
{
    check_range();
    check_denser();
    check_clear();
    check_scaled();
    check_sum();
    check_same();
    check_clock();
}
