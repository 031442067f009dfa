#include "base/mapped_file.h"

#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

/* Once it is exceeded, an eighth of the budget is made free, so that not every new block asks for
 * an old one. */
#define KEPT 0.875

struct mapped_budget {
    double most;
    _Atomic size_t held;  /* bytes in memory */
    pthread_mutex_t lock; /* of the following */
    struct mapped_file *files;
    size_t blocks;            /* of all files */
    struct mapped_file *hand; /* where the clock's hand stands; NULL: before the first */
    size_t hand_block;
};

struct mapped_budget *mapped_budget_create(double bytes)
{
    struct mapped_budget *budget = calloc(1, sizeof *budget);
    if (!budget)
        return NULL;
    budget->most = bytes;
    if (pthread_mutex_init(&budget->lock, NULL) == 0)
        return budget;
    free(budget);
    return NULL;
}

void mapped_budget_destroy(struct mapped_budget *budget)
{
    if (!budget)
        return;
    pthread_mutex_destroy(&budget->lock);
    free(budget);
}

size_t mapped_budget_held(const struct mapped_budget *budget)
{
    return atomic_load(&budget->held);
}

double mapped_budget_to_come(const struct mapped_budget *budget)
{
    double files = (double)(budget->blocks * MAPPED_BLOCK),
           held = (double)mapped_budget_held(budget);
    double most = files < budget->most ? files : budget->most;
    return most > held ? most - held : 0.0;
}

/* --- files
 * ----------------------------------------------------------------------------------------- */

static size_t block_count(const struct mapped_file *file)
{
    uintptr_t last = ((uintptr_t)file->bytes + file->size - 1) >> MAPPED_BLOCK_SHIFT;
    return last - file->first + 1;
}

static ps_result map(int descriptor, struct mapped_file *file, struct error *error)
{
    struct stat status;
    if (fstat(descriptor, &status) != 0)
        return error_set(error, PS_ERROR_IO, "it cannot be mapped: %s", strerror(errno));
    if (!S_ISREG(status.st_mode) || status.st_size <= 0)
        return error_set(error, PS_ERROR_IO, "it cannot be mapped: it is empty, or no file");
    file->size = (size_t)status.st_size;
    void *bytes = mmap(NULL, file->size, PROT_READ, MAP_SHARED, descriptor, 0);
    if (bytes == MAP_FAILED)
        return error_set(error, PS_ERROR_IO, "it cannot be mapped: %s", strerror(errno));
    file->bytes = file->mapping = bytes;
    file->first = (uintptr_t)bytes >> MAPPED_BLOCK_SHIFT;
    return PS_OK;
}

static ps_result open_and_map(const char *path, struct mapped_file *file, struct error *error)
{
    int descriptor = open(path, O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
        return error_set(error, PS_ERROR_IO, "it cannot be opened: %s", strerror(errno));
    ps_result result = map(descriptor, file, error);
    close(descriptor);
    if (result != PS_OK)
        return result;
    file->marks = calloc(block_count(file), sizeof *file->marks);
    return file->marks ? PS_OK : error_set(error, PS_ERROR_MEMORY, "out of memory for its marks");
}

static void release(struct mapped_file *file)
{
    if (file->mapping)
        munmap(file->mapping, file->size);
    free(file->marks);
    free(file);
}

struct mapped_file *mapped_file_open(const char *path, struct mapped_budget *budget,
                                     struct error *error)
{
    struct mapped_file *file = calloc(1, sizeof *file);
    if (!file) {
        error_set(error, PS_ERROR_MEMORY, "out of memory for a mapped file");
        return NULL;
    }
    if (open_and_map(path, file, error) != PS_OK) {
        release(file);
        return NULL;
    }
    file->budget = budget;
    pthread_mutex_lock(&budget->lock);
    file->next = budget->files;
    budget->files = file;
    budget->blocks += block_count(file);
    pthread_mutex_unlock(&budget->lock);
    return file;
}

void mapped_file_close(struct mapped_file *file)
{
    struct mapped_budget *budget = file->budget;
    pthread_mutex_lock(&budget->lock);
    struct mapped_file **link = &budget->files;
    while (*link != file)
        link = &(*link)->next;
    *link = file->next;
    budget->hand = NULL;
    budget->hand_block = 0;
    budget->blocks -= block_count(file);
    for (size_t i = 0; i < block_count(file); i++)
        if (file->marks[i] != MAPPED_ABSENT)
            atomic_fetch_sub(&budget->held, MAPPED_BLOCK);
    pthread_mutex_unlock(&budget->lock);
    release(file);
}

/* --- the clock
 * ------------------------------------------------------------------------------------- */

static void give_back(const struct mapped_file *file, size_t block)
{
    size_t before = (uintptr_t)file->bytes & (MAPPED_BLOCK - 1); /* of the first block */
    size_t start = block > 0 ? block * MAPPED_BLOCK - before : 0;
    size_t end = (block + 1) * MAPPED_BLOCK - before;
    void *at = (unsigned char *)file->mapping + start;
    end = end < file->size ? end : file->size;
#ifdef MADV_DONTNEED
    (void)madvise(at, end - start, MADV_DONTNEED);
#else
    (void)posix_madvise(at, end - start, POSIX_MADV_DONTNEED);
#endif
}

/* What was not looked at since the hand was here last is given back. */
static void pass_block(struct mapped_budget *budget, const struct mapped_file *file, size_t block)
{
    uint8_t recent = MAPPED_RECENT, stale = MAPPED_STALE;
    if (atomic_compare_exchange_strong(&file->marks[block], &recent, MAPPED_STALE))
        return;
    if (!atomic_compare_exchange_strong(&file->marks[block], &stale, MAPPED_ABSENT))
        return;
    atomic_fetch_sub(&budget->held, MAPPED_BLOCK);
    give_back(file, block);
}

/* To the next file, or to the first one again. */
static void turn(struct mapped_budget *budget)
{
    struct mapped_file *next = budget->hand ? budget->hand->next : NULL;
    budget->hand = next ? next : budget->files;
    budget->hand_block = 0;
}

/* Two turns of the clock pass every block. */
static void sweep(struct mapped_budget *budget)
{
    size_t left = 2 * budget->blocks;
    while (left > 0 && (double)mapped_budget_held(budget) > KEPT * budget->most) {
        if (!budget->hand || budget->hand_block == block_count(budget->hand))
            turn(budget);
        pass_block(budget, budget->hand, budget->hand_block++);
        left--;
    }
}

void mapped_file_mark(const struct mapped_file *file, size_t block)
{
    struct mapped_budget *budget = file->budget;
    if (atomic_exchange(&file->marks[block], MAPPED_RECENT) != MAPPED_ABSENT)
        return;
    size_t held = atomic_fetch_add(&budget->held, MAPPED_BLOCK) + MAPPED_BLOCK;
    if ((double)held <= budget->most)
        return;
    pthread_mutex_lock(&budget->lock);
    if ((double)mapped_budget_held(budget) > budget->most) /* another thread may have swept */
        sweep(budget);
    pthread_mutex_unlock(&budget->lock);
}
