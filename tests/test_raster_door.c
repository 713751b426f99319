/* test_raster_door.c - level (a): memory, each status that its calls can give, and that nothing is written with it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "easel.h"
#include "test.h"

static void test_memory(void)
{
    static const int32_t batches[] = {64, 65, 127, 128, 1000, 2048, 65535, 65536}, workers[] = {1, 2, 3, 63, 64};
    tyn_raster_config c = {0};
    tyn_raster *raster = NULL;
    size_t bytes = 0, zeros;
    uint8_t *block;
    TEST("raster: memory");
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 5; k++) {
            c.width = 1 + i * 4000;
            c.height = 32768 - k;
            c.batch = batches[i];
            c.workers = workers[k];
            CHECK(tyn_raster_measure(&c, &bytes) == TYN_OK);
            CHECK(bytes == TYN_RASTER_MEMORY(1 + i * 4000, 32768 - k, batches[i], workers[k]));
        }
    c.batch = c.workers = 0;
    CHECK(tyn_raster_measure(&c, &zeros) == TYN_OK);
    CHECK(zeros == TYN_RASTER_MEMORY(1, 1, 2048, 1));
    CHECK(tyn_raster_measure(NULL, &zeros) == TYN_E_NULL && tyn_raster_measure(&c, NULL) == TYN_E_NULL);
    for (int i = 0; i < 9; i++) {
        static const struct {
            int32_t width, height, batch, workers;
        } wrong[9] = {{0, 1, 0, 0},  {1, 0, 0, 0},     {32769, 1, 0, 0}, {1, 32769, 0, 0}, {1, 1, 63, 0},
                      {1, 1, -1, 0}, {1, 1, 65537, 0}, {1, 1, 0, 65},    {1, 1, 0, -1}};
        tyn_raster_config w = {wrong[i].width, wrong[i].height, wrong[i].batch, wrong[i].workers, 0};
        size_t kept = 77;
        CHECK(tyn_raster_measure(&w, &kept) == TYN_E_CONFIG && kept == 77);
        CHECK(tyn_raster_init(&raster, &w, &w, 1) == TYN_E_CONFIG && !raster);
    }
    block = malloc(zeros + 128);
    if (block) {
        uint8_t *at = block + (64 - (uintptr_t)block % 64) % 64;
        CHECK(tyn_raster_init(&raster, &c, at, zeros - 1) == TYN_E_MEMORY && !raster);
        c.isa = TYN_ISA_SCALAR | TYN_ISA_SSE2 | TYN_ISA_AVX2 | TYN_ISA_AVX512 | TYN_ISA_NEON | TYN_ISA_WASM;
        c.isa &= ~tyn_isa_available();
        CHECK(tyn_raster_init(&raster, &c, at, zeros) == TYN_E_ISA && !raster);
        c.isa = 64;
        CHECK(tyn_raster_init(&raster, &c, at, zeros) == TYN_E_CONFIG && !raster);
        c.isa = 0;
        CHECK(tyn_raster_init(&raster, &c, at + 4, zeros) == TYN_E_ALIGN && !raster);
        CHECK(tyn_raster_init(NULL, &c, at, zeros) == TYN_E_NULL && tyn_raster_init(&raster, NULL, at, zeros) == TYN_E_NULL &&
              tyn_raster_init(&raster, &c, NULL, zeros) == TYN_E_NULL && !raster);
        CHECK(tyn_raster_init(&raster, &c, at, zeros) == TYN_OK && (uint8_t *)raster == at);
    }
    free(block);
}

/* ---- arguments ------------------------------------------------------------------------------------------------------ */

static const float corners[9] = {-1, -1, -2, 1, -1, -2, 0, 1, -2};
static const uint32_t order[3] = {0, 1, 2};

typedef struct wrong {
    easel easel;
    tyn_mesh mesh;
    tyn_image picture;
    tyn_light light;
    tyn_medium medium;
    uint8_t texels[64];
    float map[16];
} wrong;

