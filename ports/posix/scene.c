/* scene.c */
#include "scene.h"

#include <stdlib.h>
#include <string.h>

#define SHARE_LIMIT 64 /* how many meshes back a quad looks for its albedo: keeps thousands of colours from costing squares */

struct scene_room {
    uint32_t vertices, triangles;
    int shared; /* of quads and boxes: may grow */
};

void scene_init(scene *s)
{
    memset(s, 0, sizeof *s);
    s->camera.up[1] = 1.0f;
}

static void free_mesh(tyn_mesh *m)
{
    free((void *)m->positions);
    free((void *)m->texcoords);
    free((void *)m->indices);
}

void scene_free(scene *s)
{
    for (int32_t i = 0; i < s->mesh_count; i++)
        free_mesh(&s->meshes[i]);
    for (int32_t i = 0; i < s->image_count; i++) {
        free(s->images[i]->pixels);
        free(s->images[i]);
    }
    free(s->meshes);
    free(s->mesh_room);
    free(s->images);
    scene_init(s);
}

/* The block for at least `need` items, larger by half so that adding one at a time is cheap. The old block stays on failure. */
static void *grow(void *block, size_t need, size_t item, size_t *capacity)
{
    size_t room = need + need / 2 + 8;
    void *more = room < SIZE_MAX / item ? realloc(block, room * item) : NULL;
    if (more)
        *capacity = room;
    return more;
}

static int room_for_mesh(scene *s)
{
    if (s->mesh_count < s->mesh_capacity)
        return 0;
    if (s->mesh_count > INT32_MAX / 2)
        return -1;
    size_t capacity = 0, unused;
    void *meshes = grow(s->meshes, (size_t)s->mesh_count + 1, sizeof *s->meshes, &capacity);
    if (!meshes)
        return -1;
    s->meshes = meshes;
    void *rooms = grow(s->mesh_room, (size_t)s->mesh_count + 1, sizeof *s->mesh_room, &unused);
    if (!rooms)
        return -1;
    s->mesh_room = rooms;
    s->mesh_capacity = (int32_t)capacity;
    return 0;
}

int scene_take_mesh(scene *s, float *positions, float *texcoords, uint32_t vertices, uint32_t *indices, uint32_t triangles,
                    const tyn_material *material)
{
    tyn_mesh m = {positions, texcoords, indices, vertices, triangles, *material};
    struct scene_room room = {vertices, triangles, 0};
    if (room_for_mesh(s) != 0) {
        free_mesh(&m);
        return -1;
    }
    s->meshes[s->mesh_count] = m;
    s->mesh_room[s->mesh_count] = room;
    s->mesh_count++;
    return 0;
}

static void *copy_of(const void *from, size_t count, size_t item, int *failed)
{
    void *to = count < SIZE_MAX / item - 1 ? malloc(count * item + 1) : NULL;
    if (!to)
        *failed = 1;
    else if (count)
        memcpy(to, from, count * item);
    return to;
}

int scene_add_mesh(scene *s, const float *positions, const float *texcoords, uint32_t vertices, const uint32_t *indices,
                   uint32_t triangles, const tyn_material *material)
{
    int failed = 0;
    float *p = copy_of(positions, vertices, 3 * sizeof *p, &failed);
    float *t = texcoords ? copy_of(texcoords, vertices, 2 * sizeof *t, &failed) : NULL;
    uint32_t *i = copy_of(indices, triangles, 3 * sizeof *i, &failed);
    if (failed) {
        free(p);
        free(t);
        free(i);
        return -1;
    }
    return scene_take_mesh(s, p, t, vertices, i, triangles, material);
}

/* The shared mesh of an albedo with room for some more; NULL without memory. */
static tyn_mesh *shared_mesh(scene *s, const float albedo[3], uint32_t vertices, uint32_t triangles)
{
    int32_t i = s->mesh_count - 1, stop = i > SHARE_LIMIT ? i - SHARE_LIMIT : 0;
    for (; i >= stop; i--)
        if (s->mesh_room[i].shared && memcmp(s->meshes[i].material.albedo, albedo, 3 * sizeof *albedo) == 0 &&
            s->meshes[i].vertices < UINT32_MAX / 4)
            break;
    if (i < stop) {
        tyn_material material;
        memset(&material, 0, sizeof material);
        memcpy(material.albedo, albedo, sizeof material.albedo);
        if (scene_take_mesh(s, NULL, NULL, 0, NULL, 0, &material) != 0)
            return NULL;
        i = s->mesh_count - 1;
        s->mesh_room[i].shared = 1;
    }
    tyn_mesh *m = &s->meshes[i];
    struct scene_room *room = &s->mesh_room[i];
    size_t capacity = 0;
    if (m->vertices + vertices > room->vertices) {
        void *more = grow((void *)m->positions, m->vertices + vertices, 3 * sizeof(float), &capacity);
        if (!more)
            return NULL;
        m->positions = more;
        room->vertices = (uint32_t)capacity;
    }
    if (m->triangles + triangles > room->triangles) {
        void *more = grow((void *)m->indices, m->triangles + triangles, 3 * sizeof(uint32_t), &capacity);
        if (!more)
            return NULL;
        m->indices = more;
        room->triangles = (uint32_t)capacity;
    }
    return m;
}

