/* value.c: turns nodes into the text that param_set reads, so that a value is checked by one
 * parser wherever it is written; only lists are the scene file's own.
 */
#include "parser/sections/value.h"

#include "base/text.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define LONGEST_NUMBER 64 /* that text_to_number takes */
#define TRIPLE_TEXT (3 * LONGEST_NUMBER + 8)
#define DOMAIN_TEXT 256

const char *value_text(const struct reader *reader, struct subject subject, const struct node *node,
                       const char *expected)
{
    if (node->kind == NODE_SCALAR && !node_is_null(node))
        return node->text;
    reader_error(reader, node, "%s in %s: expected %s, got %s", subject.key, subject.section,
                 expected, node_kind_name(node));
    return NULL;
}

static bool store(struct reader *reader, struct subject subject, const ps_param *row,
                  const struct node *node, const char *text, void *state)
{
    struct error error;
    ps_result result = param_set(row, state, text, &error);
    if (result == PS_ERROR_MEMORY)
        reader->out_of_memory = true;
    else if (result != PS_OK)
        reader_error(reader, node, "%s in %s: %s", subject.key, subject.section, error.text);
    return result == PS_OK;
}

static bool set_scalar(struct reader *reader, struct subject subject, const ps_param *row,
                       const struct node *node, void *state)
{
    char domain[DOMAIN_TEXT] = "";
    if (node->kind != NODE_SCALAR || node_is_null(node))
        param_describe_domain(row, domain, sizeof domain);
    const char *text = value_text(reader, subject, node, domain);
    return text && store(reader, subject, row, node, text, state);
}

/* The text of a number, or NULL, reported. */
static const char *number_text(const struct reader *reader, struct subject subject,
                               const struct node *node, double *number)
{
    const char *text = value_text(reader, subject, node, "a number");
    if (!text || text_to_number(text, number))
        return text;
    reader_error(reader, node, "%s in %s: expected a number, got '%.80s'", subject.key,
                 subject.section, text);
    return NULL;
}

bool value_number(const struct reader *reader, struct subject subject, const struct node *node,
                  double *number)
{
    return number_text(reader, subject, node, number) != NULL;
}

/* Numbers are checked one by one, so that an error points at the one that is wrong. */
static bool append_number(const struct reader *reader, struct subject subject,
                          const struct node *node, char text[TRIPLE_TEXT])
{
    double number;
    const char *item = number_text(reader, subject, node, &number);
    if (!item)
        return false;
    size_t used = strlen(text);
    snprintf(text + used, TRIPLE_TEXT - used, "%s%s", used > 1 ? ", " : "", item);
    return true;
}

/* Sets a member that holds three numbers, from a list of them. */
static bool set_triple(struct reader *reader, struct subject subject, const ps_param *row,
                       const struct node *node, void *state)
{
    char text[TRIPLE_TEXT] = "[";
    bool good = true;
    if (node->count != 3) {
        reader_error(reader, node, "%s in %s: expected 3 numbers, got %zu", subject.key,
                     subject.section, node->count);
        return false;
    }
    for (const struct item *item = node->first; item; item = item->next)
        good = append_number(reader, subject, item->value, text) && good;
    strcat(text, "]");
    return good && store(reader, subject, row, node, text, state);
}

/* One number for three: what a colour's text allows. */
static bool set_uniform(struct reader *reader, struct subject subject, const ps_param *row,
                        const struct node *node, void *state)
{
    ps_param uniform = *row;
    uniform.type = PS_PARAM_COLOR;
    double number;
    const char *text = value_text(reader, subject, node, "[x, y, z] or one number");
    if (!text)
        return false;
    if (!text_to_number(text, &number)) {
        reader_error(reader, node, "%s in %s: expected [x, y, z] or one number, got '%.80s'",
                     subject.key, subject.section, text);
        return false;
    }
    return store(reader, subject, &uniform, node, text, state);
}

bool value_set(struct reader *reader, struct subject subject, const struct schema_row *row,
               const struct node *node, void *state)
{
    const ps_param *param = &row->param;
    bool triple = param->type == PS_PARAM_VEC3 || param->type == PS_PARAM_COLOR;
    if (triple && node->kind == NODE_LIST)
        return set_triple(reader, subject, param, node, state);
    if (row->form == SCHEMA_SCALE)
        return set_uniform(reader, subject, param, node, state);
    return set_scalar(reader, subject, param, node, state);
}

bool value_indices(struct reader *reader, struct subject subject, const struct node *node,
                   uint32_t largest, uint32_t indices[3])
{
    const ps_param index_row = {
        .name = subject.key, .type = PS_PARAM_INT, .minimum = 0, .maximum = largest};
    if (node->kind != NODE_LIST || node->count != 3) {
        reader_error(reader, node, "%s in %s: expected [i, j, k], got %s", subject.key,
                     subject.section,
                     node->kind == NODE_LIST ? "another number of indices" : node_kind_name(node));
        return false;
    }
    bool good = true;
    size_t i = 0;
    for (const struct item *item = node->first; item; item = item->next, i++) {
        int64_t index = 0;
        good = set_scalar(reader, subject, &index_row, item->value, &index) && good;
        indices[i] = (uint32_t)index;
    }
    return good;
}
