/* model.h - small scenes of quads and boxes: built by calls or read from a scene file, in double for the oracle. */
#ifndef TYN_TEST_MODEL_H
#define TYN_TEST_MODEL_H

#include "oracle.h"

/* An empty scene: no lights, clear air, a camera at the origin that looks along -z. NULL without memory. */
oracle_scene *model_new(int width, int height);
void model_free(oracle_scene *scene);

void model_camera(oracle_scene *scene, double px, double py, double pz, double tx, double ty, double tz, double fov_degrees,
                  double near_depth, double far_depth);
void model_quad(oracle_scene *scene, const double a[3], const double b[3], const double c[3], double albedo);
void model_box(oracle_scene *scene, double x0, double y0, double z0, double x1, double y1, double z1, double albedo);
/* All channels alike, but for `blue` times the scattering in the third. */
void model_medium(oracle_scene *scene, double scatter, double absorb, double blue, tyn_phase phase, double g);
void model_sun(oracle_scene *scene, double dx, double dy, double dz, double irradiance);
void model_spot(oracle_scene *scene, double px, double py, double pz, double tx, double ty, double tz, double angle_degrees,
                double intensity);

/* Reads a scene file of quads, boxes and lights. NULL, with a line in stderr, where it has more than that. */
oracle_scene *model_read(const char *path);

/* A PFM's floats, top row first, in memory from malloc; NULL on failure. channels is 1 or 3. */
float *model_read_pfm(const char *path, int *width, int *height, int *channels);

#endif
