/* fence.c - see fence.h */
#define _DEFAULT_SOURCE /* MAP_ANONYMOUS */
#include "fence.h"

#include <setjmp.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

void *fence_copy(fence_yard *yard, const void *from, size_t bytes)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE), room = (bytes + page - 1) / page * page;
    uint8_t *map = mmap(NULL, room + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    uint8_t *inner = yard->side == FENCE_AFTER ? map : map + page, *copy;
    if (map == MAP_FAILED || yard->count == FENCE_MOST)
        abort();
    copy = yard->side == FENCE_AFTER ? inner + room - bytes : inner;
    if (bytes)
        memcpy(copy, from, bytes);
    if (mprotect(inner, room, PROT_READ) || mprotect(yard->side == FENCE_AFTER ? map + room : map, page, PROT_NONE))
        abort();
    yard->fence[yard->count].map = map;
    yard->fence[yard->count++].size = room + page;
    return copy;
}

void fence_image(fence_yard *yard, tyn_image *image)
{
    image->pixels =
        fence_copy(yard, image->pixels, (size_t)image->width * (size_t)image->height * (size_t)tyn_format_bytes(image->format));
}

void fence_shadow(fence_yard *yard, tyn_shadow *s)
{
    s->depth = fence_copy(yard, s->depth, (size_t)s->size * (size_t)s->size * (s->format == TYN_DEPTH_U16 ? 2 : 4));
}

void fence_free(fence_yard *yard)
{
    while (yard->count) {
        yard->count--;
        munmap(yard->fence[yard->count].map, yard->fence[yard->count].size);
    }
}

static sigjmp_buf back;

static void fault(int number)
{
    (void)number;
    siglongjmp(back, 1);
}

int fence_try(void (*call)(void *argument), void *argument)
{
    struct sigaction action, segv, bus;
    volatile int whole = 0;
    memset(&action, 0, sizeof action);
    action.sa_handler = fault;
    sigemptyset(&action.sa_mask);
    if (sigaction(SIGSEGV, &action, &segv) || sigaction(SIGBUS, &action, &bus))
        abort();
    if (!sigsetjmp(back, 1)) {
        call(argument);
        whole = 1;
    }
    sigaction(SIGSEGV, &segv, NULL);
    sigaction(SIGBUS, &bus, NULL);
    return whole;
}
