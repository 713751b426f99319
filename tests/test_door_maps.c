/* test_door_maps.c - shadow maps as others store them: every format and coding gives one picture. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "rig.h"
#include "stock.h"
#include "test.h"

enum { W = 40, H = 30, PIXELS = W * H };

typedef struct map_case {
    tyn_map_coding coding;
    float at_near, at_far, scale;
    int clear; /* linear: what is stored where there is nothing: 0: all ones or infinity; 1: at_far */
} map_case;

static const map_case map_cases[] = {
    {TYN_MAP_REVERSED, 0, 0, 0, 0},  {TYN_MAP_PROJECTED, 0, 0, 0, 0},    {TYN_MAP_PROJECTED, 0, 1, 0, 0},
    {TYN_MAP_PROJECTED, 1, 0, 0, 0}, {TYN_MAP_PROJECTED, -1, 1, 0, 0},   {TYN_MAP_PROJECTED, 0.25f, 0.75f, 0, 0},
    {TYN_MAP_LINEAR, 0, 60, 1, 0},   {TYN_MAP_LINEAR, 0, 60, 0.002f, 1},
};
enum { MAP_CASES = (int)(sizeof map_cases / sizeof *map_cases), MAP = 128 };

/* A copy of a map in another format and coding. `same` becomes what it then says, in the first convention. */
typedef struct recoded {
    tyn_shadow shadow;
    guard texels;
    float same[MAP * MAP];
} recoded;

static double near_end(double a, double b)
{
    return a < b ? a : b;
}

static void recode(recoded *to, const tyn_shadow *from, const map_case *c, tyn_format format, int upside_down)
{
    const float *depth = from->depth;
    const double levels = rig_levels(format);
    int parallel = from->matrix[12] == 0 && from->matrix[13] == 0 && from->matrix[14] == 0;
    double a = (double)c->at_near, b = a == 0 && c->at_far == 0 ? 1 : (double)c->at_far;
    double scale = c->scale > 0 ? (double)c->scale : 1, unit = levels > 0 ? levels : 1;
    double constant = (double)from->matrix[11]; /* of a perspective map, whose Z is that and nothing else */
    /* integers hold 0 .. 1, and distances in steps that reach far enough */
    if (levels > 0 && a < 0)
        a = 0;
    if (levels > 0 && scale >= 1)
        scale = 0.001;
    to->shadow = *from;
    to->shadow.format = format;
    to->shadow.coding = c->coding;
    to->shadow.at_near = (float)a;
    to->shadow.at_far = c->coding == TYN_MAP_LINEAR && !parallel && !c->clear ? 0 : a == 0 && b == 1 ? c->at_far : (float)b;
    to->shadow.scale = (float)scale;
    scale = (double)(float)scale;
    to->texels = guard_new(MAP, MAP, format, upside_down);
    to->shadow.depth = to->texels.image.pixels;
    to->shadow.stride = to->texels.image.stride;
    for (int i = 0; i < 4; i++) {
        double z = (double)from->matrix[8 + i], w = (double)from->matrix[12 + i];
        if (c->coding == TYN_MAP_PROJECTED || (c->coding == TYN_MAP_LINEAR && parallel))
            z = b * w + (a - b) * z;
        else if (c->coding == TYN_MAP_LINEAR)
            z = (double)test_random_float(-1, 1); /* not used */
        to->shadow.matrix[8 + i] = (float)z;
    }
    for (int i = 0; i < MAP * MAP; i++) {
        double z = near_end((double)depth[i], 1), value, back;
        char *row = (char *)to->texels.image.pixels + to->texels.image.stride * (i / MAP);
        if (c->coding == TYN_MAP_REVERSED)
            value = z * unit;
        else if (c->coding == TYN_MAP_PROJECTED)
            value = (b + (a - b) * z) * unit;
        else if (parallel)
            value = (b + (a - b) * z) / scale;
        else
            value = z > 0 ? constant / z / scale : c->clear ? b / scale * 1.0001 : levels > 0 ? levels : HUGE_VAL;
        if (levels > 0) {
            uint16_t bits = (uint16_t)(value < 0 ? 0 : value > levels ? levels : value + 0.5);
            ((uint16_t *)(void *)row)[i % MAP] = bits;
            value = (double)bits;
        } else {
            float stored = (float)value;
            ((float *)(void *)row)[i % MAP] = stored;
            value = (double)stored;
        }
        if (c->coding == TYN_MAP_LINEAR && !parallel)
            back = (c->clear && value * scale >= b) || (levels > 0 && value >= levels) ? 0 : constant / (value * scale);
        else
            back = c->coding == TYN_MAP_REVERSED ? value / unit
                                                 : (value / (c->coding == TYN_MAP_LINEAR ? 1 / scale : unit) - b) / (a - b);
        to->same[i] = (float)back;
    }
}

