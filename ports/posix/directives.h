/* directives.h - the directives that scene files and frame files share, and how both begin. */
#ifndef TOOL_DIRECTIVES_H
#define TOOL_DIRECTIVES_H

#include "keys.h"
#include "pnm.h"
#include "scene.h"

typedef struct parser {
    text t;
    scene *s;
    texture_cache textures;
    token directive;
    int frame; /* a frame file: lights have more keys, and a direction of length 1 is taken as it is */
    int images, cameras, backgrounds, ambients;
} parser;

#define READ_KEYS(p, keys) keys_read(&(p)->t, (p)->directive, keys, sizeof(keys) / sizeof *(keys))

/* The whole file: `word 1` first, then directive(p) for each line. -1: error set. */
int directives_read(parser *p, const char *word, int (*directive)(parser *p));
int directives_missing(parser *p, const char *name);

int directive_once(parser *p, int *count);
int directive_end(parser *p); /* nothing more on this line */

int directive_image(parser *p);
int directive_medium(parser *p);
int directive_light(parser *p);

/* The keys of a camera as scenes have it, and what to do when they are read. */
#define CAMERA_KEYS(c, degrees)                                                                                                \
    KEY("position", NUMBERS, 3, ANY, 1, (c)->position), KEY("target", NUMBERS, 3, ANY, 1, (c)->target),                        \
        KEY("up", NUMBERS, 3, ANY, 0, (c)->up), KEY("fov_y", NUMBERS, 1, BELOW_180, 1, degrees),                               \
        KEY("near", NUMBERS, 1, POSITIVE, 1, &(c)->near_depth), KEY("far", NUMBERS, 1, POSITIVE, 1, &(c)->far_depth)
int directive_camera_look(parser *p, scene_camera *c, const key *keys, float degrees);

/* A texture beside the file, read once; NULL: error set. */
tyn_image *directive_texture(parser *p, token name);

#endif
