/* showcase_scenes.h - one function a built-in scene: fills an empty scene, returns 0, or -1 without memory. */
#ifndef TOOL_SHOWCASE_SCENES_H
#define TOOL_SHOWCASE_SCENES_H

#include "scene.h"

int scene_pillars(scene *s);
int scene_rose(scene *s);
int scene_forest(scene *s);
int scene_spot(scene *s);
int scene_terrain(scene *s);
int scene_bench(scene *s, int leafy, int on_screen);

#endif
