/* fuzz.h - what the fuzz targets share. A target is tests/fuzz_NAME.c with a function fuzz_NAME that takes any bytes; it is
 * built into a fuzzer (tests/fuzz_main.c, `make fuzz`), and into the unit tests, which give it every file of tests/seeds/NAME.
 */
#ifndef TYN_TEST_FUZZ_H
#define TYN_TEST_FUZZ_H

#include <stddef.h>
#include <stdint.h>

#include "tyndall.h"

typedef void fuzz_target(const uint8_t *data, size_t size);

/* What must hold for any input. A fuzzer aborts where it does not; the unit tests count. */
#define FUZZ_CHECK(condition) fuzz_check(!!(condition), __FILE__, __LINE__, #condition)
void fuzz_check(int passed, const char *file, int line, const char *text);

/* ---- numbers out of bytes ---- */

/* What is left of an input. At its end come zeros, so that an empty input is each target's plain case. */
typedef struct fuzz_bytes {
    const uint8_t *at;
    size_t left;
} fuzz_bytes;

uint32_t fuzz_byte(fuzz_bytes *f);
uint32_t fuzz_word(fuzz_bytes *f);
int32_t fuzz_int(fuzz_bytes *f); /* mostly small; powers of two and the library's limits */
float fuzz_float(fuzz_bytes *f); /* mostly plain; what is odd in floats, and any bits */

/* Numbers of structs that the input may change one by one: an input is a plain case and what is wrong with it. */
typedef struct fuzz_slots {
    struct {
        void *at;
        int is_float;
    } slot[1024];
    int count;
} fuzz_slots;

void fuzz_floats(fuzz_slots *s, float *at, int count);
void fuzz_int_slots(fuzz_slots *s, void *at, int count); /* enums too */
void fuzz_edit(fuzz_bytes *f, const fuzz_slots *s);

/* Of a shadow map and its stride, and of a light without scale and tint. */
void fuzz_shadow_slots(fuzz_slots *s, tyn_shadow *m, int32_t *stride);
void fuzz_light_slots(fuzz_slots *s, tyn_light *l);

/* ---- memory ---- */

/* Exactly so many bytes, until fuzz_release. */
void *fuzz_memory(size_t bytes);
void *fuzz_block(size_t bytes); /* aligned to TYN_ALIGNMENT */
void fuzz_release(void);

/* Memory for what the image's fields say, and its pixels at their place in it. Fields that must be refused get a few bytes
 * alone. Large ones that need not be refused are set to what must. */
typedef struct fuzz_picture {
    tyn_image *image;
    uint8_t *block, *before;
    size_t size;
} fuzz_picture;
fuzz_picture fuzz_picture_new(tyn_image *image);
/* A shadow map's, by the same rules. */
void fuzz_shadow_texels(tyn_shadow *shadow, uint32_t *random, uint32_t kind);

/* Floats, or 16 bits, or bytes of one of several kinds: flat, ramps, steps, noise, and odd ones in between. */
void fuzz_fill(void *at, size_t bytes, int component, uint32_t kind, uint32_t *random);

void fuzz_keep(fuzz_picture *p);    /* its bytes as they are now are what was before a call */
void fuzz_restore(fuzz_picture *p); /* them again */
int fuzz_untouched(const fuzz_picture *p);
int fuzz_framed(const fuzz_picture *p);           /* nothing changed between the rows */
int fuzz_good(const fuzz_picture *p, float most); /* an image of floats: all 0 .. most */

/* Runs jobs in reverse, with varying worker numbers, in the calling thread. */
tyn_executor fuzz_reversed(int32_t *workers);

/* ---- files ---- */

/* An input is the files one after the other, with a byte 1 between them. Writes them; see files.h. */
void fuzz_files(const uint8_t *data, size_t size, const char *const *names, int count);

#endif
