/* scope.c: one table of names; an index of a loop takes a place in it for a while. */
#include "parser/language/scope.h"

#include "parser/language/word.h"
#include <string.h>

static struct binding *create_binding(struct scope *scope, const struct node *at)
{
    struct arena *arena = scope->reader->arena;
    struct binding *binding = arena_allocate(arena, sizeof *binding);
    if (!binding) {
        scope->reader->out_of_memory = true;
        return NULL;
    }
    *binding = (struct binding){.name = at->text, .at = at, .next = scope->first};
    binding->hidden = names_get(&scope->names, at->text);
    if (!names_put(&scope->names, arena, at->text, binding)) {
        scope->reader->out_of_memory = true;
        return NULL;
    }
    scope->first = binding;
    return binding;
}

static bool check_name(const struct scope *scope, const struct node *at, const char *what)
{
    char name[WORD_NAME];
    if (at->kind != NODE_SCALAR || !word_is_name(at->text, name) || strcmp(at->text, name) != 0)
        reader_error(scope->reader, at,
                     "%s needs a name of letters, digits and '_' that begins with no digit, got %s",
                     what, at->kind == NODE_SCALAR ? at->text : node_kind_name(at));
    else if (arithmetic_is_reserved(at->text))
        reader_error(scope->reader, at, "the name '%s' is taken: arithmetic has a meaning for it",
                     at->text);
    else
        return true;
    return false;
}

struct binding *scope_declare(struct scope *scope, const struct node *at, const char *what)
{
    if (!check_name(scope, at, what))
        return NULL;
    const struct binding *twin = scope_find(scope, at->text);
    if (twin) {
        struct origin origin = reader_origin(scope->reader, twin->at);
        reader_error(scope->reader, at, "the name '%s' is taken in %s, line %d", at->text,
                     origin.file, origin.line);
        return NULL;
    }
    return create_binding(scope, at);
}

struct binding *scope_enter(struct scope *scope, const struct node *at)
{
    if (!check_name(scope, at, "the index of a loop"))
        return NULL;
    const struct binding *outer = scope_find(scope, at->text);
    if (outer && outer->index) {
        reader_error(scope->reader, at, "'%s' is the index of the loop around this one, in line %d",
                     at->text, outer->at->mark.line);
        return NULL;
    }
    struct binding *binding = create_binding(scope, at);
    if (binding)
        binding->index = true;
    return binding;
}

void scope_leave(struct scope *scope, struct binding *binding)
{
    names_put(&scope->names, scope->reader->arena, binding->name, binding->hidden);
    scope->first = binding->next;
}

const struct binding *scope_find(const struct scope *scope, const char *name)
{
    return names_get(&scope->names, name);
}

static const struct node *find_component(const struct node *list, int component)
{
    const struct item *item = list->kind == NODE_LIST ? list->first : NULL;
    for (int i = 0; i < component && item; i++)
        item = item->next;
    return item ? item->value : NULL;
}

static const char *kind_of(const struct node *value)
{
    return node_is_number(value, NULL) ? "a number" : node_kind_name(value);
}

static void explain_component(const char *name, int component, const struct node *value,
                              struct error *error)
{
    const char axis = "xyz"[component];
    if (value->kind == NODE_LIST)
        error_set(error, PS_ERROR_INVALID, "'%s' is a list whose .%c is no number", name, axis);
    else
        error_set(error, PS_ERROR_INVALID, "'%s' is %s and has no .%c", name, kind_of(value), axis);
}

static void explain_whole(const char *name, const struct node *value, struct error *error)
{
    if (value->kind == NODE_LIST)
        error_set(error, PS_ERROR_INVALID,
                  "'%s' is a list, which stands alone; in arithmetic use %s.x, %s.y and %s.z", name,
                  name, name, name);
    else
        error_set(error, PS_ERROR_INVALID, "'%s' is %s, which arithmetic can't use", name,
                  kind_of(value));
}

static enum arithmetic_found find_number(void *user, const char *name, int component, double *value,
                                         struct error *error)
{
    const struct binding *binding = scope_find(user, name);
    if (!binding)
        return ARITHMETIC_UNKNOWN;
    if (!binding->value) {
        error_set(error, PS_ERROR_INVALID, "'%s' is not defined yet; that follows in line %d", name,
                  binding->at->mark.line);
        return ARITHMETIC_WRONG;
    }
    if (binding->value->kind == NODE_BROKEN)
        return ARITHMETIC_WRONG;
    const struct node *number =
        component < 0 ? binding->value : find_component(binding->value, component);
    if (number && node_is_number(number, value))
        return ARITHMETIC_FOUND;
    if (number && number->kind == NODE_BROKEN)
        return ARITHMETIC_WRONG;
    if (component < 0)
        explain_whole(name, binding->value, error);
    else
        explain_component(name, component, binding->value, error);
    return ARITHMETIC_WRONG;
}

static void suggest(void *user, struct suggestion *suggestion)
{
    const struct scope *scope = user;
    if (diagnostics_is_full(scope->reader->sink))
        return;
    for (const struct binding *binding = scope->first; binding; binding = binding->next)
        suggestion_consider(suggestion, binding->name);
}

struct arithmetic_names scope_names(struct scope *scope)
{
    return (struct arithmetic_names){scope, find_number, suggest};
}
