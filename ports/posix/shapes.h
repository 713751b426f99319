/* shapes.h - what the built-in scenes are built of: a stage, textures, and clay that is formed into meshes. */
#ifndef TOOL_SHAPES_H
#define TOOL_SHAPES_H

#include <stdbool.h>
#include <stdint.h>

#include "scene.h"

#define SHAPES_PI 3.14159265f

/* ---- the stage ----------------------------------------------------------------------------------------------------- */

/* Degrees. An error of stage_... is -1, as in scene.h. */
void stage_camera(scene *s, const float position[3], const float target[3], float fov, float near, float far);
void stage_colours(scene *s, const float ambient[3], const float background[3]);
int stage_sun(scene *s, const float direction[3], const float irradiance[3]);
int stage_spot(scene *s, const float position[3], const float target[3], float angle, const float intensity[3]);
int stage_medium(scene *s, const float scatter[3], const float absorb[3], tyn_phase phase, float g);

/* ---- textures ------------------------------------------------------------------------------------------------------ */

/* A texel's linear colour at (u, v), 0 .. 1, v upwards. */
typedef void (*shapes_paint)(float u, float v, float rgb[3]);

/* An RGB8 texture, or a mask (kept where rgb[0] is at least 0.5), that the scene owns. NULL: no memory. */
const tyn_image *shapes_texture(scene *s, int32_t width, int32_t height, shapes_paint paint);
const tyn_image *shapes_mask(scene *s, int32_t size, shapes_paint paint);

/* rgb = a + (b - a) t, t held to 0 .. 1; and the smooth step from 0 at `low` to 1 at `high`. */
void shapes_mix(float rgb[3], const float a[3], const float b[3], float t);
float shapes_step(float low, float high, float x);

/* ---- clay ---------------------------------------------------------------------------------------------------------- */

/* The renderer knows no ambient occlusion: a clay's `shade` says how dark a face is at a place, and faces of one
 * darkness become one mesh. */
#define SHAPES_TINTS 16

struct clay_part {
    float *positions, *texcoords; /* three corners a triangle */
    uint32_t vertices, room;
};

struct clay {
    float albedo[3];
    const tyn_image *texture, *mask;
    float scale;                                                 /* textures a metre, where texture coordinates are not given */
    float (*shade)(const float point[3], const float normal[3]); /* 0 .. 1; NULL: 1 */
    float dim;                                                   /* multiplies shade: for leaves of many greens */
    float origin[3], x[3], y[3], z[3];                           /* where local coordinates lie in the world */
    struct clay_part parts[SHAPES_TINTS];
    bool broken; /* out of memory: nothing more is added, and clay_finish says so */
};

void clay_start(struct clay *clay, float red, float green, float blue, const tyn_image *texture, float scale);

/* Local coordinates start at (x, y, z), turned by `turn` about +Y. */
void clay_place(struct clay *clay, float x, float y, float z, float turn);

/* A triangle with its texture coordinates, world space. */
void clay_triangle(struct clay *clay, const float p[3][3], const float uv[3][2]);

/* The rest takes local coordinates. Four corners in a row: */
void clay_quad(struct clay *clay, const float a[3], const float b[3], const float c[3], const float d[3]);
void clay_quad_uv(struct clay *clay, const float a[3], const float b[3], const float c[3], const float d[3]);
void clay_box(struct clay *clay, float x0, float y0, float z0, float x1, float y1, float z1);

/* profile: pairs of radius and height; with flutes, the radius swings by `depth` of itself. */
void clay_lathe(struct clay *clay, const float (*profile)[2], int32_t points, int32_t segments, int32_t flutes, float depth);

/* From a to b, u around and v along (in metres * scale). */
void clay_tube(struct clay *clay, const float a[3], const float b[3], float ra, float rb, int32_t segments);

/* A wall in the plane z = 0, from x = -width / 2 to width / 2, y = 0 to height, `thick` deep towards -z, with an opening that
 * is `open` wide, starts at `sill` and is straight up to `spring`; its arch is round with point = 1, pointed above. */
struct clay_arch {
    float width, height, thick, open, sill, spring, point;
    int32_t segments;
};
void clay_arch(struct clay *clay, const struct clay_arch *arch);

/* The wall x0 .. x1, y0 .. y1 in the plane of z with a round hole. */
struct clay_hole {
    float x0, y0, x1, y1, z, x, y, radius;
};
void clay_hole(struct clay *clay, const struct clay_hole *hole);

/* A floor of cells from (x0, z0) to (x1, z1), y = lift(x, z). */
void clay_field(struct clay *clay, float x0, float z0, float x1, float z1, int32_t cells, float (*lift)(float x, float z));

/* Gives the meshes to the scene and frees the clay. -1: no memory. */
int clay_finish(struct clay *clay, scene *s);

#endif
