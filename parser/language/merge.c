/* merge.c: the first file is shared; a second one makes a sum of copies, to which all append. */
#include "parser/language/merge.h"

#include "parser/schema/schema_language.h"
#include <string.h>

enum rule { RULE_REPLACE, RULE_KEYS, RULE_NAMES, RULE_APPEND, RULE_DIFFER };

/* A camera is one thing: half of one and half of another is none that anybody meant. */
static enum rule find_rule(const char *key, const struct node *first, const struct node *second)
{
    const struct schema_row *row = schema_language_top(key);
    if (strcmp(key, "camera") == 0 || strcmp(key, "psd") == 0 || strcmp(key, "include") == 0)
        return RULE_REPLACE;
    if (first->kind == NODE_MAP && second->kind == NODE_MAP)
        return row && row->form == SCHEMA_MAP ? RULE_KEYS : RULE_NAMES;
    return first->kind == NODE_LIST && second->kind == NODE_LIST ? RULE_APPEND : RULE_DIFFER;
}

static void append(struct reader *reader, struct node *node, const struct node *key,
                   const struct node *value)
{
    if (!node_add(node, reader->arena, key, value))
        reader->out_of_memory = true;
}

static void copy_items(struct reader *reader, struct node *copy, const struct node *node)
{
    for (const struct item *item = node->first; item && !reader->out_of_memory; item = item->next)
        append(reader, copy, item->key, item->value);
}

/* The section of the sum, as a copy that may be changed; NULL when out of memory, noted. */
static struct node *own_section(struct reader *reader, struct merge *merge, struct item *item)
{
    struct node *section = names_get(&merge->sections, item->key->text);
    if (section)
        return section;
    section = node_start(reader->arena, item->value);
    if (!section || !names_put(&merge->sections, reader->arena, item->key->text, section)) {
        reader->out_of_memory = true;
        return NULL;
    }
    copy_items(reader, section, item->value);
    item->value = section;
    return section;
}

static void report_twin(const struct reader *reader, const char *section, const struct node *first,
                        const struct node *second)
{
    struct origin origin = reader_origin(reader, first);
    reader_error(reader, second, "duplicate name '%s' in %s; the first is in %s, line %d",
                 second->text, section, origin.file, origin.line);
}

static void take_item(struct reader *reader, enum rule rule, const char *name, struct node *section,
                      const struct item *item)
{
    struct item *twin = item->key ? names_get(&section->names, item->key->text) : NULL;
    if (!twin) {
        append(reader, section, item->key, item->value);
    } else if (rule == RULE_NAMES) {
        report_twin(reader, name, twin->key, item->key);
    } else {
        *twin = (struct item){item->key, item->value, twin->next};
    }
}

static void join(struct reader *reader, struct merge *merge, enum rule rule, struct item *twin,
                 const struct item *item)
{
    struct node *section = own_section(reader, merge, twin);
    for (const struct item *each = item->value->first; each && section && !reader->out_of_memory;
         each = each->next)
        take_item(reader, rule, item->key->text, section, each);
}

/* One of them is nothing, and counts as an empty section, or they are of different kinds. */
static void choose(const struct reader *reader, struct item *twin, const struct item *item)
{
    struct origin first = reader_origin(reader, twin->key);
    if (node_is_null(twin->value))
        *twin = (struct item){item->key, item->value, twin->next};
    else if (!node_is_null(item->value) && item->value->kind != NODE_BROKEN)
        reader_error(reader, item->value, "%s is %s here, and %s in %s, line %d", item->key->text,
                     node_kind_name(item->value), node_kind_name(twin->value), first.file,
                     first.line);
}

static void take_section(struct reader *reader, struct merge *merge, const struct item *item)
{
    struct item *twin = names_get(&merge->sum->names, item->key->text);
    if (!twin) {
        append(reader, merge->sum, item->key, item->value);
        return;
    }
    enum rule rule = find_rule(item->key->text, twin->value, item->value);
    if (rule == RULE_REPLACE)
        *twin = (struct item){item->key, item->value, twin->next};
    else if (rule == RULE_DIFFER)
        choose(reader, twin, item);
    else
        join(reader, merge, rule, twin, item);
}

static bool start_sum(struct reader *reader, struct merge *merge)
{
    struct node *sum = node_start(reader->arena, merge->root);
    if (!sum) {
        reader->out_of_memory = true;
        return false;
    }
    copy_items(reader, sum, merge->root);
    merge->sum = sum;
    merge->root = sum;
    return true;
}

void merge_add(struct reader *reader, struct merge *merge, const struct node *root)
{
    if (!merge->root) {
        merge->root = root;
        return;
    }
    if (!merge->sum && !start_sum(reader, merge))
        return;
    merge->sum->mark = root->mark;
    merge->sum->file = root->file;
    for (const struct item *item = root->first; item && !reader->out_of_memory; item = item->next)
        take_section(reader, merge, item);
}
