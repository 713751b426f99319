/* options.h - the command lines of `tyndall render` and `tyndall post`. */
#ifndef TOOL_OPTIONS_H
#define TOOL_OPTIONS_H

#include "output.h"
#include "render.h"

typedef enum options_command { OPTIONS_RENDER, OPTIONS_POST } options_command;

typedef struct options {
    const char *input;                           /* scene or frame */
    const char *out, *scatter, *surface, *depth; /* file names; NULL: not given */
    const char *frame;                           /* --frame: the beginning of names */
    output_kind kind;                            /* of out */
    render_settings settings;
    int32_t threads; /* 0: the machine's */
    int stats, help;
} options;

/* 0, or -1 with a message on stderr: bad usage. */
int options_parse(options *o, options_command command, int argc, char **argv);

void options_help(options_command command);

#endif
