/* fuzz_fit.c - the functions that make cameras, media and matrices: with any numbers they refuse and change nothing, or give
 * what the library takes. An input is what is changed in plain arguments. */
#include "fuzz.h"

#include <float.h>
#include <string.h>

enum { W = 8, H = 6, CORNERS = 12 };

typedef struct given {
    fuzz_bytes in;
    uint32_t flags;
    float eye[3], at[3], up[3], fov, near_depth, far_depth, view[16], projection[16];
    int32_t size[2];
    float scale, weather[3];
    tyn_camera camera;
    tyn_light light;
    tyn_shadow maps[TYN_MAX_MAPS];
    float low[3], high[3], reach, distance, lambda, from;
    int32_t count, snapped;
    float corners[3 * CORNERS], depth[W * H];
    uint32_t indices[CORNERS];
    tyn_mesh mesh;
    tyn_image image;
} given;

static tyn_camera plain_camera; /* what does not take a camera is tried with this one */

static void plain(given *g)
{
    static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    static const float perspective[16] = {1, 0, 0, 0, 0, 1.3f, 0, 0, 0, 0, -1, -0.2f, 0, 0, -1, 0};
    uint32_t random = 77;
    g->eye[2] = 4;
    g->up[1] = 1;
    g->fov = 1;
    g->near_depth = 0.1f;
    g->far_depth = 40;
    memcpy(g->view, identity, sizeof identity);
    memcpy(g->projection, perspective, sizeof perspective);
    g->size[0] = 4;
    g->size[1] = 3;
    g->scale = g->weather[0] = g->weather[1] = g->weather[2] = 1;
    tyn_camera_look(&g->camera, g->eye, g->at, g->up, 1, 0.1f, 40, 4, 3);
    plain_camera = g->camera;
    g->light.direction[1] = -0.8f;
    g->light.direction[2] = -0.6f;
    g->light.position[1] = 4;
    g->light.angle = 1;
    g->light.shadow.size = 64;
    for (int i = 0; i < 3; i++) {
        g->light.colour[i] = 1;
        g->low[i] = -5;
        g->high[i] = 5;
    }
    for (int i = 0; i < TYN_MAX_MAPS; i++)
        g->maps[i].size = 64;
    g->reach = 30;
    g->lambda = 0.5f;
    g->count = 3;
    fuzz_fill(g->corners, sizeof g->corners, 4, 3, &random);
    for (int i = 0; i < 3 * CORNERS; i++)
        g->corners[i] = 8 * g->corners[i] - 4;
    for (uint32_t i = 0; i < CORNERS; i++)
        g->indices[i] = i;
    g->mesh.positions = g->corners;
    g->mesh.indices = g->indices;
    g->mesh.vertices = CORNERS;
    g->mesh.triangles = CORNERS / 3;
    for (int i = 0; i < W * H; i++)
        g->depth[i] = 3 + (float)(i % 9);
    g->image.pixels = g->depth;
    g->image.width = W;
    g->image.height = H;
    g->image.format = TYN_DEPTH_F32;
}

