#include "explore/watched_files.h"

#include "base/digest.h"
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

void watched_files_add(struct watched_files *files, const char *path)
{
    for (size_t i = 0; i < files->count; i++)
        if (strcmp(files->paths[i], path) == 0)
            return;
    char *copy = strdup(path);
    char **paths = copy ? realloc(files->paths, (files->count + 1) * sizeof *paths) : NULL;
    if (!paths) {
        free(copy);
        return;
    }
    files->paths = paths;
    paths[files->count++] = copy;
}

void watched_files_release(struct watched_files *files)
{
    for (size_t i = 0; i < files->count; i++)
        free(files->paths[i]);
    free(files->paths);
    *files = (struct watched_files){0};
}

static bool is_later(struct timespec a, struct timespec b)
{
    return a.tv_sec != b.tv_sec ? a.tv_sec > b.tv_sec : a.tv_nsec > b.tv_nsec;
}

/* Not 0. `newest`: when the last of them was written. */
static uint64_t digest_of(const struct watched_files *files, struct timespec *newest)
{
    uint64_t digest = DIGEST_START;
    *newest = (struct timespec){0};
    for (size_t i = 0; i < files->count; i++) {
        struct stat status;
        bool there = stat(files->paths[i], &status) == 0;
        digest_add(&digest, &there, sizeof there);
        if (!there)
            continue;
        digest_add(&digest, &status.st_size, sizeof status.st_size);
        digest_add(&digest, &status.st_ino, sizeof status.st_ino);
        digest_add(&digest, &status.st_mtim.tv_sec, sizeof status.st_mtim.tv_sec);
        digest_add(&digest, &status.st_mtim.tv_nsec, sizeof status.st_mtim.tv_nsec);
        if (is_later(status.st_mtim, *newest))
            *newest = status.st_mtim;
    }
    return digest > 0 ? digest : 1;
}

/* A time to come is somebody's joke, and no reason to read the file for ever. */
void watched_files_read(struct watched_files *files, struct timespec began)
{
    struct timespec newest, now;
    clock_gettime(CLOCK_REALTIME, &now);
    files->seen = digest_of(files, &newest);
    if (is_later(newest, began) && !is_later(newest, now))
        files->seen = 0;
    files->pending = 0;
}

bool watched_files_changed(struct watched_files *files)
{
    struct timespec newest;
    uint64_t now = digest_of(files, &newest);
    bool changed = now != files->seen && now == files->pending;
    files->pending = now;
    if (changed)
        files->seen = now;
    return changed;
}
