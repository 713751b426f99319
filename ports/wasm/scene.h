/* scene.h - the page's scene: a circle of standing stones and some trees, made in the caller's memory, without libc. */
#ifndef WASM_SCENE_H
#define WASM_SCENE_H

#include "tyndall.h"

enum { SCENE_GROUND, SCENE_STONE, SCENE_BARK, SCENE_LEAF, SCENE_MESHES, SCENE_CASTERS = SCENE_STONE };

typedef struct scene {
    tyn_mesh meshes[SCENE_MESHES]; /* those from SCENE_CASTERS on cast shadows */
    tyn_image textures[SCENE_MESHES];
    float low[3], high[3]; /* the box around what casts shadows */
} scene;

/* Bytes that scene_build wants, at an address of any alignment. */
size_t scene_bytes(void);
void scene_build(scene *s, void *memory);

/* The sine and cosine of degrees: the same bits everywhere, which libm's are not. */
void scene_turn(float degrees, float *sine, float *cosine);

#endif