/* One thing wrong at a time. */
static tyn_status spoil(wrong *w, int i)
{
    tyn_surface *s = &w->easel.surface;
    switch (i) {
    case 0:
        s->depth.pixels = NULL;
        return TYN_E_NULL;
    case 1:
        s->depth.format = TYN_RGB_F32;
        return TYN_E_IMAGE;
    case 2:
        s->depth.width = 0;
        return TYN_E_IMAGE;
    case 3:
        s->depth.pixels = (uint8_t *)s->depth.pixels + 2;
        return TYN_E_ALIGN;
    case 4:
        s->depth.stride = 8;
        return TYN_E_IMAGE;
    case 5:
        s->colour.height--;
        return TYN_E_IMAGE;
    case 6:
        s->colour.format = TYN_DEPTH_F32;
        return TYN_E_IMAGE;
    case 7:
        s->depth.width = s->colour.width = 9;
        return TYN_E_LIMIT;
    case 8:
        s->camera.near_depth = 0;
        return TYN_E_CAMERA;
    case 9:
        s->camera.far_depth = s->camera.near_depth;
        return TYN_E_CAMERA;
    case 10:
        s->camera.forward[0] = NAN;
        return TYN_E_CAMERA;
    case 11:
        s->lights = NULL;
        return TYN_E_NULL;
    case 12:
        s->light_count = TYN_MAX_LIGHTS + 1;
        return TYN_E_LIMIT;
    case 13:
        w->light.direction[1] = 3;
        return TYN_E_LIGHT;
    case 14:
        w->light.colour[2] = -1;
        return TYN_E_LIGHT;
    case 15:
        w->light.shadow.size = 0;
        return TYN_E_LIGHT;
    case 16:
        w->medium.scatter[0] = -1;
        return TYN_E_MEDIUM;
    case 17:
        s->media = NULL;
        return TYN_E_NULL;
    case 18:
        s->meshes = NULL;
        return TYN_E_NULL;
    case 19:
        s->mesh_count = -1;
        return TYN_E_MESH;
    case 20:
        w->mesh.vertices = 2;
        return TYN_E_MESH;
    case 21:
        w->mesh.positions = NULL;
        return TYN_E_NULL;
    case 22:
        w->mesh.indices = NULL;
        return TYN_E_NULL;
    case 23:
        w->mesh.material.albedo[1] = 1.5f;
        return TYN_E_MESH;
    case 24:
        w->mesh.material.albedo[1] = NAN;
        return TYN_E_MESH;
    case 25:
        w->picture.pixels = NULL;
        return TYN_E_NULL;
    case 26:
        w->picture.format = TYN_RGBA8_SRGB;
        return TYN_E_IMAGE;
    case 27:
        w->mesh.material.mask = &w->picture; /* not a mask's format */
        return TYN_E_IMAGE;
    case 28:
        s->ambient[0] = -1;
        return TYN_E_LIGHT;
    case 29:
        s->background[2] = INFINITY;
        return TYN_E_LIGHT;
    case 30:
        s->shadow_bias = NAN;
        return TYN_E_LIGHT;
    default:
        return TYN_OK;
    }
}

static void fresh(wrong *w)
{
    w->easel = easel_new(8, 8, 64, 2, 0);
    w->mesh = easel_mesh(corners, 1);
    w->mesh.indices = order;
    memset(&w->picture, 0, sizeof w->picture);
    w->picture.pixels = w->texels;
    w->picture.width = w->picture.height = 4;
    w->picture.format = TYN_RGB8_LINEAR;
    w->mesh.material.texture = &w->picture;
    memset(&w->light, 0, sizeof w->light);
    w->light.direction[2] = -1;
    w->light.shadow.depth = w->map;
    w->light.shadow.size = 4;
    for (int k = 0; k < 16; k += 5)
        w->light.shadow.matrix[k] = 1;
    memset(&w->medium, 0, sizeof w->medium);
    memset(w->map, 0, sizeof w->map);
    w->easel.surface.meshes = &w->mesh;
    w->easel.surface.mesh_count = 1;
    w->easel.surface.lights = &w->light;
    w->easel.surface.light_count = 1;
    w->easel.surface.media = &w->medium;
    w->easel.surface.medium_count = 1;
    w->easel.surface.stats = &w->easel.stats;
    memset(&w->easel.stats, 0x5a, sizeof w->easel.stats);
}

