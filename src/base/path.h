/* path.h: the parts of a file's path. */
#ifndef BASE_PATH_H
#define BASE_PATH_H

#include <stddef.h>
#include <string.h>

/* What follows the last slash: the name without its folder. Empty where the path ends in a
 * slash. */
static inline const char *path_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Of absolute paths of folders: how long the part is that both begin with, at the end of a folder's
 * name. */
static inline size_t path_common_length(const char *a, const char *b)
{
    size_t length = 0, i = 0;
    for (; a[i] && a[i] == b[i]; i++)
        if (a[i] == '/')
            length = i;
    if ((!a[i] || a[i] == '/') && (!b[i] || b[i] == '/'))
        length = i;
    return length;
}

#endif
