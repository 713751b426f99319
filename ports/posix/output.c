/* output.c */
#define _XOPEN_SOURCE 700 /* S_ISVTX */
#include "output.h"
#include "file.h"
#include "png.h"
#include "pool.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* What a signal must remove; it holds signals back who changes it, or has files halfway to their places. */
static const char *volatile unfinished[OUTPUT_MAX];

static const int signals[] = {POOL_SIGNALS, SIGPIPE};
enum { SIGNALS = sizeof signals / sizeof *signals };

static void on_signal(int number)
{
    for (int i = 0; i < OUTPUT_MAX; i++)
        if (unfinished[i])
            unlink(unfinished[i]);
    signal(number, SIG_DFL);
    raise(number);
}

static void catch_signals(void)
{
    struct sigaction action, old;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    sigfillset(&action.sa_mask);
    for (int i = 0; i < SIGNALS; i++)
        if (sigaction(signals[i], NULL, &old) == 0 && old.sa_handler == SIG_DFL) /* nohup's SIG_IGN stays */
            sigaction(signals[i], &action, NULL);
    signal(SIGXFSZ, SIG_IGN); /* a file too large for its limit is a write error then, with a message */
}

static void hold_signals(sigset_t *old)
{
    sigset_t ours;
    sigemptyset(&ours);
    for (int i = 0; i < SIGNALS; i++)
        sigaddset(&ours, signals[i]);
    pthread_sigmask(SIG_BLOCK, &ours, old);
}

static void let_signals(const sigset_t *old)
{
    pthread_sigmask(SIG_SETMASK, old, NULL);
}

output_kind output_kind_of(const char *path)
{
    static const struct {
        const char *ending;
        output_kind kind;
    } kinds[] = {
        {".png", OUTPUT_PNG}, {".ppm", OUTPUT_PPM}, {".pfm", OUTPUT_PFM}, {".rgb565", OUTPUT_RGB565}, {".rgba", OUTPUT_RGBA}};
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        size_t n = strlen(kinds[i].ending);
        if (length > n && strcasecmp(path + length - n, kinds[i].ending) == 0)
            return kinds[i].kind;
    }
    return OUTPUT_UNKNOWN;
}

/* Beside the file, by a name that is never too long; of one of characters none is cut in two. */
static int open_temporary(struct output *o, int number)
{
    const char *base = file_base(o->path);
    size_t room = strlen(o->path) + 48, shown = strlen(base) < 100 ? strlen(base) : 100;
    int fd = -1;
    while (shown > 0 && ((unsigned char)base[shown] & 0xc0) == 0x80)
        shown--;
    o->temporary = malloc(room);
    o->old = malloc(room);
    if (!o->temporary || !o->old)
        return -1;
    for (int i = 0; i < 100; i++) {
        sigset_t before;
        snprintf(o->temporary, room, "%.*s.part-%ld-%d", (int)(base - o->path + (ptrdiff_t)shown), o->path, (long)getpid(), i);
        snprintf(o->old, room, "%s.old", o->temporary);
        hold_signals(&before);
        fd = open(o->temporary, O_WRONLY | O_CREAT | O_EXCL, 0666);
        if (fd >= 0)
            unfinished[number] = o->temporary;
        let_signals(&before);
        if (fd >= 0 || errno != EEXIST)
            break;
    }
    return fd;
}

/* A file of somebody else in a folder as /tmp can be written, but not replaced. */
static int stuck(const char *path, const struct stat *st)
{
    struct stat above;
    char *folder = file_beside(path, ".", 1);
    int yes = folder && geteuid() != 0 && stat(folder, &above) == 0 && (above.st_mode & S_ISVTX) && st->st_uid != geteuid() &&
              above.st_uid != geteuid();
    free(folder);
    return yes;
}

static const char *open_file(struct output *o, int number, const char *path)
{
    struct stat st;
    const char *why = NULL;
    int fd, exists = stat(path, &st) == 0;
    if (exists && S_ISDIR(st.st_mode))
        return "is a folder";
    if (exists && !S_ISREG(st.st_mode)) {
        o->path = file_beside("", path, strlen(path));
        fd = o->path ? file_open(path, O_WRONLY, &why) : -1;
    } else {
        o->path = file_behind_links(path);
        if (!o->path)
            return strerror(errno);
        if (exists && access(o->path, W_OK) != 0)
            return strerror(errno);
        if (exists && stuck(o->path, &st))
            return strerror(EPERM);
        fd = open_temporary(o, number);
        if (fd >= 0 && exists)
            (void)fchmod(fd, st.st_mode & 0777); /* not on all file systems */
    }
    if (fd >= 0 && !(o->file = fdopen(fd, "wb"))) {
        why = strerror(errno);
        close(fd);
    }
    return o->file ? NULL : why ? why : strerror(errno);
}

static void discard(output_set *set, int i)
{
    struct output *o = &set->all[i];
    if (o->file)
        fclose(o->file);
    if (unfinished[i])
        unlink(o->temporary);
    unfinished[i] = NULL;
    free(o->temporary);
    free(o->old);
    free(o->path);
    memset(o, 0, sizeof *o);
}

