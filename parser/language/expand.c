/* expand.c: a walk over the tree that copies only what changes.
 *
 * Values, and what a name stands for, are shared and never copied, so that a loop over a mesh costs
 * no more than its turns. Everything that is walked, or put in, is taken from one budget, as
 * whoever reads the tree will visit it as often.
 */
#include "parser/language/expand.h"

#include "parser/language/loop.h"
#include "parser/language/word.h"
#include <string.h>

void expand_fail_memory(struct expansion *expansion)
{
    expansion->reader->out_of_memory = true;
    expansion->stopped = true;
}

void expand_error(struct expansion *expansion, const struct node *at, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    reader_error_list(expansion->reader, at, format, arguments);
    va_end(arguments);
    if (++expansion->errors >= MOST_EXPANSION_ERRORS)
        expansion->stopped = true;
}

bool expand_count(struct expansion *expansion, const struct node *at, double values)
{
    struct budget *budget = &expansion->budget;
    if (values <= (double)(budget->most - budget->used)) {
        budget->used += (size_t)values;
        return true;
    }
    if (!expansion->stopped)
        expand_error(expansion, at, "more than %zu values in one scene", budget->most);
    expansion->stopped = true;
    return false;
}

const struct node *expand_broken(struct expansion *expansion, const struct node *like)
{
    struct node *node = node_scalar(expansion->reader->arena, like, "");
    if (!node) {
        expand_fail_memory(expansion);
        return like;
    }
    node->kind = NODE_BROKEN;
    return node;
}

/* Points into the scalar where that is possible: it is as long as it looks, on one line. */
static void report_formula(struct expansion *expansion, const struct node *node, size_t position,
                           const char *message)
{
    struct node at = *node;
    size_t quote = node->plain ? 0 : 1, offset = position + 1 + quote;
    if (strlen(node->text) + 2 * quote == (size_t)node->mark.width &&
        offset < (size_t)node->mark.width) {
        at.mark.column += (int)offset;
        at.mark.width = 1;
    }
    expand_error(expansion, &at, "%s", message);
}

static const struct node *evaluate(struct expansion *expansion, const struct node *node)
{
    struct arithmetic_names names = scope_names(expansion->scope);
    struct error error;
    size_t position;
    double value;
    char text[WORD_NUMBER];
    if (arithmetic_evaluate(node->text + 1, &names, &value, &position, &error) != PS_OK) {
        if (error.text[0])
            report_formula(expansion, node, position, error.text);
        return expand_broken(expansion, node);
    }
    word_write_number(value, text);
    const char *copy = arena_copy(expansion->reader->arena, text, strlen(text));
    struct node *number = copy ? node_scalar(expansion->reader->arena, node, copy) : NULL;
    if (!number)
        expand_fail_memory(expansion);
    return number ? number : node;
}

static bool count_formula(struct expansion *expansion, const struct node *node)
{
    size_t limit = expansion->budget.most * MOST_FORMULA_CHARACTERS;
    expansion->formula_characters += strlen(node->text);
    if (expansion->formula_characters <= limit)
        return true;
    expand_error(expansion, node, "loops and aliases make more than %zu characters of formulas",
                 limit);
    expansion->stopped = true;
    return false;
}

/* What the name that is the whole formula stands for; NULL where it is no such name. */
static const struct node *find_whole(struct expansion *expansion, const struct node *node)
{
    char name[WORD_NAME];
    if (!word_is_name(node->text + 1, name))
        return NULL;
    const struct binding *binding = scope_find(expansion->scope, name);
    return binding ? binding->value : NULL;
}

/* Stands where the name stands, so that messages are about that place; any other value stays where
 * it was written, as the path of a file must. */
static const struct node *copy_number(struct expansion *expansion, const struct node *node,
                                      const struct node *value)
{
    const struct node *copy = node_scalar(expansion->reader->arena, node, value->text);
    if (!copy)
        expand_fail_memory(expansion);
    return copy ? copy : node;
}

