/* version.h: the version of psplat; CMakeLists.txt reads it from here. */
#ifndef BASE_VERSION_H
#define BASE_VERSION_H

#define PSPLAT_VERSION "0.1.0"

#endif
