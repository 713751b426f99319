/* parse.h - scene files, version 1. */
#ifndef TOOL_PARSE_H
#define TOOL_PARSE_H

#include "error.h"
#include "scene.h"

/* Fills an empty scene from a file and all files that it names. -1: *error says what and where, the scene is empty again. */
int scene_load(scene *s, const char *path, tool_error *error);

#endif