static void change(given *g)
{
    static fuzz_slots s;
    tyn_camera *c = &g->camera;
    s.count = 0;
    fuzz_floats(&s, g->eye, 3);
    fuzz_floats(&s, g->at, 3);
    fuzz_floats(&s, g->up, 3);
    fuzz_floats(&s, &g->fov, 1);
    fuzz_floats(&s, &g->near_depth, 1);
    fuzz_floats(&s, &g->far_depth, 1);
    fuzz_int_slots(&s, g->size, 2);
    fuzz_floats(&s, g->view, 16);
    fuzz_floats(&s, g->projection, 16);
    fuzz_floats(&s, &g->scale, 1);
    fuzz_floats(&s, g->weather, 3);
    fuzz_int_slots(&s, &c->kind, 1);
    fuzz_floats(&s, c->position, 3);
    fuzz_floats(&s, c->right, 3);
    fuzz_floats(&s, c->up, 3);
    fuzz_floats(&s, c->forward, 3);
    fuzz_floats(&s, &c->left_edge, 1);
    fuzz_floats(&s, &c->right_edge, 1);
    fuzz_floats(&s, &c->bottom_edge, 1);
    fuzz_floats(&s, &c->top_edge, 1);
    fuzz_floats(&s, &c->near_depth, 1);
    fuzz_floats(&s, &c->far_depth, 1);
    fuzz_int_slots(&s, &g->light.kind, 1);
    fuzz_floats(&s, g->light.position, 3);
    fuzz_floats(&s, g->light.direction, 3);
    fuzz_floats(&s, g->light.colour, 3);
    fuzz_floats(&s, &g->light.angle, 1);
    fuzz_int_slots(&s, &g->light.shadow.size, 1);
    fuzz_int_slots(&s, &g->light.shadow.height, 1);
    for (int i = 0; i < TYN_MAX_MAPS; i++)
        fuzz_int_slots(&s, &g->maps[i].size, 1);
    fuzz_floats(&s, g->low, 3);
    fuzz_floats(&s, g->high, 3);
    fuzz_floats(&s, &g->reach, 1);
    fuzz_floats(&s, &g->distance, 1);
    fuzz_floats(&s, &g->lambda, 1);
    fuzz_floats(&s, &g->from, 1);
    fuzz_int_slots(&s, &g->count, 1);
    fuzz_int_slots(&s, &g->snapped, 1);
    fuzz_floats(&s, g->corners, 3 * CORNERS);
    fuzz_int_slots(&s, g->indices, CORNERS);
    fuzz_floats(&s, g->depth, W * H);
    fuzz_edit(&g->in, &s);
}

static int all_finite(const float *v, int count)
{
    for (int i = 0; i < count; i++)
        if (!(v[i] >= -FLT_MAX && v[i] <= FLT_MAX))
            return 0;
    return 1;
}

/* The camera, the media and a light with this map are good for a ray. */
static void use(const tyn_camera *camera, const tyn_medium *media, int32_t medium_count, const tyn_light *light,
                const tyn_shadow *map)
{
    static const float texels[4] = {0.5f, 0.2f, 0, 0.9f};
    const tyn_query_point point = {3.5f, 2.5f, 20};
    tyn_query_result result;
    tyn_light with;
    tyn_frame f;
    memset(&f, 0, sizeof f);
    f.camera = *camera;
    f.depth.width = W;
    f.depth.height = H;
    f.media = media;
    f.medium_count = medium_count;
    if (light) {
        with = *light;
        memcpy(with.shadow.matrix, map->matrix, sizeof map->matrix);
        with.shadow.depth = texels;
        with.shadow.size = with.shadow.height = 2;
        f.lights = &with;
        f.light_count = 1;
    }
    FUZZ_CHECK(tyn_query(&f, &point, &result, 1) == TYN_OK);
    FUZZ_CHECK(all_finite(result.scatter, 3) && all_finite(result.transmittance, 3));
}

static void cameras(given *g)
{
    tyn_camera camera, before;
    memset(&camera, 0x5a, sizeof camera);
    before = camera;
    if (tyn_camera_look(&camera, g->eye, g->at, g->up, g->fov, g->near_depth, g->far_depth, g->size[0], g->size[1]) == TYN_OK)
        use(&camera, NULL, 0, NULL, NULL);
    else
        FUZZ_CHECK(memcmp(&camera, &before, sizeof camera) == 0);
    camera = before;
    if (tyn_camera_from_matrices(&camera, g->view, g->projection, g->near_depth, g->far_depth) == TYN_OK)
        use(&camera, NULL, 0, NULL, NULL);
    else
        FUZZ_CHECK(memcmp(&camera, &before, sizeof camera) == 0);
}

