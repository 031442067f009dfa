/* builder.h: builds a tree of nodes (node.h) from the pieces of a text, in their order.
 *
 * What a text may cost is judged piece by piece. Errors that leave the tree's shape known are
 * reported, and building goes on; after others `result` is not PS_OK, and it must end.
 */
#ifndef PARSER_YAML_BUILDER_H
#define PARSER_YAML_BUILDER_H

#include "parser/yaml/diagnostic.h"
#include "parser/yaml/node.h"

/* Aliases make a small text stand for many nodes; beyond what a scene can mean by it, that is an
 * attack. A text of N nodes may expand to N * MOST_EXPANSION + EXPANSION_BASE. */
#define DEEPEST_NESTING 64
#define MOST_NODES ((size_t)4000000)
#define MOST_EXPANSION ((size_t)100)
#define EXPANSION_BASE ((size_t)10000)

/* A list or map that is being built; `key` waits for its value in a map. */
struct frame {
    struct node *node;
    const struct node *key;
    bool drop_value; /* the key was reported */
};

/* How many values a scene may have, and how many it has so far. */
struct budget {
    size_t most, used;
};

/* Zeroed but for the first five members: nothing was built yet. */
struct builder {
    const char *file;
    struct mark start; /* of the text in the file: line 1, column 1 unless it is a part of it */
    struct diagnostics *sink;
    struct arena *arena; /* of the tree */
    struct budget *budget;
    const struct node *root;
    struct names anchors; /* the latest node of each name */
    struct frame frames[DEEPEST_NESTING];
    size_t depth;
    size_t node_count, expanded_count; /* without and with repetition by aliases */
    ps_result result;                  /* PS_ERROR_MEMORY is not reported in the sink */
};

/* What can stand before a scalar, list or map; NULL where it does not. */
struct properties {
    const char *anchor, *tag;
};

void builder_scalar(struct builder *builder, struct mark mark, struct properties properties,
                    const char *text, size_t length, bool plain);
void builder_start(struct builder *builder, struct mark mark, struct properties properties,
                   enum node_kind kind);
void builder_end(struct builder *builder);
void builder_alias(struct builder *builder, struct mark mark, const char *name);

/* Reports an error. */
void builder_report(const struct builder *builder, struct mark mark, const char *format, ...)
    PRINTF_LIKE(3, 4);

#endif
