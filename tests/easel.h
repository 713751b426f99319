/* easel.h - what the rasterizer's tests draw on: a context in guarded memory, guarded images, executors that mix jobs up. */
#ifndef TYN_TEST_EASEL_H
#define TYN_TEST_EASEL_H

#include "guard.h"

typedef struct easel {
    tyn_raster *raster;
    uint8_t *block;
    size_t bytes;
    guard depth, colour;
    tyn_surface surface; /* of both images, a camera at the origin that looks along -z, and no more */
    tyn_raster_stats stats;
} easel;

/* batch and workers as in tyn_raster_config. `upside_down`: images with negative strides. */
easel easel_new(int32_t width, int32_t height, int32_t batch, int32_t workers, int upside_down);
void easel_free(easel *e);

/* Sets meshes and draws; checks that no band was touched. */
tyn_status easel_draw(easel *e, const tyn_mesh *meshes, int32_t count);
tyn_status easel_shadow(easel *e, const tyn_shadow *shadow, float *depth, const tyn_mesh *meshes, int32_t count);
int easel_intact(const easel *e);

float easel_depth(const easel *e, int32_t x, int32_t y);
const float *easel_colour(const easel *e, int32_t x, int32_t y);

/* The way from the camera through a pixel's centre, of depth 1, in the camera's axes. */
void easel_ray(const tyn_camera *camera, int32_t width, int32_t height, int32_t x, int32_t y, double ray[2]);

/* Triangles out of an array of positions in order: 9 floats each. Indices count up; at most EASEL_CORNERS. */
#define EASEL_CORNERS 65536
tyn_mesh easel_mesh(const float *positions, uint32_t triangles);

typedef enum easel_order { EASEL_FORWARD, EASEL_REVERSED, EASEL_SHUFFLED } easel_order;

/* Runs all jobs in the calling thread, in that order, with worker numbers at random. */
typedef struct easel_crew {
    tyn_executor executor;
    easel_order order;
    int32_t fault; /* 1: leaves a job out; 2: runs one twice; 3: a worker number out of range; 4: refuses */
} easel_crew;
void easel_hire(easel_crew *crew, easel_order order, int32_t workers);

/* Rays from the origin of (x, y, w) through (r, 1): edge planes work for corners on either side of the eye. */
typedef struct easel_exact {
    double edge[3][3], normal[3], distance;
} easel_exact;
easel_exact easel_exact_new(double v[3][3]);

/* w where the ray meets the triangle; 0: it misses; -1: too near to an edge to tell, `margin` pixels of sizes `step`. */
double easel_exact_hit(const easel_exact *t, const double r[3], const double step[2], double margin);
double easel_dot(const double a[3], const double b[3]);
void easel_cross(const double a[3], const double b[3], double out[3]);

/* A parallel map over the texels' own coordinates: u = x / size, v = y / size, z = z. */
tyn_shadow easel_plain_map(int32_t size);

/* A random light: parallel, or perspective with near / distance. Rows U, V, Z, W. */
void easel_random_matrix(float m[16], int perspective);

void easel_set_corner(float *p, double x, double y, double z);

/* Texels that hold something. */
int64_t easel_count_set(const float *map, int32_t size);

#endif
