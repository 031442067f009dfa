#include "parser/language/parameter.h"

#include "base/suggestion.h"
#include "parser/schema/schema_language.h"
#include "parser/sections/fill.h"
#include <stdio.h>
#include <string.h>

#define VECTOR_TEXT 256
#define NAMES_TEXT 200

static const char *const type_names[] = {[TYPE_AUTO] = "auto",
                                         [TYPE_NUMBER] = "number",
                                         [TYPE_VECTOR] = "vector",
                                         [TYPE_STRING] = "string"};

static const char *const expectations[] = {[TYPE_AUTO] = "a number, [x, y, z] or text",
                                           [TYPE_NUMBER] = "a number",
                                           [TYPE_VECTOR] = "[x, y, z]",
                                           [TYPE_STRING] = "text"};

static bool is_vector(const struct node *value)
{
    bool numbers = value->kind == NODE_LIST && value->count == 3;
    for (const struct item *item = value->first; item && numbers; item = item->next)
        numbers = node_is_number(item->value, NULL);
    return numbers;
}

static bool fits(const struct node *value, enum schema_type type)
{
    bool text = value->kind == NODE_SCALAR && !node_is_null(value);
    switch (type) {
    case TYPE_NUMBER:
        return node_is_number(value, NULL);
    case TYPE_VECTOR:
        return is_vector(value);
    case TYPE_STRING:
        return text;
    default:
        return text || is_vector(value);
    }
}

static enum schema_type type_of(const struct node *value)
{
    return node_is_number(value, NULL) ? TYPE_NUMBER : is_vector(value) ? TYPE_VECTOR : TYPE_STRING;
}

static bool has_broken(const struct node *value)
{
    bool broken = value->kind == NODE_BROKEN;
    for (const struct item *item = value->first; item && !broken; item = item->next)
        broken = has_broken(item->value);
    return broken;
}

/* Whether the value is of the type; `what` says whose value it is. */
static bool check(struct expansion *expansion, const char *what, const char *name,
                  const struct node *value, enum schema_type type)
{
    if (has_broken(value))
        return false;
    if (fits(value, type))
        return true;
    bool word = value->kind == NODE_SCALAR && !node_is_null(value);
    expand_error(expansion, value, "%s '%s': expected %s, got %s%.80s%s", what, name,
                 expectations[type], word ? "'" : "", word ? value->text : node_kind_name(value),
                 word ? "'" : "");
    return false;
}

static const struct node *find_value(const struct node *map, const char *key)
{
    const struct item *item = node_find(map, key);
    return item ? item->value : NULL;
}

static void read_fallback(struct expansion *expansion, const struct item *item,
                          struct parameter *parameter)
{
    const struct node *written = find_value(item->value, "default");
    if (!written) {
        if (parameter->type == TYPE_AUTO)
            parameter->type = TYPE_NUMBER;
        return;
    }
    parameter->fallback = expand_node(expansion, written, 0);
    if (!check(expansion, "default of parameter", item->key->text, parameter->fallback,
               parameter->type))
        parameter->type = TYPE_AUTO;
    else if (parameter->type == TYPE_AUTO)
        parameter->type = type_of(parameter->fallback);
}

struct parameter parameter_read(struct expansion *expansion, const struct item *item)
{
    struct schema_parameter state = {0};
    struct parameter parameter = {0};
    const struct schema_section *section = schema_only("parameter");
    if (!fill_section(expansion->reader, section, item->key, item->value, &state))
        expansion->errors++;
    parameter.type = (enum schema_type)state.type;
    parameter.wrong = item->value->kind != NODE_MAP && !node_is_null(item->value);
    const struct node *help = find_value(item->value, "help");
    if (help && (help->kind != NODE_SCALAR || node_is_null(help)))
        expand_error(expansion, help, "help in parameter: expected text, got %s",
                     node_kind_name(help));
    else if (help)
        parameter.help = help->text;
    read_fallback(expansion, item, &parameter);
    return parameter;
}

/* The last one counts, as with other options. */
static const struct assignment *find_given(const struct assignments *given, const char *name)
{
    for (size_t i = given->count; i-- > 0;)
        if (strcmp(given->items[i].key, name) == 0)
            return &given->items[i];
    return NULL;
}

