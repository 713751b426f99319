/* fuzz_mtl.c - MTL files with their pictures. */
#include "fuzz.h"

#include "files.h"
#include "mtl.h"

void fuzz_mtl(const uint8_t *data, size_t size)
{
    static const char *const names[] = {"m.mtl", "t.ppm", "k.pgm"};
    texture_cache textures = {0};
    tool_error error;
    mtl_set set = {0};
    scene s;
    int status;
    fuzz_files(data, size, names, 3);
    scene_init(&s);
    error.text[0] = '\0';
    status = mtl_load(&set, files_path("m.mtl"), &s, &textures, &error);
    FUZZ_CHECK(status == 0 || error.text[0]);
    for (int32_t i = 0; i < set.names.count && status == 0; i++) {
        const mtl *m = &set.all[i];
        FUZZ_CHECK(names_find(&set.names, set.names.all[i].text, set.names.all[i].length) == i);
        for (int k = 0; k < 3; k++)
            FUZZ_CHECK(!m->has_kd || (m->kd[k] >= 0 && m->kd[k] <= 1));
        FUZZ_CHECK(!m->colour || tyn_format_bytes(m->colour->format) >= 3);
        FUZZ_CHECK(!m->mask || m->mask->format == TYN_MASK8);
    }
    mtl_set_free(&set);
    texture_cache_free(&textures);
    scene_free(&s);
}
