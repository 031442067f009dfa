/* statement_read.c: reads parameter lists; see statement.h. */
#include "pbrt/importer.h"

#include "base/suggestion.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LARGEST_NUMBER 1e30 /* so that products of a few are within floats' range, or found out */

static const struct parameter_type types[] = {
    {"integer", VALUE_NUMBER, 1}, {"float", VALUE_NUMBER, 1},     {"point2", VALUE_NUMBER, 2},
    {"vector2", VALUE_NUMBER, 2}, {"point", VALUE_NUMBER, 3},     {"point3", VALUE_NUMBER, 3},
    {"vector", VALUE_NUMBER, 3},  {"vector3", VALUE_NUMBER, 3},   {"normal", VALUE_NUMBER, 3},
    {"normal3", VALUE_NUMBER, 3}, {"color", VALUE_NUMBER, 3},     {"rgb", VALUE_NUMBER, 3},
    {"xyz", VALUE_NUMBER, 3},     {"blackbody", VALUE_NUMBER, 0}, {"spectrum", VALUE_NUMBER, 0},
    {"string", VALUE_STRING, 1},  {"texture", VALUE_STRING, 1},   {"bool", VALUE_BOOL, 1},
};

static const struct parameter_type *find_type(const char *name, size_t length)
{
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (strlen(types[i].name) == length && strncmp(types[i].name, name, length) == 0)
            return &types[i];
    return NULL;
}

void statement_release(struct statement *statement)
{
    for (size_t i = 0; i < statement->count; i++) {
        struct parameter *parameter = &statement->parameters[i];
        for (size_t j = 0; j < parameter->count && parameter->strings; j++)
            free(parameter->strings[j]);
        free(parameter->strings);
        free(parameter->numbers);
        free(parameter->name);
    }
    free(statement->parameters);
    free(statement->kind);
    *statement = (struct statement){0};
}

/* "float radius" becomes a new parameter; NULL: reported. */
static struct parameter *declare(struct importer *importer, const struct token *token,
                                 struct statement *statement)
{
    static const char space[] = " \t";
    const char *type = token->text + strspn(token->text, space);
    size_t type_length = strcspn(type, space);
    const char *name = type + type_length + strspn(type + type_length, space);
    size_t name_length = strcspn(name, space);
    if (type_length == 0 || name_length == 0 ||
        name[name_length + strspn(name + name_length, space)]) {
        importer_error(importer, &token->origin, token->width,
                       "expected a parameter, \"TYPE NAME\", got \"%.100s\"", token->text);
        return NULL;
    }
    const struct parameter_type *found = find_type(type, type_length);
    if (!found) {
        char word[64], hint[SUGGESTION_TEXT];
        snprintf(word, sizeof word, "%.*s", (int)(type_length < 60 ? type_length : 60), type);
        struct suggestion suggestion = suggestion_start(word);
        for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
            suggestion_consider(&suggestion, types[i].name);
        suggestion_text(&suggestion, hint);
        importer_error(importer, &token->origin, token->width, "unknown type '%s' of a parameter%s",
                       word, hint);
        return NULL;
    }
    if (!importer_grow(importer, (void **)&statement->parameters, &statement->capacity,
                       statement->count + 1, sizeof *statement->parameters))
        return NULL;
    struct parameter *parameter = &statement->parameters[statement->count];
    *parameter = (struct parameter){.type = found, .origin = token->origin, .width = token->width};
    parameter->name = strndup(name, name_length);
    if (!parameter->name) {
        importer_no_memory(importer);
        return NULL;
    }
    statement->count++;
    return parameter;
}

static bool add_string(struct importer *importer, const struct token *token,
                       struct parameter *parameter, size_t *capacity)
{
    bool fits = parameter->type->kind == VALUE_STRING || parameter_is(parameter, "spectrum") ||
                parameter_is(parameter, "bool");
    if (!fits || parameter->numbers) {
        importer_error(importer, &token->origin, token->width, "%s %s: expected a number",
                       parameter->type->name, parameter->name);
        return false;
    }
    if (!importer_grow(importer, (void **)&parameter->strings, capacity, parameter->count + 1,
                       sizeof *parameter->strings))
        return false;
    parameter->strings[parameter->count] = strdup(token->text);
    if (!parameter->strings[parameter->count])
        return importer_no_memory(importer);
    parameter->count++;
    return true;
}

