/* raster.h - the rasterizer's inside: clip, set up, fill, shade.
 *
 * A view (a camera or a shadow map) takes a world point to four numbers: x, y, value and w. x / w and y / w say where on the
 * image it is; value / w is linear over the image on a plane. A camera has value = 1, so that value / w is 1 / depth; a shadow
 * map has its Z. All else is the same for both.
 *
 * Triangles go through in batches. Stage 1 (setup.c, clip.c) makes one piece of each triangle: a convex polygon on a grid of
 * 1/256 pixel and the plane of its value. Stage 2 (fill.c) fills the pieces in order, each job into a band of rows of its own.
 * So neither the number of workers nor their order nor the size of a batch changes a byte. What a pixel shows is kept as mesh
 * and triangle in the colour image itself until all is filled; then shade.c turns these numbers into light, once a pixel.
 *
 * The colour image until then: a row's pixels in blocks of 16 (TYNI_RASTER_BLOCK), the last one as wide as what is left. Of the
 * 12 bytes a pixel has, a block of n pixels holds n mesh numbers, n triangle numbers, and n words of nothing. So a vector of
 * them is stored at once, and a block can be shaded where it lies. */
#ifndef TYNI_RASTER_H
#define TYNI_RASTER_H

#include "base.h"
#include "jobs.h"
#include "door.h"
#include "slide.h"
#include "vec.h"

#define TYNI_RASTER_CHUNK 64 /* triangles that one job sets up */
#define TYNI_RASTER_BAND 32  /* rows that one job fills */
#define TYNI_RASTER_BLOCK 16 /* pixels; a multiple of any vector */
#define TYNI_RASTER_FACES 64 /* triangles that a worker remembers for shading */
#define TYNI_RASTER_SLOPES 7 /* slopes that are remembered with them */
#define TYNI_RASTER_NUMBERS 14
#define TYNI_RASTER_GROUP 2048 /* bytes of a worker for the pixels that it shades at once */
#define TYNI_RASTER_SUB 256    /* grid positions per pixel */
#define TYNI_RASTER_CORNERS 8  /* 3, and one more for the near plane and each side of the guard band */
#define TYNI_RASTER_BATCH 2048
#define TYNI_RASTER_SLIDES 6           /* most textures of a light */
#define TYNI_RASTER_NOTHING UINT32_MAX /* a mesh number: background */

/* The guard band: pieces are cut this many pixels off the image's centre. With images up to 32768 that keeps grid coordinates
 * below (65536 + 16384) * 256 < 2^25, differences below 2^26, and products of two of them below 2^52. */
#define TYNI_RASTER_GUARD 65536.0f

typedef struct tyni_raster_vertex {
    float x, y, value, w;
} tyni_raster_vertex;

typedef struct tyni_raster_point {
    int32_t x, y; /* 1/256 pixel from the image's top left corner */
} tyni_raster_point;

/* A function that is linear over the image: value at the centre of pixel (x0, y0), and change per pixel. */
typedef struct tyni_raster_plane {
    float value, dx, dy;
    int32_t x0, y0;
} tyni_raster_plane;

/* What is left of a triangle: 64 bytes that all pieces use, and the corners that only clipping makes. */
typedef struct tyni_raster_piece {
    tyni_raster_plane plane;
    float low, high; /* of value / w over the corners; the plane's errors must not leave them */
    uint32_t mesh, triangle;
    int32_t corners; /* 0: nothing to draw */
    tyni_raster_point corner[TYNI_RASTER_CORNERS];
    uint32_t pad[6];
} tyni_raster_piece;

/* Rows of the image that a piece touches; first > last: none. */
typedef struct tyni_raster_rows {
    uint16_t first, last;
} tyni_raster_rows;

/* The triangles of one set-up job, which may belong to several meshes. */
typedef struct tyni_raster_chunk {
    uint32_t mesh, triangle; /* the first */
    int32_t count;
    int32_t first, last; /* rows that any of its pieces touches */
    int32_t bad;
} tyni_raster_chunk;

/* A worker's sums, on a cache line of its own. */
typedef struct tyni_raster_tally {
    int64_t drawn, pixels;
    uint8_t pad[48];
} tyni_raster_tally;

typedef struct tyni_raster_view {
    float origin[3];           /* subtracted from a world point first */
    float row[4][3], shift[4]; /* then these give x, y, value, w */
    float middle[2];           /* x / w and y / w at the image's centre; the exact number is middle + middle_low */
    float half[2];             /* pixels from its top left corner to there */
    float scale[2];            /* pixels per x / w, y / w */
    float step[2];             /* x / w, y / w per pixel; step + step_low */
    float middle_low[2], step_low[2];
    float clip; /* w below this is cut off; > 0 */
    int32_t width, height;
} tyni_raster_view;

