/* default_path.h: the files that a command makes where none are named. */
#ifndef CLI_DEFAULT_PATH_H
#define CLI_DEFAULT_PATH_H

/* The scene's name with another suffix, in the current folder; "-" gives "stdin". The caller frees
 * it. NULL, printed, when out of memory. */
char *default_path(const char *scene_path, const char *suffix);

#endif