static bool add_number(struct importer *importer, const struct token *token, double number,
                       struct parameter *parameter, size_t *capacity)
{
    bool whole = !parameter_is(parameter, "integer") ||
                 (number == floor(number) && fabs(number) <= 2147483647.0);
    if (!whole || fabs(number) > LARGEST_NUMBER) {
        importer_error(importer, &token->origin, token->width, "%s %s: expected %s",
                       parameter->type->name, parameter->name,
                       whole ? "a number within -1e30..1e30" : "a whole number of 32 bits");
        return false;
    }
    if (parameter->type->kind == VALUE_STRING || parameter->strings) {
        importer_error(importer, &token->origin, token->width, "%s %s: expected a text in quotes",
                       parameter->type->name, parameter->name);
        return false;
    }
    if (!importer_grow(importer, (void **)&parameter->numbers, capacity, parameter->count + 1,
                       sizeof *parameter->numbers))
        return false;
    parameter->numbers[parameter->count++] = number;
    return true;
}

/* pbrt-v3 has "true" and "false" in quotes. */
static bool add_value(struct importer *importer, const struct token *token,
                      struct parameter *parameter, size_t *capacity)
{
    bool word = token->kind == TOKEN_WORD || token->kind == TOKEN_STRING;
    bool is_true = word && strcmp(token->text, "true") == 0;
    if (parameter->type->kind == VALUE_BOOL) {
        if (is_true || (word && strcmp(token->text, "false") == 0))
            return add_number(importer, token, is_true ? 1.0 : 0.0, parameter, capacity);
    } else if (token->kind == TOKEN_NUMBER) {
        return add_number(importer, token, token->number, parameter, capacity);
    } else if (token->kind == TOKEN_STRING) {
        return add_string(importer, token, parameter, capacity);
    }
    importer_error(importer, &token->origin, token->width, "%s %s: expected %s",
                   parameter->type->name, parameter->name,
                   token->kind == TOKEN_BAD                ? token->text
                   : parameter->type->kind == VALUE_BOOL   ? "true or false"
                   : parameter->type->kind == VALUE_STRING ? "a text in quotes"
                                                           : "a number, or ] behind the last");
    return false;
}

static bool check_count(struct importer *importer, const struct parameter *parameter)
{
    size_t width = parameter->type->width;
    if (parameter->count > 0 && (width == 0 || parameter->count % width == 0))
        return true;
    if (parameter->count == 0)
        return true; /* an empty list is one of no values */
    importer_error(importer, &parameter->origin, parameter->width,
                   "%s %s: expected numbers in groups of %zu, got %zu", parameter->type->name,
                   parameter->name, width, parameter->count);
    return false;
}

static bool read_values(struct importer *importer, struct lexer *lexer, struct parameter *parameter)
{
    size_t capacity = 0;
    struct token token = lexer_next(lexer);
    if (token.kind != TOKEN_OPEN)
        return add_value(importer, &token, parameter, &capacity) &&
               check_count(importer, parameter);
    struct origin opened = token.origin;
    for (token = lexer_next(lexer); token.kind != TOKEN_CLOSE; token = lexer_next(lexer)) {
        if (token.kind == TOKEN_END) {
            importer_error(importer, &opened, 1, "the file ends before this bracket is closed");
            return false;
        }
        if (!add_value(importer, &token, parameter, &capacity))
            return false;
    }
    return check_count(importer, parameter);
}

bool statement_read(struct importer *importer, struct lexer *lexer, struct token *token,
                    struct statement *statement)
{
    for (; token->kind == TOKEN_STRING; *token = lexer_next(lexer)) {
        struct parameter *parameter = declare(importer, token, statement);
        if (!parameter || !read_values(importer, lexer, parameter))
            return false;
    }
    return true;
}
