/* fill.c: one walk over a section's table serves all sections.
 *
 * Rows are filled in the order of the table rather than of the file, so that a row may rely on
 * those before it (triangles on the number of vertices).
 */
#include "parser/sections/fill.h"

#include "base/suggestion.h"
#include "base/text.h"
#include "parser/schema/keys.h"
#include "parser/sections/list_value.h"
#include "parser/sections/sections.h"
#include "parser/sections/value.h"
#include <string.h>

#define KINDS_TEXT 256 /* the names of a family's kinds */

bool fill_expect(const struct reader *reader, const char *name, const struct node *node,
                 enum node_kind kind)
{
    if (node->kind == kind || node_is_null(node))
        return true;
    reader_error(reader, node, "expected a %s for %s, got %s", kind == NODE_LIST ? "list" : "map",
                 name, node_kind_name(node));
    return false;
}

/* What a walk over a table knows. */
struct walk {
    struct reader *reader;
    const struct schema_section *section;
    const struct node *at, *map;
    void *state;
    size_t point_count; /* of the latest list of points */
};

static bool is_text(const struct reader *reader, struct subject subject,
                    const struct schema_row *row, const struct node *node)
{
    if (node->kind == NODE_SCALAR && !node_is_null(node) && node->text[0] != '\0')
        return true;
    char expected[64];
    schema_describe(row, expected, sizeof expected);
    reader_error(reader, node, "%s in %s: expected the %s, got %s", subject.key, subject.section,
                 expected, node->kind == NODE_SCALAR ? "nothing" : node_kind_name(node));
    return false;
}

static bool store_node(const struct node *node, const struct node **member)
{
    *member = node;
    return true;
}

static bool fill_list(struct walk *walk, struct subject subject, const struct schema_row *row,
                      const struct node *node, void *member)
{
    struct reader *reader = walk->reader;
    struct point_list *points = member;
    bool good;
    switch (row->form) {
    case SCHEMA_POINTS:
        good = list_points(reader, subject, row, node, points);
        walk->point_count = points->count;
        return good;
    case SCHEMA_PAIRS:
        return list_pairs(reader, subject, row, node, member);
    case SCHEMA_TRIANGLES:
        return list_triangles(reader, subject, row, node, walk->point_count, member);
    case SCHEMA_COLORS:
        return list_colors(reader, subject, row, node, member);
    case SCHEMA_WORDS:
        return list_words(reader, subject, row, node, member);
    case SCHEMA_MATRIX:
        return list_matrix(reader, subject, row, node, member);
    default:
        return list_pair(reader, subject, node, member);
    }
}

static bool fill_point_or_auto(struct reader *reader, struct subject subject,
                               const struct schema_row *row, const struct node *node, void *state)
{
    struct point_or_auto *place = (struct point_or_auto *)((char *)state + row->param.offset);
    bool is_word = node->kind == NODE_SCALAR && strcmp(node->text, AUTO_WORD) == 0;
    char expected[64];
    place->automatic = is_word;
    if (is_word || node->kind == NODE_LIST)
        return is_word || value_set(reader, subject, row, node, state);
    schema_describe(row, expected, sizeof expected);
    const char *text = value_text(reader, subject, node, expected);
    if (text)
        reader_error(reader, node, "%s in %s: expected %s, got '%.80s'", subject.key,
                     subject.section, expected, text);
    return false;
}

static bool fill_row(struct walk *walk, const struct schema_row *row, const struct node *node)
{
    struct reader *reader = walk->reader;
    struct subject subject = {row->param.name, walk->section->name};
    void *member = (char *)walk->state + row->param.offset;
    if (node->kind == NODE_BROKEN)
        return false;
    switch (row->form) {
    case SCHEMA_VALUE:
    case SCHEMA_SCALE:
        return value_set(reader, subject, row, node, walk->state);
    case SCHEMA_POINT_OR_AUTO:
        return fill_point_or_auto(reader, subject, row, node, walk->state);
    case SCHEMA_PAIR:
    case SCHEMA_MATRIX:
    case SCHEMA_WORDS:
    case SCHEMA_POINTS:
    case SCHEMA_PAIRS:
    case SCHEMA_TRIANGLES:
    case SCHEMA_COLORS:
        return fill_list(walk, subject, row, node, member);
    case SCHEMA_PIGMENT:
    case SCHEMA_SCALAR_PIGMENT:
        return pigment_read(reader, subject, row, node, walk->state);
    case SCHEMA_MATERIAL:
        return is_text(reader, subject, row, node) && reference_material(reader, node, member);
    case SCHEMA_MATERIALS:
        return fill_expect(reader, subject.key, node, NODE_MAP) && store_node(node, member);
    case SCHEMA_GROUP:
    case SCHEMA_FILE:
    case SCHEMA_LAYER:
        return is_text(reader, subject, row, node) && store_node(node, member);
    case SCHEMA_STRATEGY:
        return strategy_read(reader, subject, node, member);
    case SCHEMA_MAP:
    case SCHEMA_NAMED:
    case SCHEMA_ITEMS:
    case SCHEMA_STEPS:
    case SCHEMA_LIST:
    case SCHEMA_NAMED_LISTS:
    case SCHEMA_OTHER:
        break; /* read by who fills the description, or before */
    }
    return true;
}

