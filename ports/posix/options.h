/* options.h - the command lines of `tyndall render`, `post` and `bench`. */
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
    const char *bench_scene; /* --bench-scene; NULL: not given */
    int32_t repeats;         /* of bench; 0: not given */
    int32_t threads;         /* 0: the machine's */
    int brief;
    int stats, help;
} options;

/* 0, or -1 with a message on stderr: bad usage. */
int options_parse(options *o, options_command command, int argc, char **argv);

/* The same for `tyndall bench`, which reads and writes no files. */
int options_parse_bench(options *o, int argc, char **argv);

void options_help(options_command command);
void options_help_bench(void);

#endif
