/* mtl.h - the materials of an OBJ. */
#ifndef TOOL_MTL_H
#define TOOL_MTL_H

#include "error.h"
#include "pnm.h"
#include "text.h"

typedef struct mtl {
    char *name;
    int32_t next;      /* in its hash chain, -1 at the end */
    int defined;       /* newmtl was seen; else usemtl alone */
    int32_t used_line; /* of the first usemtl, when it was not defined then */
    int has_kd;
    float kd[3];
    const tyn_image *colour, *mask; /* map_Kd, map_d */
    int left_out;                   /* d below 0.5 */
} mtl;

#define MTL_CHAINS 4096

typedef struct mtl_set {
    mtl *all;
    int32_t count, capacity;
    int32_t *chains; /* MTL_CHAINS of them: first material by hash of the name, -1: none */
    char **files;    /* the libraries that were read */
    int32_t file_count, file_capacity;
} mtl_set;

int mtl_set_init(mtl_set *set); /* -1: no memory */
void mtl_set_free(mtl_set *set);

/* The number of a material of that name, new if there is none; -1: no memory. */
int32_t mtl_find(mtl_set *set, token name);

/* Reads a library, once. -1: error set. */
int mtl_load(mtl_set *set, const char *path, scene *s, texture_cache *textures, tool_error *error);

#endif
