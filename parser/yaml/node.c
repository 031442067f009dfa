/* node.c: building and searching the tree.
 *
 * Items are linked lists: they are walked in order, never indexed, and grow while libyaml reads.
 */
#include "parser/yaml/node.h"

#include "base/text.h"
#include <string.h>

bool node_append(struct node *node, struct arena *arena, const struct node *key,
                 const struct node *value)
{
    struct item *item = arena_allocate(arena, sizeof *item);
    if (!item || (key && !names_put(&node->names, arena, key->text, item)))
        return false;
    item->key = key;
    item->value = value;
    if (node->last)
        node->last->next = item;
    else
        node->first = item;
    node->last = item;
    node->count++;
    return true;
}

bool node_add(struct node *node, struct arena *arena, const struct node *key,
              const struct node *value)
{
    node->weight += value->weight;
    if (node->height <= value->height)
        node->height = (uint8_t)(value->height + 1);
    return node_append(node, arena, key, value);
}

struct node *node_start(struct arena *arena, const struct node *like)
{
    struct node *node = arena_allocate(arena, sizeof *node);
    if (node)
        *node = (struct node){.kind = like->kind,
                              .mark = like->mark,
                              .file = like->file,
                              .weight = 1,
                              .height = 1,
                              .text = ""};
    return node;
}

struct node *node_scalar(struct arena *arena, const struct node *like, const char *text)
{
    struct node *node = node_start(arena, like);
    if (node) {
        node->kind = NODE_SCALAR;
        node->height = 0;
        node->plain = true;
        node->text = text;
    }
    return node;
}

const struct item *node_find(const struct node *node, const char *key)
{
    return node->kind == NODE_MAP ? names_get(&node->names, key) : NULL;
}

bool node_is_null(const struct node *node)
{
    return node->kind == NODE_SCALAR && node->plain &&
           (node->text[0] == '\0' || strcmp(node->text, "~") == 0 ||
            strcmp(node->text, "null") == 0);
}

bool node_is_number(const struct node *node, double *number)
{
    double value;
    return node->kind == NODE_SCALAR && text_to_number(node->text, number ? number : &value);
}

bool node_is_formula(const struct node *node)
{
    return node->kind == NODE_SCALAR && node->text[0] == '=';
}

const char *node_kind_name(const struct node *node)
{
    if (node_is_null(node))
        return "nothing";
    return node->kind == NODE_LIST ? "a list" : node->kind == NODE_MAP ? "a map" : "text";
}

static bool unlink_item(struct node *node, struct arena *arena, const struct item *item)
{
    struct item **link = &node->first, *previous = NULL;
    while (*link != item) {
        previous = *link;
        link = &(*link)->next;
    }
    *link = item->next;
    if (node->last == item)
        node->last = previous;
    node->count--;
    return names_put(&node->names, arena, item->key->text, NULL);
}

/* Adds what `source` has and `node` has not. */
static bool merge_one(struct node *node, struct arena *arena, const struct node *source,
                      const struct node **culprit)
{
    if (source->kind != NODE_MAP && source->kind != NODE_BROKEN) {
        *culprit = source;
        return true;
    }
    for (const struct item *item = source->first; item; item = item->next)
        if (!node_find(node, item->key->text) && !node_append(node, arena, item->key, item->value))
            return false;
    return true;
}

static bool names_by_formula(const struct node *value)
{
    if (value->kind != NODE_LIST)
        return node_is_formula(value);
    for (const struct item *item = value->first; item; item = item->next)
        if (node_is_formula(item->value))
            return true;
    return false;
}

bool node_merge(struct node *node, struct arena *arena, const struct node **culprit)
{
    *culprit = NULL;
    const struct item *merge = node_find(node, "<<");
    if (!merge || !merge->key->plain || names_by_formula(merge->value))
        return true;
    if (!unlink_item(node, arena, merge))
        return false;
    if (merge->value->kind != NODE_LIST)
        return merge_one(node, arena, merge->value, culprit);
    for (const struct item *item = merge->value->first; item && !*culprit; item = item->next)
        if (!merge_one(node, arena, item->value, culprit))
            return false;
    return true;
}
