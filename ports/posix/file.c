/* file.c */
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char *slurp(int fd, char **data, size_t *size)
{
    struct stat st;
    size_t room = 65536, used = 0;
    if (fstat(fd, &st) != 0)
        return strerror(errno);
    if (S_ISDIR(st.st_mode))
        return "is a folder";
    /* Devices such as /dev/zero never end. */
    if (!S_ISREG(st.st_mode) && !S_ISFIFO(st.st_mode))
        return "is not a file";
    if (S_ISREG(st.st_mode) && (uintmax_t)st.st_size >= SIZE_MAX / 4)
        return "is too large";
    if (S_ISREG(st.st_mode) && st.st_size > 0)
        room = (size_t)st.st_size + 1; /* one more: the read that finds the end needs no growth */
    char *bytes = malloc(room + 1);
    if (!bytes)
        return "out of memory";
    for (;;) {
        ssize_t got;
        if (used == room) {
            char *more = room < SIZE_MAX / 4 ? realloc(bytes, room * 2 + 1) : NULL;
            if (!more) {
                free(bytes);
                return "out of memory";
            }
            bytes = more;
            room *= 2;
        }
        got = read(fd, bytes + used, room - used);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            const char *why = strerror(errno);
            free(bytes);
            return why;
        }
        if (got == 0)
            break;
        used += (size_t)got;
    }
    bytes[used] = '\0';
    *data = bytes;
    *size = used;
    return NULL;
}

const char *file_read(const char *path, char **data, size_t *size)
{
    const char *why;
    int fd = open(path, O_RDONLY);
    if (fd < 0)
        return strerror(errno);
    why = slurp(fd, data, size);
    close(fd);
    return why;
}

char *file_beside(const char *base, const char *name, size_t length)
{
    const char *slash = strrchr(base, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - base) + 1 : 0;
    char *path = malloc(folder + length + 1);
    if (!path)
        return NULL;
    memcpy(path, base, folder);
    memcpy(path + folder, name, length);
    path[folder + length] = '\0';
    return path;
}
