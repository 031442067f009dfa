/* failing_allocation.c: a library to preload, under which one allocation of psplat fails.
 *
 * It counts the allocations that the program, its plugins and libyaml ask for. Other libraries are
 * not looked at: how they meet the end of memory is not psplat's to mend.
 *
 *     FAIL_AT=N      the Nth fails; without it, or with 0, none
 *     FAIL_ON=1      those after it, too
 *     FAIL_COUNT=F   how many there were is written to file F at the end
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static atomic_long count;

/* The functions that those here stand before. */
static struct {
    void *(*malloc)(size_t), *(*calloc)(size_t, size_t), *(*realloc)(void *, size_t);
    void *(*aligned_alloc)(size_t, size_t);
    int (*posix_memalign)(void **, size_t, size_t);
    char *(*strdup)(const char *), *(*strndup)(const char *, size_t);
} next;

/* ISO C has no cast from an object's pointer to a function's. */
#define FIND(name) (*(void **)&next.name = dlsym(RTLD_NEXT, #name))

/* With the first allocation, when there is one thread. dlsym() may allocate as well, and copes
 * where it can't. */
static bool find_next(void)
{
    static atomic_bool begun;
    if (!atomic_exchange(&begun, true)) {
        FIND(malloc);
        FIND(calloc);
        FIND(realloc);
        FIND(aligned_alloc);
        FIND(posix_memalign);
        FIND(strdup);
        FIND(strndup);
    }
    return next.strndup != NULL;
}

static bool is_of_psplat(const void *code)
{
    Dl_info info;
    if (!dladdr(code, &info) || !info.dli_fname)
        return false;
    const char *slash = strrchr(info.dli_fname, '/'), *name = slash ? slash + 1 : info.dli_fname;
    return strcmp(name, "psplat") == 0 || strstr(info.dli_fname, "/psplat/") ||
           strncmp(name, "libyaml", strlen("libyaml")) == 0;
}

static bool fails(const void *caller)
{
    const char *at = getenv("FAIL_AT");
    if (!is_of_psplat(caller))
        return false;
    long number = atomic_fetch_add(&count, 1) + 1, first = at ? atol(at) : 0;
    bool failing = first > 0 && (number == first || (number > first && getenv("FAIL_ON")));
    if (failing)
        errno = ENOMEM;
    return failing;
}

#define CALLER __builtin_return_address(0)

void *malloc(size_t size)
{
    return !find_next() || fails(CALLER) ? NULL : next.malloc(size);
}

void *calloc(size_t n, size_t size)
{
    return !find_next() || fails(CALLER) ? NULL : next.calloc(n, size);
}

void *realloc(void *old, size_t size)
{
    return !find_next() || fails(CALLER) ? NULL : next.realloc(old, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return !find_next() || fails(CALLER) ? NULL : next.aligned_alloc(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    return !find_next() || fails(CALLER) ? ENOMEM : next.posix_memalign(memory, alignment, size);
}

char *strdup(const char *text)
{
    return !find_next() || fails(CALLER) ? NULL : next.strdup(text);
}

char *strndup(const char *text, size_t most)
{
    return !find_next() || fails(CALLER) ? NULL : next.strndup(text, most);
}

static __attribute__((destructor)) void write_count(void)
{
    const char *path = getenv("FAIL_COUNT");
    FILE *file = path ? fopen(path, "w") : NULL;
    if (!file)
        return;
    fprintf(file, "%ld\n", atomic_load(&count));
    fclose(file);
}
