/* fill.c: one walk over a section's table serves all sections.
 *
 * Rows are filled in the order of the table rather than of the file, so that a row may rely on
 * those before it (triangles on the number of vertices).
 */
#include "parser/fill.h"

#include "parser/strategy.h"
#include "parser/suggestion.h"
#include "parser/value.h"

bool fill_expect(const struct reader *reader, const char *name, const struct node *node,
                 enum node_kind kind)
{
    if (node->kind == kind || node_is_null(node))
        return true;
    reader_error(reader, node, "expected a %s for %s, got %s", kind == NODE_LIST ? "list" : "map",
                 name, node_kind_name(node));
    return false;
}

/* Whether the list may be read: it is one, of as many items as the row allows. */
static bool check_list(const struct reader *reader, struct subject subject,
                       const struct schema_row *row, const struct node *list)
{
    if (list->kind == NODE_LIST && list->count >= row->fewest && list->count <= row->most)
        return true;
    char expected[64];
    schema_describe(row, expected, sizeof expected);
    if (list->kind == NODE_LIST)
        reader_error(reader, list, "%s in %s: expected a %s, got %zu", subject.key, subject.section,
                     expected, list->count);
    else
        reader_error(reader, list, "%s in %s: expected a %s, got %s", subject.key, subject.section,
                     expected, node_kind_name(list));
    return false;
}

static bool fill_points(struct reader *reader, struct subject subject, const struct schema_row *row,
                        const struct node *list, struct object_description *object)
{
    if (!check_list(reader, subject, row, list))
        return false;
    object->vertices = reader_allocate(reader, list->count, sizeof *object->vertices);
    if (!object->vertices)
        return false;
    object->vertex_count = list->count;
    struct schema_row point = {.param = row->param};
    point.param.offset = 0;
    bool good = true;
    ps_vec3 *vertex = object->vertices;
    for (const struct item *item = list->first; item; item = item->next)
        good = value_set(reader, subject, &point, item->value, vertex++) && good;
    return good;
}

static bool fill_triangles(struct reader *reader, struct subject subject,
                           const struct schema_row *row, const struct node *list,
                           struct object_description *object)
{
    if (!check_list(reader, subject, row, list))
        return false;
    object->triangles = reader_allocate(reader, list->count, sizeof *object->triangles);
    if (!object->triangles)
        return false;
    object->triangle_count = list->count;
    /* Without vertices, which was reported, any index will do. */
    uint32_t largest = object->vertex_count > 0 ? (uint32_t)(object->vertex_count - 1) : UINT32_MAX;
    bool good = true;
    uint32_t(*triangle)[3] = object->triangles;
    for (const struct item *item = list->first; item; item = item->next)
        good = value_indices(reader, subject, item->value, largest, *triangle++) && good;
    return good;
}

static bool fill_material(const struct reader *reader, struct subject subject,
                          const struct node *node, size_t *index)
{
    char scratch[VALUE_NUMBER_TEXT];
    const char *name = node->kind == NODE_SCALAR && !node_is_null(node)
                           ? node->text
                           : value_text(reader, subject, node, "the name of a material", scratch);
    if (!name)
        return false;
    const struct scene_description *description = reader->description;
    const struct material_description *material = names_get(&reader->materials, name);
    if (material) {
        *index = (size_t)(material - description->materials);
        return true;
    }
    struct suggestion suggestion = suggestion_start(name);
    for (size_t i = 0; i < description->material_count && !diagnostics_is_full(reader->sink); i++)
        if (description->materials[i].name)
            suggestion_consider(&suggestion, description->materials[i].name);
    char hint[SUGGESTION_TEXT];
    suggestion_text(&suggestion, hint);
    reader_error(reader, node, "undefined material '%s'%s", name, hint);
    return false;
}

static bool fill_row(struct reader *reader, struct subject subject, const struct schema_row *row,
                     const struct node *node, void *state)
{
    void *member = (char *)state + row->param.offset;
    if (node->kind == NODE_BROKEN)
        return false;
    switch (row->form) {
    case SCHEMA_VALUE:
    case SCHEMA_SCALE:
        return value_set(reader, subject, row, node, state);
    case SCHEMA_POINTS:
        return fill_points(reader, subject, row, node, state);
    case SCHEMA_TRIANGLES:
        return fill_triangles(reader, subject, row, node, state);
    case SCHEMA_MATERIAL:
        return fill_material(reader, subject, node, member);
    case SCHEMA_STRATEGY:
        return strategy_read(reader, subject, node, member);
    case SCHEMA_MAP:
    case SCHEMA_NAMED:
    case SCHEMA_LIST:
    case SCHEMA_OTHER:
        break; /* read by who fills the description, or before */
    }
    return true;
}

static void report_unknown(const struct reader *reader, const struct schema_section *section,
                           const struct node *key)
{
    struct param_table table = schema_table(section);
    struct suggestion suggestion = {.word = key->text};
    if (!diagnostics_is_full(reader->sink))
        suggestion.best = param_suggest(&table, key->text);
    char hint[SUGGESTION_TEXT];
    suggestion_text(&suggestion, hint);
    reader_error(reader, key, "unknown key '%s' in %s%s", key->text, section->name, hint);
}

bool fill_section(struct reader *reader, const struct schema_section *section,
                  const struct node *at, const struct node *map, void *state)
{
    struct param_table table = schema_table(section);
    struct error error;
    if (!fill_expect(reader, section->name, map, NODE_MAP))
        return false;
    bool good = param_set_defaults(&table, state, &error) == PS_OK;
    for (size_t i = 0; i < section->row_count; i++) {
        const struct schema_row *row = &section->rows[i];
        const struct item *item = node_find(map, row->param.name);
        struct subject subject = {row->param.name, section->name};
        if (item) {
            good = fill_row(reader, subject, row, item->value, state) && good;
        } else if (schema_is_required(row)) {
            reader_error(reader, at, "missing key '%s' in %s", row->param.name, section->name);
            good = false;
        }
    }
    for (const struct item *item = map->first; item; item = item->next)
        if (!param_find(&table, item->key->text)) {
            report_unknown(reader, section, item->key);
            good = false;
        }
    return good;
}
