/* obj.c */
#include "obj.h"
#include "file.h"
#include "mtl.h"
#include "text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#define NONE UINT32_MAX
#define TRIES 64 /* in the hash table: pairs made to collide become vertices of their own, and cost no squares */

/* The triangles of one material, either those with texture coordinates or those without. A vertex is a pair of numbers in the
 * file's lists of v and vt (NONE without). */
typedef struct part {
    int32_t material; /* -1: before any usemtl */
    int textured;
    uint32_t (*pairs)[2];
    uint32_t *indices;
    size_t vertices, corners; /* used; corners is three times the triangles */
    size_t vertex_capacity, corner_capacity;
} part;

/* A number that points beyond what the file held when it was read; a later line may still bring it. */
typedef struct beyond {
    uint32_t largest; /* from 1; 0: none */
    int32_t line;
} beyond;

typedef struct loader {
    text t;
    scene *s;
    texture_cache *textures;
    mtl_set materials;
    int32_t current; /* material, -1: none yet */
    float *v, *vt;
    size_t v_count, vt_count, vn_count, v_capacity, vt_capacity; /* counts of points, capacities of floats */
    beyond far_v, far_vt, far_vn;
    part *parts;
    int32_t part_count;
    size_t part_capacity;
    int32_t *part_of; /* two per material and two for none: part number, -1: none */
    int32_t part_of_count;
    uint32_t (*face)[2]; /* corners of the line at hand */
    size_t face_capacity;
    uint32_t *table; /* hash table: slot -> 1 + vertex of the part in table_part */
    uint32_t *table_part;
    size_t table_size, table_used; /* size: a power of two */
} loader;

/* The array with room for `need` items. On failure it stays as it was and *failed is set. */
static void *reserve(void *block, size_t *capacity, size_t need, size_t item, int *failed)
{
    size_t room = need + need / 2 + 64;
    void *more;
    if (need <= *capacity)
        return block;
    more = room < SIZE_MAX / item ? realloc(block, room * item) : NULL;
    if (!more) {
        *failed = 1;
        return block;
    }
    *capacity = room;
    return more;
}

static uint32_t hash_of(uint32_t number, uint32_t v, uint32_t vt)
{
    uint32_t h = (v * 0x9e3779b1u) ^ (vt * 0x85ebca77u) ^ (number * 0xc2b2ae3du);
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    return h ^ h >> 13;
}

static int grow_table(loader *l)
{
    size_t size = l->table_size ? l->table_size * 2 : 4096;
    uint32_t *table = size < SIZE_MAX / 8 ? calloc(size, sizeof *table) : NULL;
    uint32_t *part_at = size < SIZE_MAX / 8 ? malloc(size * sizeof *part_at) : NULL;
    if (!table || !part_at) {
        free(table);
        free(part_at);
        return -1;
    }
    for (size_t i = 0; i < l->table_size; i++) {
        const uint32_t *pair;
        size_t slot;
        if (!l->table[i])
            continue;
        pair = l->parts[l->table_part[i]].pairs[l->table[i] - 1];
        slot = hash_of(l->table_part[i], pair[0], pair[1]) & (size - 1);
        while (table[slot])
            slot = (slot + 1) & (size - 1);
        table[slot] = l->table[i];
        part_at[slot] = l->table_part[i];
    }
    free(l->table);
    free(l->table_part);
    l->table = table;
    l->table_part = part_at;
    l->table_size = size;
    return 0;
}

/* The number of a pair among the part's vertices, new if need be; NONE: no memory. */
static uint32_t vertex_of(loader *l, uint32_t number, uint32_t v, uint32_t vt)
{
    part *p = &l->parts[number];
    int failed = 0, tries = 0;
    size_t slot;
    if (2 * l->table_used >= l->table_size && grow_table(l) != 0)
        return NONE;
    slot = hash_of(number, v, vt) & (l->table_size - 1);
    for (; l->table[slot] && tries < TRIES; slot = (slot + 1) & (l->table_size - 1), tries++) {
        uint32_t at = l->table[slot] - 1;
        if (l->table_part[slot] == number && p->pairs[at][0] == v && p->pairs[at][1] == vt)
            return at;
    }
    p->pairs = reserve(p->pairs, &p->vertex_capacity, p->vertices + 1, sizeof *p->pairs, &failed);
    if (failed || p->vertices >= INT32_MAX)
        return NONE;
    p->pairs[p->vertices][0] = v;
    p->pairs[p->vertices][1] = vt;
    p->vertices++;
    if (tries < TRIES) {
        l->table[slot] = (uint32_t)p->vertices;
        l->table_part[slot] = number;
        l->table_used++;
    }
    return (uint32_t)(p->vertices - 1);
}

