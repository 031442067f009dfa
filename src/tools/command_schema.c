/* command_schema.c: psplat schema: the scene language, for editors. */
#include "cli/command.h"
#include "parser/schema/schema_json.h"

#include <stdio.h>

static int run(const struct argument *arguments, size_t count)
{
    (void)arguments;
    if (count > 0) {
        print_error("schema: takes no operands. Try 'psplat schema --help'.");
        return STATUS_USAGE;
    }
    schema_json_write(stdout);
    return STATUS_OK;
}

const struct command command_schema = {
    .name = "schema",
    .operands = "",
    .summary = "prints the scene language as JSON Schema",
    .run = run,
};
