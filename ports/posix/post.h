/* post.h - somebody else's frame to a picture with shafts. */
#ifndef TOOL_POST_H
#define TOOL_POST_H

#include "foreign.h"
#include "render.h"

/* As render_scene. Makes the shadow maps that the frame wants made of its depth. */
int post_frame(foreign *f, const char *name, const render_settings *settings, pool *threads, render_result *result,
               tool_error *error);

#endif
