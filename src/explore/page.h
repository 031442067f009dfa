/* page.h: the files of the web page, which are in the program: src/explore/page, by embed.cmake. */
#ifndef EXPLORE_PAGE_H
#define EXPLORE_PAGE_H

#include <stddef.h>

struct page_file {
    const char *name; /* such as "explore.js" */
    const unsigned char *bytes;
    size_t length;
};

extern const struct page_file page_files[];
extern const size_t page_file_count;

#endif