static const struct node *expand_formula(struct expansion *expansion, const struct node *node,
                                         int depth)
{
    if (!count_formula(expansion, node))
        return node;
    const struct node *value = find_whole(expansion, node);
    if (!value)
        return evaluate(expansion, node);
    if (node_is_number(value, NULL))
        return copy_number(expansion, node, value);
    if (!expand_count(expansion, node, value->weight))
        return node;
    if (depth + value->height <= DEEPEST_NESTING)
        return value;
    expand_error(expansion, node, "nested deeper than %d levels", DEEPEST_NESTING);
    return expand_broken(expansion, node);
}

/* A copy with the items before `end`. */
static struct node *copy_head(struct expansion *expansion, const struct node *node,
                              const struct item *end)
{
    struct arena *arena = expansion->reader->arena;
    struct node *copy = node_start(arena, node);
    for (const struct item *item = node->first; copy && item != end; item = item->next)
        if (!node_add(copy, arena, item->key, item->value))
            copy = NULL;
    if (!copy)
        expand_fail_memory(expansion);
    return copy;
}

static void resolve_merge(struct expansion *expansion, struct node *map)
{
    const struct node *culprit;
    if (!node_merge(map, expansion->reader->arena, &culprit))
        expand_fail_memory(expansion);
    else if (culprit)
        expand_error(expansion, culprit, "'<<' merges a map or a list of maps, not %s",
                     node_kind_name(culprit));
}

static const struct node *expand_items(struct expansion *expansion, const struct node *node,
                                       int depth)
{
    struct node *copy = NULL;
    for (const struct item *item = node->first; item && !expansion->stopped; item = item->next) {
        bool splice = node->kind == NODE_LIST && loop_is(item->value);
        const struct node *value = splice ? NULL : expand_node(expansion, item->value, depth + 1);
        if (!copy && value == item->value)
            continue;
        if (!copy)
            copy = copy_head(expansion, node, item);
        if (copy && splice)
            expand_item(expansion, item->value, depth + 1, copy);
        else if (copy && !node_add(copy, expansion->reader->arena, item->key, value))
            expand_fail_memory(expansion);
    }
    if (copy && copy->kind == NODE_MAP && !expansion->stopped)
        resolve_merge(expansion, copy);
    return copy ? copy : node;
}

const struct node *expand_node(struct expansion *expansion, const struct node *node, int depth)
{
    if (expansion->stopped || !expand_count(expansion, node, 1))
        return node;
    if (node->kind == NODE_LIST || node->kind == NODE_MAP)
        return expand_items(expansion, node, depth);
    return node_is_formula(node) ? expand_formula(expansion, node, depth) : node;
}

/* What was read before the tree was expanded, and has done its work. */
static bool is_done(const char *key)
{
    return strcmp(key, "include") == 0 || strcmp(key, "define") == 0 ||
           strcmp(key, "parameters") == 0;
}

const struct node *expand_root(struct expansion *expansion, const struct node *root)
{
    if (root->kind != NODE_MAP)
        return expand_node(expansion, root, 0);
    struct node *copy = copy_head(expansion, root, root->first);
    for (const struct item *item = root->first; item && !expansion->stopped; item = item->next) {
        bool done = is_done(item->key->text);
        const struct node *value = done ? NULL : expand_node(expansion, item->value, 1);
        if (!done && !node_add(copy, expansion->reader->arena, item->key, value))
            expand_fail_memory(expansion);
    }
    if (!expansion->stopped)
        resolve_merge(expansion, copy);
    return copy ? copy : root;
}

void expand_item(struct expansion *expansion, const struct node *node, int depth, struct node *list)
{
    if (expansion->stopped)
        return;
    if (loop_is(node)) {
        loop_expand(expansion, node, depth, list);
        return;
    }
    const struct node *value = expand_node(expansion, node, depth);
    if (!node_add(list, expansion->reader->arena, NULL, value))
        expand_fail_memory(expansion);
}
