/* watched_files.h: whether files have changed, by what the file system says of them.
 *
 * Asked from time to time: inotify tells of folders on the same machine alone, and editors that
 * replace a file lose what it watches.
 */
#ifndef EXPLORE_WATCHED_FILES_H
#define EXPLORE_WATCHED_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

/* Zeroed: none. */
struct watched_files {
    char **paths; /* owned */
    size_t count;
    uint64_t seen;    /* a digest of what they were like when they were read; 0: not known */
    uint64_t pending; /* and of what they were found to be since, where that differs */
};

/* Adds one, once. When out of memory, it is not watched. */
void watched_files_add(struct watched_files *files, const char *path);

void watched_files_release(struct watched_files *files);

/* They were read just now, which began at that time; what was written since is a change. */
void watched_files_read(struct watched_files *files, struct timespec began);

/* Whether they are not what they were, and have come to rest since the last question: editors write
 * in several steps. They count as read then. */
bool watched_files_changed(struct watched_files *files);

#endif
