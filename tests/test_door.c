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

static double levels_of(tyn_format format)
{
    return format == TYN_DEPTH_U16 ? 65535.0 : format == TYN_DEPTH_U24 ? 16777215.0 : 0.0;
}

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
    return (a + n * (b - a)) * (levels_of(format) > 0 ? levels_of(format) : 1);
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
    n = (value / (levels_of(format) > 0 ? levels_of(format) : 1) - a) / (b - a);
    if (camera->kind == TYN_CAMERA_ORTHOGRAPHIC)
        return plane[0] + n * (plane[1] - plane[0]);
    return 1 / (1 / plane[0] + n * (1 / plane[1] - 1 / plane[0]));
}

/* Stores a value in pixel i; returns what it became. */
static double put(const tyn_image *image, int i, double value)
{
    char *row = (char *)image->pixels + image->stride * (i / W);
    double levels = levels_of(image->format);
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
            coding.sky = (float)levels_of(depth_formats[f]);
            check_odd(r, &coding, depth_formats[f], levels_of(depth_formats[f]), 1, &rig_ways[way]);
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

/* ---- shadow maps ----------------------------------------------------------------------------------------------------- */

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
    const double levels = levels_of(format);
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

/* The scatter of a rig from its maps recoded is that from the same depths in the first convention. */
static void check_maps(rig *r, const map_case *c, tyn_format format, int upside_down, const rig_way *way, double tolerance)
{
    static recoded map[6];
    static float plain[3 * PIXELS], original[3 * PIXELS];
    tyn_shadow more[5];
    tyn_config config = rig_way_config(r, way);
    tyn_frame frame = rig_frame(r);
    tyn_light light = r->light[0];
    int count = light.more_count + 1;
    config.steps = 40;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(original, r->scatter, sizeof original);
    frame.lights = &light;
    for (int i = 0; i < count; i++)
        recode(&map[i], i ? &r->light[0].more[i - 1] : &r->light[0].shadow, c, format, upside_down);
    light.shadow.depth = map[0].same;
    for (int i = 1; i < count; i++) {
        more[i - 1] = r->light[0].more[i - 1];
        more[i - 1].depth = map[i].same;
    }
    light.more = count > 1 ? more : NULL;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    memcpy(plain, r->scatter, sizeof plain);
    light.shadow = map[0].shadow;
    for (int i = 1; i < count; i++)
        more[i - 1] = map[i].shadow;
    CHECK(rig_render(r, &config, &frame) == TYN_OK);
    CHECK_NEAR(rig_l1(r->scatter, plain, 3 * PIXELS), 0, 5e-4);
    CHECK_NEAR(rig_l1(r->scatter, original, 3 * PIXELS), 0, tolerance);
    for (int i = 0; i < count; i++)
        guard_free(&map[i].texels);
}

static void test_shadows(void)
{
    static const char *const names[] = {"sun off the left", "lamp off the left", "bulb off the right"};
    TEST("every format and coding of shadow maps");
    for (int n = 0; n < 3; n++) {
        rig *r = rig_stock(names[n], W, H, MAP);
        for (int c = 0; c < MAP_CASES; c++)
            for (int f = 0; f < 2; f++)
                for (int way = 0; way < (f ? 2 : RIG_WAYS - 1); way++)
                    check_maps(r, &map_cases[c], f ? TYN_DEPTH_U16 : TYN_DEPTH_F32, (c + way) & 1, &rig_ways[way],
                               f ? 3e-2 : 5e-4);
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

static void check_windows(rig *r, tyn_shadow *maps, int count, double tolerance)
{
    static float one[3 * PIXELS];
    for (int way = 0; way < RIG_WAYS - 1; way++) {
        tyn_config config = rig_way_config(r, &rig_ways[way]);
        tyn_frame frame = rig_frame(r);
        tyn_light light = r->light[0];
        double most = 0, worst = 0;
        config.steps = 40;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        memcpy(one, r->scatter, sizeof one);
        config.maps = count;
        light.shadow = maps[0];
        light.more = maps + 1;
        light.more_count = count - 1;
        frame.lights = &light;
        CHECK(rig_render(r, &config, &frame) == TYN_OK);
        for (int i = 0; i < 3 * PIXELS; i++) {
            most = fmax(most, (double)one[i]);
            worst = fmax(worst, fabs((double)one[i] - (double)r->scatter[i]));
        }
        /* ED10's lines are not stretched: at a lamp in view they have many samples to a pixel, and which of these rays cross so
         * few columns that they are walked hangs on how many pieces the columns are in. One pixel, beside the lamp. */
        /* And in what order columns come hangs on the pieces: prefiltered sums round in other places. */
        CHECK_NEAR(worst / most, 0,
                   config.gather == TYN_GATHER_ED10          ? 0.04
                   : config.method >= TYN_METHOD_PREFILTERED ? 2 * tolerance
                                                             : tolerance);
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
    CHECK(n == 48);
    rig_free(r);
}

void test_door(void)
{
    test_depths();
    test_odd();
    test_alone();
    test_shadows();
    test_odd_texels();
    test_windows();
    test_cascades();
    test_bias();
    test_surfaces();
    test_transmittance();
    test_statuses();
}
