/* reference.c: what the file names to refer to it from elsewhere. */
#include "parser/sections/sections.h"

#include "base/suggestion.h"

void reference_put(struct reader *reader, struct names *names, const char *name, size_t index)
{
    size_t *known = arena_allocate(reader->arena, sizeof *known);
    if (!known || !names_put(names, reader->arena, name, known)) {
        reader->out_of_memory = true;
        return;
    }
    *known = index;
}

bool reference_get(const struct names *names, const char *name, size_t *index)
{
    const size_t *known = names_get(names, name);
    if (known)
        *index = *known;
    return known != NULL;
}

static void report_undefined(const struct reader *reader, const struct node *node, const char *what,
                             struct suggestion suggestion)
{
    char hint[SUGGESTION_TEXT];
    suggestion_text(&suggestion, hint);
    reader_error(reader, node, "undefined %s '%s'%s", what, node->text, hint);
}

bool reference_material(const struct reader *reader, const struct node *node, size_t *index)
{
    const struct scene_description *description = reader->description;
    if (reference_get(&reader->materials, node->text, index))
        return true;
    struct suggestion suggestion = suggestion_start(node->text);
    size_t other; /* materials of mesh files have names too, but no other object can use them */
    for (size_t i = 0; i < description->material_count && !diagnostics_is_full(reader->sink); i++)
        if (description->materials[i].name &&
            reference_get(&reader->materials, description->materials[i].name, &other))
            suggestion_consider(&suggestion, description->materials[i].name);
    report_undefined(reader, node, "material", suggestion);
    return false;
}

bool reference_group(const struct reader *reader, const struct node *node, size_t *index)
{
    const struct scene_description *description = reader->description;
    if (reference_get(&reader->groups, node->text, index))
        return true;
    struct suggestion suggestion = suggestion_start(node->text);
    for (size_t i = 0; i < description->group_count && !diagnostics_is_full(reader->sink); i++)
        if (description->groups[i].name)
            suggestion_consider(&suggestion, description->groups[i].name);
    report_undefined(reader, node, "group", suggestion);
    return false;
}
