/* keys.h - a directive as a table of its keys: what scene files and frame files have in common, below the directives. */
#ifndef TOOL_KEYS_H
#define TOOL_KEYS_H

#include "text.h"

typedef enum key_range { ANY, NOT_NEGATIVE, UNIT, POSITIVE, BELOW_180, BELOW_170 } key_range;
typedef enum key_kind { NUMBERS, FILE_NAME, WORD, FLAG, PHASE } key_kind; /* FLAG: nothing after it */

typedef struct key {
    const char *name;
    key_kind kind;
    int count; /* of numbers */
    key_range range;
    int required;
    float *numbers; /* holds the default */
    /* What was found: */
    int seen;
    token at, word; /* the key; the file name, the word or the phase */
} key;

#define KEY(name, kind, count, range, required, numbers)                                                                       \
    {                                                                                                                          \
        name, kind, count, range, required, numbers, 0, {NULL, 0},                                                             \
        {                                                                                                                      \
            NULL, 0                                                                                                            \
        }                                                                                                                      \
    }

/* The rest of the line as keys. -1: error set. */
int keys_read(text *t, token directive, key *keys, size_t count);

/* `count` numbers after the token `of`. -1: error set. */
int keys_numbers(text *t, token of, int count, key_range r, float *out);

/* Where the key's word is in a list that ends with NULL; -1: error set. */
int keys_word(text *t, const key *k, const char *const *words);

double vector_length(const double v[3]);
void vector_difference(const float a[3], const float b[3], double out[3]);
int vector_is_zero(const float v[3]);
int matrix_is_invertible(const float m[16]);
int vector_parallel(const double a[3], const float b[3]);

#endif
