/* oracle.h - what scene-format.md's integral says, in double precision: no shadow maps, no steps.
 *
 * The geometry is convex polygons. The air behind a polygon, as a light sees it, is a convex volume bounded by planes, so a
 * view ray is dark in it along one interval whose ends are exact. Between all those ends the integral is smooth: a closed form
 * for directional lights, adaptive Gauss-Legendre quadrature for lights at a point. */
#ifndef TYN_TEST_ORACLE_H
#define TYN_TEST_ORACLE_H

#include "tyndall.h"

#define ORACLE_CORNERS 4
#define ORACLE_POLYGONS 1024
#define ORACLE_LIGHTS 4
#define ORACLE_MEDIA 4

typedef struct oracle_polygon {
    int corners; /* 3 or 4, convex and flat */
    double corner[ORACLE_CORNERS][3];
    double normal[3]; /* of length 1; set by oracle_prepare */
    double albedo[3];
} oracle_polygon;

typedef enum oracle_kind { ORACLE_DIRECTIONAL, ORACLE_SPOT, ORACLE_POINT } oracle_kind;

/* n . p >= d inside. */
typedef struct oracle_plane {
    double n[3], d;
} oracle_plane;

typedef struct oracle_volume {
    int planes; /* 0: the light lies in the polygon's plane, no shadow */
    oracle_plane plane[ORACLE_CORNERS + 1];
} oracle_volume;

/* Multiplies a light's colour, bilinear, dark outside; scene-format.md says how it lies. rgb NULL: none. */
typedef struct oracle_texture {
    int width, height;
    float *rgb; /* from malloc; oracle_release gives it back */
    double up[3], extent[2];
    double x[4], y[4], w[4]; /* texels of a point: (x, y) / w, each a dot product with (p, 1); by oracle_prepare */
    oracle_plane edge[4];    /* inside of it */
} oracle_texture;

typedef struct oracle_light {
    oracle_kind kind;
    double position[3], direction[3], colour[3];
    double cosine;          /* spot: of half the cone's angle */
    oracle_texture texture; /* of a sun (gobo) or a spot (slide: a square frustum, not a cone) */
    oracle_volume *volume;  /* of each polygon; by oracle_prepare */
} oracle_light;

typedef struct oracle_medium {
    double scatter[3], absorb[3];
    tyn_phase phase;
    double g;
} oracle_medium;

typedef struct oracle_camera {
    double position[3], right[3], up[3], forward[3];
    double left_edge, right_edge, bottom_edge, top_edge, near_depth, far_depth;
} oracle_camera;

typedef struct oracle_scene {
    int width, height;
    oracle_camera camera;
    int polygons, lights, media;
    oracle_polygon polygon[ORACLE_POLYGONS];
    oracle_light light[ORACLE_LIGHTS];
    oracle_medium medium[ORACLE_MEDIA];
    double ambient[3], background[3];
    double *scratch; /* dark intervals of a ray, 2 * (polygons + 1); by oracle_prepare */
} oracle_scene;

typedef struct oracle_pixel {
    double scatter[3]; /* L_scat; infinite where the ray meets a point light */
    double surface[3]; /* L_surface, not attenuated */
    double extinct[3]; /* exp(-sigma s) */
    double depth;      /* view-space depth, far where nothing is hit */
    int polygon;       /* that was hit; -1: none */
} oracle_pixel;

/* Precomputes normals and shadow volumes; 0 without memory. oracle_release gives it back. */
int oracle_prepare(oracle_scene *scene);
void oracle_release(oracle_scene *scene);

/* The view ray through (x, y) in pixels; the centre of the top left pixel is (0.5, 0.5). */
void oracle_trace(oracle_scene *scene, double x, double y, oracle_pixel *out);

/* Unit direction of that ray. */
void oracle_ray(const oracle_scene *scene, double x, double y, double v[3]);

/* L_scat along c + t v for t in 0 .. s. */
void oracle_scatter(oracle_scene *scene, const double v[3], double s, double out[3]);

/* 1: the light reaches the point (cone and polygons but the one numbered `except`), by tracing a ray: not the way
 * oracle_scatter finds it, so that one can be held against the other. */
int oracle_lit(const oracle_scene *scene, const oracle_light *light, const double point[3], int except);

/* The phase function. */
double oracle_phase(const oracle_medium *medium, double cosine);

/* The light's irradiance at a point, without visibility, for a channel's extinction. */
double oracle_irradiance(const oracle_light *light, const double point[3], double sigma, int channel);

/* Sum of scatter and absorb. */
double oracle_extinction(const oracle_scene *scene, int channel);

#endif
