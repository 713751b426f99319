/* obj.h - Wavefront OBJ and MTL. */
#ifndef TOOL_OBJ_H
#define TOOL_OBJ_H

#include "error.h"
#include "pnm.h"
#include "scene.h"

/* Where an OBJ goes: p -> matrix p + translate. */
typedef struct obj_place {
    double matrix[3][3];
    double translate[3];
    float albedo[3]; /* of faces whose material has no Kd and no map_Kd */
} obj_place;

/* Adds a file's faces to the scene, one mesh per material. -1: error set. */
int obj_load(scene *s, const char *path, const obj_place *place, texture_cache *textures, tool_error *error);

#endif
