/* main.c - runs the rooms' tests: all, those named on the command line, or all but those named with a minus. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "test.h"

#define ROOM(name) void test_##name(void);
#include "rooms.h"
#undef ROOM

static const struct {
    const char *name;
    void (*run)(void);
} rooms[] = {
#define ROOM(name) {#name, test_##name},
#include "rooms.h"
};

static int wanted(const char *name, int argc, char **argv)
{
    int want = argc < 2 || argv[1][0] == '-';
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], name) == 0)
            want = 1;
        if (argv[i][0] == '-' && strcmp(argv[i] + 1, name) == 0)
            want = 0;
    }
    return want;
}

/* Arguments that are the name of no room. */
static int unknown(int argc, char **argv, int count)
{
    int bad = 0;
    for (int i = 1; i < argc; i++) {
        int known = 0;
        for (int r = 0; r < count; r++)
            known |= strcmp(argv[i] + (argv[i][0] == '-'), rooms[r].name) == 0;
        bad += !known;
    }
    return bad;
}

int main(int argc, char **argv)
{
    const char *given = getenv("TYN_SEED");
    unsigned long seed = given ? strtoul(given, NULL, 0) : 1;
    const int count = (int)(sizeof rooms / sizeof *rooms);
    int passed = 0, failed = 0;
    printf("seed %lu (TYN_SEED)\n", seed & 0xffffffffu);
    for (int r = 0; r < count; r++) {
        int before_passed = passed, before_failed = failed;
        clock_t start = clock();
        if (!wanted(rooms[r].name, argc, argv))
            continue;
        test_seed((uint32_t)seed); /* for each room anew: one run alone sees what it saw among the others */
        rooms[r].run();
        test_end();
        test_count(&passed, &failed);
        printf("%-12s %3d passed, %d failed, %.1f s\n", rooms[r].name, passed - before_passed, failed - before_failed,
               (double)(clock() - start) / CLOCKS_PER_SEC);
        fflush(stdout);
    }
    if (unknown(argc, argv, count)) {
        printf("FAILED: no such room; there are:");
        for (int r = 0; r < count; r++)
            printf(" %s", rooms[r].name);
        printf("\n");
        failed++;
    }
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
