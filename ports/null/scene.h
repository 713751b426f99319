/* scene.h - a hall with tall windows that the sun looks into, made in code: no files, no libm, the same floats everywhere. */
#ifndef NULL_SCENE_H
#define NULL_SCENE_H

#include "tyndall.h"

#define SCENE_BOXES 64 /* room for */
#define SCENE_FAR 40.0f

typedef struct scene {
    float corner[SCENE_BOXES][8][3];
    uint32_t index[SCENE_BOXES][12][3];
    tyn_mesh mesh[2]; /* stone and floor */
    tyn_camera camera;
    tyn_light sun;
    tyn_medium air;
    float ambient[3], sky[3];
} scene;

/* All of it but the sun's map. `moment`, -1 .. 1, moves the sun from the left to the right. */
tyn_status scene_make(scene *s, float moment, int32_t width, int32_t height);

#endif