/* The scatter of a rig from its maps recoded is that from the same depths in the first convention, and near `original`. */
static void check_maps(rig *r, const tyn_config *config, const map_case *c, tyn_format format, int upside_down,
                       const float *original)
{
    static recoded map[6];
    static float plain[3 * PIXELS];
    tyn_shadow more[5];
    tyn_frame frame = rig_frame(r);
    tyn_light light = r->light[0];
    int count = light.more_count + 1;
    frame.lights = &light;
    for (int i = 0; i < count; i++)
        recode(&map[i], i ? &r->light[0].more[i - 1] : &r->light[0].shadow, c, format, upside_down);
    light.shadow.depth = map[0].same;
    for (int i = 1; i < count; i++) {
        more[i - 1] = r->light[0].more[i - 1];
        more[i - 1].depth = map[i].same;
    }
    light.more = count > 1 ? more : NULL;
    CHECK(rig_render(r, config, &frame) == TYN_OK);
    memcpy(plain, r->scatter, sizeof plain);
    light.shadow = map[0].shadow;
    for (int i = 1; i < count; i++)
        more[i - 1] = map[i].shadow;
    CHECK(rig_render(r, config, &frame) == TYN_OK);
    CHECK_NEAR(rig_l1(r->scatter, plain, 3 * PIXELS), 0, 5e-4);
    CHECK_NEAR(rig_l1(r->scatter, original, 3 * PIXELS), 0, format == TYN_DEPTH_U16 ? 3e-2 : 5e-4);
    for (int i = 0; i < count; i++)
        guard_free(&map[i].texels);
}

static void test_shadows(void)
{
    static const char *const names[] = {"sun off the left", "lamp off the left", "bulb off the right"};
    TEST("every format and coding of shadow maps");
    for (int n = 0; n < 3; n++) {
        rig *r = rig_stock(names[n], W, H, MAP);
        for (int way = 0; way < RIG_WAYS - 1; way++) {
            static float original[3 * PIXELS];
            tyn_config config = rig_way_config(r, &rig_ways[way]);
            tyn_frame frame = rig_frame(r);
            config.steps = 40;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            memcpy(original, r->scatter, sizeof original);
            for (int c = 0; c < MAP_CASES; c++)
                for (int f = 0; f < (way < 2 ? 2 : 1); f++)
                    check_maps(r, &config, &map_cases[c], f ? TYN_DEPTH_U16 : TYN_DEPTH_F32, (c + way) & 1, original);
        }
        rig_free(r);
    }
}

/* Texels that are no depths: NaN and whatever lies beyond the far end are nothing, what lies before the near end is there. */
static void test_odd_texels(void)
{
    static const map_case *const cases[] = {&map_cases[0], &map_cases[1], &map_cases[4], &map_cases[6]};
    static recoded map;
    static const char *const names[] = {"sun off the left", "lamp off the left"};
    TEST("texels that are no depths");
    for (int n = 0; n < 2; n++) {
        rig *r = rig_stock(names[n], W, H, MAP);
        for (int c = 0; c < 4; c++)
            for (int way = 0; way < RIG_WAYS - 1; way++) {
                tyn_config config = rig_way_config(r, &rig_ways[way]);
                tyn_frame frame = rig_frame(r);
                tyn_light light = r->light[0];
                static float first[3 * PIXELS];
                float *row;
                int rising = cases[c]->coding != TYN_MAP_REVERSED; /* stored values grow with the distance */
                recode(&map, &r->light[0].shadow, cases[c], TYN_DEPTH_F32, 0);
                light.shadow = map.shadow;
                frame.lights = &light;
                for (int i = 0; i < MAP * MAP; i++) {
                    static const float odd[] = {(float)NAN, HUGE_VALF, -HUGE_VALF, 3e38f, -3e38f};
                    int k = (int)(test_random() % 40);
                    row = (float *)(void *)((char *)map.texels.image.pixels + map.texels.image.stride * (i / MAP));
                    if (k >= 5)
                        continue;
                    row[i % MAP] = odd[k];
                    map.same[i] = k == 0 || (k % 2 == 1) == rising ? 0 : 1;
                    if (cases[c]->coding == TYN_MAP_LINEAR && n == 1)
                        map.same[i] = 0; /* no distance is negative */
                }
                config.steps = 40;
                CHECK(rig_render(r, &config, &frame) == TYN_OK);
                memcpy(first, r->scatter, sizeof first);
                for (int i = 0; i < 3 * PIXELS; i++)
                    CHECK(first[i] >= 0 && first[i] < 1e6f);
                light.shadow = r->light[0].shadow;
                light.shadow.depth = map.same;
                CHECK(rig_render(r, &config, &frame) == TYN_OK);
                CHECK_NEAR(rig_l1(r->scatter, first, 3 * PIXELS), 0, 5e-4);
                guard_free(&map.texels);
            }
        rig_free(r);
    }
}

