/* option_list.h: options of a render, by their names on the command line, as lists that grow and
 * are copied. */
#ifndef EXPLORE_OPTION_LIST_H
#define EXPLORE_OPTION_LIST_H

#include "base/json_reader.h"
#include "base/json_writer.h"
#include <psplat/psplat.h>
#include <stdbool.h>

struct explore_option {
    char *name;  /* without dashes */
    char *value; /* NULL: a flag */
};

/* Zeroed: empty. Owns everything. */
struct option_list {
    struct explore_option *items;
    size_t count;
};

/* Appends a copy; false when out of memory, with the list as it was. */
bool option_list_add(struct option_list *list, const char *name, const char *value);

/* Appends copies of all; false when out of memory, with the list as it was. */
bool option_list_append(struct option_list *list, const struct option_list *other);

/* The same for those alone that say what is to be seen, and not by which method and how well. */
bool option_list_append_scene(struct option_list *list, const struct option_list *other);

void option_list_release(struct option_list *list);

/* The value of the last of that name; NULL: there is none, or it takes none. */
const char *option_list_value(const struct option_list *list, const char *name);

/* Whether an option says how a picture of this scene is to look, and not what the program may do:
 * those are for the command line alone. */
bool option_is_of_view(const char *name);

/* Appends [["NAME", "VALUE"], ...], whose options are those of a view and name no plugin by its
 * path. PS_ERROR_INVALID, with what is wrong, or PS_ERROR_MEMORY; to be released in any case. */
ps_result option_list_read(struct option_list *list, const struct json *array, struct error *error);

/* Writes them likewise; and as words of a shell, each after a blank. */
void option_list_write(const struct option_list *list, struct json_writer *writer);
void option_list_print(const struct option_list *list, FILE *stream);

/* Gives them to a scene. */
ps_result option_list_set(const struct option_list *list, psplat_scene *scene, psplat_error *error);

#endif
