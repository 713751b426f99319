/* mtl.h - the materials of an OBJ. */
#ifndef TOOL_MTL_H
#define TOOL_MTL_H

#include "error.h"
#include "names.h"
#include "pnm.h"
#include "text.h"

typedef struct mtl {
    int defined;       /* newmtl was seen; else usemtl alone */
    int32_t used_line; /* of the first usemtl, when it was not defined then */
    int has_kd;
    float kd[3];
    const tyn_image *colour, *mask; /* map_Kd, map_d */
    int left_out;                   /* d below 0.5 */
} mtl;

/* Zero bytes are an empty set. */
typedef struct mtl_set {
    mtl *all; /* by their number in names */
    int32_t capacity;
    name_set names, files; /* files: keys of the libraries that were read */
} mtl_set;

void mtl_set_free(mtl_set *set);

/* The number of a material of that name, new if there is none; -1: no memory. */
int32_t mtl_find(mtl_set *set, token name);

/* Reads a library, once. -1: error set. */
int mtl_load(mtl_set *set, const char *path, scene *s, texture_cache *textures, tool_error *error);

#endif