static void test_surface_door(void)
{
    int i = 0, more = 1;
    TEST("raster: what is wrong with a surface is found before anything is written");
    for (; more; i++) {
        static wrong w;
        tyn_status want, got;
        tyn_raster_stats before;
        fresh(&w);
        before = w.easel.stats;
        want = spoil(&w, i);
        more = want != TYN_OK;
        got = tyn_raster_surface(w.easel.raster, &w.easel.surface);
        CHECK_NEAR(got, want, 0);
        if (more) {
            CHECK(guard_untouched(&w.easel.depth) && guard_untouched(&w.easel.colour) && easel_intact(&w.easel));
            CHECK(memcmp(&before, &w.easel.stats, sizeof before) == 0);
        }
        easel_free(&w.easel);
    }
    CHECK_NEAR(i, 32, 0); /* all cases, and the last without a fault drew */
    {
        static wrong w;
        tyn_executor crew = {NULL, NULL, 1};
        fresh(&w);
        w.easel.surface.executor = &crew;
        CHECK(tyn_raster_surface(w.easel.raster, &w.easel.surface) == TYN_E_EXECUTOR);
        CHECK(tyn_raster_surface(NULL, &w.easel.surface) == TYN_E_NULL);
        CHECK(tyn_raster_surface(w.easel.raster, NULL) == TYN_E_NULL);
        CHECK(guard_untouched(&w.easel.depth));
        easel_free(&w.easel);
    }
}

