/* document.h: reads YAML text into a tree of nodes (node.h). */
#ifndef PARSER_YAML_DOCUMENT_H
#define PARSER_YAML_DOCUMENT_H

#include "parser/yaml/builder.h"

/* A text that passed encoding_check. */
struct document {
    const char *file;  /* names it in messages; nodes point to that name */
    struct mark start; /* where the text starts in the file: line 1, column 1, or further on */
    const char *text;
    size_t length;
};

/* Reads a document into nodes of the arena, whose values are taken from the budget. PS_OK when
 * there is a tree that can be looked at, though errors may have been reported on the way; else
 * PS_ERROR_INVALID or PS_ERROR_MEMORY (the latter is not reported). */
ps_result document_read(const struct document *document, struct diagnostics *sink,
                        struct arena *arena, struct budget *budget, const struct node **root);

#endif
