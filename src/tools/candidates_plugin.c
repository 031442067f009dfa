#include "tools/candidates_plugin.h"

#include "plugin/loader.h"
#include <stdio.h>
#include <string.h>

/* Longer words are cut, and then match nothing. */
#define WORD_SIZE 1024

static void print_kinds(const struct prefix *prefix, ps_kind first)
{
    char word[64];
    for (int kind = (int)first; kind < PS_KINDS; kind++) {
        snprintf(word, sizeof word, "%s=", kinds[kind].name);
        candidate_print(prefix, word, kinds[kind].summary, true);
    }
}

struct listing {
    const struct prefix *prefix;
    const char *kind;
    bool parameters;
};

static void print_strategy(void *user, const struct listed_strategy *listed)
{
    const struct listing *listing = user;
    char word[WORD_SIZE];
    if (!listed->type)
        return;
    snprintf(word, sizeof word, "%s=%s", listing->kind, listed->name);
    candidate_print(listing->prefix, word, listed->type->summary,
                    listing->parameters && listed->type->row_count > 0);
}

/* Whether the list "KEY=VALUE,KEY=..." gives the parameter a value. */
static bool is_given(const char *list, const char *name)
{
    size_t length = strlen(name);
    for (; list; list = strchr(list, ',')) {
        list += *list == ',';
        if (strncmp(list, name, length) == 0 && list[length] == '=')
            return true;
    }
    return false;
}

static void print_choices(const struct prefix *prefix, const ps_param *row)
{
    if (row->type == PS_PARAM_BOOL) {
        candidate_print(prefix, "yes", "", true);
        candidate_print(prefix, "no", "", true);
    }
    for (size_t i = 0; row->choices && row->choices[i]; i++)
        candidate_print(prefix, row->choices[i], "", true);
}

/* `list` is what follows the colon; the parameter at its end is completed: its name, or its
 * value. */
static void print_parameters(const struct prefix *prefix, const struct param_table *table,
                             const char *list)
{
    const char *comma = strrchr(list, ',');
    const char *last = comma ? comma + 1 : list, *equals = strchr(last, '=');
    const char *typed = equals ? equals + 1 : last;
    char before[WORD_SIZE], word[WORD_SIZE];
    snprintf(before, sizeof before, "%s%.*s", prefix->before, (int)(typed - prefix->typed),
             prefix->typed);
    const struct prefix rest = {before, typed};
    for (size_t i = 0; i < table->count; i++) {
        const ps_param *row = param_row(table, i);
        snprintf(word, sizeof word, "%s=", row->name);
        if (equals && strncmp(last, word, strlen(word)) == 0)
            print_choices(&rest, row);
        else if (!equals && !is_given(list, row->name))
            candidate_print(&rest, word, row->help, true);
    }
}

static void print_strategy_parameters(struct loader *loader, const struct prefix *prefix,
                                      ps_kind kind, const char *name)
{
    struct strategy_type *type;
    struct error error;
    char text[WORD_SIZE];
    size_t length = strcspn(name, ":");
    snprintf(text, sizeof text, "%.*s", (int)length, name);
    /* A path is a plugin's file, which is not run to find out what may be typed. */
    if (strchr(text, '/') || loader_find(loader, kind, text, &type, &error) != PS_OK)
        return;
    struct param_table table = strategy_type_params(type);
    print_parameters(prefix, &table, name + length + 1);
    strategy_type_destroy(type);
}

void candidates_print_plugins(const struct prefix *prefix, ps_kind first, bool parameters)
{
    const char *name;
    struct loader *loader;
    struct error error;
    ps_kind kind = kind_parse(prefix->typed, &name);
    if (!strchr(prefix->typed, '=')) {
        print_kinds(prefix, first);
        return;
    }
    if (kind == PS_KINDS || kind < first || loader_create(&loader, &error) != PS_OK)
        return;
    struct listing listing = {prefix, kinds[kind].name, parameters};
    if (!strchr(name, ':'))
        loader_list(loader, kind, print_strategy, &listing, &error);
    else if (parameters)
        print_strategy_parameters(loader, prefix, kind, name);
    loader_destroy(loader);
}
