/* test.h - the checks of tyndall's tests: each failed CHECK prints its place and its text and is counted. */
#ifndef TYN_TEST_H
#define TYN_TEST_H

#include <stdint.h>

/* One room's tests: tests/test_<room>.c defines `void test_<room>(void)`, tests/main.c calls it. */

/* Starts a named test; the checks that follow belong to it. One test counts as one passed or failed. */
void test_begin(const char *name);
void test_check(int passed, const char *file, int line, const char *text);
void test_skip(const char *why); /* prints SKIPPED and the reason; the test counts as neither */

/* The first place in memory at TYN_ALIGNMENT bytes: blocks want as much more. */
void *test_aligned(void *memory);

/* Reproducible random numbers: the same at every run, as a check that fails one day in ten proves nothing on the other nine.
 * Their seed is printed; TYN_SEED in the environment is another one, to hunt with. */
uint32_t test_random(void);
float test_random_float(float low, float high);

#define TEST(name) test_begin(name)
#define CHECK(condition) test_check(!!(condition), __FILE__, __LINE__, #condition)
/* |a - b| <= tolerance; prints both. */
#define CHECK_NEAR(a, b, tolerance) test_near((double)(a), (double)(b), (double)(tolerance), __FILE__, __LINE__, #a " ~ " #b)
void test_near(double a, double b, double tolerance, const char *file, int line, const char *text);

/* The path of a shared file, such as "reference/01_pillars.scene": below TYN_SHARED in the environment, else below ../shared.
 * NULL, after a test_skip of the running test, where it is not there. Valid until the next call. */
const char *test_shared(const char *path);

/* For tests/main.c. */
void test_seed(uint32_t seed);             /* starts the random numbers of a room */
void test_end(void);                       /* closes the running test */
void test_count(int *passed, int *failed); /* so far */

#endif