/* The part for faces of the current material; -1: no memory. */
static int32_t part_for(loader *l, int textured)
{
    int32_t slot = 2 * (l->current + 1) + textured;
    if (slot >= l->part_of_count) {
        int32_t room = slot + slot / 2 + 16;
        int32_t *more = realloc(l->part_of, (size_t)room * sizeof *more);
        if (!more)
            return -1;
        for (int32_t i = l->part_of_count; i < room; i++)
            more[i] = -1;
        l->part_of = more;
        l->part_of_count = room;
    }
    if (l->part_of[slot] < 0) {
        int failed = 0;
        part *p = reserve(l->parts, &l->part_capacity, (size_t)l->part_count + 1, sizeof *p, &failed);
        l->parts = p;
        if (failed)
            return -1;
        p += l->part_count;
        memset(p, 0, sizeof *p);
        p->material = l->current;
        p->textured = textured;
        l->part_of[slot] = l->part_count++;
    }
    return l->part_of[slot];
}

/* One index of a corner: 1 is the first, -1 the last so far. *out counts from 0. The whole corner is the token to blame. */
static int face_index(loader *l, token corner, const char **at, size_t count, beyond *far, uint32_t *out)
{
    const char *p = *at, *end = corner.start + corner.length;
    int negative = p < end && *p == '-';
    uint32_t value = 0;
    const char *digits;
    p += negative;
    digits = p;
    for (; p < end && *p >= '0' && *p <= '9'; p++)
        value = value < 200000000 ? value * 10 + (uint32_t)(*p - '0') : INT32_MAX;
    if (p == digits || (p < end && *p != '/'))
        return text_fail(&l->t, corner, "is not a corner of a face (v, v/vt, v//vn or v/vt/vn)");
    if (value == 0 || value >= INT32_MAX || (negative && value > count))
        return text_fail(&l->t, corner, "index out of range: there are %lu so far", (unsigned long)count);
    if (value > count && value > far->largest) {
        far->largest = value;
        far->line = l->t.line;
    }
    *out = negative ? (uint32_t)count - value : value - 1;
    *at = p;
    return 0;
}

static int face_corner(loader *l, token corner, uint32_t pair[2])
{
    const char *at = corner.start, *end = at + corner.length;
    uint32_t normal;
    pair[1] = NONE;
    if (face_index(l, corner, &at, l->v_count, &l->far_v, &pair[0]) != 0)
        return -1;
    if (at == end)
        return 0;
    at++; /* the slash */
    if (at == end || *at != '/') {
        if (face_index(l, corner, &at, l->vt_count, &l->far_vt, &pair[1]) != 0)
            return -1;
        if (at == end)
            return 0;
    }
    at++;
    if (face_index(l, corner, &at, l->vn_count, &l->far_vn, &normal) != 0)
        return -1;
    return at == end ? 0 : text_fail(&l->t, corner, "has too many slashes");
}

static int face(loader *l, token word)
{
    token corner;
    size_t count = 0;
    uint32_t ring[3]; /* first, previous, this one */
    int failed = 0, textured = 1;
    int32_t number;
    part *p;
    while (text_token(&l->t, &corner)) {
        l->face = reserve(l->face, &l->face_capacity, count + 1, sizeof *l->face, &failed);
        if (failed)
            return error_memory(l->t.error);
        if (face_corner(l, corner, l->face[count]) != 0)
            return -1;
        textured = textured && l->face[count][1] != NONE;
        count++;
    }
    if (count < 3)
        return text_fail(&l->t, word, "a face needs three corners or more");
    number = part_for(l, textured);
    if (number < 0)
        return error_memory(l->t.error);
    p = &l->parts[number];
    p->indices = reserve(p->indices, &p->corner_capacity, p->corners + 3 * (count - 2), sizeof *p->indices, &failed);
    if (failed || p->corners / 3 + count > INT32_MAX)
        return error_memory(l->t.error);
    for (size_t i = 0; i < count; i++) {
        uint32_t at = vertex_of(l, (uint32_t)number, l->face[i][0], textured ? l->face[i][1] : NONE);
        if (at == NONE)
            return error_memory(l->t.error);
        ring[i < 2 ? i : 2] = at;
        if (i < 2)
            continue;
        memcpy(&p->indices[p->corners], ring, sizeof ring);
        p->corners += 3;
        ring[1] = at;
    }
    return 0;
}

