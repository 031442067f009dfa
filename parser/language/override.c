/* override.c: copies the lists and maps on the way to a value, and nothing beside it. */
#include "parser/language/override.h"

#include <stdlib.h>
#include <string.h>

struct path {
    struct reader *reader;
    const struct assignment *assignment;
    const struct node *value;
    size_t at; /* byte of the key at which the next part starts */
    int depth;
};

static const struct node *set_in(struct path *path, const struct node *node);

/* The next part of the path, as a key; NULL where it has no text (reported), or out of memory. */
static const struct node *next_part(struct path *path)
{
    const char *rest = path->assignment->key + path->at;
    size_t length = strcspn(rest, ".");
    const struct node *part = assignment_key(path->reader, path->assignment, path->at, length);
    if (part && length == 0) {
        reader_error(path->reader, part, "a key is missing in '%s'", path->assignment->key);
        return NULL;
    }
    path->at += length + (rest[length] == '.');
    return part;
}

/* The path up to a part, for messages. */
static int length_before(const struct path *path, const struct node *part)
{
    size_t end = path->at;
    const char *key = path->assignment->key;
    if (key[end] != '\0' || (end > 0 && key[end - 1] == '.'))
        end--;
    end -= strlen(part->text);
    return end > 0 ? (int)(end - 1) : 0;
}

static void *fail_memory(struct path *path)
{
    path->reader->out_of_memory = true;
    return NULL;
}

static const struct node *set_in_map(struct path *path, const struct node *map,
                                     const struct node *key)
{
    struct arena *arena = path->reader->arena;
    static const struct node nothing = {.kind = NODE_SCALAR, .plain = true, .text = ""};
    struct node *copy = node_start(arena, map);
    bool found = false;
    for (const struct item *item = map->first; item && copy; item = item->next) {
        bool here = strcmp(item->key->text, key->text) == 0;
        const struct node *value = here ? set_in(path, item->value) : item->value;
        if (!value)
            return NULL;
        found = found || here;
        if (!node_add(copy, arena, item->key, value))
            copy = NULL;
    }
    const struct node *value = copy && !found ? set_in(path, &nothing) : NULL;
    if (copy && !found && !value)
        return NULL;
    if (!copy || (value && !node_add(copy, arena, key, value)))
        return fail_memory(path);
    return copy;
}

static bool read_index(const struct path *path, const struct node *list, const struct node *part,
                       size_t *index)
{
    char *end;
    int length = length_before(path, part);
    const char *name = path->assignment->key;
    bool digits = part->text[strspn(part->text, "0123456789")] == '\0';
    *index = strtoul(part->text, &end, 10);
    if (digits && *index < list->count)
        return true;
    if (!digits)
        reader_error(path->reader, part,
                     "'%.*s' is a list; expected the number of an item, got '%s'", length, name,
                     part->text);
    else if (list->count == 0)
        reader_error(path->reader, part, "'%.*s' is an empty list", length, name);
    else
        reader_error(path->reader, part, "'%.*s' has no item %s; it has %zu, counted from 0",
                     length, name, part->text, list->count);
    return false;
}

static const struct node *set_in_list(struct path *path, const struct node *list,
                                      const struct node *part)
{
    struct arena *arena = path->reader->arena;
    struct node *copy = node_start(arena, list);
    size_t index, at = 0;
    if (!copy)
        return fail_memory(path);
    if (!read_index(path, list, part, &index))
        return NULL;
    for (const struct item *item = list->first; item; item = item->next) {
        const struct node *value = at++ == index ? set_in(path, item->value) : item->value;
        if (!value)
            return NULL;
        if (!node_add(copy, arena, NULL, value))
            return fail_memory(path);
    }
    return copy;
}

/* A map that was not there before. */
static const struct node *start_map(struct path *path, const struct node *part)
{
    struct node *map = node_start(path->reader->arena, part);
    if (!map)
        return fail_memory(path);
    map->kind = NODE_MAP;
    return map;
}

static const struct node *set_below(struct path *path, const struct node *node,
                                    const struct node *part)
{
    if (node_is_null(node))
        node = start_map(path, part);
    if (!node)
        return NULL;
    if (node->kind == NODE_MAP)
        return set_in_map(path, node, part);
    if (node->kind == NODE_LIST)
        return set_in_list(path, node, part);
    if (node->kind == NODE_SCALAR)
        reader_error(path->reader, part, "'%.*s' is text, in which there is no '%s'",
                     length_before(path, part), path->assignment->key, part->text);
    return NULL;
}

/* The node with the value at the rest of the path; NULL where that was reported. */
static const struct node *set_in(struct path *path, const struct node *node)
{
    const char *key = path->assignment->key;
    bool ended = key[path->at] == '\0' && path->at > 0 && key[path->at - 1] != '.';
    if (ended)
        return path->value;
    const struct node *part = next_part(path);
    if (!part)
        return NULL;
    path->depth++;
    if (path->depth + path->value->height > DEEPEST_NESTING) {
        reader_error(path->reader, part, "nested deeper than %d levels", DEEPEST_NESTING);
        return NULL;
    }
    return set_below(path, node, part);
}

static bool is_settable(const struct reader *reader, const struct assignment *assignment)
{
    const struct node at = {
        .kind = NODE_SCALAR, .mark = assignment->key_mark, .file = assignment->file};
    bool include = strncmp(assignment->key, "include", 7) == 0 &&
                   (assignment->key[7] == '\0' || assignment->key[7] == '.');
    if (include)
        reader_error(reader, &at, "include can't be set: the files have been read by then");
    return !include;
}

const struct node *override_tree(struct reader *reader, const struct assignments *sets,
                                 struct budget *budget, const struct node *root)
{
    for (size_t i = 0; i < sets->count && !reader->out_of_memory; i++) {
        struct path path = {.reader = reader, .assignment = &sets->items[i]};
        if (!is_settable(reader, path.assignment))
            continue;
        path.value = assignment_value(reader, path.assignment, budget);
        const struct node *changed = path.value ? set_in(&path, root) : NULL;
        if (changed)
            root = changed;
    }
    return root;
}
