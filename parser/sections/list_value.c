/* list_value.c: see list_value.h. */
#include "parser/sections/list_value.h"

#include "base/suggestion.h"
#include <math.h>
#include <string.h>

/* Whether the list may be read: it is one, of as many items as the row allows. */
static bool check_list(const struct reader *reader, struct subject subject,
                       const struct schema_row *row, const struct node *list)
{
    if (list->kind == NODE_LIST && list->count >= row->fewest && list->count <= row->most)
        return true;
    char expected[128];
    schema_describe(row, expected, sizeof expected);
    if (list->kind == NODE_LIST)
        reader_error(reader, list, "%s in %s: expected a %s, got %zu", subject.key, subject.section,
                     expected, list->count);
    else
        reader_error(reader, list, "%s in %s: expected a %s, got %s", subject.key, subject.section,
                     expected, node_kind_name(list));
    return false;
}

bool list_points(struct reader *reader, struct subject subject, const struct schema_row *row,
                 const struct node *list, struct point_list *points)
{
    if (!check_list(reader, subject, row, list))
        return false;
    points->items = reader_allocate(reader, list->count, sizeof *points->items);
    if (!points->items)
        return false;
    points->count = list->count;
    struct schema_row point = {.param = row->param};
    point.param.offset = 0;
    bool good = true;
    ps_vec3 *next = points->items;
    for (const struct item *item = list->first; item; item = item->next)
        good = value_set(reader, subject, &point, item->value, next++) && good;
    return good;
}

static bool fits_float(const struct reader *reader, struct subject subject, const struct node *node,
                       double number)
{
    if (isfinite((float)number))
        return true;
    reader_error(reader, node, "%s in %s: the number is too large", subject.key, subject.section);
    return false;
}

static bool read_numbers(const struct reader *reader, struct subject subject,
                         const struct node *list, double *numbers)
{
    bool good = true;
    for (const struct item *item = list->first; item; item = item->next, numbers++)
        good = value_number(reader, subject, item->value, numbers) &&
               fits_float(reader, subject, item->value, *numbers) && good;
    return good;
}

bool list_pair(const struct reader *reader, struct subject subject, const struct node *node,
               double pair[2])
{
    if (node->kind == NODE_LIST && node->count == 2)
        return read_numbers(reader, subject, node, pair);
    if (node->kind == NODE_LIST) {
        reader_error(reader, node, "%s in %s: expected 2 numbers, got %zu", subject.key,
                     subject.section, node->count);
        return false;
    }
    if (!value_number(reader, subject, node, &pair[0]) ||
        !fits_float(reader, subject, node, pair[0]))
        return false;
    pair[1] = pair[0];
    return true;
}

bool list_pairs(struct reader *reader, struct subject subject, const struct schema_row *row,
                const struct node *list, struct pair_list *pairs)
{
    if (!check_list(reader, subject, row, list))
        return false;
    pairs->items = reader_allocate(reader, list->count, sizeof *pairs->items);
    if (!pairs->items)
        return false;
    pairs->count = list->count;
    bool good = true;
    float(*next)[2] = pairs->items;
    for (const struct item *item = list->first; item; item = item->next, next++) {
        double pair[2] = {0, 0};
        if (item->value->kind == NODE_LIST) {
            good = list_pair(reader, subject, item->value, pair) && good;
        } else {
            reader_error(reader, item->value, "%s in %s: expected [u, v], got %s", subject.key,
                         subject.section, node_kind_name(item->value));
            good = false;
        }
        (*next)[0] = (float)pair[0];
        (*next)[1] = (float)pair[1];
    }
    return good;
}

bool list_triangles(struct reader *reader, struct subject subject, const struct schema_row *row,
                    const struct node *list, size_t point_count, struct triangle_list *triangles)
{
    if (!check_list(reader, subject, row, list))
        return false;
    triangles->items = reader_allocate(reader, list->count, sizeof *triangles->items);
    if (!triangles->items)
        return false;
    triangles->count = list->count;
    uint32_t largest = point_count > 0 ? (uint32_t)(point_count - 1) : UINT32_MAX;
    bool good = true;
    uint32_t(*triangle)[3] = triangles->items;
    for (const struct item *item = list->first; item; item = item->next)
        good = value_indices(reader, subject, item->value, largest, *triangle++) && good;
    return good;
}

bool list_colors(struct reader *reader, struct subject subject, const struct schema_row *row,
                 const struct node *list, ps_rgb *colors)
{
    if (!check_list(reader, subject, row, list))
        return false;
    struct schema_row color = {.param = row->param};
    color.param.offset = 0;
    bool good = true;
    for (const struct item *item = list->first; item; item = item->next)
        good = value_set(reader, subject, &color, item->value, colors++) && good;
    return good;
}

static bool add_word(const struct reader *reader, struct subject subject,
                     const struct schema_row *row, const struct node *node, int32_t *words)
{
    char expected[128];
    const char *text = value_text(reader, subject, node, "a word");
    if (!text)
        return false;
    struct suggestion suggestion = suggestion_start(text);
    for (int i = 0; row->param.choices[i]; i++) {
        suggestion_consider(&suggestion, row->param.choices[i]);
        if (strcmp(row->param.choices[i], text) == 0) {
            *words |= 1 << i;
            return true;
        }
    }
    char hint[SUGGESTION_TEXT];
    suggestion_text(&suggestion, hint);
    schema_describe(row, expected, sizeof expected);
    reader_error(reader, node, "%s in %s: expected a %s, got '%.80s'%s", subject.key,
                 subject.section, expected, text, hint);
    return false;
}

bool list_words(const struct reader *reader, struct subject subject, const struct schema_row *row,
                const struct node *list, int32_t *words)
{
    if (!check_list(reader, subject, row, list))
        return false;
    bool good = true;
    *words = 0;
    for (const struct item *item = list->first; item; item = item->next)
        good = add_word(reader, subject, row, item->value, words) && good;
    return good;
}

bool list_matrix(const struct reader *reader, struct subject subject, const struct schema_row *row,
                 const struct node *list, double matrix[12])
{
    return check_list(reader, subject, row, list) && read_numbers(reader, subject, list, matrix);
}
