/* node.h: a YAML document as a tree.
 *
 * An alias shares the node that it names, so the tree is a directed graph without cycles. Maps
 * have unique scalar keys, merge keys are resolved. All memory is an arena's.
 */
#ifndef PARSER_YAML_NODE_H
#define PARSER_YAML_NODE_H

#include "parser/yaml/names.h"
#include <stdbool.h>
#include <stdint.h>

enum node_kind {
    NODE_SCALAR,
    NODE_LIST,
    NODE_MAP,
    NODE_BROKEN /* stands for what was reported already; say nothing more about it */
};

struct item {
    const struct node *key; /* NULL in a list */
    const struct node *value;
    struct item *next;
};

/* A place in the text. */
struct mark {
    int line, column; /* from 1 */
    int width;        /* characters to underline */
};

struct node {
    enum node_kind kind;
    struct mark mark; /* where it starts */
    uint32_t weight;  /* nodes in it, with those that aliases share counted each time */
    uint8_t height;   /* levels of lists and maps */
    bool plain;       /* a scalar without quotes */
    bool open;        /* a list or map that has not ended yet */
    const char *text; /* of a scalar */
    const char *file; /* in which it was written; owned by the scene description */
    struct item *first, *last;
    size_t count;
    struct names names; /* of a map: its items by key */
};

/* False when out of memory. */
bool node_append(struct node *node, struct arena *arena, const struct node *key,
                 const struct node *value);

/* The same for a value that has ended; the node's weight and height grow with it. */
bool node_add(struct node *node, struct arena *arena, const struct node *key,
              const struct node *value);

/* A list or map of the same kind and place as `like`, still without items; NULL when out of memory.
 */
struct node *node_start(struct arena *arena, const struct node *like);

/* A scalar of the same place as `like` (which may be another kind of node), with a text that is not
 * copied; NULL when out of memory. */
struct node *node_scalar(struct arena *arena, const struct node *like, const char *text);

/* The item of a map (or NULL: none, or no map). */
const struct item *node_find(const struct node *node, const char *key);

/* A plain empty scalar, `~` or `null`: a key without a value. */
bool node_is_null(const struct node *node);

/* A scalar that begins with '='. */
bool node_is_formula(const struct node *node);

/* A scalar that is a decimal number; its value goes to `number`, which may be NULL. */
bool node_is_number(const struct node *node, double *number);

/* "a list", "a map", ... */
const char *node_kind_name(const struct node *node);

/* Resolves the merge key `<<` of a map: adds the items of the map, or maps, that it names, where
 * the key is not there yet. Where it names one by a formula (`=name`), nothing happens yet. Sets
 * `culprit` to a node that is no map and cannot be merged, else NULL. False when out of memory. */
bool node_merge(struct node *node, struct arena *arena, const struct node **culprit);

#endif