static void test_shadow_door(void)
{
    float map[16], before[16];
    easel e = easel_new(4, 4, 64, 1, 0);
    tyn_mesh mesh = easel_mesh(corners, 1);
    TEST("raster: what is wrong with a shadow map is found before anything is written");
    mesh.indices = order;
    for (int i = 0; i < 16; i++)
        map[i] = before[i] = 7;
    for (int i = 0; i < 12; i++) {
        tyn_shadow s = {.size = 4, .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
        tyn_executor crew = {NULL, NULL, 1};
        tyn_mesh spoiled = mesh;
        tyn_status want = i == 11   ? TYN_E_ALIGN
                          : i == 10 ? TYN_E_EXECUTOR
                          : i >= 8  ? TYN_E_MESH
                          : i >= 6  ? TYN_E_LIMIT
                                    : TYN_E_LIGHT;
        if (i < 2)
            s.size = i ? TYN_MAX_SHADOW + 1 : 0;
        if (i == 2)
            s.matrix[3] = NAN;
        if (i == 3)
            s.matrix[10] = 0; /* z is the same everywhere: singular */
        if (i == 4)
            memcpy(s.matrix + 4, s.matrix, 16);
        if (i == 5)
            s.matrix[15] = -1; /* all behind the light */
        if (i == 6 || i == 7)
            s.size = i == 6 ? 5 : TYN_MAX_SHADOW;
        if (i == 8)
            spoiled.vertices = 0;
        CHECK_NEAR(tyn_raster_shadow(e.raster, &s, i == 11 ? (float *)(void *)((uint8_t *)map + 1) : map, &spoiled,
                                     i == 9 ? -2 : 1, i == 10 ? &crew : NULL, NULL, NULL, NULL),
                   want, 0);
        CHECK(memcmp(map, before, sizeof map) == 0);
    }
    {
        const tyn_shadow s = {.size = 4, .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
        CHECK(tyn_raster_shadow(NULL, &s, map, &mesh, 1, NULL, NULL, NULL, NULL) == TYN_E_NULL);
        CHECK(tyn_raster_shadow(e.raster, NULL, map, &mesh, 1, NULL, NULL, NULL, NULL) == TYN_E_NULL);
        CHECK(tyn_raster_shadow(e.raster, &s, NULL, &mesh, 1, NULL, NULL, NULL, NULL) == TYN_E_NULL);
        CHECK(tyn_raster_shadow(e.raster, &s, map, NULL, 1, NULL, NULL, NULL, NULL) == TYN_E_NULL);
        CHECK(memcmp(map, before, sizeof map) == 0);
        CHECK(tyn_raster_shadow(e.raster, &s, map, &mesh, 1, NULL, NULL, NULL, NULL) == TYN_OK);
    }
    easel_free(&e);
}

/* Any stride gives the same texels, and what lies between rows stays. */
static void test_shadow_stride(void)
{
    static const float high[9] = {-1, -1, 0.5f, 1, -1, 0.5f, 0, 1, 0.25f};
    static float map[7 * 11], gapped[7 * 16], before[7 * 16];
    tyn_shadow s = {.size = 11, .height = 7, .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    easel e = easel_new(11, 11, 64, 1, 0);
    tyn_mesh mesh = easel_mesh(high, 1);
    TEST("raster: shadow maps with gaps between their rows");
    mesh.indices = order;
    for (int i = 0; i < 7 * 16; i++)
        before[i] = (float)(i + 7);
    CHECK(tyn_raster_shadow(e.raster, &s, map, &mesh, 1, NULL, NULL, NULL, NULL) == TYN_OK);
    for (int way = -1; way <= 1; way += 2) {
        int different = 0, drawn = 0;
        memcpy(gapped, before, sizeof gapped);
        s.stride = way * 16 * (int)sizeof(float);
        CHECK(tyn_raster_shadow(e.raster, &s, way > 0 ? gapped : gapped + 6 * 16, &mesh, 1, NULL, NULL, NULL, NULL) == TYN_OK);
        for (int y = 0; y < 7; y++)
            for (int x = 0; x < 16; x++) {
                const int i = 16 * (way > 0 ? y : 6 - y) + x;
                const float want = x < 11 ? map[11 * y + x] : before[i];
                different += memcmp(&gapped[i], &want, sizeof want) != 0;
                drawn += x < 11 && want > 0.0f;
            }
        CHECK(different == 0 && drawn > 3);
    }
    for (int i = 0; i < 6; i++) {
        static const ptrdiff_t strides[] = {40, -40, 46, -66, INT32_MAX / 7 / 4 * 4 + 4, PTRDIFF_MIN};
        memcpy(gapped, before, sizeof gapped);
        s.stride = strides[i];
        CHECK(tyn_raster_shadow(e.raster, &s, gapped, &mesh, 1, NULL, NULL, NULL, NULL) == TYN_E_LIGHT);
        CHECK(memcmp(gapped, before, sizeof gapped) == 0);
    }
    easel_free(&e);
}

static uint64_t tick(void *context)
{
    return *(uint64_t *)context += 10;
}

static void test_clock(void)
{
    easel e = easel_new(4, 4, 64, 1, 0);
    tyn_mesh mesh = easel_mesh(corners, 1);
    uint64_t now = 5;
    TEST("raster: the clock is the caller's");
    CHECK(easel_draw(&e, &mesh, 1) == TYN_OK && e.stats.total_ns == 0);
    e.surface.clock = tick;
    e.surface.clock_context = &now;
    CHECK(easel_draw(&e, &mesh, 1) == TYN_OK && e.stats.total_ns == 10);
    easel_free(&e);
}

void test_raster_door(void)
{
    test_memory();
    test_surface_door();
    test_shadow_door();
    test_shadow_stride();
    test_clock();
}