/* A default is written as a user would, but for pairs, of which both are the same. */
static bool fill_default(const struct schema_row *row, void *state)
{
    const char *text = row->param.default_value;
    void *member = (char *)state + row->param.offset;
    struct error error;
    if (row->form == SCHEMA_POINT_OR_AUTO) {
        ((struct point_or_auto *)member)->automatic = 1;
        return strcmp(text, AUTO_WORD) == 0;
    }
    if (row->form == SCHEMA_PAIR) {
        double *pair = member;
        bool good = text_to_number(text, &pair[0]);
        pair[1] = pair[0];
        return good;
    }
    if (row->form == SCHEMA_WORDS) {
        for (int i = 0; row->param.choices[i]; i++)
            if (strstr(text, row->param.choices[i]))
                *(int32_t *)member |= 1 << i;
        return true;
    }
    return param_set(&row->param, state, text, &error) == PS_OK;
}

static bool fill_defaults(const struct schema_section *section, void *state)
{
    bool good = true;
    for (size_t i = 0; i < section->row_count; i++)
        if (section->rows[i].param.default_value)
            good = fill_default(&section->rows[i], state) && good;
    return good;
}

/* The first row before `end` that is given and can't stand beside `row`. */
static const struct schema_row *find_rival(const struct walk *walk, size_t end,
                                           const struct schema_row *row)
{
    for (size_t i = 0; i < end; i++) {
        const struct schema_row *other = &walk->section->rows[i];
        if (other->choice == row->choice && other->alternative != row->alternative &&
            node_find(walk->map, other->param.name))
            return other;
    }
    return NULL;
}

/* Reports that none of the rows of a choice is given; once, at its first row. */
static bool check_demand(const struct walk *walk, size_t first)
{
    const struct schema_section *section = walk->section;
    int choice = section->rows[first].choice;
    char names[KINDS_TEXT] = "";
    for (size_t i = 0; i < section->row_count; i++) {
        const struct schema_row *row = &section->rows[i];
        if (row->choice != choice)
            continue;
        if (i < first || node_find(walk->map, row->param.name))
            return true;
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used ? ", " : "", row->param.name);
    }
    reader_error(walk->reader, walk->at, "%s needs one of %s", section->name, names);
    return false;
}

static bool check_choices(const struct walk *walk)
{
    bool good = true;
    for (size_t i = 0; i < walk->section->row_count; i++) {
        const struct schema_row *row = &walk->section->rows[i];
        if (row->choice == 0)
            continue;
        const struct item *item = node_find(walk->map, row->param.name);
        const struct schema_row *rival = item ? find_rival(walk, i, row) : NULL;
        if (rival) {
            reader_error(walk->reader, item->value, "%s has both %s and %s; give one of them",
                         walk->section->name, rival->param.name, row->param.name);
            good = false;
        }
        if (row->demanded)
            good = check_demand(walk, i) && good;
    }
    return good;
}

static void report_unknown(const struct reader *reader, const struct schema_section *section,
                           const struct node *key)
{
    struct param_table table = schema_table(section);
    struct suggestion suggestion = {.word = key->text};
    if (!diagnostics_is_full(reader->sink))
        suggestion = param_suggest(&table, key->text);
    char hint[SUGGESTION_TEXT];
    suggestion_text(&suggestion, hint);
    reader_error(reader, key, "unknown key '%s' in %s%s", key->text, section->name, hint);
}

bool fill_section(struct reader *reader, const struct schema_section *section,
                  const struct node *at, const struct node *map, void *state)
{
    struct walk walk = {reader, section, at, map, state, 0};
    struct param_table table = schema_table(section);
    if (section->word && map->kind == NODE_SCALAR && !node_is_null(map)) {
        reader_error(reader, map, "expected %s or a map for %s, got '%.80s'", section->word,
                     section->name, map->text);
        return false;
    }
    if (!fill_expect(reader, section->name, map, NODE_MAP))
        return false;
    bool good = fill_defaults(section, state);
    for (size_t i = 0; i < section->row_count; i++) {
        const struct schema_row *row = &section->rows[i];
        const struct item *item = node_find(map, row->param.name);
        if (item) {
            good = fill_row(&walk, row, item->value) && good;
        } else if (schema_is_required(row)) {
            reader_error(reader, at, "missing key '%s' in %s", row->param.name, section->name);
            good = false;
        }
    }
    good = check_choices(&walk) && good;
    for (const struct item *item = map->first; item; item = item->next)
        if (!param_find(&table, item->key->text)) {
            report_unknown(reader, section, item->key);
            good = false;
        }
    return good;
}

static void report_unknown_kind(const struct reader *reader, const char *family,
                                const struct node *key)
{
    int singular = (int)strlen(family) - 1; /* "lights" -> "light" */
    struct suggestion suggestion = suggestion_start(key->text);
    char known[KINDS_TEXT] = "; known are", hint[SUGGESTION_TEXT];
    size_t first = strlen(known);
    for (size_t i = 0; i < schema_section_count(); i++) {
        const struct schema_section *section = schema_section(i);
        if (strcmp(section->family, family) != 0)
            continue;
        suggestion_consider(&suggestion, section->name);
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s %s", used > first ? "," : "",
                 section->name);
    }
    suggestion_text(&suggestion, hint);
    reader_error(reader, key, "unknown %.*s kind '%s'%s", singular, family, key->text,
                 suggestion.best ? hint : known);
}

const struct schema_section *fill_find_kind(const struct reader *reader, const char *family,
                                            const char *name, const struct node *node)
{
    if (node->kind != NODE_MAP || node->count == 0) {
        reader_error(reader, node, "expected a map with one key in %s, got %s", name,
                     node->kind == NODE_MAP ? "an empty map" : node_kind_name(node));
        return NULL;
    }
    const struct item *item = node->first;
    const struct schema_section *section = schema_find(family, item->key->text);
    if (!section)
        report_unknown_kind(reader, family, item->key);
    if (item->next) {
        reader_error(reader, item->next->key,
                     "key '%s' stands beside '%s'; indent it to put it inside",
                     item->next->key->text, item->key->text);
        return NULL;
    }
    return section;
}
