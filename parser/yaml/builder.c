/* builder.c: a stack of the lists and maps that are open.
 *
 * An alias shares its target instead of copying it. It is counted as if it were copied, because
 * whoever walks the tree visits the target once for each alias.
 */
#include "parser/yaml/builder.h"

#include <string.h>

#define CORE_TAG "tag:yaml.org,2002:"

void builder_report(const struct builder *builder, struct mark mark, const char *format, ...)
{
    struct origin origin = {builder->file, mark.line, mark.column};
    va_list arguments;
    va_start(arguments, format);
    diagnostics_report_list(builder->sink, SEVERITY_ERROR, &origin, mark.width, format, arguments);
    va_end(arguments);
}

static void fail_memory(struct builder *builder)
{
    builder->result = PS_ERROR_MEMORY;
}

static struct node *create_node(struct builder *builder, enum node_kind kind, struct mark mark)
{
    struct node *node = arena_allocate(builder->arena, sizeof *node);
    if (!node) {
        fail_memory(builder);
        return NULL;
    }
    bool container = kind == NODE_LIST || kind == NODE_MAP;
    node->kind = kind;
    node->mark = mark;
    node->file = builder->file;
    node->weight = 1;
    node->height = container;
    node->open = container;
    node->text = "";
    builder->node_count++;
    return node;
}

/* Counts the nodes and levels that are about to be hung into the tree; where they are too many,
 * reports that and returns false. */
static bool count_nodes(struct builder *builder, struct mark mark, const struct node *node)
{
    builder->expanded_count += node->weight;
    builder->budget->used += node->weight;
    size_t limit = MOST_EXPANSION * builder->node_count + EXPANSION_BASE;
    if (builder->expanded_count > limit)
        builder_report(builder, mark, "aliases expand this text to more than %zu values", limit);
    else if (builder->budget->used > builder->budget->most)
        builder_report(builder, mark, "more than %zu values in one scene", builder->budget->most);
    else if (builder->depth + node->height > DEEPEST_NESTING)
        builder_report(builder, mark, "nested deeper than %d levels", DEEPEST_NESTING);
    else
        return true;
    builder->result = PS_ERROR_INVALID;
    return false;
}

static void take_key(struct builder *builder, struct frame *frame, const struct node *key)
{
    frame->key = key;
    frame->drop_value = true;
    const struct item *twin = key->kind == NODE_SCALAR ? node_find(frame->node, key->text) : NULL;
    if (twin)
        builder_report(builder, key->mark, "duplicate key '%s'; the first is on line %d", key->text,
                       twin->key->mark.line);
    else if (key->kind == NODE_SCALAR)
        frame->drop_value = false;
    else if (key->kind != NODE_BROKEN)
        builder_report(builder, key->mark, "a key must be text, not %s", node_kind_name(key));
}

/* Hangs a node, whose end may be yet to come, below what is open. */
static void attach(struct builder *builder, const struct node *node)
{
    if (builder->depth == 0) {
        builder->root = node;
        return;
    }
    struct frame *frame = &builder->frames[builder->depth - 1];
    if (frame->node->kind == NODE_MAP && !frame->key) {
        take_key(builder, frame, node);
        return;
    }
    bool dropped = frame->key && frame->drop_value;
    if (!dropped && !node_append(frame->node, builder->arena, frame->key, node))
        fail_memory(builder);
    frame->key = NULL;
}

/* Adds an ended node to the size of what it is in. */
static void add_size(struct builder *builder, const struct node *node)
{
    if (builder->depth == 0)
        return;
    struct node *parent = builder->frames[builder->depth - 1].node;
    parent->weight += node->weight;
    if (parent->height <= node->height)
        parent->height = (uint8_t)(node->height + 1);
}

static void check_tag(const struct builder *builder, const struct node *node, const char *tag)
{
    static const char *const fitting[][6] = {
        [NODE_SCALAR] = {"str", "int", "float", "bool", "null"},
        [NODE_LIST] = {"seq"},
        [NODE_MAP] = {"map"}};
    if (!tag || strcmp(tag, "!") == 0)
        return;
    size_t prefix = strlen(CORE_TAG);
    bool core = strncmp(tag, CORE_TAG, prefix) == 0;
    const char *shown = core ? tag + prefix : tag;
    for (size_t i = 0; core && fitting[node->kind][i]; i++)
        if (strcmp(shown, fitting[node->kind][i]) == 0)
            return;
    builder_report(builder, node->mark, "tag '%s%s' is not allowed here", core ? "!!" : "", shown);
}

static void take_properties(struct builder *builder, struct node *node,
                            struct properties properties)
{
    check_tag(builder, node, properties.tag);
    if (!properties.anchor)
        return;
    char *name = arena_copy(builder->arena, properties.anchor, strlen(properties.anchor));
    if (!name || !names_put(&builder->anchors, builder->arena, name, node))
        fail_memory(builder);
}

void builder_scalar(struct builder *builder, struct mark mark, struct properties properties,
                    const char *text, size_t length, bool plain)
{
    struct node *node = create_node(builder, NODE_SCALAR, mark);
    if (!node)
        return;
    node->plain = plain;
    node->text = arena_copy(builder->arena, text, length);
    if (!node->text) {
        fail_memory(builder);
        return;
    }
    take_properties(builder, node, properties);
    if (memchr(text, '\0', length)) {
        builder_report(builder, mark, "a NUL character is not allowed");
        node->kind = NODE_BROKEN;
    }
    if (!count_nodes(builder, mark, node))
        return;
    attach(builder, node);
    add_size(builder, node);
}

void builder_start(struct builder *builder, struct mark mark, struct properties properties,
                   enum node_kind kind)
{
    struct node *node = create_node(builder, kind, mark);
    if (!node)
        return;
    take_properties(builder, node, properties);
    if (!count_nodes(builder, mark, node))
        return;
    attach(builder, node);
    builder->frames[builder->depth++] = (struct frame){.node = node};
}

void builder_end(struct builder *builder)
{
    struct node *node = builder->frames[--builder->depth].node;
    const struct node *culprit = NULL;
    node->open = false;
    if (node->kind == NODE_MAP && !node_merge(node, builder->arena, &culprit))
        fail_memory(builder);
    if (culprit)
        builder_report(builder, culprit->mark, "'<<' merges a map or a list of maps, not %s",
                       node_kind_name(culprit));
    add_size(builder, node);
}

void builder_alias(struct builder *builder, struct mark mark, const char *name)
{
    const struct node *target = names_get(&builder->anchors, name);
    if (!target)
        builder_report(builder, mark, "undefined alias '*%s'", name);
    else if (target->open)
        builder_report(builder, mark, "alias '*%s' stands inside of what it names", name);
    if (!target || target->open)
        target = create_node(builder, NODE_BROKEN, mark);
    if (!target || !count_nodes(builder, mark, target))
        return;
    attach(builder, target);
    add_size(builder, target);
}
