/* foreign.h - somebody else's frame in memory: what `tyndall post` reads. The file format is in README.md beside this file. */
#ifndef TOOL_FOREIGN_H
#define TOOL_FOREIGN_H

#include "error.h"
#include "scene.h"

typedef struct foreign_light {
    tyn_shadow maps[TYN_MAX_MAPS];
    int32_t count;
    int from_depth;  /* 'shadow depth': the maps are to be made of the frame's own depth */
    int32_t size;    /* of those; 0: the default */
    float jump;      /* relative jump of depth where that surface is torn */
    float thickness; /* metres it goes on behind its edges; 0: none */
} foreign_light;

typedef struct foreign {
    scene s; /* image size, media, lights, and all images; no meshes */
    tyn_camera camera;
    tyn_image depth; /* memory of s, as colour's */
    tyn_depth_coding coding;
    int has_unknown; /* the stored value `unknown` means: not measured */
    float unknown;
    tyn_image colour; /* TYN_RGB_F32; pixels NULL: black */
    foreign_light lights[TYN_MAX_LIGHTS];
    float shaft_contrast, fog_scale, max_distance; /* as in tyn_frame */
} foreign;

/* Reads a frame file and all that it names. -1: *error says what and where, nothing to free. */
int foreign_load(foreign *f, const char *path, tool_error *error);
void foreign_free(foreign *f);

#endif
