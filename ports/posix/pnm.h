/* pnm.h - PPM (P3, P6) and PGM (P2, P5) as textures and as depth. */
#ifndef TOOL_PNM_H
#define TOOL_PNM_H

#include "error.h"
#include "names.h"
#include "scene.h"

/* A texture: TYN_RGB8_LINEAR for a maxval of 255, else TYN_RGB16_LINEAR with the values stretched to 65535. NULL: error set. */
tyn_image *pnm_load_colour(scene *s, const char *path, tool_error *error);

/* A mask: TYN_MASK8 with 0 where a value is below half of maxval, else 255. NULL: error set. */
tyn_image *pnm_load_mask(scene *s, const char *path, tool_error *error);

/* Depth: TYN_DEPTH_U16 with the values as they stand in the file, 0 .. maxval. NULL: error set. */
tyn_image *pnm_load_counts(scene *s, const char *path, int32_t *maxval, tool_error *error);

/* The textures of a scene, each file of which is read once, by whatever names. Zero bytes are an empty cache. */
typedef struct texture_cache {
    name_set files; /* by key, and whether it is a mask */
    tyn_image **images;
    int32_t capacity;
} texture_cache;

/* The image of a file, read at its first use. NULL: error set. */
tyn_image *texture_load(texture_cache *cache, scene *s, const char *path, int mask, tool_error *error);
void texture_cache_free(texture_cache *cache);

#endif
