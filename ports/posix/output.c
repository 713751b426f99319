/* output.c */
#define _XOPEN_SOURCE 700 /* realpath */
#include "output.h"
#include "file.h"
#include "png.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* What a signal must remove. Set before the file is made and cleared after it is gone; the strings outlive the entry. */
static const char *volatile unfinished[OUTPUT_MAX];

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
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE};
    struct sigaction action, old;
    memset(&action, 0, sizeof action);
    action.sa_handler = on_signal;
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (sigaction(numbers[i], NULL, &old) == 0 && old.sa_handler == SIG_DFL) /* nohup's SIG_IGN stays */
            sigaction(numbers[i], &action, NULL);
    signal(SIGXFSZ, SIG_IGN); /* a file too large for its limit is a write error then, with a message */
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

static int open_temporary(struct output *o)
{
    size_t room = strlen(o->path) + 48;
    o->temporary = malloc(room);
    if (!o->temporary)
        return -1;
    for (int i = 0; i < 100; i++) {
        int fd;
        snprintf(o->temporary, room, "%s.part-%ld-%d", o->path, (long)getpid(), i);
        fd = open(o->temporary, O_WRONLY | O_CREAT | O_EXCL, 0666);
        if (fd >= 0)
            return fd;
        if (errno != EEXIST)
            break;
    }
    return -1;
}

FILE *output_open(output_set *set, const char *path, tool_error *error)
{
    struct output *o = &set->all[set->count];
    struct stat st;
    const char *why = NULL;
    int exists = stat(path, &st) == 0, fd;
    memset(o, 0, sizeof *o);
    if (set->count == 0)
        catch_signals();
    if (exists && S_ISDIR(st.st_mode)) {
        error_set(error, path, 0, NULL, 0, "can't be written: is a folder");
        return NULL;
    }
    if (exists && S_ISREG(st.st_mode)) {
        o->path = realpath(path, NULL); /* through a link: the file behind it is replaced, not the link */
    } else {
        o->path = malloc(strlen(path) + 1);
        if (o->path)
            strcpy(o->path, path);
    }
    if (!o->path) {
        error_memory(error);
        return NULL;
    }
    fd = exists && !S_ISREG(st.st_mode) ? file_open(path, O_WRONLY, &why) : open_temporary(o);
    if (fd >= 0)
        o->file = fdopen(fd, "wb");
    if (!o->file) {
        error_set(error, path, 0, NULL, 0, "can't be written: %s", why ? why : strerror(errno));
        if (fd >= 0) {
            close(fd);
            if (o->temporary)
                unlink(o->temporary);
        }
        free(o->temporary);
        free(o->path);
        return NULL;
    }
    unfinished[set->count] = o->temporary;
    set->count++;
    return o->file;
}

int output_failed(const output_set *set, const FILE *file, tool_error *error)
{
    int why = errno;
    for (int i = 0; i < set->count; i++)
        if (set->all[i].file == file)
            return error_set(error, set->all[i].path, 0, NULL, 0, "can't be written: %s", strerror(why));
    return error_set(error, "output", 0, NULL, 0, "can't be written: %s", strerror(why));
}

static void release(output_set *set)
{
    for (int i = 0; i < set->count; i++) {
        unfinished[i] = NULL;
        free(set->all[i].temporary);
        free(set->all[i].path);
    }
    set->count = 0;
}

int output_commit(output_set *set, tool_error *error)
{
    for (int i = 0; i < set->count; i++) {
        FILE *file = set->all[i].file;
        if (fflush(file) != 0 || ferror(file)) {
            output_failed(set, file, error);
            output_abort(set);
            return -1;
        }
    }
    for (int i = 0; i < set->count; i++) {
        struct output *o = &set->all[i];
        int closed = fclose(o->file);
        o->file = NULL;
        if (closed != 0 || (o->temporary && rename(o->temporary, o->path) != 0)) {
            error_set(error, o->path, 0, NULL, 0, "can't be written: %s", strerror(errno));
            for (int k = 0; k < i; k++) /* those that have their name already */
                if (set->all[k].temporary)
                    unlink(set->all[k].path);
            output_abort(set);
            return -1;
        }
    }
    release(set);
    return 0;
}

void output_abort(output_set *set)
{
    for (int i = 0; i < set->count; i++) {
        if (set->all[i].file)
            fclose(set->all[i].file);
        if (set->all[i].temporary)
            unlink(set->all[i].temporary);
    }
    release(set);
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
