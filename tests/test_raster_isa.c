/* test_raster_isa.c - the rasterizer by every ISA: the same bytes as by scalar, for every kind of light, map and texture that
 * kernels know or leave to scalar code, and images narrower than a vector. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "rig.h"
#include "test.h"

#define SOUP 160 /* triangles of a mesh */
#define MESHES 8
#define MAP 48
#define LIGHTS 10
#define MAPS 8

typedef struct world {
    float position[MESHES][SOUP * 9], texcoord[MESHES][SOUP * 6];
    uint32_t index[SOUP * 3];
    tyn_mesh meshes[MESHES];
    tyn_image textures[MESHES], mask, slide;
    void *pixels[MESHES + 2];
    tyn_light lights[LIGHTS];
    tyn_shadow more[LIGHTS][MAPS];
    float maps[LIGHTS][MAPS][MAP * MAP];
    uint16_t words[MAP * MAP];
    int32_t light_count;
    tyn_medium haze;
    tyn_camera camera;
} world;

static float between(float low, float high)
{
    return test_random_float(low, high);
}

/* A texture of any format and size, its first row on top or at the bottom. */
static void *make_texture(tyn_image *image, tyn_format format, int32_t width, int32_t height)
{
    const int32_t row = width * tyn_format_bytes(format);
    const ptrdiff_t stride = (row + 3) / 4 * 4 + 4 * (ptrdiff_t)(test_random() % 3);
    uint8_t *bytes = malloc((size_t)(stride * height));
    if (!bytes)
        abort();
    for (ptrdiff_t i = 0; i < stride * height; i++)
        bytes[i] = (uint8_t)test_random();
    if (format == TYN_RGB_F32)
        for (ptrdiff_t i = 0; i < stride * height / 4; i++)
            ((float *)(void *)bytes)[i] = i % 19 ? between(0, 2) : i % 38 ? NAN : -INFINITY;
    image->width = width;
    image->height = height;
    image->format = format;
    image->stride = test_random() % 2 ? stride : -stride;
    image->pixels = image->stride > 0 ? bytes : bytes + stride * (height - 1);
    return bytes;
}

static void make_meshes(world *w)
{
    static const tyn_format formats[] = {TYN_FORMAT_NONE, TYN_RGB8_LINEAR, TYN_RGB16_LINEAR, TYN_RGB_F32,
                                         TYN_RGB8_LINEAR, TYN_RGB8_LINEAR, TYN_RGB16_LINEAR, TYN_RGB8_LINEAR};
    static const int32_t sizes[][2] = {{0, 0}, {33, 17}, {16, 31}, {9, 8}, {1, 1}, {1, 7}, {1, 1}, {5, 1}};
    for (uint32_t i = 0; i < SOUP * 3; i++)
        w->index[i] = i;
    w->pixels[MESHES] = make_texture(&w->mask, TYN_MASK8, 7, 9);
    w->pixels[MESHES + 1] = make_texture(&w->slide, TYN_RGB8_LINEAR, 13, 11);
    for (int m = 0; m < MESHES; m++) {
        tyn_mesh *mesh = &w->meshes[m];
        for (int i = 0; i < SOUP; i++) {
            const float x = between(-6, 6), y = between(-4, 4), z = between(-14, -1), size = i % 9 ? 1.5f : 9.0f;
            for (int k = 0; k < 9; k++)
                w->position[m][9 * i + k] = (k % 3 == 0 ? x : k % 3 == 1 ? y : z) + between(-size, size);
            for (int k = 0; k < 6; k++)
                w->texcoord[m][6 * i + k] = i % 23 ? between(-3, 3) : i % 2 ? 1e9f : NAN;
        }
        mesh->positions = w->position[m];
        mesh->texcoords = w->texcoord[m];
        mesh->indices = w->index;
        mesh->vertices = SOUP * 3;
        mesh->triangles = SOUP;
        for (int c = 0; c < 3; c++)
            mesh->material.albedo[c] = between(0, 1);
        if (m > 0) {
            w->pixels[m] = make_texture(&w->textures[m], formats[m], sizes[m][0], sizes[m][1]);
            mesh->material.texture = &w->textures[m];
        }
        mesh->material.mask = m == 3 ? &w->mask : NULL;
    }
}

static tyn_light sun(void)
{
    tyn_light l;
    float length;
    memset(&l, 0, sizeof l);
    for (int c = 0; c < 3; c++) {
        l.direction[c] = between(-1, 1);
        l.colour[c] = between(0, 5);
    }
    l.direction[1] -= 1.5f;
    length = sqrtf(l.direction[0] * l.direction[0] + l.direction[1] * l.direction[1] + l.direction[2] * l.direction[2]);
    for (int c = 0; c < 3; c++)
        l.direction[c] /= length;
    return l;
}