typedef enum tyni_raster_kind {
    TYNI_RASTER_DEPTH, /* a camera's depth, smallest wins */
    TYNI_RASTER_SEEN,  /* the same, and what is seen goes into the colour image */
    TYNI_RASTER_SHADOW /* a shadow map, largest wins */
} tyni_raster_kind;

/* One drawing of all meshes. */
typedef struct tyni_raster_pass {
    tyn_raster *raster;
    tyni_jobs jobs;
    tyni_raster_view view;
    tyni_raster_kind kind;
    const tyn_mesh *meshes;
    uint32_t mesh_count;
    uint8_t *depth, *colour; /* rows of floats; rows of 3 floats or NULL */
    ptrdiff_t depth_stride, colour_stride;
    float nearest, clear; /* of depth: less is not seen; what an empty pixel holds */
    int32_t chunks;       /* in the batch at hand */
    int64_t triangles, bad;
} tyni_raster_pass;

/* What shading needs of a shadow map beyond tyn_shadow; see light.c. */
typedef struct tyni_raster_map {
    tyni_vec3 across, down; /* world displacement per u and per v (times w where the map is perspective) */
    tyni_vec3 along;        /* parallel: displacement per z. perspective: the apex */
    float slope_u, slope_v; /* perspective: z per u and v that any surface has */
    float apex;             /* perspective: Z at the apex */
    float bias, bias_z;     /* bias of the compare is |bias - bias_z * z| */
    int32_t parallel;
    int32_t number; /* among the maps of all lights */
    tyni_texels texels;
    float z[4]; /* row of the matrix for the depths that they hold */
} tyni_raster_map;

/* The same of a light. */
typedef struct tyni_raster_lamp {
    const tyn_light *light;
    const tyni_raster_map *maps; /* of light->shadow, then of light->more */
    const tyni_slide *slides;    /* light->texture_count of them */
    tyni_vec3 towards;           /* to a directional light; against a spot's axis */
    tyni_vec3 position;          /* spot, point: relative to the camera */
    float cosine;                /* of half the cone's angle; -1 for a point */
    int16_t mapped;              /* there is any map */
    int16_t plain;               /* no slides, no tints, maps of floats: kernels can do it */
    float outside;               /* what arrives where no map covers: 0 or 1 */
} tyni_raster_lamp;

/* How z changes over each map, in texels, on a triangle's plane; calculated when it is first looked up there. */
typedef struct tyni_raster_slopes {
    uint32_t ready;               /* a bit for each map */
    float slope[TYN_MAX_MAPS][2]; /* per u, per v */
} tyni_raster_slopes;

/* What shading needs of a triangle. Points are relative to the camera. */
typedef struct tyni_raster_face {
    uint32_t mesh, triangle;
    tyni_vec3 corner, normal;           /* of length 1, towards the camera */
    float u, v;                         /* at the corner */
    tyni_vec3 grow_u, grow_v;           /* these are TYNI_RASTER_NUMBERS, without a gap */
    uint32_t ready;                     /* a bit for each of the slopes */
    float slope[TYNI_RASTER_SLOPES][2]; /* of the first parallel shadow maps of all lights, per u and v */
    uint32_t pad;
} tyni_raster_face;

struct tyn_raster {
    int32_t width, height, batch, workers, isa;
    tyni_raster_piece *pieces;  /* batch */
    tyni_raster_rows *rows;     /* batch */
    tyni_raster_chunk *chunks;  /* batch / 64, rounded up */
    tyni_raster_tally *tallies; /* workers */
    tyni_jobs_count *counts;    /* workers */
    tyni_raster_face *faces;    /* workers * TYNI_RASTER_FACES */
    uint8_t *groups;            /* workers * TYNI_RASTER_GROUP */
    tyni_raster_slopes *slopes; /* workers * TYN_MAX_LIGHTS */
    tyni_raster_lamp *lamps;    /* TYN_MAX_LIGHTS */
    tyni_raster_map *maps;      /* TYN_MAX_LIGHTS * TYN_MAX_MAPS */
    tyni_slide *slides;         /* TYN_MAX_LIGHTS * TYNI_RASTER_SLIDES */
};

/* view.c */
void tyni_raster_view_camera(tyni_raster_view *view, const tyn_camera *camera, int32_t width, int32_t height);
void tyni_raster_view_shadow(tyni_raster_view *view, const tyn_shadow *shadow);

/* A triangle's own plane: normal (of any length), and what gradients of its corners' values need. */
typedef struct tyni_raster_facet {
    tyni_vec3 a, b, normal;
    float unit, square;
} tyni_raster_facet;

