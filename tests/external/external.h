/* external.h: for tests of files that psplat does not ship, in the folder that $PSPLAT_SHARED
 * names. */
#ifndef TESTS_EXTERNAL_H
#define TESTS_EXTERNAL_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#define EXTERNAL_SKIPPED 77 /* the exit status that CTest counts as skipped */

/* Whether the folder is there; prints a line where it is not. */
static inline bool external_files_are_there(const char *folder)
{
    char path[4096];
    const char *shared = getenv("PSPLAT_SHARED");
    snprintf(path, sizeof path, "%s/%s", shared ? shared : "", folder);
    bool there = shared && access(path, R_OK) == 0;
    if (!there)
        printf("skipped: PSPLAT_SHARED names no folder with %s in it\n", folder);
    return there;
}

#endif
