/* strategy.c: the plugins that `render` names, with their parameters.
 *
 * Values stay text, because only the plugin knows what they mean and the parser loads no plugins;
 * but arithmetic is done here, as it is the scene file's. Scenes are passed around, so a path to a
 * plugin is refused here, before anything can load it.
 */
#include "parser/sections/sections.h"

#include "parser/sections/fill.h"
#include <string.h>

/* Appends an item of a list to `text`; a NULL `text` only counts. Returns the length then, or 0
 * where something was reported. */
static size_t append_item(struct reader *reader, struct subject subject, const struct node *node,
                          char *text, size_t length)
{
    const char *item = value_text(reader, subject, node, "a number or a word");
    if (!item)
        return 0;
    size_t separator = length > 1 ? 2 : 0, bytes = strlen(item);
    if (text) {
        memcpy(text + length, ", ", separator);
        memcpy(text + length + separator, item, bytes);
    }
    return length + separator + bytes;
}

static size_t join_items(struct reader *reader, struct subject subject, const struct node *list,
                         char *text)
{
    size_t length = 1;
    for (const struct item *item = list->first; item && length > 0; item = item->next)
        length = append_item(reader, subject, item->value, text, length);
    return length;
}

/* "[a, b, c]" */
static char *join_list(struct reader *reader, struct subject subject, const struct node *list)
{
    size_t length = join_items(reader, subject, list, NULL);
    char *text = length > 0 ? reader_allocate(reader, length + 2, 1) : NULL;
    if (text) {
        text[0] = '[';
        join_items(reader, subject, list, text);
        text[length] = ']';
    }
    return text;
}

static char *copy_value(struct reader *reader, struct subject subject, const struct node *node)
{
    if (node->kind == NODE_LIST)
        return join_list(reader, subject, node);
    const char *text = value_text(reader, subject, node, "a number, a word or a list of them");
    return text ? reader_copy(reader, text) : NULL;
}

static bool read_parameters(struct reader *reader, const struct node *map,
                            struct strategy_choice *choice)
{
    choice->parameters = reader_allocate(reader, map->count, sizeof *choice->parameters);
    if (!choice->parameters)
        return map->count == 0;
    bool good = true;
    for (const struct item *item = map->first; item; item = item->next) {
        struct parameter_text *parameter = &choice->parameters[choice->parameter_count++];
        struct subject subject = {item->key->text, choice->name};
        parameter->key = reader_copy(reader, item->key->text);
        parameter->value = copy_value(reader, subject, item->value);
        parameter->key_origin = reader_origin(reader, item->key);
        parameter->value_origin = reader_origin(reader, item->value);
        good = good && parameter->key && parameter->value;
    }
    return good;
}

bool strategy_read(struct reader *reader, struct subject subject, const struct node *node,
                   struct strategy_choice *choice)
{
    bool map = node->kind == NODE_MAP && node->count == 1;
    const struct node *name = map ? node->first->key : node;
    if (name->kind != NODE_SCALAR || node_is_null(name) || name->text[0] == '\0') {
        reader_error(reader, node,
                     "%s in %s: expected a plugin's name or {NAME: {PARAMETER: VALUE}}, got %s",
                     subject.key, subject.section,
                     node->kind == NODE_MAP ? "another map" : node_kind_name(node));
        return false;
    }
    if (strchr(name->text, '/') && !reader->allow_plugin_paths) {
        reader_error(reader, name,
                     "%s in %s: a plugin is a program, and a scene names it without a path; to run "
                     "this file all the same, use --plugin or --allow-scene-plugins",
                     subject.key, subject.section);
        return false;
    }
    choice->name = reader_copy(reader, name->text);
    choice->origin = reader_origin(reader, name);
    if (!choice->name)
        return false;
    return !map || (fill_expect(reader, name->text, node->first->value, NODE_MAP) &&
                    read_parameters(reader, node->first->value, choice));
}
