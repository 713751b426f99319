/* door.c - see door.h */
#include "door.h"

#include "base.h"
#include "check.h"

/* ---- scene depth --------------------------------------------------------------------------------------------------- */

/* What a stored integer of all ones stands for where values are normalised. */
static float full_scale(tyn_format format)
{
    return format == TYN_DEPTH_U16 ? 65535.0f : format == TYN_DEPTH_U24 ? 16777215.0f : 1.0f;
}

static void planes(const tyn_depth_coding *coding, const tyn_camera *camera, float depth[2])
{
    depth[0] = coding->near_depth == 0.0f ? camera->near_depth : coding->near_depth;
    depth[1] = coding->far_depth == 0.0f ? camera->far_depth : coding->far_depth;
}

tyn_status tyni_door_check(const tyn_depth_coding *coding, const tyn_camera *camera)
{
    float ends[2], depth[2];
    if ((uint32_t)coding->kind > (uint32_t)TYN_CODING_DISTANCE)
        return TYN_E_IMAGE;
    if (!(coding->scale >= 0.0f) || !tyni_finite(coding->scale))
        return TYN_E_IMAGE;
    if (coding->kind != TYN_CODING_PROJECTED)
        return TYN_OK;
    planes(coding, camera, depth);
    /* an infinite far plane is one under a perspective: 1 / far is 0 */
    if (camera->kind == TYN_CAMERA_ORTHOGRAPHIC && !tyni_finite(depth[1]))
        return TYN_E_IMAGE;
    if (!tyni_check_range(coding->at_near, coding->at_far, ends) || !(depth[0] >= 1e-20f) || !(depth[0] < depth[1]))
        return TYN_E_IMAGE;
    return TYN_OK;
}

/* Everything is measured from the far end, where the step from one stored value to the next is a long way: what is stored
 * there is subtracted before anything else rounds. */
static void open_projected(tyni_door *door, const tyn_depth_coding *coding, const tyn_camera *camera)
{
    float ends[2], depth[2], unit = full_scale(door->image->format);
    (void)tyni_check_range(coding->at_near, coding->at_far, ends);
    planes(coding, camera, depth);
    if (door->parallel) {
        door->base = depth[1];
        door->step = (depth[0] - depth[1]) / (ends[1] - ends[0]);
    } else {
        door->base = 1.0f / depth[1];
        door->step = (1.0f / depth[0] - door->base) / (ends[1] - ends[0]);
    }
    door->end = ends[1] * unit;
    door->step /= unit;
}

void tyni_door_open(tyni_door *door, const tyn_image *image, const tyn_depth_coding *coding, const tyn_camera *camera)
{
    tyni_vec3 right = tyni_vec_load(camera->right), up = tyni_vec_load(camera->up);
    memset(door, 0, sizeof *door);
    door->image = image;
    door->stride = tyni_image_stride(image);
    door->kind = coding->kind;
    door->scale = coding->scale == 0.0f ? 1.0f : coding->scale;
    door->marked = coding->has_sky;
    door->sky = coding->sky;
    door->far_depth = camera->far_depth;
    door->parallel = camera->kind == TYN_CAMERA_ORTHOGRAPHIC;
    door->plain = image->format == TYN_DEPTH_F32 && door->kind == TYN_CODING_VIEW && door->scale == 1.0f && !door->marked;
    if (door->kind == TYN_CODING_PROJECTED)
        open_projected(door, coding, camera);
    door->dx = tyni_vec_scale(right, (camera->right_edge - camera->left_edge) / (float)image->width);
    door->dy = tyni_vec_scale(up, (camera->bottom_edge - camera->top_edge) / (float)image->height);
    door->origin = tyni_vec_mad(tyni_vec_mad(tyni_vec_load(camera->forward), camera->left_edge, right), camera->top_edge, up);
}

static float stored(const tyni_door *door, int32_t x, int32_t y)
{
    const uint8_t *row = (const uint8_t *)door->image->pixels + door->stride * (ptrdiff_t)y;
    if (door->image->format == TYN_DEPTH_U16)
        return (float)((const uint16_t *)(const void *)row)[x];
    if (door->image->format == TYN_DEPTH_U24)
        return (float)(((const uint32_t *)(const void *)row)[x] & 0xffffffu);
    return ((const float *)(const void *)row)[x];
}

/* Metres along the forward axis per metre along a pixel's ray. */
static float slant(const tyni_door *door, int32_t x, int32_t y)
{
    if (door->parallel)
        return 1.0f;
    return 1.0f /
           tyni_vec_length(tyni_vec_mad(tyni_vec_mad(door->origin, (float)x + 0.5f, door->dx), (float)y + 0.5f, door->dy));
}

static float unproject(const tyni_door *door, float value)
{
    float at = door->base + (door->end - value) * door->step;
    if (door->parallel)
        return at;
    return at > 0.0f ? 1.0f / at : door->far_depth; /* beyond an infinite far plane */
}

