/* output_file.c: a file that appears whole or not at all.
 *
 * Bytes go to ".NAME.PROCESS-ATTEMPT" beside the target (a rename cannot cross file systems), which
 * is renamed onto the target once it is on disk. The name is made here and opened with O_EXCL
 * rather than by mkstemp, because mkstemp gives mode 0600 and the umask cannot be read without
 * changing it for all threads; open() applies it by itself. Writes carry their offset (OpenEXR
 * fills in its chunk table last), so the target must be seekable, which is why pipes are refused.
 */
#define _XOPEN_SOURCE 700 /* for realpath */

#include "base/output_file.h"

#include "base/path.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define ATTEMPT_LIMIT 1000   /* names tried; only leftovers of a killed process are in the way */
#define NAME_KEPT_LENGTH 200 /* of the target's name, so that the temporary one stays below 255 */

static ps_result refuse(const struct output_file *file, struct error *error, const char *why)
{
    return error_set(error, PS_ERROR_IO, "cannot write '%s': %s", file->path, why);
}

static ps_result refuse_taken(const struct output_file *file, struct error *error)
{
    return error_set(error, PS_ERROR_INVALID, "%s is there already, and stays as it is",
                     file->path);
}

static void release(struct output_file *file)
{
    free(file->path);
    free(file->target);
    free(file->temporary);
    *file = (struct output_file){.descriptor = -1};
}

/* Sets `target`, and `direct` where it is a device; refuses what cannot be replaced or written. */
static ps_result find_target(struct output_file *file, bool *direct, struct error *error)
{
    struct stat status;
    *direct = false;
    if (stat(file->path, &status) != 0) {
        if (errno != ENOENT && errno != ENOTDIR) {
            return refuse(file, error, strerror(errno));
        }
        if (lstat(file->path, &status) == 0) {
            return refuse(file, error, "it is a symbolic link to nothing");
        }
        if (*path_name(file->path) == '\0') {
            return refuse(file, error, "it names no file");
        }
        file->target = strdup(file->path);
    } else if (S_ISDIR(status.st_mode)) {
        return refuse(file, error, "it is a directory");
    } else if (!S_ISREG(status.st_mode) && !S_ISCHR(status.st_mode)) {
        return refuse(file, error, "it is neither a file nor a device (give a file's name)");
    } else if (access(file->path, W_OK) != 0) {
        return refuse(file, error, strerror(errno));
    } else {
        *direct = S_ISCHR(status.st_mode);
        file->target = *direct ? strdup(file->path) : realpath(file->path, NULL);
    }
    return file->target ? PS_OK : refuse(file, error, strerror(errno));
}

static ps_result open_temporary(struct output_file *file, struct error *error)
{
    const char *name = path_name(file->target);
    int directory_length = (int)(name - file->target);
    size_t size = (size_t)directory_length + NAME_KEPT_LENGTH + 48;
    file->temporary = malloc(size);
    if (!file->temporary) {
        return error_memory(error, size, "a temporary file's name");
    }
    for (int attempt = 0; attempt < ATTEMPT_LIMIT; attempt++) {
        snprintf(file->temporary, size, "%.*s.%.*s.%ld-%d", directory_length, file->target,
                 NAME_KEPT_LENGTH, name, (long)getpid(), attempt);
        file->descriptor = open(file->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file->descriptor >= 0) {
            return PS_OK;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    return error_set(error, PS_ERROR_IO, "cannot write '%s': cannot create a file in '%.*s': %s",
                     file->path, directory_length ? directory_length : 1,
                     directory_length ? file->target : ".", strerror(errno));
}

/* Fails with EEXIST where the name was taken: of all calls link(2) alone asks and acts at once on
 * every system. Where the file system has no links, a name that is taken in this very moment is
 * lost. */
static bool put_new(const struct output_file *file)
{
    if (link(file->temporary, file->target) == 0) {
        unlink(file->temporary);
        return true;
    }
    if (errno != EPERM && errno != EOPNOTSUPP && errno != ENOSYS)
        return false;
    if (access(file->target, F_OK) != 0)
        return rename(file->temporary, file->target) == 0;
    errno = EEXIST;
    return false;
}

static bool put(const struct output_file *file)
{
    return file->is_new ? put_new(file) : rename(file->temporary, file->target) == 0;
}

static ps_result open_device(struct output_file *file, struct error *error)
{
    file->descriptor = open(file->target, O_WRONLY | O_NOCTTY | O_CLOEXEC);
    return file->descriptor >= 0 ? PS_OK : refuse(file, error, strerror(errno));
}

static ps_result open_file(struct output_file *file, const char *path, bool is_new,
                           struct error *error)
{
    struct stat status;
    bool direct = false;
    *file = (struct output_file){.path = strdup(path), .descriptor = -1, .is_new = is_new};
    if (!file->path) {
        return error_memory(error, strlen(path) + 1, "a file's name");
    }
    ps_result result = is_new && lstat(path, &status) == 0 ? refuse_taken(file, error)
                                                           : find_target(file, &direct, error);
    if (result == PS_OK) {
        result = direct ? open_device(file, error) : open_temporary(file, error);
    }
    if (result != PS_OK) {
        release(file);
    }
    return result;
}

ps_result output_file_open(struct output_file *file, const char *path, struct error *error)
{
    return open_file(file, path, false, error);
}

ps_result output_file_open_new(struct output_file *file, const char *path, struct error *error)
{
    return open_file(file, path, true, error);
}

ps_result output_file_write(const struct output_file *file, uint64_t offset, const void *data,
                            size_t size, struct error *error)
{
    const char *bytes = data;
    while (size > 0) {
        ssize_t written = pwrite(file->descriptor, bytes, size, (off_t)offset);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            return refuse(file, error, written < 0 ? strerror(errno) : "nothing could be written");
        }
        bytes += written;
        size -= (size_t)written;
        offset += (uint64_t)written;
    }
    return PS_OK;
}

ps_result output_file_commit(struct output_file *file, struct error *error)
{
    /* Some file systems report a full disk only when the bytes are forced out or the file closed.
     */
    bool stored = !file->temporary || fsync(file->descriptor) == 0;
    int reason = errno;
    if (close(file->descriptor) != 0 && stored) {
        stored = false;
        reason = errno;
    }
    if (stored && file->temporary && !put(file)) {
        stored = false;
        reason = errno;
    }
    ps_result result = stored                             ? PS_OK
                       : file->is_new && reason == EEXIST ? refuse_taken(file, error)
                                                          : refuse(file, error, strerror(reason));
    if (!stored && file->temporary) {
        unlink(file->temporary);
    }
    release(file);
    return result;
}

void output_file_discard(struct output_file *file)
{
    close(file->descriptor);
    if (file->temporary) {
        unlink(file->temporary);
    }
    release(file);
}
