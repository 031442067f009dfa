/* definitions.c: names are declared before any has a value, so that a formula that is too early can
 * be told from one that is misspelt.
 */
#include "parser/language/definitions.h"

#include "parser/language/parameter.h"
#include "parser/sections/fill.h"
#include <string.h>

static const struct node *find_map(struct expansion *expansion, const struct node *root,
                                   const char *key)
{
    static const struct node nothing = {.kind = NODE_SCALAR, .plain = true, .text = ""};
    const struct item *item = node_find(root, key);
    if (item && !fill_expect(expansion->reader, key, item->value, NODE_MAP))
        expansion->errors++;
    return item && item->value->kind == NODE_MAP ? item->value : &nothing;
}

static void declare(struct expansion *expansion, const struct node *map, const char *what)
{
    for (const struct item *item = map->first; item && !expansion->stopped; item = item->next)
        if (!scope_declare(expansion->scope, item->key, what))
            expansion->errors++;
}

/* The binding that an item made; NULL where its name was refused. */
static struct binding *find_own(const struct expansion *expansion, const struct item *item)
{
    struct binding *binding = names_get(&expansion->scope->names, item->key->text);
    return binding && binding->at == item->key ? binding : NULL;
}

static void define(struct expansion *expansion, const struct node *map)
{
    for (const struct item *item = map->first; item && !expansion->stopped; item = item->next) {
        struct binding *binding = find_own(expansion, item);
        const struct node *value = expand_node(expansion, item->value, 0);
        if (node_is_null(value))
            expand_error(expansion, item->key, "'%s' is defined without a value", item->key->text);
        if (binding)
            binding->value = value;
    }
}

void definitions_read(struct expansion *expansion, const struct node *root,
                      const struct assignments *given)
{
    const struct node *parameters = find_map(expansion, root, "parameters");
    const struct node *definitions = find_map(expansion, root, "define");
    declare(expansion, parameters, "a parameter");
    declare(expansion, definitions, "a definition");
    parameter_check_names(expansion, parameters, given);
    for (const struct item *item = parameters->first; item && !expansion->stopped;
         item = item->next) {
        struct binding *binding = find_own(expansion, item);
        struct parameter parameter = parameter_read(expansion, item);
        if (binding)
            binding->value = parameter_value(expansion, item, &parameter, given);
    }
    define(expansion, definitions);
}

void definitions_list(struct expansion *expansion, const struct node *root,
                      void (*each)(void *user, const struct psd_parameter *parameter), void *user)
{
    const struct node *parameters = find_map(expansion, root, "parameters");
    declare(expansion, parameters, "a parameter");
    for (const struct item *item = parameters->first; item && !expansion->stopped;
         item = item->next) {
        struct binding *binding = find_own(expansion, item);
        struct parameter parameter = parameter_read(expansion, item);
        if (!binding)
            continue;
        binding->value = parameter.fallback ? parameter.fallback : item->value;
        parameter_list(item, &parameter, each, user);
    }
}
