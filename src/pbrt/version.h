/* version.h: which version of pbrt a scene is for: the files do not say. */
#ifndef PBRT_VERSION_H
#define PBRT_VERSION_H

#include <stddef.h>

/* 3 or 4, as the first word tells that only one of them has; 0: no word tells. */
int version_guess(const char *text, size_t length);

#endif
