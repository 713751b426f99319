/* files.c */
#include "files.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

const char *files_path(const char *name)
{
    static char names[8][sizeof folder + 256];
    static int turn;
    char *path = names[turn++ % 8];
    if (!folder[0]) {
        mkdir("build", 0777);
        mkdir("build/tmp", 0777);
        snprintf(folder, sizeof folder, "build/tmp/%ld", (long)getpid()); /* several test runs may share build/ */
    }
    mkdir(folder, 0777);
    snprintf(path, sizeof names[0], "%s/%s", folder, name);
    return path;
}

const char *files_write(const char *name, const void *bytes, size_t size)
{
    const char *path = files_path(name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        fprintf(stderr, "tests: can't write %s\n", path);
        exit(1);
    }
    return path;
}

const char *files_text(const char *name, const char *text)
{
    return files_write(name, text, strlen(text));
}

char *files_read(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    char *bytes = NULL;
    long length;
    if (!file)
        return NULL;
    if (fseek(file, 0, SEEK_END) == 0 && (length = ftell(file)) >= 0 && (bytes = malloc((size_t)length + 1)) != NULL) {
        rewind(file);
        *size = fread(bytes, 1, (size_t)length, file);
        bytes[*size] = '\0';
    }
    fclose(file);
    return bytes;
}

void files_remove(void)
{
    DIR *d = folder[0] ? opendir(folder) : NULL;
    struct dirent *entry;
    while (d && (entry = readdir(d)) != NULL)
        if (entry->d_name[0] != '.')
            unlink(files_path(entry->d_name));
    if (d)
        closedir(d);
    rmdir(folder);
}