static tyn_light lamp(tyn_light_kind kind)
{
    tyn_light l = sun();
    l.kind = kind;
    for (int c = 0; c < 3; c++) {
        l.position[c] = between(-3, 3) - (c == 2 ? 7.0f : 0.0f);
        l.colour[c] *= 20.0f;
    }
    l.angle = kind == TYN_LIGHT_SPOT ? between(0.5f, 2.5f) : 0.0f;
    l.up[0] = 1;
    return l;
}

static void fit(world *w, tyn_light *l, float *map)
{
    CHECK(tyn_shadow_fit(l, &w->camera, NULL, NULL) == TYN_OK);
    l->shadow.size = MAP;
    l->shadow.depth = map;
}

/* Kinds of lighting. */
static void make_lights(world *w, int kind)
{
    w->light_count = 2;
    for (int i = 0; i < LIGHTS; i++)
        for (int k = 0; k < MAPS; k++)
            for (int p = 0; p < MAP * MAP; p++)
                w->maps[i][k][p] = between(-0.5f, 1);
    w->lights[0] = sun();
    w->lights[1] = lamp(TYN_LIGHT_SPOT);
    if (kind == 0) /* no maps */
        w->light_count = 1;
    else if (kind == 1) { /* a sun with cascades */
        fit(w, &w->lights[0], w->maps[0][0]);
        w->light_count = 1;
        for (int k = 0; k < 3; k++) {
            w->more[0][k] = w->lights[0].shadow;
            for (int c = 0; c < 12; c++) /* the middle part is larger in the first ones */
                w->more[0][k].matrix[c] *= c < 8 ? 0.7f - 0.2f * (float)k : 1.0f;
            w->more[0][k].depth = k == 1 ? NULL : w->maps[0][k + 1];
            w->more[0][k].size = k == 1 ? 0 : MAP;
        }
        w->lights[0].more = w->more[0];
        w->lights[0].more_count = 3;
    } else if (kind == 2) { /* a spot with a map, and one without */
        fit(w, &w->lights[1], w->maps[1][0]);
        w->lights[0] = lamp(TYN_LIGHT_SPOT);
    } else if (kind == 3) { /* a cube of maps */
        tyn_light *l = &w->lights[0];
        tyn_shadow faces[6];
        *l = lamp(TYN_LIGHT_POINT);
        memset(faces, 0, sizeof faces);
        CHECK(tyn_shadow_fit_cube(faces, l->position, 20) == TYN_OK);
        for (int k = 0; k < 6; k++) {
            faces[k].size = MAP;
            faces[k].depth = w->maps[0][k];
        }
        l->shadow = faces[0];
        memcpy(w->more[0], faces + 1, 5 * sizeof *faces);
        l->more = w->more[0];
        l->more_count = 5;
    } else if (kind == 4) { /* what kernels leave alone: slides, tints, maps of words, distances */
        w->light_count = 4;
        fit(w, &w->lights[0], w->maps[0][0]);
        w->lights[0].shadow.tint = &w->slide;
        w->lights[1].textures = &w->slide;
        w->lights[1].texture_count = 1;
        w->lights[2] = sun();
        fit(w, &w->lights[2], NULL);
        for (int p = 0; p < MAP * MAP; p++)
            w->words[p] = (uint16_t)test_random();
        w->lights[2].shadow.depth = w->words;
        w->lights[2].shadow.format = TYN_DEPTH_U16;
        w->lights[3] = lamp(TYN_LIGHT_SPOT);
        fit(w, &w->lights[3], w->maps[3][0]);
        w->lights[3].shadow.coding = TYN_MAP_LINEAR;
        w->lights[3].shadow.scale = 12;
    } else { /* more maps than a face remembers slopes of */
        w->light_count = LIGHTS;
        for (int i = 0; i < LIGHTS; i++) {
            w->lights[i] = sun();
            fit(w, &w->lights[i], w->maps[i][0]);
            if (i % 2) { /* projected, bottom row first */
                w->lights[i].shadow.coding = TYN_MAP_PROJECTED;
                w->lights[i].shadow.at_near = 0.75f;
                w->lights[i].shadow.at_far = -0.5f;
                w->lights[i].shadow.depth = w->maps[i][0] + MAP * (MAP - 1);
                w->lights[i].shadow.stride = -(ptrdiff_t)(MAP * sizeof(float));
            }
        }
    }
}

#define LIGHTINGS 6

/* Draws by one ISA into images of its own, and a map of the meshes. */
typedef struct drawn {
    guard colour, depth;
    float map[MAP * MAP + 3];
    tyn_raster_stats stats;
} drawn;