float tyni_door_depth(const tyni_door *door, int32_t x, int32_t y)
{
    float value = stored(door, x, y);
    if (door->marked && value == door->sky)
        return door->far_depth;
    /* a float that is no number becomes one here, and never meets another */
    if (!tyni_finite(value))
        return value < 0.0f && door->kind != TYN_CODING_PROJECTED ? 0.0f : door->far_depth;
    if (door->kind == TYN_CODING_PROJECTED)
        value = unproject(door, value);
    else if (door->kind == TYN_CODING_DISTANCE)
        value *= door->scale * slant(door, x, y);
    else
        value *= door->scale;
    return tyni_clampf(value, 0.0f, door->far_depth);
}

const float *tyni_door_row(const tyni_door *door, int32_t x, int32_t y, int32_t count, float *room)
{
    if (door->plain)
        return (const float *)tyni_image_row(door->image, y) + x;
    for (int32_t i = 0; i < count; i++)
        room[i] = tyni_door_depth(door, x + i, y);
    return room;
}

/* ---- shadow maps --------------------------------------------------------------------------------------------------- */

/* A bias changes z by z' = (z - a) * share + a under a perspective, whose z is a + b / w, and by a constant in parallel. As
 * share and loss: z' = z * share - loss. */
static void bias_of(const tyn_shadow *shadow, const float z[4], float bias, float *share, float *loss)
{
    const float *m = shadow->matrix;
    tyni_vec3 u = tyni_vec_load(m), v = tyni_vec_load(m + 4), w = tyni_vec_load(m + 12), zv = tyni_vec_load(z);
    float width = (float)shadow->size, height = (float)tyni_shadow_height(shadow);
    *share = 1.0f;
    *loss = 0.0f;
    if (bias <= 0.0f)
        return;
    if (tyni_shadow_parallel(shadow)) {
        /* along the way in which u and v do not change */
        tyni_vec3 way = tyni_vec_normalise(tyni_vec_cross(u, v));
        float texel = tyni_absf(m[15]) / tyni_minf(tyni_vec_length(u) * width, tyni_vec_length(v) * height);
        *loss = bias * texel * tyni_absf(tyni_vec_dot(zv, way) / m[15]);
    } else {
        float length2 = tyni_vec_dot(w, w), a = tyni_vec_dot(zv, w) / length2, step;
        tyni_vec3 side_u = tyni_vec_mad(u, -tyni_vec_dot(u, w) / length2, w);
        tyni_vec3 side_v = tyni_vec_mad(v, -tyni_vec_dot(v, w) / length2, w);
        /* a texel's width over its distance */
        step = bias * tyni_vec_length(w) / tyni_minf(tyni_vec_length(side_u) * width, tyni_vec_length(side_v) * height);
        *share = 1.0f / (1.0f + step);
        *loss = -a * step * *share;
    }
    if (!(*share > 0.0f) || !tyni_finite(*loss)) { /* a matrix of no use */
        *share = 1.0f;
        *loss = 0.0f;
    }
}

void tyni_door_map(tyni_texels *t, float z[4], const tyn_shadow *shadow, float bias)
{
    const float *m = shadow->matrix;
    float ends[2] = {1.0f, 0.0f}, unit, share, loss;
    t->pixels = shadow->depth;
    t->width = shadow->size;
    t->height = tyni_shadow_height(shadow);
    t->bytes = tyni_shadow_bytes(shadow);
    t->pitch = shadow->stride ? shadow->stride : (ptrdiff_t)t->width * t->bytes;
    t->inverse = shadow->coding == TYN_MAP_LINEAR && !tyni_shadow_parallel(shadow);
    t->limit = 0.0f;
    /* stored steps in one of z */
    unit =
        shadow->coding == TYN_MAP_LINEAR ? 1.0f / (shadow->scale == 0.0f ? 1.0f : shadow->scale) : full_scale(shadow->format);
    if (t->inverse) {
        for (int32_t i = 0; i < 4; i++)
            z[i] = i == 3 ? 1.0f : 0.0f; /* depth is 1 / w */
        bias_of(shadow, z, bias, &share, &loss);
        t->end = 0.0f;
        t->step = 1.0f / (unit * share);
        t->limit = shadow->at_far > 0.0f ? shadow->at_far / share : 3e38f;
        if (shadow->format == TYN_DEPTH_U16)
            t->limit = tyni_minf(t->limit, 65535.0f * t->step);
        return;
    }
    if (shadow->coding != TYN_MAP_REVERSED)
        (void)tyni_check_range(shadow->at_near, shadow->at_far, ends);
    /* z is measured from the far end and rises towards the near one */
    t->step = 1.0f / (ends[0] - ends[1]);
    for (int32_t i = 0; i < 4; i++)
        z[i] = (m[8 + i] - ends[1] * m[12 + i]) * t->step;
    bias_of(shadow, z, bias, &share, &loss);
    t->step *= share / unit;
    t->end = ends[1] * unit + loss / t->step;
}
