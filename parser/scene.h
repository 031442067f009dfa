/* scene.h: from the tree of a .psd document to a scene description. */
#ifndef PARSER_SCENE_H
#define PARSER_SCENE_H

#include "parser/reader.h"

/* Fills the reader's description from the root of the tree, reporting what is wrong. */
void scene_read(struct reader *reader, const struct node *root);

#endif