/* Text is taken as it stands; a file's name may hold what YAML has a meaning for. */
static const struct node *read_given(struct expansion *expansion, enum schema_type type,
                                     const struct assignment *given)
{
    if (type != TYPE_STRING) {
        const struct node *value = assignment_value(expansion->reader, given, &expansion->budget);
        return value ? expand_node(expansion, value, 0) : NULL;
    }
    struct node like = {.mark = given->value_mark, .file = given->file};
    like.mark.width = (int)strlen(given->value);
    const struct node *value = node_scalar(expansion->reader->arena, &like, given->value);
    if (!value)
        expand_fail_memory(expansion);
    return value;
}

const struct node *parameter_value(struct expansion *expansion, const struct item *item,
                                   const struct parameter *parameter,
                                   const struct assignments *given)
{
    static const char *const examples[] = {"VALUE", "NUMBER", "[X,Y,Z]", "TEXT"};
    const char *name = item->key->text;
    const struct assignment *assignment = find_given(given, name);
    if (assignment) {
        const struct node *value = read_given(expansion, parameter->type, assignment);
        if (!value)
            expansion->errors++;
        if (value && check(expansion, "parameter", name, value, parameter->type))
            return value;
        return expand_broken(expansion, item->key);
    }
    if (parameter->fallback)
        return has_broken(parameter->fallback) ? expand_broken(expansion, item->key)
                                               : parameter->fallback;
    if (parameter->wrong)
        return expand_broken(expansion, item->key);
    expand_error(expansion, item->key, "parameter '%s' has no default; give it with --param %s=%s",
                 name, name, examples[parameter->type]);
    return expand_broken(expansion, item->key);
}

static void report_unknown(struct expansion *expansion, const struct node *parameters,
                           const struct assignment *given)
{
    const struct node at = {.kind = NODE_SCALAR, .mark = given->key_mark, .file = given->file};
    struct suggestion suggestion = suggestion_start(given->key);
    char known[NAMES_TEXT] = "", hint[SUGGESTION_TEXT];
    for (const struct item *item = parameters->first; item; item = item->next) {
        size_t used = strlen(known);
        suggestion_consider(&suggestion, item->key->text);
        snprintf(known + used, sizeof known - used, "%s%s", used > 0 ? ", " : "", item->key->text);
    }
    suggestion_text(&suggestion, hint);
    if (parameters->count == 0)
        expand_error(expansion, &at, "unknown parameter '%s'; the scene declares none", given->key);
    else if (suggestion.best)
        expand_error(expansion, &at, "unknown parameter '%s'%s", given->key, hint);
    else
        expand_error(expansion, &at, "unknown parameter '%s'; declared are %s", given->key, known);
}

void parameter_check_names(struct expansion *expansion, const struct node *parameters,
                           const struct assignments *given)
{
    for (size_t i = 0; i < given->count && !expansion->stopped; i++)
        if (!node_find(parameters, given->items[i].key))
            report_unknown(expansion, parameters, &given->items[i]);
}

/* "[x, y, z]" for a list, else the text of a scalar. */
static const char *describe(const struct node *value, char text[VECTOR_TEXT])
{
    if (value->kind != NODE_LIST)
        return value->text;
    size_t used = (size_t)snprintf(text, VECTOR_TEXT, "[");
    for (const struct item *item = value->first; item; item = item->next)
        used += (size_t)snprintf(text + used, VECTOR_TEXT - used, "%s%s", item->value->text,
                                 item->next ? ", " : "]");
    return text;
}

void parameter_list(const struct item *item, const struct parameter *parameter,
                    void (*each)(void *user, const struct psd_parameter *parameter), void *user)
{
    char text[VECTOR_TEXT];
    bool good = parameter->fallback && fits(parameter->fallback, parameter->type);
    const struct psd_parameter shown = {.name = item->key->text,
                                        .type = type_names[parameter->type],
                                        .default_value =
                                            good ? describe(parameter->fallback, text) : NULL,
                                        .help = parameter->help};
    each(user, &shown);
}