/* `need` to 7 numbers; `keep` of them into a list (NULL: none are kept), those that are not there are 0. */
static int point(loader *l, token word, int need, int keep, float **list, size_t *capacity, size_t *count)
{
    float values[3] = {0.0f, 0.0f, 0.0f};
    int failed = 0, n = 0;
    token number;
    for (; text_token(&l->t, &number); n++) {
        float value;
        if (!token_number(number, &value))
            return text_fail(&l->t, number, "is not a finite number");
        if (n < 3)
            values[n] = value;
        if (n == 7)
            return text_fail(&l->t, number, "one number too many");
    }
    if (n < need)
        return text_fail(&l->t, word, "needs %d numbers or more", need);
    if (*count >= INT32_MAX)
        return error_memory(l->t.error);
    if (list) {
        *list = reserve(*list, capacity, (*count + 1) * (size_t)keep, sizeof **list, &failed);
        if (failed)
            return error_memory(l->t.error);
        memcpy(*list + *count * (size_t)keep, values, (size_t)keep * sizeof *values);
    }
    ++*count;
    return 0;
}

static int use(loader *l, token word)
{
    token name;
    mtl *m;
    if (!text_rest(&l->t, &name))
        return text_fail(&l->t, word, "a name is missing after it");
    l->current = mtl_find(&l->materials, name);
    if (l->current < 0)
        return error_memory(l->t.error);
    m = &l->materials.all[l->current];
    if (!m->defined && !m->used_line)
        m->used_line = l->t.line;
    return 0;
}

/* "mtllib a.mtl b.mtl" names two files, "mtllib my file.mtl" one: it is one if there is such a file. */
static int libraries(loader *l, token word)
{
    text line = l->t;
    token name;
    int whole = 1, result = 0;
    if (!text_rest(&l->t, &name))
        return text_fail(&l->t, word, "a file name is missing after it");
    if (memchr(name.start, ' ', name.length)) {
        char *path = file_beside(l->t.file, name.start, name.length);
        struct stat st;
        if (!path)
            return error_memory(l->t.error);
        whole = stat(path, &st) == 0 && !S_ISDIR(st.st_mode);
        free(path);
    }
    while (result == 0 && (whole || text_token(&line, &name))) {
        char *path = file_beside(l->t.file, name.start, name.length);
        if (!path)
            return error_memory(l->t.error);
        result = mtl_load(&l->materials, path, l->s, l->textures, l->t.error);
        if (result != 0)
            error_wrap(l->t.error, l->t.file, l->t.line, name.start, name.length);
        free(path);
        if (whole)
            break;
    }
    return result;
}

static int statements(loader *l)
{
    while (text_line(&l->t)) {
        token word;
        int result = 0;
        if (!text_token(&l->t, &word))
            continue;
        if (token_is(word, "f"))
            result = face(l, word);
        else if (token_is(word, "v"))
            result = point(l, word, 3, 3, &l->v, &l->v_capacity, &l->v_count);
        else if (token_is(word, "vt"))
            result = point(l, word, 1, 2, &l->vt, &l->vt_capacity, &l->vt_count);
        else if (token_is(word, "vn"))
            result = point(l, word, 3, 0, NULL, NULL, &l->vn_count);
        else if (token_is(word, "usemtl"))
            result = use(l, word);
        else if (token_is(word, "mtllib"))
            result = libraries(l, word);
        if (result != 0)
            return -1;
    }
    return 0;
}

