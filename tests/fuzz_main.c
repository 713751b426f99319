/* fuzz_main.c - all targets as one program for libFuzzer and AFL++; TYN_FUZZ in the environment names the one to run. */
#include "fuzz.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"

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

static fuzz_target *target;

int LLVMFuzzerInitialize(int *argc, char ***argv);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

void fuzz_check(int passed, const char *file, int line, const char *text)
{
    if (!passed) {
        fprintf(stderr, "%s:%d: %s\n", file, line, text);
        abort();
    }
}

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    const char *name = getenv("TYN_FUZZ");
    (void)argc, (void)argv;
    for (size_t i = 0; name && i < sizeof targets / sizeof *targets; i++)
        if (strcmp(targets[i].name, name) == 0)
            target = targets[i].run;
    if (!target) {
        fprintf(stderr, "TYN_FUZZ must name a target\n");
        exit(2);
    }
    atexit(files_remove);
    return 0;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    target(data, size);
    return 0;
}
