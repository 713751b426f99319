/* scene.c - see scene.h */
#include "scene.h"

#include <string.h>

static void add_box(scene *s, tyn_mesh *mesh, float x0, float y0, float z0, float x1, float y1, float z1)
{
    static const uint8_t face[12][3] = {{0, 1, 3}, {0, 3, 2}, {4, 6, 7}, {4, 7, 5}, {0, 4, 5}, {0, 5, 1},
                                        {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 5, 7}, {1, 7, 3}};
    const float low[3] = {x0, y0, z0}, high[3] = {x1, y1, z1};
    uint32_t box = mesh->vertices / 8 + (mesh == s->mesh ? 0 : s->mesh[0].vertices / 8);
    if (box >= SCENE_BOXES)
        return;
    for (uint32_t i = 0; i < 8; i++)
        for (uint32_t k = 0; k < 3; k++)
            s->corner[box][i][k] = (i >> k & 1) ? high[k] : low[k];
    for (uint32_t i = 0; i < 12; i++)
        for (uint32_t k = 0; k < 3; k++)
            s->index[box][i][k] = mesh->vertices + face[i][k];
    mesh->vertices += 8;
    mesh->triangles += 12;
}

/* The wall at z: three windows with bars in them. */
static void add_wall(scene *s, tyn_mesh *stone, float z)
{
    add_box(s, stone, -6, 0, z - 0.6f, 6, 1.4f, z);
    add_box(s, stone, -6, 6.2f, z - 0.6f, 6, 8, z);
    for (int i = 0; i < 4; i++) { /* piers */
        float x = -4.5f + 3.0f * (float)i;
        add_box(s, stone, x - (i == 0 ? 1.5f : 0.6f), 1.4f, z - 0.6f, x + (i == 3 ? 1.5f : 0.6f), 6.2f, z);
    }
    for (int i = 0; i < 3; i++) {
        float x = -3.0f + 3.0f * (float)i;
        add_box(s, stone, x - 0.07f, 1.4f, z - 0.4f, x + 0.07f, 6.2f, z - 0.2f);
        for (int k = 1; k < 4; k++)
            add_box(s, stone, x - 0.9f, 1.35f + 1.2f * (float)k, z - 0.4f, x + 0.9f, 1.45f + 1.2f * (float)k, z - 0.2f);
    }
}

static void add_column(scene *s, tyn_mesh *stone, float x, float z)
{
    add_box(s, stone, x - 0.5f, 0, z - 0.5f, x + 0.5f, 0.4f, z + 0.5f);
    add_box(s, stone, x - 0.3f, 0.4f, z - 0.3f, x + 0.3f, 6.6f, z + 0.3f);
    add_box(s, stone, x - 0.55f, 6.6f, z - 0.55f, x + 0.55f, 7, z + 0.55f);
}

static void build(scene *s)
{
    tyn_mesh *stone = &s->mesh[0], *floor = &s->mesh[1];
    stone->positions = s->corner[0][0];
    stone->indices = s->index[0][0];
    add_wall(s, stone, -14);
    add_box(s, stone, -7, 0, -15, -6, 8, 4); /* sides and ceiling */
    add_box(s, stone, 6, 0, -15, 7, 8, 4);
    add_box(s, stone, -7, 8, -15, 7, 8.5f, 4);
    for (int i = 0; i < 3; i++) {
        add_column(s, stone, -3.6f, -2.5f - 4.0f * (float)i);
        add_column(s, stone, 3.6f, -2.5f - 4.0f * (float)i);
        add_box(s, stone, -6, 7, -2.9f - 4.0f * (float)i, 6, 7.5f, -2.1f - 4.0f * (float)i); /* beams */
    }
    for (int i = 0; i < 4; i++) /* a stair, a stone on it */
        add_box(s, stone, -1.6f + 0.2f * (float)i, 0, -9.6f + 0.4f * (float)i, 1.6f - 0.2f * (float)i, 0.16f * (float)(i + 1),
                -6.0f - 0.4f * (float)i);
    add_box(s, stone, -0.45f, 0.64f, -8.2f, 0.45f, 1.9f, -7.3f);
    floor->positions = s->corner[stone->vertices / 8][0];
    floor->indices = s->index[stone->vertices / 8][0];
    add_box(s, floor, -30, -0.2f, -40, 30, 0, 8);
}

tyn_status scene_make(scene *s, float moment, int32_t width, int32_t height)
{
    static const tyn_material stone = {{0.55f, 0.5f, 0.44f}, NULL, NULL}, floor = {{0.34f, 0.3f, 0.27f}, NULL, NULL};
    static const float eye[3] = {-1.9f, 1.5f, -0.4f}, target[3] = {0.5f, 3.1f, -10}, up[3] = {0, 1, 0};
    static const float ambient[3] = {0.22f, 0.25f, 0.32f}, sky[3] = {0.75f, 0.85f, 1.0f};
    static const tyn_medium air = {{0.03f, 0.03f, 0.032f}, {0, 0, 0}, TYN_PHASE_HG, 0.45f};
    /* the half-angle's tangent makes a unit vector without a sine */
    const float t = 0.25f * moment, across = 2 * t / (1 + t * t), along = (1 - t * t) / (1 + t * t);
    memset(s, 0, sizeof *s);
    s->mesh[0].material = stone;
    s->mesh[1].material = floor;
    build(s);
    memcpy(s->ambient, ambient, sizeof ambient);
    memcpy(s->sky, sky, sizeof sky);
    s->air = air;
    s->sun.direction[0] = 12.0f / 13 * across;
    s->sun.direction[1] = -5.0f / 13;
    s->sun.direction[2] = 12.0f / 13 * along;
    s->sun.colour[0] = 13.0f;
    s->sun.colour[1] = 11.0f;
    s->sun.colour[2] = 8.0f;
    return tyn_camera_look(&s->camera, eye, target, up, 1.05f, 0.1f, SCENE_FAR, width, height);
}