static void draw(const world *w, int32_t isa, int32_t width, int32_t height, int with_colour, drawn *d)
{
    tyn_raster_config config;
    tyn_raster *raster;
    tyn_surface f;
    size_t bytes;
    void *block;
    memset(&config, 0, sizeof config);
    config.width = config.height = 256;
    config.batch = 64;
    config.isa = isa;
    CHECK(tyn_raster_measure(&config, &bytes) == TYN_OK);
    block = rig_block(bytes);
    memset(block, 0xa5, bytes);
    CHECK(tyn_raster_init(&raster, &config, block, bytes) == TYN_OK);
    memset(&f, 0, sizeof f);
    f.camera = w->camera;
    f.meshes = w->meshes;
    f.mesh_count = MESHES;
    f.lights = w->lights;
    f.light_count = w->light_count;
    f.media = &w->haze;
    f.medium_count = 1;
    f.ambient[0] = f.ambient[2] = 0.4f;
    f.background[1] = 0.6f;
    d->colour = guard_new(width, height, TYN_RGB_F32, width % 3);
    d->depth = guard_new(width, height, TYN_DEPTH_F32, width % 2);
    f.depth = d->depth.image;
    if (with_colour)
        f.colour = d->colour.image;
    f.stats = &d->stats;
    CHECK(tyn_raster_surface(raster, &f) == TYN_OK);
    memset(d->map, 0x5a, sizeof d->map);
    {
        tyn_light l = w->lights[0];
        CHECK(tyn_shadow_fit(&l, &w->camera, NULL, NULL) == TYN_OK || l.kind == TYN_LIGHT_POINT);
        l.shadow.depth = NULL;
        l.shadow.tint = NULL;
        l.shadow.size = 1 + (width + height) % MAP;
        CHECK(tyn_raster_shadow(raster, &l.shadow, d->map, w->meshes, MESHES, NULL, NULL, NULL, NULL) == TYN_OK);
    }
    free(block);
}

static int same(const tyn_image *a, const tyn_image *b)
{
    int equal = 1;
    for (int32_t y = 0; y < a->height; y++)
        equal &= memcmp((uint8_t *)a->pixels + a->stride * y, (uint8_t *)b->pixels + b->stride * y,
                        (size_t)a->width * (size_t)tyn_format_bytes(a->format)) == 0;
    return equal;
}

static void compare(const world *w, int32_t isa, int32_t width, int32_t height)
{
    for (int with_colour = 0; with_colour < 2; with_colour++) {
        drawn a, b;
        draw(w, TYN_ISA_SCALAR, width, height, with_colour, &a);
        draw(w, isa, width, height, with_colour, &b);
        CHECK(same(&a.depth.image, &b.depth.image));
        CHECK(!with_colour || same(&a.colour.image, &b.colour.image));
        CHECK(memcmp(&a.stats, &b.stats, sizeof a.stats) == 0 && a.stats.pixels > 0);
        CHECK(memcmp(a.map, b.map, sizeof a.map) == 0);
        CHECK(guard_intact(&b.colour) && guard_intact(&b.depth));
        guard_free(&a.colour);
        guard_free(&a.depth);
        guard_free(&b.colour);
        guard_free(&b.depth);
    }
}

static world *make_world(void)
{
    static const float eye[3] = {0, 0, 2}, target[3] = {0.3f, 0.2f, -5}, up[3] = {0, 1, 0};
    world *w = calloc(1, sizeof *w);
    make_meshes(w);
    for (int c = 0; c < 3; c++)
        w->haze.scatter[c] = 0.02f * (float)(c + 1);
    CHECK(tyn_camera_look(&w->camera, eye, target, up, 1.2f, 0.4f, 30, 4, 3) == TYN_OK);
    return w;
}

static void free_world(world *w)
{
    for (int i = 0; i < MESHES + 2; i++)
        free(w->pixels[i]);
    free(w);
}

static void test_isa(int32_t isa)
{
    static const int32_t sizes[][2] = {{96, 70}, {1, 40}, {3, 40}, {15, 33}, {16, 9}, {17, 20}, {37, 41}, {130, 5}};
    static char name[60];
    world *w;
    strcpy(name, "raster: ");
    TEST(strcat(strcat(name, tyn_isa_name(isa)), " gives the bytes of scalar"));
    if (!(tyn_isa_available() & isa)) {
        test_skip(tyn_isa_built() & isa ? "this machine lacks it" : "not built for this machine");
        return;
    }
    w = make_world();
    for (int lighting = 0; lighting < LIGHTINGS; lighting++) {
        make_lights(w, lighting);
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
            compare(w, isa, sizes[i][0], sizes[i][1]);
    }
    free_world(w);
}

void test_raster_isa(void)
{
    for (int32_t isa = TYN_ISA_SSE2; isa <= TYN_ISA_WASM; isa *= 2)
        test_isa(isa);
}
