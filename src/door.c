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

/* The ends of a range, of which 0, 0 means 0, 1; 0 where they are too close together, or too large, to compute with. */
static int range(float at_near, float at_far, float ends[2])
{
    ends[0] = at_near;
    ends[1] = at_near == 0.0f && at_far == 0.0f ? 1.0f : at_far;
    return tyni_absf(at_near) <= 1e6f && tyni_absf(at_far) <= 1e6f && tyni_absf(ends[1] - ends[0]) >= 1e-6f;
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
    /* an infinite far plane is one: 1 / far is 0 */
    if (!range(coding->at_near, coding->at_far, ends) || !(depth[0] >= 1e-20f) || !(depth[0] < depth[1]))
        return TYN_E_IMAGE;
    return TYN_OK;
}

/* Everything is measured from the far end, where the step from one stored value to the next is a long way: what is stored
 * there is subtracted before anything else rounds. */
static void open_projected(tyni_door *door, const tyn_depth_coding *coding, const tyn_camera *camera)
{
    float ends[2], depth[2], unit = full_scale(door->image->format);
    (void)range(coding->at_near, coding->at_far, ends);
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
    /* a float that is no number becomes one here, and never meets another */
    if (!tyni_finite(value))
        return value < 0.0f && door->kind != TYN_CODING_PROJECTED ? 0.0f : door->far_depth;
    if (door->marked && value == door->sky)
        return door->far_depth;
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
