/* lean.c - a library without its parts (TYN_LEAVE_OUT=63): what is left out is refused, by the status that tyndall.h says, and
 * what is left goes on. tests/ports.sh builds it. */
#include <stdio.h>
#include <string.h>

#include "tyndall.h"

enum { W = 32, H = 24, MAP = 16 };

static int passed, failed;
static float depth[W * H], map[MAP * MAP];
static uint8_t target[4 * W * H], texel[3];
static union {
    uint64_t align[8];
    uint8_t bytes[1 << 18];
} block;

static void expect(const char *what, tyn_status is, tyn_status wanted)
{
    if (is == wanted) {
        passed++;
        return;
    }
    failed++;
    printf("FAILED %s: %s, not %s\n", what, tyn_status_name(is), tyn_status_name(wanted));
}

static tyn_config plain(void)
{
    tyn_config c;
    memset(&c, 0, sizeof c);
    c.width = W;
    c.height = H;
    c.shadow_size = MAP;
    return c;
}

static void configs(void)
{
    size_t bytes;
    tyn_config c = plain();
    expect("a plain config", tyn_measure(&c, &bytes), TYN_OK);
    for (int32_t m = TYN_METHOD_EPIPOLAR; m <= TYN_METHOD_HYBRID; m++) {
        c = plain();
        c.method = (tyn_method)m;
        expect("methods", tyn_measure(&c, &bytes),
               m == TYN_METHOD_EPIPOLAR || m == TYN_METHOD_MARCH || m == TYN_METHOD_NONE ? TYN_OK : TYN_E_CONFIG);
    }
    for (int32_t r = TYN_RAYS_WORDS; r <= TYN_RAYS_COLUMNS; r++) {
        c = plain();
        c.rays = (tyn_rays)r;
        expect("rays", tyn_measure(&c, &bytes), r == TYN_RAYS_WORDS ? TYN_OK : TYN_E_CONFIG);
    }
    for (int32_t g = TYN_GATHER_SHEAR; g <= TYN_GATHER_ED10; g++) {
        c = plain();
        c.gather = (tyn_gather)g;
        expect("gathers", tyn_measure(&c, &bytes), g == TYN_GATHER_SHEAR ? TYN_OK : TYN_E_CONFIG);
    }
    c = plain();
    c.downscale = 2;
    expect("downscale", tyn_measure(&c, &bytes), TYN_E_CONFIG);
    c = plain();
    c.textured = 1;
    expect("textured", tyn_measure(&c, &bytes), TYN_E_CONFIG);
}

static void frames(void)
{
    const float eye[3] = {0, 0, 0}, at[3] = {0, 0, -1}, up[3] = {0, 1, 0};
    const tyn_image image = {texel, 1, 1, 0, TYN_RGB8_LINEAR};
    const tyn_query_point point = {1, 1, 1};
    const tyn_medium air = {{0.1f, 0.1f, 0.1f}, {0, 0, 0}, TYN_PHASE_ISOTROPIC, 0};
    tyn_query_result result;
    tyn_config c = plain();
    tyn_context *context;
    tyn_frame f;
    tyn_light sun, l;
    memset(&f, 0, sizeof f);
    memset(&sun, 0, sizeof sun);
    sun.direction[2] = 1;
    sun.colour[0] = sun.colour[1] = sun.colour[2] = 1;
    f.depth.pixels = depth;
    f.depth.format = TYN_DEPTH_F32;
    f.target.pixels = target;
    f.target.format = TYN_RGBA8_SRGB;
    f.depth.width = f.target.width = W;
    f.depth.height = f.target.height = H;
    f.media = &air;
    f.medium_count = 1;
    f.lights = &l;
    f.light_count = 1;
    expect("camera", tyn_camera_look(&f.camera, eye, at, up, 1, 0.1f, 10, W, H), TYN_OK);
    expect("shadow", tyn_shadow_fit(&sun, &f.camera, NULL, NULL), TYN_OK);
    sun.shadow.depth = map;
    sun.shadow.size = MAP;
    expect("init", tyn_init(&context, &c, (uint8_t *)&block + (64 - (uintptr_t)&block % 64) % 64, sizeof block - 64), TYN_OK);
    l = sun;
    expect("a sun", tyn_render(context, &f), TYN_OK);
    l.kind = TYN_LIGHT_POINT;
    expect("a bulb", tyn_render(context, &f), TYN_E_LIGHT);
    expect("a bulb asked for", tyn_query(&f, &point, &result, 1), TYN_E_LIGHT);
    l.kind = TYN_LIGHT_SPOT;
    l.angle = 1;
    expect("a spot", tyn_render(context, &f), TYN_E_LIGHT);
    l = sun;
    l.shadow.tint = &image;
    expect("a tint", tyn_render(context, &f), TYN_E_LIMIT);
    expect("a tint asked for", tyn_query(&f, &point, &result, 1), TYN_E_LIMIT);
    l = sun;
    l.textures = &image;
    l.texture_count = 1;
    expect("a gobo", tyn_render(context, &f), TYN_E_LIMIT);
    l = sun;
    for (int32_t d = TYN_DEBUG_LINES; d <= TYN_DEBUG_BASIS; d++) {
        f.debug = (tyn_debug)d;
        expect("debug views", tyn_render(context, &f), TYN_E_DISPLAY);
    }
}

int main(void)
{
    configs();
    frames();
    printf("%d passed, %d failed\n", passed, failed);
    return failed > 0;
}
