/* scene.h - a scene in memory: what the parser and the built-in scenes fill, and what render.c draws.
 *
 * All functions that return int give 0, or -1 when memory (or a 32-bit count) runs out; the scene stays valid and
 * scene_free releases it. */
#ifndef TOOL_SCENE_H
#define TOOL_SCENE_H

#include <stddef.h>
#include <stdint.h>

#include "tyndall.h"

/* A light of the file. `light.shadow` is empty until render.c makes the map. What the library does not draw yet is kept beside.
 */
typedef struct scene_light {
    tyn_light light;     /* kind, position, direction (of length 1), colour, angle (radians) */
    int point;           /* a point light: position and colour alone hold, kind means nothing */
    tyn_image *texture;  /* gobo or slide; NULL: none. Owned by the scene */
    float texture_up[3]; /* with a texture: its up */
    float extent[2];     /* with a texture, directional: metres wide and high */
    int32_t line;        /* in the scene file, for messages; 0 for a built-in scene */
} scene_light;

typedef struct scene_camera {
    float position[3], target[3], up[3];
    float fov_y; /* radians */
    float near_depth, far_depth;
    int32_t line;
} scene_camera;

/* Zero bytes are an empty scene, but scene_init also sets defaults (up 0 1 0). */
typedef struct scene {
    int32_t width, height;
    scene_camera camera;
    float background[3];
    float ambient[3];
    tyn_medium media[TYN_MAX_MEDIA];
    int32_t medium_count;
    scene_light lights[TYN_MAX_LIGHTS];
    int32_t light_count;
    tyn_mesh *meshes; /* world space, memory owned; hand them to the library as they are */
    int32_t mesh_count;
    tyn_image **images; /* textures and masks, owned; meshes and lights point at them */
    int32_t image_count;

    /* private: room in the arrays above; mesh_room[i] is what meshes[i] has room for */
    int32_t mesh_capacity, image_capacity;
    struct scene_room *mesh_room;
} scene;

void scene_init(scene *s);
void scene_free(scene *s);

/* Copies. texcoords (2 per vertex) may be NULL. material.texture and .mask must live as long as the scene (scene_add_image). */
int scene_add_mesh(scene *s, const float *positions, const float *texcoords, uint32_t vertices, const uint32_t *indices,
                   uint32_t triangles, const tyn_material *material);

/* Takes over malloc'ed arrays, also when it fails (they are freed then). */
int scene_take_mesh(scene *s, float *positions, float *texcoords, uint32_t vertices, uint32_t *indices, uint32_t triangles,
                    const tyn_material *material);

/* The parallelogram a, b, b + c - a, c. Quads and boxes of one albedo share a mesh. */
int scene_add_quad(scene *s, const float a[3], const float b[3], const float c[3], const float albedo[3]);
int scene_add_box(scene *s, const float min[3], const float max[3], const float albedo[3]);
int scene_add_triangle(scene *s, const float a[3], const float b[3], const float c[3], const float albedo[3]);

/* An image of its own, zeroed, rows without a gap; NULL without memory. */
tyn_image *scene_add_image(scene *s, int32_t width, int32_t height, tyn_format format);

/* Media of one phase function add up exactly and share an entry; -1 when TYN_MAX_MEDIA different ones are there already. */
int scene_add_medium(scene *s, const tyn_medium *medium);

/* -1 when TYN_MAX_LIGHTS are there already. */
int scene_add_light(scene *s, const scene_light *light);

/* The box of all vertices. Returns 0 for a scene without any: min and max are not set then. */
int scene_bounds(const scene *s, float min[3], float max[3]);

/* The camera for an image of width x height. */
tyn_status scene_camera_make(const scene *s, int32_t width, int32_t height, tyn_camera *camera);

#endif
