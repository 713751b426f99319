/* fuzz_ppm.c - PPM and PGM files as textures, as masks and as depth. */
#include "fuzz.h"

#include "files.h"
#include "pnm.h"

/* All bytes of the picture are there, and are its own. */
static void check(const tyn_image *image, const tool_error *error)
{
    uint32_t sum = 0;
    if (!image) {
        FUZZ_CHECK(error->text[0]);
        return;
    }
    FUZZ_CHECK(image->width >= 1 && image->height >= 1);
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height * (size_t)tyn_format_bytes(image->format); i++)
        sum += ((const uint8_t *)image->pixels)[i];
    FUZZ_CHECK(image->format != TYN_MASK8 || sum % 255 == 0);
}

void fuzz_ppm(const uint8_t *data, size_t size)
{
    const char *path = files_write("t.ppm", data, size);
    tyn_image *counts;
    tool_error error;
    int32_t most = 0;
    scene s;
    scene_init(&s);
    error.text[0] = '\0';
    check(pnm_load_colour(&s, path, &error), &error);
    error.text[0] = '\0';
    check(pnm_load_mask(&s, path, &error), &error);
    error.text[0] = '\0';
    counts = pnm_load_counts(&s, path, &most, &error);
    check(counts, &error);
    for (int32_t i = 0; counts && i < counts->width * counts->height; i++)
        FUZZ_CHECK(((const uint16_t *)counts->pixels)[i] <= most);
    scene_free(&s);
}