FILE *output_open(output_set *set, const char *path, tool_error *error)
{
    struct output *o = &set->all[set->count];
    const char *why = NULL;
    memset(o, 0, sizeof *o);
    if (set->count == 0)
        catch_signals();
    for (int i = 0; i < set->count && !why; i++)
        why = file_same(set->all[i].path, path) ? "is another output too" : NULL;
    if (!why)
        why = open_file(o, set->count, path);
    if (why) {
        error_set(error, path, 0, NULL, 0, "can't be written: %s", why);
        discard(set, set->count);
        return NULL;
    }
    set->count++;
    return o->file;
}

static int failed(const struct output *o, tool_error *error)
{
    return error_set(error, o->path, 0, NULL, 0, "can't be written: %s", strerror(errno));
}

int output_failed(const output_set *set, const FILE *file, tool_error *error)
{
    int i = 0;
    while (i + 1 < set->count && set->all[i].file != file)
        i++;
    return failed(&set->all[i], error);
}

/* A new file in its place. The old one is kept by its other name, as more than one can't come at once, and a later one may
 * fail. Where there can be no such name the old one is lost then. */
static int put(struct output *o, int keep)
{
    if (!o->temporary)
        return 0;
    o->kept = keep && link(o->path, o->old) == 0;
    o->fresh = !o->kept && access(o->path, F_OK) != 0;
    if (rename(o->temporary, o->path) == 0)
        return 0;
    if (o->kept)
        unlink(o->old);
    return -1;
}

static void put_back(const struct output *o)
{
    if (o->kept)
        rename(o->old, o->path);
    else if (o->fresh)
        unlink(o->path);
}

static int put_all(output_set *set, tool_error *error)
{
    for (int i = 0; i < set->count; i++)
        if (put(&set->all[i], i + 1 < set->count) != 0) {
            failed(&set->all[i], error);
            while (i-- > 0)
                put_back(&set->all[i]);
            return -1;
        }
    for (int i = 0; i < set->count; i++) {
        if (set->all[i].kept)
            unlink(set->all[i].old);
        unfinished[i] = NULL;
    }
    return 0;
}

int output_commit(output_set *set, tool_error *error)
{
    sigset_t before;
    int result = 0;
    for (int i = 0; i < set->count && result == 0; i++) {
        FILE *file = set->all[i].file;
        int lost = ferror(file); /* whose errno is long gone */
        set->all[i].file = NULL;
        errno = 0;
        if (fclose(file) != 0 || lost) {
            errno = errno ? errno : EIO;
            result = failed(&set->all[i], error);
        }
    }
    if (result == 0) {
        hold_signals(&before);
        result = put_all(set, error);
        let_signals(&before);
    }
    output_abort(set);
    return result;
}

void output_abort(output_set *set)
{
    while (set->count > 0)
        discard(set, --set->count);
}

static int write_ppm(FILE *file, const uint8_t *rgba, int32_t width, int32_t height)
{
    size_t row = (size_t)width;
    uint8_t *rgb = malloc(3 * row);
    int result = rgb && fprintf(file, "P6\n%ld %ld\n255\n", (long)width, (long)height) > 0 ? 0 : -1;
    for (int32_t y = 0; y < height && result == 0; y++) {
        const uint8_t *from = rgba + 4 * row * (size_t)y;
        for (size_t x = 0; x < row; x++)
            memcpy(rgb + 3 * x, from + 4 * x, 3);
        if (fwrite(rgb, 3, row, file) != row)
            result = -1;
    }
    free(rgb);
    return result;
}

/* Low byte first on every host: the same file everywhere. */
static int write_565(FILE *file, const uint16_t *pixels, size_t count)
{
    uint8_t bytes[8192];
    while (count) {
        size_t n = count < sizeof bytes / 2 ? count : sizeof bytes / 2;
        for (size_t i = 0; i < n; i++) {
            bytes[2 * i] = (uint8_t)(pixels[i] & 255);
            bytes[2 * i + 1] = (uint8_t)(pixels[i] >> 8);
        }
        if (fwrite(bytes, 2, n, file) != n)
            return -1;
        pixels += n;
        count -= n;
    }
    return 0;
}

int output_picture(FILE *file, output_kind kind, const void *pixels, int32_t width, int32_t height)
{
    size_t count = (size_t)width * (size_t)height;
    switch (kind) {
    case OUTPUT_PNG:
        return png_write(file, pixels, width, height);
    case OUTPUT_PPM:
        return write_ppm(file, pixels, width, height);
    case OUTPUT_RGB565:
        return write_565(file, pixels, count);
    case OUTPUT_RGBA:
        return fwrite(pixels, 4, count, file) == count ? 0 : -1;
    case OUTPUT_PFM:
    case OUTPUT_UNKNOWN:
        break;
    }
    errno = EINVAL;
    return -1;
}
