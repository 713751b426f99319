/* test_names.c - the tool's numbers for names: those that a plain list gives. */
#include <string.h>

#include "names.h"
#include "test.h"

enum { NAMES = 400, LONGEST = 12 };

/* Of few letters, so that many are the beginnings of others; 0xff and 1 for the ends of bytes. */
static size_t make(char *name)
{
    size_t length = 1 + test_random() % LONGEST;
    for (size_t i = 0; i < length; i++)
        name[i] = "aac\001\377"[test_random() % 5];
    return length;
}

void test_names(void)
{
    static char list[NAMES][LONGEST];
    static size_t lengths[NAMES];
    name_set set = {0};
    int32_t count = 0;
    int wrong = 0;
    TEST("names have the numbers of a list");
    for (int i = 0; i < 4 * NAMES && count < NAMES; i++) {
        char name[LONGEST];
        size_t length = make(name);
        int32_t at = 0;
        while (at < count && (lengths[at] != length || memcmp(list[at], name, length) != 0))
            at++;
        wrong += names_find(&set, name, length) != at;
        if (at == count) {
            memcpy(list[at], name, length);
            lengths[count++] = length;
        }
        wrong += set.count != count;
    }
    for (int32_t i = 0; i < count; i++)
        wrong += names_find(&set, list[i], lengths[i]) != i || set.all[i].length != lengths[i] ||
                 memcmp(set.all[i].text, list[i], lengths[i]) != 0;
    CHECK(wrong == 0 && count > NAMES / 2);
    names_free(&set);
    CHECK(set.count == 0 && names_find(&set, "", 0) == 0 && names_find(&set, "a", 1) == 1 && names_find(&set, "", 0) == 0);
    names_free(&set);
}
