/* options.h - the command line of `tyndall render`. */
#ifndef TOOL_OPTIONS_H
#define TOOL_OPTIONS_H

#include "output.h"
#include "render.h"

typedef struct options {
    const char *scene, *out, *scatter, *surface, *depth; /* file names; NULL: not given */
    output_kind kind;                                    /* of out */
    render_settings settings;
    int32_t threads; /* 0: the machine's */
    int stats, help;
} options;

/* 0, or -1 with a message on stderr: bad usage. */
int options_parse(options *o, int argc, char **argv);

void options_help(void);

#endif
