/* merge.h: makes one tree of the files of a scene. */
#ifndef PARSER_LANGUAGE_MERGE_H
#define PARSER_LANGUAGE_MERGE_H

#include "parser/sections/reader.h"

/* Zeroed: no file yet. */
struct merge {
    const struct node *root; /* NULL: no file yet */
    struct node *sum;        /* the same, where there were several */
    struct names sections;   /* struct node: those of the sum that may be appended to */
};

/* Adds the tree of a file, a map, to those before it. Lists go together, and so do maps from names
 * of the user's choice, in which a name that is there twice is an error. Of maps that are sections
 * (image, render), a key of the later file goes before the same one of an earlier, and of camera
 * the whole section. */
void merge_add(struct reader *reader, struct merge *merge, const struct node *root);

#endif
