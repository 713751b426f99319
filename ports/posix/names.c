/* names.c - a crit-bit tree: nodes test bits in their order, so that no path is longer than a name has bits. */
#include "names.h"

#include <stdlib.h>
#include <string.h>

static int side(const struct name *node, const char *text, size_t length)
{
    return node->byte < length && ((unsigned char)text[node->byte] & node->bit);
}

/* The name that shares most bits with the text if any does. */
static int32_t nearest(const name_set *n, const char *text, size_t length)
{
    int32_t at = n->root;
    while (at < 0) {
        const struct name *node = &n->all[~at];
        at = node->below[side(node, text, length)];
    }
    return at;
}

static int32_t add(name_set *n, const char *text, size_t length)
{
    struct name *name;
    if (n->count == n->capacity) {
        int32_t room = n->capacity < INT32_MAX / 4 ? n->capacity * 2 + 16 : 0;
        void *more = room && (size_t)room < SIZE_MAX / sizeof *n->all ? realloc(n->all, (size_t)room * sizeof *n->all) : NULL;
        if (!more)
            return -1;
        n->all = more;
        n->capacity = room;
    }
    name = &n->all[n->count];
    name->text = malloc(length + 1);
    if (!name->text)
        return -1;
    memcpy(name->text, text, length);
    name->text[length] = '\0';
    name->length = length;
    return n->count++;
}

/* Puts a new name's node where paths first part from it. */
static void insert(name_set *n, int32_t number, size_t byte, unsigned differ)
{
    struct name *name = &n->all[number];
    int32_t *link = &n->root;
    int where;
    name->byte = byte;
    name->bit = 128;
    while (!(name->bit & differ))
        name->bit >>= 1;
    while (*link < 0) {
        struct name *node = &n->all[~*link];
        if (node->byte > byte || (node->byte == byte && node->bit < name->bit))
            break;
        link = &node->below[side(node, name->text, name->length)];
    }
    where = side(name, name->text, name->length);
    name->below[where] = number;
    name->below[!where] = *link;
    *link = ~number;
}

int32_t names_find(name_set *n, const void *bytes, size_t length)
{
    const char *text = bytes;
    const struct name *other;
    size_t byte = 0;
    unsigned differ;
    int32_t at;
    if (n->count == 0) {
        n->root = 0;
        return add(n, text, length);
    }
    at = nearest(n, text, length);
    other = &n->all[at];
    while (byte < length && byte < other->length && text[byte] == other->text[byte])
        byte++;
    if (byte == length && byte == other->length)
        return at;
    differ = byte < length ? (unsigned char)text[byte] : 0;
    differ ^= byte < other->length ? (unsigned char)other->text[byte] : 0;
    at = add(n, text, length);
    if (at >= 0)
        insert(n, at, byte, differ);
    return at;
}

void names_free(name_set *n)
{
    for (int32_t i = 0; i < n->count; i++)
        free(n->all[i].text);
    free(n->all);
    memset(n, 0, sizeof *n);
}