/* setup.c. 0 for a triangle without area. */
int tyni_raster_make_facet(tyni_vec3 p0, tyni_vec3 p1, tyni_vec3 p2, tyni_raster_facet *facet);

/* Along the plane, of a quantity that is larger at p1 and p2 than at p0 by da and db. */
tyni_vec3 tyni_raster_gradient(const tyni_raster_facet *facet, float da, float db);

int tyni_raster_transform(const tyni_raster_view *view, const float point[3], tyni_raster_vertex *vertex);
int tyni_raster_set_plane(const tyni_raster_view *view, const tyni_raster_vertex v[3], tyni_raster_plane *plane);
void tyni_raster_setup(void *pass, int32_t chunk, int32_t worker);

/* clip.c: out of 3 vertices 0 or 3 .. TYNI_RASTER_CORNERS. */
int32_t tyni_raster_outside(const tyni_raster_view *view, const tyni_raster_vertex *v);
int32_t tyni_raster_clip(const tyni_raster_view *view, tyni_raster_vertex v[TYNI_RASTER_CORNERS]);

/* fill.c */
void tyni_raster_fill(void *pass, int32_t band, int32_t worker);

/* Where in a row of `width` pixels x's mesh number lies, and how far behind it its triangle number. */
static inline ptrdiff_t tyni_raster_mark_at(int32_t x)
{
    const int32_t block = x & ~(TYNI_RASTER_BLOCK - 1);
    return 12 * (ptrdiff_t)block + 4 * (x - block);
}
static inline ptrdiff_t tyni_raster_mark_step(int32_t x, int32_t width)
{
    return 4 * tyni_mini(TYNI_RASTER_BLOCK, width - (x & ~(TYNI_RASTER_BLOCK - 1)));
}

/* pass.c: clears, sets up and fills. */
tyn_status tyni_raster_run(tyni_raster_pass *pass);

/* texture.c */
typedef struct tyni_raster_cutout {
    const tyn_image *mask;
    tyni_raster_plane u, v, w; /* u / w, v / w, 1 / w */
} tyni_raster_cutout;

void tyni_raster_texel(const tyn_image *texture, float u, float v, float rgb[3]);
void tyni_raster_set_cutout(const tyni_raster_pass *pass, const tyni_raster_piece *piece, tyni_raster_cutout *cutout);
int tyni_raster_solid(const tyni_raster_cutout *cutout, int32_t x, int32_t y);

static inline int tyni_raster_masked(const tyn_mesh *mesh)
{
    return mesh->material.mask && mesh->texcoords;
}

static inline float tyni_raster_at(const tyni_raster_plane *p, int32_t x, int32_t y)
{
    return p->dx * (float)(x - p->x0) + (p->dy * (float)(y - p->y0) + p->value);
}

/* light.c. Room: TYN_MAX_MAPS maps, TYNI_RASTER_SLIDES slides. */
void tyni_raster_set_lamp(tyni_raster_lamp *lamp, tyni_raster_map *maps, tyni_slide *slides, const tyn_light *light,
                          const float origin[3], float bias, int32_t number);

void tyni_raster_set_slope(tyni_raster_slopes *slopes, int32_t i, const tyni_raster_map *map, tyni_vec3 point,
                           tyni_vec3 normal);

static inline const tyn_shadow *tyni_raster_shadow_of(const tyn_light *light, int32_t map)
{
    return map ? &light->more[map - 1] : &light->shadow;
}

/* Shadows here have hard edges. The four nearest comparisons, bilinearly weighted, put the edge where they cross 1/2: a
 * straighter line than the texels' outlines. A ramp of 1/4 texel about it measured best or equal on three scenes against exact
 * shadows: 25 % less error than plain bilinear weights, 0 .. 11 % less than the nearest texel alone. */
#define TYNI_RASTER_SHARPNESS 4.0f

/* The share of the light that arrives at a point, 0 .. 1, shadows only, on a plane of that normal. The point is in the world.
 * Multiplies rgb by the map's tint. */
float tyni_raster_visible(const tyni_raster_lamp *lamp, tyni_vec3 point, tyni_vec3 normal, tyni_raster_slopes *slopes,
                          float rgb[3]);

/* shade.c */
typedef struct tyni_raster_shading {
    const tyni_raster_pass *pass;
    const tyn_surface *surface;
    const tyni_raster_lamp *lamps;
    float sigma[3];
    int32_t hazy; /* sigma is not zero */
} tyni_raster_shading;

void tyni_raster_shade(void *shading, int32_t band, int32_t worker);

#endif
