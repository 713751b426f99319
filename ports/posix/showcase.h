/* showcase.h - the built-in scenes: the pictures of `tyndall showcase` and the benchmark's. */
#ifndef TOOL_SHOWCASE_H
#define TOOL_SHOWCASE_H

#include "scene.h"

/* Fills *s, which must be as scene_init leaves it: pillars, rose, forest, spot, terrain; simple-on, simple-off, leafy-on,
 * leafy-off. Returns 0, -1 without memory, 1 for an unknown name. scene_free releases it in all cases. */
int showcase_scene(const char *name, scene *s);

#endif
