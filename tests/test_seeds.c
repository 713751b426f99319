/* test_seeds.c - every seed of every fuzz target: what once was found, and what fuzzing begins with. */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "fuzz.h"
#include "test.h"

#define TARGET(name) fuzz_target fuzz_##name;
#include "targets.h"
#undef TARGET

static const struct {
    const char *name;
    fuzz_target *run;
} targets[] = {
#define TARGET(name) {#name, fuzz_##name},
#include "targets.h"
};

static char path[512];

void fuzz_check(int passed, const char *file, int line, const char *text)
{
    if (!passed)
        printf("  %s\n", path);
    test_check(passed, file, line, text);
}

static void run(const char *target, fuzz_target *function)
{
    DIR *folder;
    struct dirent *entry;
    int seeds = 0;
    snprintf(path, sizeof path, "tests/seeds/%s", target);
    folder = opendir(path);
    CHECK(folder != NULL);
    while (folder && (entry = readdir(folder)) != NULL) {
        size_t size = 0;
        char *bytes;
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "tests/seeds/%s/%s", target, entry->d_name);
        bytes = files_read(path, &size);
        CHECK(bytes != NULL);
        if (!bytes)
            continue;
        function((const uint8_t *)bytes, size);
        free(bytes);
        seeds++;
    }
    if (folder)
        closedir(folder);
    CHECK(seeds > 0);
    function(NULL, 0);
}

void test_seeds(void)
{
    for (size_t i = 0; i < sizeof targets / sizeof *targets; i++) {
        static char text[80]; /* lives as long as the test */
        test_end();
        snprintf(text, sizeof text, "seeds of the fuzz target %s", targets[i].name);
        TEST(text);
        run(targets[i].name, targets[i].run);
    }
    files_remove();
}