static void append(tyn_mesh *m, const float (*corners)[3], uint32_t vertices, const uint8_t *order, uint32_t triangles)
{
    float *positions = (float *)m->positions + 3 * (size_t)m->vertices;
    uint32_t *indices = (uint32_t *)m->indices + 3 * (size_t)m->triangles;
    memcpy(positions, corners, vertices * sizeof *corners);
    for (uint32_t i = 0; i < 3 * triangles; i++)
        indices[i] = m->vertices + order[i];
    m->vertices += vertices;
    m->triangles += triangles;
}

int scene_add_triangle(scene *s, const float a[3], const float b[3], const float c[3], const float albedo[3])
{
    static const uint8_t order[] = {0, 1, 2};
    float corners[3][3];
    tyn_mesh *m = shared_mesh(s, albedo, 3, 1);
    if (!m)
        return -1;
    memcpy(corners[0], a, sizeof corners[0]);
    memcpy(corners[1], b, sizeof corners[1]);
    memcpy(corners[2], c, sizeof corners[2]);
    append(m, (const float(*)[3])corners, 3, order, 1);
    return 0;
}

int scene_add_quad(scene *s, const float a[3], const float b[3], const float c[3], const float albedo[3])
{
    static const uint8_t order[] = {0, 1, 2, 0, 2, 3};
    float corners[4][3];
    tyn_mesh *m = shared_mesh(s, albedo, 4, 2);
    if (!m)
        return -1;
    for (int i = 0; i < 3; i++) {
        corners[0][i] = a[i];
        corners[1][i] = b[i];
        corners[2][i] = b[i] + c[i] - a[i];
        corners[3][i] = c[i];
    }
    append(m, (const float(*)[3])corners, 4, order, 2);
    return 0;
}

int scene_add_box(scene *s, const float min[3], const float max[3], const float albedo[3])
{
    /* Corner i has max where bit 0, 1, 2 of i is set in x, y, z; counter-clockwise from outside. */
    static const uint8_t order[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                    2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    float corners[8][3];
    tyn_mesh *m = shared_mesh(s, albedo, 8, 12);
    if (!m)
        return -1;
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++)
            corners[i][k] = i >> k & 1 ? max[k] : min[k];
    append(m, (const float(*)[3])corners, 8, order, 12);
    return 0;
}

tyn_image *scene_add_image(scene *s, int32_t width, int32_t height, tyn_format format)
{
    size_t bytes = (size_t)tyn_format_bytes(format);
    if (s->image_count == s->image_capacity) {
        size_t capacity = 0;
        void *more =
            s->image_count < INT32_MAX / 2 ? grow(s->images, (size_t)s->image_count + 1, sizeof *s->images, &capacity) : NULL;
        if (!more)
            return NULL;
        s->images = more;
        s->image_capacity = (int32_t)capacity;
    }
    if (bytes == 0 || width < 1 || height < 1 || (size_t)width > SIZE_MAX / bytes / (size_t)height)
        return NULL;
    tyn_image *image = malloc(sizeof *image);
    void *pixels = calloc((size_t)width * (size_t)height, bytes);
    if (!image || !pixels) {
        free(image);
        free(pixels);
        return NULL;
    }
    image->pixels = pixels;
    image->width = width;
    image->height = height;
    image->stride = 0;
    image->format = format;
    s->images[s->image_count++] = image;
    return image;
}

int scene_add_medium(scene *s, const tyn_medium *medium)
{
    for (int32_t i = 0; i < s->medium_count; i++) {
        tyn_medium *m = &s->media[i];
        if (m->phase == medium->phase && (m->phase != TYN_PHASE_HG || !(m->g < medium->g || m->g > medium->g))) {
            for (int k = 0; k < 3; k++) {
                m->scatter[k] += medium->scatter[k];
                m->absorb[k] += medium->absorb[k];
            }
            return 0;
        }
    }
    if (s->medium_count == TYN_MAX_MEDIA)
        return -1;
    s->media[s->medium_count++] = *medium;
    return 0;
}

int scene_add_light(scene *s, const scene_light *light)
{
    if (s->light_count == TYN_MAX_LIGHTS)
        return -1;
    s->lights[s->light_count++] = *light;
    return 0;
}

int scene_bounds(const scene *s, float min[3], float max[3])
{
    int any = 0;
    for (int32_t i = 0; i < s->mesh_count; i++) {
        const float *p = s->meshes[i].positions, *end = p + (s->meshes[i].vertices ? 3 * (size_t)s->meshes[i].vertices : 0);
        for (; p < end; p += 3) {
            if (!any)
                for (int k = 0; k < 3; k++)
                    min[k] = max[k] = p[k];
            any = 1;
            for (int k = 0; k < 3; k++) {
                min[k] = p[k] < min[k] ? p[k] : min[k];
                max[k] = p[k] > max[k] ? p[k] : max[k];
            }
        }
    }
    return any;
}

tyn_status scene_camera_make(const scene *s, int32_t width, int32_t height, tyn_camera *camera)
{
    const scene_camera *c = &s->camera;
    return tyn_camera_look(camera, c->position, c->target, c->up, c->fov_y, c->near_depth, c->far_depth, width, height);
}