static void media(given *g)
{
    tyn_medium made[2], before[2];
    memset(made, 0x5a, sizeof made);
    memcpy(before, made, sizeof made);
    if (tyn_medium_air(made, g->scale) == TYN_OK)
        use(&plain_camera, made, 2, NULL, NULL);
    else
        FUZZ_CHECK(memcmp(made, before, sizeof made) == 0);
    memcpy(made, before, sizeof made);
    if (tyn_medium_weather(made, g->weather[0], g->weather[1], g->weather[2]) == TYN_OK)
        use(&plain_camera, made, 2, NULL, NULL);
    else
        FUZZ_CHECK(memcmp(made, before, sizeof made) == 0);
}

/* Nothing but matrices has changed, and they only with TYN_OK. */
static void check_maps(const given *g, tyn_shadow *maps, const tyn_shadow *before, int32_t count, tyn_status status,
                       const tyn_light *light)
{
    static const tyn_medium medium = {{0.1f, 0.1f, 0.1f}, {0, 0, 0}, TYN_PHASE_ISOTROPIC, 0};
    for (int32_t i = 0; i < count && status == TYN_OK; i++) {
        FUZZ_CHECK(all_finite(maps[i].matrix, 16));
        use(&g->camera, &medium, 1, light, &maps[i]);
        memcpy(maps[i].matrix, before[i].matrix, sizeof maps[i].matrix);
    }
    FUZZ_CHECK(memcmp(maps, before, TYN_MAX_MAPS * sizeof *maps) == 0);
}

static void one_map(given *g, int which)
{
    tyn_shadow maps[TYN_MAX_MAPS], before[TYN_MAX_MAPS];
    tyn_light light = g->light;
    const int bounds = !(g->flags & 8);
    tyn_status status;
    memset(maps, 0, sizeof maps);
    if (which == 0)
        status = tyn_shadow_fit(&light, &g->camera, bounds ? g->low : NULL, bounds ? g->high : NULL);
    else
        status = tyn_shadow_fit_scene(&light, &g->camera, g->flags & 16 ? NULL : &g->image, &g->mesh, bounds);
    maps[0] = light.shadow;
    memcpy(before, maps, sizeof maps);
    before[0] = g->light.shadow;
    check_maps(g, maps, before, 1, status, &g->light);
    memcpy(light.shadow.matrix, g->light.shadow.matrix, sizeof light.shadow.matrix);
    FUZZ_CHECK(memcmp(&light, &g->light, sizeof light) == 0);
}

static void many_maps(given *g, int which)
{
    tyn_shadow maps[TYN_MAX_MAPS];
    tyn_light light = g->light;
    const int bounds = !(g->flags & 8);
    int32_t count = g->count;
    tyn_status status;
    float weight;
    memcpy(maps, g->maps, sizeof maps);
    switch (which) {
    case 2:
        status = tyn_shadow_fit_cube(maps, g->light.position, g->reach);
        g->camera = plain_camera;
        memset(light.colour, 0, sizeof light.colour);
        light.kind = TYN_LIGHT_POINT;
        count = 6;
        break;
    case 3:
        status = tyn_shadow_snap(maps, &g->light, &g->camera, g->distance);
        count = 1;
        break;
    case 4:
        status = tyn_shadow_fit_cascades(maps, count, &g->light, &g->camera, bounds ? g->low : NULL, bounds ? g->high : NULL,
                                         g->distance, g->lambda, g->snapped);
        break;
    default:
        weight = tyn_shadow_rectifiable(&g->light, &g->camera);
        FUZZ_CHECK(weight >= 0 && weight <= 1);
        status = tyn_shadow_fit_rectified(maps, count, &g->light, &g->camera, g->from, g->distance);
        break;
    }
    check_maps(g, maps, g->maps, count, status, &light);
}

void fuzz_fit(const uint8_t *data, size_t size)
{
    static given g;
    uint32_t which;
    memset(&g, 0, sizeof g);
    g.in.at = data;
    g.in.left = size;
    plain(&g);
    g.flags = fuzz_byte(&g.in);
    change(&g);
    which = g.flags & 7;
    if (which < 2)
        one_map(&g, (int)which);
    else if (which < 6)
        many_maps(&g, (int)which);
    else if (which == 6)
        cameras(&g);
    else
        media(&g);
}
