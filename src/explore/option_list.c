#include "explore/option_list.h"

#include "base/shell_word.h"
#include "explore/json_text.h"
#include <stdlib.h>
#include <string.h>

static void release(struct explore_option *option)
{
    free(option->name);
    free(option->value);
}

bool option_list_add(struct option_list *list, const char *name, const char *value)
{
    struct explore_option *items = realloc(list->items, (list->count + 1) * sizeof *items);
    if (!items)
        return false;
    list->items = items;
    struct explore_option option = {strdup(name), value ? strdup(value) : NULL};
    if (!option.name || (value && !option.value)) {
        release(&option);
        return false;
    }
    items[list->count++] = option;
    return true;
}

static bool is_of_display(const struct explore_option *option)
{
    return strcmp(option->name, "plugin") == 0 &&
           (strncmp(option->value, "bloom=", 6) == 0 || strncmp(option->value, "tonemap=", 8) == 0);
}

static bool is_of_scene(const struct explore_option *option)
{
    return is_of_display(option) ||
           (strcmp(option->name, "plugin") != 0 && strcmp(option->name, "seed") != 0 &&
            strcmp(option->name, "quality") != 0);
}

static bool append(struct option_list *list, const struct option_list *other, bool scene_alone)
{
    size_t before = list->count;
    for (size_t i = 0; i < other->count; i++)
        if ((!scene_alone || is_of_scene(&other->items[i])) &&
            !option_list_add(list, other->items[i].name, other->items[i].value)) {
            while (list->count > before)
                release(&list->items[--list->count]);
            return false;
        }
    return true;
}

bool option_list_append(struct option_list *list, const struct option_list *other)
{
    return append(list, other, false);
}

bool option_list_append_scene(struct option_list *list, const struct option_list *other)
{
    return append(list, other, true);
}

void option_list_release(struct option_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        release(&list->items[i]);
    free(list->items);
    *list = (struct option_list){0};
}

const char *option_list_value(const struct option_list *list, const char *name)
{
    for (size_t i = list->count; i > 0; i--)
        if (strcmp(list->items[i - 1].name, name) == 0)
            return list->items[i - 1].value;
    return NULL;
}

bool option_is_of_view(const char *name)
{
    static const char *const names[] = {"plugin",  "param",   "set",  "camera", "size",
                                        "quality", "bounces", "seed", "direct", "direct-resolution",
                                        "exposure"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (strcmp(names[i], name) == 0)
            return true;
    return false;
}

/* A page may choose among the programs that are installed, and not bring its own. */
static bool names_a_file(const char *name, const char *value)
{
    return strcmp(name, "plugin") == 0 && memchr(value, '/', strcspn(value, ":"));
}

static ps_result check(const char *name, const char *value, struct error *error)
{
    if (!option_is_of_view(name))
        return error_set(error, PS_ERROR_INVALID, "'%.100s' is no option of a view", name);
    if (names_a_file(name, value))
        return error_set(error, PS_ERROR_INVALID,
                         "--plugin: '%.200s' is a file, which the command line alone may name",
                         value);
    return PS_OK;
}

static ps_result add_checked(struct option_list *list, const char *name, const char *value,
                             struct error *error)
{
    if (!name || !value)
        return error_set(error, PS_ERROR_INVALID, "options: a text is not UTF-8, or has NUL");
    ps_result result = check(name, value, error);
    if (result == PS_OK && !option_list_add(list, name, value))
        result = error_memory(error, 0, "options");
    return result;
}

static ps_result read_pair(struct option_list *list, const struct json *pair, struct error *error)
{
    const struct json *parts[2] = {json_element(pair, 0), json_element(pair, 1)};
    if (!parts[0] || !parts[1] || pair->count != 2 || parts[0]->kind != JSON_STRING ||
        parts[1]->kind != JSON_STRING)
        return error_set(error, PS_ERROR_INVALID,
                         "options: expected a list of [\"NAME\", \"VALUE\"]");
    char *name = json_text_copy(parts[0]), *value = json_text_copy(parts[1]);
    ps_result result = add_checked(list, name, value, error);
    free(name);
    free(value);
    return result;
}

ps_result option_list_read(struct option_list *list, const struct json *array, struct error *error)
{
    ps_result result = PS_OK;
    if (!array || array->kind != JSON_ARRAY)
        return error_set(error, PS_ERROR_INVALID,
                         "options: expected a list of [\"NAME\", \"VALUE\"]");
    for (size_t i = 0; i < array->count && result == PS_OK; i++)
        result = read_pair(list, json_element(array, i), error);
    return result;
}

void option_list_write(const struct option_list *list, struct json_writer *writer)
{
    json_writer_open(writer, '[');
    for (size_t i = 0; i < list->count; i++) {
        json_writer_open(writer, '[');
        json_text_write(writer, list->items[i].name);
        json_text_write(writer, list->items[i].value ? list->items[i].value : "");
        json_writer_close(writer, '[');
    }
    json_writer_close(writer, '[');
}

void option_list_print(const struct option_list *list, FILE *stream)
{
    for (size_t i = 0; i < list->count; i++) {
        fprintf(stream, " --%s", list->items[i].name);
        if (!list->items[i].value)
            continue;
        fputc(' ', stream);
        shell_word_print(stream, list->items[i].value);
    }
}

ps_result option_list_set(const struct option_list *list, psplat_scene *scene, psplat_error *error)
{
    ps_result result = PS_OK;
    for (size_t i = 0; i < list->count && result == PS_OK; i++)
        result = psplat_scene_set(scene, list->items[i].name, list->items[i].value, error);
    return result;
}
