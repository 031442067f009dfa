/* lock_file.h: one process at a time works on a file.
 *
 * By a lock on FILE.lock, which the system releases with the process, however that ends.
 */
#ifndef BASE_LOCK_FILE_H
#define BASE_LOCK_FILE_H

#include "base/error.h"

struct lock_file {
    char *path; /* owned; NULL: no lock is held */
    int descriptor;
};

/* PS_ERROR_IO, with a message, where another process holds it, or the file cannot be made. */
ps_result lock_file_take(struct lock_file *lock, const char *path, struct error *error);
void lock_file_release(struct lock_file *lock);

#endif