/* What only the end of the file shows. */
static int check_beyond(const loader *l, const beyond *far, size_t count, const char *what)
{
    char token_text[16];
    size_t length = 0;
    if (far->largest <= count)
        return 0;
    for (uint32_t v = far->largest; v; v /= 10)
        length++;
    for (uint32_t v = far->largest, i = 0; v; v /= 10)
        token_text[length - ++i] = (char)('0' + v % 10);
    return error_set(l->t.error, l->t.file, far->line, token_text, length, "index out of range: the file has %lu %s",
                     (unsigned long)count, what);
}

static int check_end(const loader *l)
{
    for (int32_t i = 0; i < l->materials.names.count; i++) {
        const mtl *m = &l->materials.all[i];
        const struct name *name = &l->materials.names.all[i];
        if (!m->defined)
            return error_set(l->t.error, l->t.file, m->used_line, name->text, name->length, "usemtl of an unknown material");
    }
    if (check_beyond(l, &l->far_v, l->v_count, "v") != 0 || check_beyond(l, &l->far_vt, l->vt_count, "vt") != 0)
        return -1;
    return check_beyond(l, &l->far_vn, l->vn_count, "vn");
}

static int add_part(const loader *l, const part *p, const obj_place *place)
{
    const mtl *m = p->material >= 0 ? &l->materials.all[p->material] : NULL;
    tyn_material material = {{place->albedo[0], place->albedo[1], place->albedo[2]}, NULL, NULL};
    float *positions, *texcoords = NULL;
    uint32_t *indices;
    int mapped;
    if (m && m->left_out)
        return 0;
    mapped = m && p->textured && (m->colour || m->mask);
    if (mapped) {
        material.texture = m->colour;
        material.mask = m->mask;
    }
    for (int k = 0; m && k < 3; k++)
        material.albedo[k] = m->has_kd ? m->kd[k] : mapped && m->colour ? 1.0f : place->albedo[k];
    positions = malloc(p->vertices * 3 * sizeof *positions + 1);
    indices = malloc(p->corners * sizeof *indices + 1);
    if (mapped)
        texcoords = malloc(p->vertices * 2 * sizeof *texcoords + 1);
    if (!positions || !indices || (mapped && !texcoords)) {
        free(positions);
        free(indices);
        free(texcoords);
        return error_memory(l->t.error);
    }
    memcpy(indices, p->indices, p->corners * sizeof *indices);
    for (size_t i = 0; i < p->vertices; i++) {
        const float *v = l->v + 3 * (size_t)p->pairs[i][0];
        for (int k = 0; k < 3; k++) {
            const double *row = place->matrix[k];
            double x = row[0] * (double)v[0] + row[1] * (double)v[1] + row[2] * (double)v[2] + place->translate[k];
            positions[3 * i + (size_t)k] = (float)x;
            if (!isfinite(positions[3 * i + (size_t)k])) {
                free(positions);
                free(indices);
                free(texcoords);
                return error_set(l->t.error, l->t.file, 0, NULL, 0, "scale and translate put a vertex out of a float's range");
            }
        }
        if (mapped)
            memcpy(texcoords + 2 * i, l->vt + 2 * (size_t)p->pairs[i][1], 2 * sizeof *texcoords);
    }
    if (scene_take_mesh(l->s, positions, texcoords, (uint32_t)p->vertices, indices, (uint32_t)(p->corners / 3), &material) != 0)
        return error_memory(l->t.error);
    return 0;
}

int obj_load(scene *s, const char *path, const obj_place *place, texture_cache *textures, tool_error *error)
{
    loader l;
    int result = -1;
    memset(&l, 0, sizeof l);
    l.s = s;
    l.textures = textures;
    l.current = -1;
    if (text_open(&l.t, path, TEXT_OBJ, error) == 0) {
        result = statements(&l);
        if (result == 0)
            result = check_end(&l);
        for (int32_t i = 0; result == 0 && i < l.part_count; i++)
            result = add_part(&l, &l.parts[i], place);
        text_close(&l.t);
    }
    for (int32_t i = 0; i < l.part_count; i++) {
        free(l.parts[i].pairs);
        free(l.parts[i].indices);
    }
    free(l.parts);
    free(l.part_of);
    free(l.v);
    free(l.vt);
    free(l.face);
    free(l.table);
    free(l.table_part);
    mtl_set_free(&l.materials);
    return result;
}
