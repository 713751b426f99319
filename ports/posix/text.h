/* text.h - text files by lines and tokens: scenes, OBJ and MTL. */
#ifndef TOOL_TEXT_H
#define TOOL_TEXT_H

#include <stddef.h>
#include <stdint.h>

#include "error.h"

typedef struct token {
    const char *start; /* into the text; not ended by NUL */
    size_t length;
} token;

typedef enum text_kind {
    TEXT_SCENE, /* # starts a comment anywhere */
    TEXT_OBJ    /* # at the start of a token does; a backslash at the end joins lines */
} text_kind;

typedef struct text {
    const char *file; /* its name, for messages */
    char *data;       /* owned */
    text_kind kind;
    char *next, *end;     /* what is left after this line */
    char *at, *line_end;  /* what is left of this line */
    int32_t line, joined; /* its number, from 1; lines joined to it */
    tool_error *error;
} text;

/* Reads the whole file; a NUL byte in it is an error. -1: error is set (without the line of whoever asked: see error_wrap). */
int text_open(text *t, const char *file, text_kind kind, tool_error *error);
void text_close(text *t);

/* Goes to the next line; 0 at the end of the file. */
int text_line(text *t);

/* The next token of the line; 0 (and an empty token) when there is none. */
int text_token(text *t, token *out);

/* The rest of the line without the blanks around it: names in OBJ and MTL may hold blanks. 0 when nothing is left. */
int text_rest(text *t, token *out);

int token_is(token t, const char *word);

/* The whole token as strtof reads it in the "C" locale; 0 if it is none or not finite. */
int token_number(token t, float *out);

/* The next token as a number; `of` is the token to blame when the line ends too early. -1: error set. */
int text_number(text *t, token of, float *out);

/* An error at this line; returns -1. */
int text_fail(text *t, token at, const char *format, ...) TOOL_PRINTF(3, 4);

#endif
