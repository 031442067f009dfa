#include "base/lock_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define ATTEMPTS 100 /* against processes that remove the file between opening and locking it */

static int lock(int descriptor)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    return fcntl(descriptor, F_SETLK, &whole);
}

/* Whether the file that was locked is still the one of that name. */
static int is_there(const char *path, int descriptor)
{
    struct stat named, locked;
    return stat(path, &named) == 0 && fstat(descriptor, &locked) == 0 &&
           named.st_dev == locked.st_dev && named.st_ino == locked.st_ino;
}

static ps_result fail(struct lock_file *file, const char *path, struct error *error)
{
    int reason = errno;
    if (file->descriptor >= 0)
        close(file->descriptor);
    free(file->path);
    *file = (struct lock_file){.descriptor = -1};
    if (reason == EACCES || reason == EAGAIN)
        return error_set(error, PS_ERROR_IO, "another process is at work on '%s'", path);
    return error_set(error, PS_ERROR_IO, "cannot lock '%s': %s", path, strerror(reason));
}

ps_result lock_file_take(struct lock_file *file, const char *path, struct error *error)
{
    size_t size = strlen(path) + sizeof ".lock";
    *file = (struct lock_file){.path = malloc(size), .descriptor = -1};
    if (!file->path)
        return error_memory(error, size, "a file's name");
    snprintf(file->path, size, "%s.lock", path);
    for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
        file->descriptor = open(file->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (file->descriptor < 0 || lock(file->descriptor) != 0)
            return fail(file, path, error);
        if (is_there(file->path, file->descriptor))
            return PS_OK;
        close(file->descriptor);
    }
    file->descriptor = -1;
    errno = EAGAIN;
    return fail(file, path, error);
}

/* Removed while it is locked, so that whoever opens it next makes a new one. */
void lock_file_release(struct lock_file *file)
{
    if (!file->path)
        return;
    unlink(file->path);
    close(file->descriptor);
    free(file->path);
    *file = (struct lock_file){.descriptor = -1};
}
