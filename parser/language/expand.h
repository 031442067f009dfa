/* expand.h: puts values in the place of formulas, and items in the place of loops and
 * conditions. */
#ifndef PARSER_LANGUAGE_EXPAND_H
#define PARSER_LANGUAGE_EXPAND_H

#include "parser/language/scope.h"
#include "parser/yaml/builder.h"

/* A formula may be read again in every turn of a loop: so many characters in all for each value
 * that a scene may have. */
#define MOST_FORMULA_CHARACTERS 16

/* So many errors end it: most are one error in many turns. */
#define MOST_EXPANSION_ERRORS 100

struct expansion {
    struct reader *reader;
    struct scope *scope;
    struct budget budget;
    size_t formula_characters;
    size_t errors;
    bool stopped; /* reported, or out of memory, noted: the tree is of no use */
};

/* The node without formulas, loops and conditions; itself, shared, where it had none. `depth` is
 * how many lists and maps it stands in. Errors are reported and leave a NODE_BROKEN. */
const struct node *expand_node(struct expansion *expansion, const struct node *node, int depth);

/* Appends an item of a list to another; a loop, or a condition, as many as it makes. */
void expand_item(struct expansion *expansion, const struct node *node, int depth,
                 struct node *list);

/* The same for the root of a scene, without the sections that definitions.h and include.h read. */
const struct node *expand_root(struct expansion *expansion, const struct node *root);

/* A NODE_BROKEN in the place of a node. */
const struct node *expand_broken(struct expansion *expansion, const struct node *like);

/* Takes so many values from the budget; false, reported, where it does not hold them. */
bool expand_count(struct expansion *expansion, const struct node *at, double values);

/* reader_error that counts. */
void expand_error(struct expansion *expansion, const struct node *at, const char *format, ...)
    PRINTF_LIKE(3, 4);

void expand_fail_memory(struct expansion *expansion);

#endif
