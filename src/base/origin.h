/* origin.h: where something was written, for errors that are found after the text was read. */
#ifndef BASE_ORIGIN_H
#define BASE_ORIGIN_H

/* `file` is owned by the scene description; line and column count from 1; line 0: not from a
 * file. */
struct origin {
    const char *file;
    int line, column;
};

#endif
