/* document.h: reads YAML text into a tree of nodes (node.h). */
#ifndef PARSER_DOCUMENT_H
#define PARSER_DOCUMENT_H

#include "parser/diagnostic.h"
#include "parser/node.h"

struct document {
    struct arena arena;
    const struct node *root; /* never NULL where document_read returned PS_OK */
};

/* Reads a text that passed encoding_check. `file` names it in messages, and nodes point to that
 * name. PS_OK when there is a tree that can be looked at, though
 * errors may have been reported on the way; else PS_ERROR_INVALID or PS_ERROR_MEMORY (the latter
 * is not reported). To be released in any case. */
ps_result document_read(const char *file, const char *text, size_t length, struct diagnostics *sink,
                        struct document *document);

void document_release(struct document *document);

#endif
