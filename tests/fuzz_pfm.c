/* fuzz_pfm.c - PFM files, there and back. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "pfm.h"

void fuzz_pfm(const uint8_t *data, size_t size)
{
    const char *path = files_write("x.pfm", data, size);
    tool_error error;
    pfm first, second;
    size_t bytes;
    FILE *file;
    error.text[0] = '\0';
    if (pfm_load(&first, path, &error) != 0) {
        FUZZ_CHECK(error.text[0]);
        return;
    }
    bytes = (size_t)first.width * (size_t)first.height * (size_t)first.channels * sizeof *first.values;
    file = fopen(path, "wb");
    if (!file || pfm_write(file, first.values, first.width, first.height, first.channels) != 0 || fclose(file) != 0)
        abort();
    FUZZ_CHECK(pfm_load(&second, path, &error) == 0);
    FUZZ_CHECK(first.width == second.width && first.height == second.height && first.channels == second.channels);
    FUZZ_CHECK(memcmp(first.values, second.values, bytes) == 0);
    free(first.values);
    free(second.values);
}
