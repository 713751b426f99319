/* mtl.c */
#include "mtl.h"
#include "file.h"

#include <stdlib.h>
#include <string.h>

void mtl_set_free(mtl_set *set)
{
    names_free(&set->names);
    names_free(&set->files);
    free(set->all);
    memset(set, 0, sizeof *set);
}

int32_t mtl_find(mtl_set *set, token name)
{
    int32_t count = set->names.count, at = names_find(&set->names, name.start, name.length);
    if (at >= set->capacity) {
        mtl *more = realloc(set->all, (size_t)set->names.capacity * sizeof *more);
        if (!more)
            return -1;
        set->all = more;
        set->capacity = set->names.capacity;
    }
    if (at == count)
        memset(&set->all[at], 0, sizeof *set->all);
    return at;
}

static const tyn_image *map(text *t, token statement, scene *s, texture_cache *textures, int mask)
{
    token name;
    char *path;
    const tyn_image *image;
    if (!text_rest(t, &name)) {
        text_fail(t, statement, "a file name is missing after it");
        return NULL;
    }
    /* "-s 2 2 1 file" and the like would change the picture: rather none than a wrong one. */
    if (name.start[0] == '-') {
        text_fail(t, name, "options of textures are not supported");
        return NULL;
    }
    path = file_beside(t->file, name.start, name.length);
    if (!path) {
        error_memory(t->error);
        return NULL;
    }
    image = texture_load(textures, s, path, mask, t->error);
    free(path);
    if (!image)
        error_wrap(t->error, t->file, t->line, name.start, name.length);
    return image;
}

static int dissolve(text *t, token statement, mtl *m)
{
    token value;
    float d;
    text ahead = *t;
    if (text_token(&ahead, &value) && token_is(value, "-halo"))
        *t = ahead;
    if (text_number(t, statement, &d) != 0)
        return -1;
    m->left_out = d < 0.5f;
    return 0;
}

static int diffuse(text *t, token statement, mtl *m)
{
    for (int k = 0; k < 3; k++) {
        text before = *t;
        token number;
        text_token(&before, &number);
        if (text_number(t, statement, &m->kd[k]) != 0)
            return -1;
        if (m->kd[k] < 0.0f || m->kd[k] > 1.0f)
            return text_fail(t, number, "Kd must be from 0 to 1");
    }
    m->has_kd = 1;
    return 0;
}

static int statements(mtl_set *set, text *t, scene *s, texture_cache *textures)
{
    int32_t current = -1;
    while (text_line(t)) {
        token word, name;
        int known;
        if (!text_token(t, &word))
            continue;
        if (token_is(word, "newmtl")) {
            mtl *m;
            if (!text_rest(t, &name))
                return text_fail(t, word, "a name is missing after it");
            current = mtl_find(set, name);
            if (current < 0)
                return error_memory(t->error);
            m = &set->all[current]; /* defined again: the last one holds */
            m->defined = 1;
            m->has_kd = m->left_out = 0;
            m->colour = m->mask = NULL;
            continue;
        }
        known = token_is(word, "Kd") || token_is(word, "d") || token_is(word, "map_Kd") || token_is(word, "map_d");
        if (!known)
            continue;
        if (current < 0)
            return text_fail(t, word, "stands before the first newmtl");
        mtl *m = &set->all[current];
        if (token_is(word, "Kd")) {
            if (diffuse(t, word, m) != 0)
                return -1;
        } else if (token_is(word, "d")) {
            if (dissolve(t, word, m) != 0)
                return -1;
        } else {
            int mask = token_is(word, "map_d");
            const tyn_image *image = map(t, word, s, textures, mask);
            if (!image)
                return -1;
            if (mask)
                m->mask = image;
            else
                m->colour = image;
            continue;
        }
        if (text_token(t, &name))
            return text_fail(t, name, "one token too many");
    }
    return 0;
}

int mtl_load(mtl_set *set, const char *path, scene *s, texture_cache *textures, tool_error *error)
{
    text t;
    int result;
    int32_t count = set->files.count, at = count;
    uintmax_t key[2];
    if (file_key(path, key) == 0)
        at = names_find(&set->files, key, sizeof key);
    if (at < count)
        return at < 0 ? error_memory(error) : 0;
    if (text_open(&t, path, TEXT_OBJ, error) != 0)
        return -1;
    result = statements(set, &t, s, textures);
    text_close(&t);
    return result;
}
