#include "tools/last_stages.h"

#include "base/param.h"
#include "cli/command.h"
#include "parser/schema/schema.h"
#include "plugin/kind.h"
#include <stdio.h>

ps_result last_stages_create(struct last_stages *stages, struct error *error)
{
    struct param_table table = schema_table(schema_only("render"));
    *stages = (struct last_stages){.loader = NULL};
    ps_result result = param_set_defaults(&table, &stages->description, 1.0, error);
    return result == PS_OK ? loader_create(&stages->loader, error) : result;
}

void last_stages_release(struct last_stages *stages)
{
    render_description_release(&stages->description);
    loader_destroy(stages->loader);
}

ps_result last_stages_choose(struct last_stages *stages, ps_kind kind, const char *text,
                             struct error *error)
{
    struct strategy_choice choice;
    ps_result result = settings_parse_choice(text, &choice, error);
    return result == PS_OK
               ? settings_override(&stages->description.strategies[kind], &choice, error)
               : result;
}

/* "denoiser=NAME, bloom=NAME or tonemap=NAME" */
static void list_kinds(ps_kind first, char *text, size_t size)
{
    int length = snprintf(text, size, "%s=NAME", kinds[first].name);
    for (int kind = (int)first + 1; kind < PS_KINDS && length < (int)size; kind++)
        length += snprintf(text + length, size - (size_t)length, "%s%s=NAME",
                           kind + 1 < PS_KINDS ? ", " : " or ", kinds[kind].name);
}

ps_result last_stages_override(struct last_stages *stages, ps_kind first, const char *text,
                               struct error *error)
{
    const char *wanted;
    ps_kind kind = kind_parse(text, &wanted);
    char names[200];
    if (kind < PS_KINDS && wanted && kind >= first)
        return last_stages_choose(stages, kind, wanted, error);
    list_kinds(first, names, sizeof names);
    return error_set(error, PS_ERROR_INVALID,
                     "--plugin: expected %s, got '%.200s'; what other strategies do is done", names,
                     text);
}

static void report(void *user, const struct origin *origin, const char *message)
{
    (void)user;
    (void)origin;
    print_error(message);
}

ps_result last_stages_resolve(struct last_stages *stages, uint32_t threads,
                              struct render_settings *settings, struct error *error)
{
    error->text[0] = '\0';
    return settings_resolve(stages->loader, &stages->description, threads, 1, report, NULL,
                            settings);
}