/* A bias moves shadows away from what casts them: by so much light as that much air gets, whatever the coding. */
static void test_bias(void)
{
    static const char *const names[] = {"sun off the left", "lamp off the left"};
    TEST("a depth bias in texels lets in light, the same in every coding");
    for (int n = 0; n < 2; n++) {
        rig *r = rig_stock(names[n], W, H, MAP);
        tyn_config config = rig_config(r, TYN_METHOD_MARCH, TYN_RAYS_WORDS);
        static recoded map;
        static float plain[3 * PIXELS];
        double last = -1;
        for (int bias = 0; bias <= 32; bias = bias ? 2 * bias : 1) {
            tyn_frame frame = rig_frame(r);
            tyn_light light = r->light[0];
            double sum = 0;
            light.shadow.bias = (float)bias;
            frame.lights = &light;
            CHECK(rig_render(r, &config, &frame) == TYN_OK);
            memcpy(plain, r->scatter, sizeof plain);
            for (int i = 0; i < 3 * PIXELS; i++)
                sum += (double)plain[i];
            CHECK(sum > last && (last < 0 || sum < 1.5 * last));
            last = sum;
            for (int c = 1; c < MAP_CASES; c++) {
                recode(&map, &r->light[0].shadow, &map_cases[c], TYN_DEPTH_F32, c & 1);
                light.shadow = map.shadow;
                light.shadow.bias = (float)bias;
                CHECK(rig_render(r, &config, &frame) == TYN_OK);
                CHECK_NEAR(rig_l1(r->scatter, plain, 3 * PIXELS), 0, 1e-3);
                guard_free(&map.texels);
            }
        }
        rig_free(r);
    }
}

/* Surfaces see the same shadows through any coding. */
static void test_surfaces(void)
{
    static const char *const names[] = {"sun off the left", "lamp off the left", "bulb off the right"};
    static recoded map[6];
    static float plain[3 * PIXELS], colour[3 * PIXELS], depth[PIXELS];
    TEST("surfaces under maps of every format and coding");
    for (int n = 0; n < 3; n++) {
        rig *r = rig_stock(names[n], W, H, MAP);
        tyn_raster_config config = {W, H, 0, 0, 0};
        tyn_raster *raster = NULL;
        tyn_light light = r->light[0];
        tyn_shadow more[5];
        tyn_surface surface;
        size_t bytes = 0;
        void *block;
        int count = light.more_count + 1;
        CHECK(tyn_raster_measure(&config, &bytes) == TYN_OK);
        block = rig_block(bytes);
        CHECK(block && tyn_raster_init(&raster, &config, block, bytes) == TYN_OK);
        memset(&surface, 0, sizeof surface);
        surface.camera = r->camera;
        surface.meshes = r->mesh;
        surface.mesh_count = r->meshes;
        surface.lights = &light;
        surface.light_count = 1;
        surface.colour.pixels = plain;
        surface.depth.pixels = depth;
        surface.colour.width = surface.depth.width = W;
        surface.colour.height = surface.depth.height = H;
        surface.colour.format = TYN_RGB_F32;
        surface.depth.format = TYN_DEPTH_F32;
        CHECK(tyn_raster_surface(raster, &surface) == TYN_OK);
        surface.colour.pixels = colour;
        for (int c = 0; c < MAP_CASES; c++)
            for (int f = 0; f < 2; f++) {
                for (int i = 0; i < count; i++)
                    recode(&map[i], i ? &r->light[0].more[i - 1] : &r->light[0].shadow, &map_cases[c],
                           f ? TYN_DEPTH_U16 : TYN_DEPTH_F32, c & 1);
                light.shadow = map[0].shadow;
                for (int i = 1; i < count; i++)
                    more[i - 1] = map[i].shadow;
                light.more = count > 1 ? more : NULL;
                CHECK(tyn_raster_surface(raster, &surface) == TYN_OK);
                CHECK_NEAR(rig_l1(colour, plain, 3 * PIXELS), 0, f ? 3e-2 : 1e-3);
                for (int i = 0; i < count; i++)
                    guard_free(&map[i].texels);
            }
        free(block);
        rig_free(r);
    }
}

/* ---- light and transmittance alone ----------------------------------------------------------------------------------- */

void test_door_maps(void)
{
    test_shadows();
    test_odd_texels();
    test_bias();
    test_surfaces();
}
