#include "parser/schema/schema_language.h"

#include "parser/schema/schema_rows.h"

static const char *const types[] = {[TYPE_AUTO] = "auto",
                                    [TYPE_NUMBER] = "number",
                                    [TYPE_VECTOR] = "vector",
                                    [TYPE_STRING] = "string",
                                    NULL};

static const struct schema_row parameter_rows[] = {
    {.param = PS_CHOICE(struct schema_parameter, type, "auto", types, "kind of the value")},
    SCHEMA_OTHER_ROW("default", "number, [x, y, z] or text", "the command line must give one",
                     "value where the command line gives none"),
    SCHEMA_OTHER_ROW("help", "text", "nothing", "what the parameter is, for who sets it"),
};

static const struct schema_row for_rows[] = {
    SCHEMA_OTHER_ROW("for", "name", NULL, "index of the loop, which formulas in do can use"),
    {.param = PS_NUMBER(struct schema_loop, from, NULL, -INFINITY, INFINITY, 0, "",
                        "first value of the index"),
     .absent = "in must be given"},
    {.param = PS_NUMBER(struct schema_loop, to, NULL, -INFINITY, INFINITY, 0, "",
                        "value of the index at which the loop ends, and which belongs to it"),
     .absent = "in must be given"},
    {.param = PS_NUMBER(struct schema_loop, step, "1", -INFINITY, INFINITY, 0, "",
                        "difference from one value of the index to the next, not 0")},
    SCHEMA_OTHER_ROW("in", "list", "from and to must be given", "the values of the index"),
    SCHEMA_OTHER_ROW("do", "item, or list of items", NULL,
                     "what stands in the list for each value of the index"),
};

static const struct schema_row if_rows[] = {
    {.param = {.name = "if",
               .type = PS_PARAM_BOOL,
               .offset = offsetof(struct schema_condition, holds),
               .unit = "",
               .help = "the condition; a number counts as yes unless it is 0"}},
    SCHEMA_OTHER_ROW("do", "item, or list of items", "nothing",
                     "what stands in the list where the condition holds"),
    SCHEMA_OTHER_ROW("else", "item, or list of items", "nothing",
                     "what stands in the list where it does not"),
};

static const struct schema_section sections[] = {
    ONLY(parameter, "a value that the command line can set"),
    ONLY(for, "a loop, in any list"),
    ONLY(if, "a condition, in any list"),
};

const struct schema_part schema_language_part = {sections, COUNT(sections)};

const struct schema_row *schema_language_top(const char *key)
{
    const struct param_table table = schema_table(schema_only("scene"));
    return (const struct schema_row *)param_find(&table, key);
}
