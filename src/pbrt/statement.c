/* statement.c: looks parameters up; see statement.h. */
#include "pbrt/importer.h"

#include <string.h>

bool parameter_is(const struct parameter *parameter, const char *type)
{
    return strcmp(parameter->type->name, type) == 0;
}

static struct parameter *find_in(const struct statement *statement, const char *name)
{
    for (size_t i = 0; i < statement->count; i++)
        if (strcmp(statement->parameters[i].name, name) == 0) {
            statement->parameters[i].used = true;
            return &statement->parameters[i];
        }
    return NULL;
}

struct parameter *statement_find(const struct statement *statement, const char *name)
{
    struct parameter *found = find_in(statement, name);
    for (const struct attributes *a = statement->attributes; a && !found; a = a->next)
        found = find_in(a->statement, name);
    return found;
}

struct place statement_place(const struct statement *statement, const struct parameter *parameter)
{
    return parameter ? (struct place){&parameter->origin, parameter->width}
                     : (struct place){&statement->origin, statement->width};
}

/* NULL where it is absent, or, reported, is no value of that sort. */
static const struct parameter *find_one(struct importer *importer,
                                        const struct statement *statement, const char *name,
                                        bool good_type(const struct parameter *), size_t count,
                                        const char *wanted)
{
    const struct parameter *parameter = statement_find(statement, name);
    if (!parameter)
        return NULL;
    if (good_type(parameter) && parameter->count == count)
        return parameter;
    importer_error(importer, &parameter->origin, parameter->width,
                   "%s: expected %s, got %zu of type %s", name, wanted, parameter->count,
                   parameter->type->name);
    return NULL;
}

static bool is_number(const struct parameter *parameter)
{
    return parameter_is(parameter, "float") || parameter_is(parameter, "integer");
}

static bool is_whole(const struct parameter *parameter)
{
    return parameter_is(parameter, "integer");
}

static bool is_bool(const struct parameter *parameter)
{
    return parameter->type->kind == VALUE_BOOL;
}

static bool is_string(const struct parameter *parameter)
{
    return parameter->type->kind == VALUE_STRING;
}

static bool is_vector(const struct parameter *parameter)
{
    return parameter->type->width == 3 && !parameter_is(parameter, "rgb") &&
           !parameter_is(parameter, "color");
}

double statement_number(struct importer *importer, const struct statement *statement,
                        const char *name, double otherwise)
{
    const struct parameter *found = find_one(importer, statement, name, is_number, 1, "one float");
    return found ? found->numbers[0] : otherwise;
}

long statement_integer(struct importer *importer, const struct statement *statement,
                       const char *name, long otherwise, long least, long most)
{
    const struct parameter *found = find_one(importer, statement, name, is_whole, 1, "one integer");
    if (!found)
        return otherwise;
    if (found->numbers[0] >= (double)least && found->numbers[0] <= (double)most)
        return (long)found->numbers[0];
    importer_error(importer, &found->origin, found->width, "%s: expected %ld..%ld, got %.0f", name,
                   least, most, found->numbers[0]);
    return otherwise;
}

bool statement_bool(struct importer *importer, const struct statement *statement, const char *name,
                    bool otherwise)
{
    const struct parameter *found = find_one(importer, statement, name, is_bool, 1, "one bool");
    return found ? found->numbers[0] != 0.0 : otherwise;
}

const char *statement_string(struct importer *importer, const struct statement *statement,
                             const char *name)
{
    const struct parameter *found = find_one(importer, statement, name, is_string, 1, "one string");
    return found ? found->strings[0] : NULL;
}

struct vector statement_vector(struct importer *importer, const struct statement *statement,
                               const char *name, struct vector otherwise)
{
    const struct parameter *found =
        find_one(importer, statement, name, is_vector, 3, "one point or vector");
    return found ? (struct vector){found->numbers[0], found->numbers[1], found->numbers[2]}
                 : otherwise;
}

const double *statement_list(struct importer *importer, const struct statement *statement,
                             const char *name, size_t width, size_t *count)
{
    const struct parameter *found = statement_find(statement, name);
    *count = 0;
    if (!found)
        return NULL;
    size_t type = found->type->width;
    /* pbrt-v3's texture coordinates are floats or points of two numbers. */
    bool fits = found->type->kind == VALUE_NUMBER && (type == width || (type == 1 && width <= 2)) &&
                found->count % width == 0;
    if (!fits) {
        importer_error(importer, &found->origin, found->width,
                       "%s: expected values of %zu numbers, got %s", name, width,
                       found->type->name);
        return NULL;
    }
    *count = found->count / width;
    return found->numbers;
}

void statement_ignore(const struct statement *statement, const char *const *names, size_t count)
{
    for (size_t i = 0; i < count; i++)
        (void)statement_find(statement, names[i]);
}

void statement_report_unused(struct importer *importer, const struct statement *statement)
{
    for (size_t i = 0; i < statement->count; i++) {
        const struct parameter *parameter = &statement->parameters[i];
        if (!parameter->used)
            importer_warn(importer, &parameter->origin, parameter->width,
                          "%s %s: parameter '%s' is left out", statement->directive,
                          statement->kind ? statement->kind : "", parameter->name);
    }
}
