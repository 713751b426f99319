/* no_memory.c - the tool with its nth allocation failing, and all after it, for every n: no_memory FOLDER COMMAND... Each run
 * ends with status 1 and a message, and leaves nothing in FOLDER; the last one, when no allocation fails, with status 0. Linked
 * with --wrap=main,malloc,calloc,realloc. */
#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

int __real_main(int argc, char **argv);
void *__real_malloc(size_t size);
void *__real_calloc(size_t count, size_t size);
void *__real_realloc(void *block, size_t size);
int __wrap_main(int argc, char **argv);
void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_realloc(void *block, size_t size);

static long left = -1; /* allocations that work; below 0: all */

static int fails(void)
{
    int yes = left == 0;
    left -= left > 0;
    if (yes)
        errno = ENOMEM;
    return yes;
}

void *__wrap_malloc(size_t size)
{
    return fails() ? NULL : __real_malloc(size);
}

void *__wrap_calloc(size_t count, size_t size)
{
    return fails() ? NULL : __real_calloc(count, size);
}

void *__wrap_realloc(void *block, size_t size)
{
    return fails() ? NULL : __real_realloc(block, size);
}

static int is_empty(const char *folder)
{
    DIR *d = opendir(folder);
    const struct dirent *e;
    int others = 0;
    while (d && (e = readdir(d)) != NULL)
        others += strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0;
    if (d)
        closedir(d);
    return d && !others;
}

/* The message goes to the file err.txt. */
static int run(long works, int argc, char **argv)
{
    int status = -1;
    pid_t child;
    fflush(NULL);
    child = fork();
    if (child == 0) {
        if (!freopen("err.txt", "w", stderr))
            _exit(99);
        left = works;
        status = __real_main(argc, argv);
        left = -1;
        exit(status);
    }
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static int says_so(char *text, size_t size)
{
    FILE *file = fopen("err.txt", "r");
    size_t n = file ? fread(text, 1, size - 1, file) : 0;
    text[n] = '\0';
    if (file)
        fclose(file);
    return strstr(text, "out of memory") || strstr(text, "Cannot allocate memory");
}

int __wrap_main(int argc, char **argv)
{
    char text[1000];
    long step = argc > 3 ? strtol(argv[1], NULL, 10) : 0;
    for (long n = 0; n < 100000 && step > 0; n += step) {
        int status = run(n, argc - 2, argv + 2);
        if (status == 0) {
            printf("%ld\n", n);
            return 0;
        }
        if (status != 1 || !says_so(text, sizeof text) || !is_empty(argv[2])) {
            fprintf(stderr, "without allocation %ld: status %d, %s\n%s", n, status,
                    is_empty(argv[2]) ? "nothing left" : "files left", text);
            return 1;
        }
    }
    return 1;
}
