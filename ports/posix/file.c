/* file.c */
#include "file.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define BLOCK 65536
#define PIPE_MOST ((size_t)256 << 20) /* bytes: twice a picture of 3840 x 2160 pixels as floats */
#define PIPE_WAIT 3                   /* seconds */

static void on_alarm(int number)
{
    (void)number; /* its coming ends open() */
}

int file_open(const char *path, int flags, const char **why)
{
    struct stat st;
    struct sigaction action, old;
    int fd, pipe = stat(path, &st) == 0 && S_ISFIFO(st.st_mode);
    if (pipe) {
        memset(&action, 0, sizeof action);
        action.sa_handler = on_alarm;
        sigemptyset(&action.sa_mask);
        sigaction(SIGALRM, &action, &old);
        alarm(PIPE_WAIT);
    }
    fd = open(path, flags);
    if (fd < 0)
        *why = pipe && errno == EINTR ? "is a pipe with nobody at its other end" : strerror(errno);
    if (pipe) {
        alarm(0);
        sigaction(SIGALRM, &old, NULL);
    }
    return fd;
}

/* Whether the beginning shows that the rest need not be read: it is not what it should be, whatever comes. */
static int judged(file_kind kind, const char *bytes, size_t used, size_t got)
{
    return kind == FILE_TEXT ? memchr(bytes + used - got, '\0', got) != NULL : bytes[0] != 'P';
}

/* Room for more than `used` bytes; NULL: *why is set and the old block freed. */
static char *grow(char *bytes, size_t used, size_t *room, const struct stat *st, const char **why)
{
    size_t want = *room * 2;
    char *more = NULL;
    *why = "out of memory";
    if (S_ISREG(st->st_mode) && (uintmax_t)st->st_size >= want)
        want = (size_t)st->st_size + 1; /* one more: the read that finds the end needs no growth */
    if (!S_ISREG(st->st_mode) && used >= PIPE_MOST)
        *why = "is a pipe that goes on after 256 MiB";
    else if (want < SIZE_MAX / 4)
        more = realloc(bytes, want + 1);
    if (!more)
        free(bytes);
    *room = want;
    return more;
}

static const char *slurp(int fd, file_kind kind, char **data, size_t *size)
{
    struct stat st;
    size_t room = BLOCK, used = 0;
    const char *why;
    if (fstat(fd, &st) != 0)
        return strerror(errno);
    if (S_ISDIR(st.st_mode))
        return "is a folder";
    /* Devices such as /dev/zero never end. */
    if (!S_ISREG(st.st_mode) && !S_ISFIFO(st.st_mode))
        return "is not a file";
    if (S_ISREG(st.st_mode) && (uintmax_t)st.st_size >= SIZE_MAX / 4)
        return "is too large";
    if (S_ISREG(st.st_mode) && st.st_size > 0 && st.st_size < BLOCK)
        room = (size_t)st.st_size + 1;
    char *bytes = malloc(room + 1);
    if (!bytes)
        return "out of memory";
    for (;;) {
        ssize_t got;
        if (used == room && !(bytes = grow(bytes, used, &room, &st, &why)))
            return why;
        got = read(fd, bytes + used, room - used);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            why = strerror(errno);
            free(bytes);
            return why;
        }
        used += (size_t)got;
        if (got == 0 || judged(kind, bytes, used, (size_t)got))
            break;
    }
    bytes[used] = '\0';
    *data = bytes;
    *size = used;
    return NULL;
}

const char *file_read(const char *path, file_kind kind, char **data, size_t *size)
{
    const char *why = NULL;
    int fd = file_open(path, O_RDONLY, &why);
    if (fd < 0)
        return why;
    why = slurp(fd, kind, data, size);
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

const char *file_base(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

char *file_behind_links(const char *path)
{
    char target[4096], *at = file_beside("", path, strlen(path));
    for (int i = 0; at && i < 40; i++) {
        ssize_t length = readlink(at, target, sizeof target);
        char *next;
        if (length < 0 || (size_t)length == sizeof target)
            return at;
        next = file_beside(at, target, (size_t)length);
        free(at);
        at = next;
    }
    if (at)
        errno = ELOOP;
    free(at);
    return NULL;
}

int file_key(const char *path, uintmax_t key[2])
{
    struct stat st;
    if (stat(path, &st) != 0)
        return -1;
    key[0] = (uintmax_t)st.st_dev;
    key[1] = (uintmax_t)st.st_ino;
    return 0;
}

int file_same_folder(const char *a, const char *b)
{
    const char *const paths[2] = {a, b};
    uintmax_t keys[2][2];
    for (int i = 0; i < 2; i++) {
        char *folder = file_beside(paths[i], ".", 1);
        int good = folder && file_key(folder, keys[i]) == 0;
        free(folder);
        if (!good)
            return 0;
    }
    return memcmp(keys[0], keys[1], sizeof keys[0]) == 0;
}

static int same_end(const char *a, const char *b)
{
    struct stat st[2];
    if (stat(a, &st[0]) == 0 && stat(b, &st[1]) == 0)
        return S_ISREG(st[0].st_mode) && st[0].st_dev == st[1].st_dev && st[0].st_ino == st[1].st_ino;
    return strcmp(file_base(a), file_base(b)) == 0 && file_same_folder(a, b);
}

int file_same(const char *a, const char *b)
{
    char *ends[2] = {file_behind_links(a), file_behind_links(b)};
    int same = strcmp(a, b) == 0 || (ends[0] && ends[1] && same_end(ends[0], ends[1]));
    free(ends[0]);
    free(ends[1]);
    return same;
}
