/* fuzz_post.c - what `tyndall post` reads, and the picture of what is small. */
#include "fuzz.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "files.h"
#include "post.h"

enum { MOST_PIXELS = 40 * 30 };

static void draw(foreign *f)
{
    static pool *threads;
    render_settings settings;
    render_result result;
    tool_error error;
    if ((int64_t)f->s.width * f->s.height > MOST_PIXELS)
        return;
    for (int32_t i = 0; i < f->s.light_count; i++)
        if (f->lights[i].size > 512)
            f->lights[i].size = 512;
    if (!threads && (threads = pool_create(1)) == NULL)
        abort();
    memset(&settings, 0, sizeof settings);
    settings.shadow_size = 32;
    settings.slices = 16;
    settings.want_scatter = 1;
    error.text[0] = '\0';
    if (post_frame(f, "f.frame", &settings, threads, &result, &error) != 0) {
        FUZZ_CHECK(error.text[0]);
        return;
    }
    for (int32_t i = 0; i < 3 * f->s.width * f->s.height; i++) {
        FUZZ_CHECK(result.scatter[i] >= 0 && result.scatter[i] <= FLT_MAX);
        FUZZ_CHECK(result.radiance[i] >= 0 && result.radiance[i] <= FLT_MAX);
    }
    render_free(&result);
}

void fuzz_post(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"f.frame", "d.pfm", "d.pgm", "c.pfm", "c.ppm", "m.pgm"};
    tool_error error;
    foreign f;
    fuzz_files(data, size, names, 6);
    error.text[0] = '\0';
    if (foreign_load(&f, files_path("f.frame"), &error) != 0) {
        FUZZ_CHECK(error.text[0]);
        return;
    }
    draw(&f);
    foreign_free(&f);
}
