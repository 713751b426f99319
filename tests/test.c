/* test.c - see test.h */
#include "test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tyndall.h"

#define SHOWN 10 /* failed checks of one test that are printed; a broken loop should not bury the others */

static struct {
    const char *name; /* NULL: none is running */
    int failed_checks;
    int checks;
    int skipped;
    int passed;
    int failed;
    uint32_t random;
} state = {NULL, 0, 0, 0, 0, 0, 1};

void test_end(void)
{
    if (!state.name)
        return;
    if (!state.checks && !state.skipped) {
        printf("FAILED %s: it checks nothing\n", state.name);
        state.failed_checks++;
    }
    if (state.failed_checks > SHOWN)
        printf("FAILED %s: and %d more checks\n", state.name, state.failed_checks - SHOWN);
    if (state.failed_checks)
        state.failed++;
    else if (!state.skipped)
        state.passed++;
    state.name = NULL;
    fflush(stdout);
}

void test_begin(const char *name)
{
    test_end();
    state.name = name;
    state.failed_checks = state.checks = state.skipped = 0;
}

static void complain(const char *file, int line)
{
    if (!state.name)
        test_begin("(check outside of a test)");
    state.checks++;
    if (state.failed_checks++ < SHOWN)
        printf("FAILED %s: %s:%d: ", state.name, file, line);
}

void test_check(int passed, const char *file, int line, const char *text)
{
    if (passed) {
        state.checks++;
        return;
    }
    complain(file, line);
    if (state.failed_checks <= SHOWN)
        printf("%s\n", text);
}

void test_near(double a, double b, double tolerance, const char *file, int line, const char *text)
{
    double distance = a > b ? a - b : b - a;
    if (distance <= tolerance || (a >= b && a <= b)) { /* the second for two infinities; a NaN fails both */
        state.checks++;
        return;
    }
    complain(file, line);
    if (state.failed_checks <= SHOWN)
        printf("%s: %.9g, %.9g, tolerance %.3g\n", text, a, b, tolerance);
}

void test_skip(const char *why)
{
    state.skipped = 1;
    printf("SKIPPED: %s: %s\n", state.name ? state.name : "", why);
}

void test_seed(uint32_t seed)
{
    state.random = seed ? seed : 1;
}

/* xorshift32 (Marsaglia 2003): any nonzero state visits all others. */
uint32_t test_random(void)
{
    uint32_t x = state.random;
    x ^= x << 13;
    x ^= x >> 17;
    x ^= x << 5;
    return state.random = x;
}

float test_random_float(float low, float high)
{
    return low + (high - low) * ((float)(test_random() >> 8) / 16777216.0f);
}

const char *test_shared(const char *path)
{
    static char full[1024], why[1100];
    const char *root = getenv("TYN_SHARED");
    FILE *file = NULL;
    int length = snprintf(full, sizeof full, "%s/%s", root && *root ? root : "../shared", path);
    if (length > 0 && (size_t)length < sizeof full)
        file = fopen(full, "rb");
    if (file) {
        fclose(file);
        return full;
    }
    snprintf(why, sizeof why, "no %s (TYN_SHARED says where the shared data is)", full);
    test_skip(why);
    return NULL;
}

void test_count(int *passed, int *failed)
{
    *passed = state.passed;
    *failed = state.failed;
}

void *test_aligned(void *memory)
{
    return (void *)(((uintptr_t)memory + TYN_ALIGNMENT - 1) / TYN_ALIGNMENT * TYN_ALIGNMENT);
}
