/* command_plugins.c: psplat plugins: which strategies there are, and their parameters. */
#include "base/param.h"
#include "cli/command.h"
#include "plugin/strategy.h"
#include "tools/plugin_test.h"

#include <stdio.h>
#include <string.h>

enum { OPTION_EXPERT, OPTION_TEST };

static const struct option options[] = {
    [OPTION_EXPERT] = {0, "expert", NULL, "show the parameters for experts too"},
    [OPTION_TEST] = {0, "test", "FILE[:KEY=VALUE,...]",
                     "try the strategies of a module; may be repeated"},
};

static void print_kind(const struct kind *kind)
{
    printf("%-15s %s (default: %s)\n", kind->name, kind->summary, kind->default_strategy);
}

/* Notes are lines; in a list they are set in. */
static void print_notes(const char *notes)
{
    while (*notes) {
        size_t length = strcspn(notes, "\n");
        printf("                %.*s\n", (int)length, notes);
        notes += length + (notes[length] == '\n');
    }
}

static void print_line(void *user, const struct listed_strategy *listed)
{
    (void)user;
    if (listed->type) {
        printf("  %-13s %s\n", listed->name, listed->type->summary);
        print_notes(listed->problem);
    } else {
        printf("  %-13s can't be used%s\n", listed->name, listed->problem);
    }
}

static int list_kind(struct loader *loader, ps_kind kind)
{
    struct error error;
    print_kind(&kinds[kind]);
    if (loader_list(loader, kind, print_line, NULL, &error) == PS_OK)
        return STATUS_OK;
    print_error(error.text);
    return STATUS_FAILED;
}

static void print_parameter(const ps_param *row)
{
    char domain[256];
    param_describe_domain(row, domain, sizeof domain);
    printf("  %s\n      %s\n      %s%s%s", row->name, row->help, domain,
           row->unit[0] ? ", in " : "", row->unit);
    if (row->default_value)
        printf("; default: %s%s\n", row->default_value,
               row->flags & PS_PARAM_QUALITY ? ", by quality" : "");
    else
        printf("; required\n");
}

static bool is_expert(const ps_param *row)
{
    return (row->flags & PS_PARAM_EXPERT) != 0;
}

/* The parameters of one level under a heading, if there are any. */
static void print_parameters(const struct param_table *table, bool expert, const char *heading)
{
    for (size_t i = 0; i < table->count; i++) {
        if (is_expert(param_row(table, i)) != expert)
            continue;
        if (heading)
            printf("%s\n", heading);
        heading = NULL;
        print_parameter(param_row(table, i));
    }
}

/* That there are others, in one line. */
static void name_experts(const struct param_table *table)
{
    const char *lead = "for experts, shown by --expert: ";
    for (size_t i = 0; i < table->count; i++)
        if (is_expert(param_row(table, i))) {
            printf("%s%s", lead, param_row(table, i)->name);
            lead = ", ";
        }
    if (lead[0] == ',')
        printf("\n");
}

static int describe(struct loader *loader, ps_kind kind, const char *name, bool experts)
{
    struct strategy_type *type;
    struct error error;
    if (loader_find(loader, kind, name, &type, &error) != PS_OK) {
        print_error(error.text);
        return STATUS_USAGE;
    }
    printf("%s=%s, version %s\n%s\nafter: %s\nfile: %s\n", kinds[kind].name, type->name,
           type->version, type->summary, type->paper,
           type->file ? type->file : "none; linked into the program");
    struct param_table table = strategy_type_params(type);
    if (table.count == 0)
        printf("no parameters\n");
    print_parameters(&table, false, "parameters:");
    if (experts)
        print_parameters(&table, true, "parameters for experts:");
    else
        name_experts(&table);
    strategy_type_destroy(type);
    return STATUS_OK;
}

/* "injection" or "injection=photon" */
static int print_one(struct loader *loader, const char *operand, bool experts)
{
    const char *name;
    ps_kind kind = kind_parse(operand, &name);
    if (kind == PS_KINDS) {
        fprintf(stderr, "psplat: error: no kind of plugin '%.*s'; the kinds are:",
                (int)strcspn(operand, "="), operand);
        for (int i = 0; i < PS_KINDS; i++)
            fprintf(stderr, " %s", kinds[i].name);
        fprintf(stderr, "\n");
        return STATUS_USAGE;
    }
    return name ? describe(loader, kind, name, experts) : list_kind(loader, kind);
}

static int print_all(struct loader *loader, const struct argument *arguments, size_t count)
{
    int status = STATUS_OK;
    size_t operands = 0;
    bool experts = false;
    for (size_t i = 0; i < count; i++) {
        experts |= argument_is(&arguments[i], "expert");
        operands += arguments[i].option == NULL;
    }
    for (size_t i = 0; i < count && status == STATUS_OK; i++)
        if (!arguments[i].option)
            status = print_one(loader, arguments[i].value, experts);
    for (int kind = 0; kind < PS_KINDS && operands == 0 && status == STATUS_OK; kind++)
        status = list_kind(loader, (ps_kind)kind);
    return status;
}

/* All that are asked for, whether one fails or not. */
static int test_modules(struct loader *loader, const struct argument *arguments, size_t count)
{
    int worst = STATUS_OK;
    for (size_t i = 0; i < count; i++) {
        if (!argument_is(&arguments[i], "test"))
            continue;
        int status = plugin_test(loader, arguments[i].value);
        worst = status > worst ? status : worst;
    }
    return worst;
}

static int run(const struct argument *arguments, size_t count)
{
    struct loader *loader;
    struct error error;
    bool tests = false;
    ps_result created = loader_create(&loader, &error);
    if (created != PS_OK) {
        print_error(error.text);
        return created == PS_ERROR_INVALID ? STATUS_USAGE : STATUS_FAILED;
    }
    for (size_t i = 0; i < count; i++)
        tests |= argument_is(&arguments[i], "test");
    int status =
        tests ? test_modules(loader, arguments, count) : print_all(loader, arguments, count);
    loader_destroy(loader);
    return status;
}

const struct command command_plugins = {
    .name = "plugins",
    .operands = "[KIND[=NAME]]...",
    .summary = "lists strategies and their parameters",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
