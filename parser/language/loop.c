/* loop.c: items of a list that stand for others.
 *
 *     - {for: i, from: 0, to: 9, step: 3, do: ITEMS}     i = 0, 3, 6, 9
 *     - {for: m, in: [red, blue], do: ITEMS}             m = red, blue
 *     - {if: =i > 3, do: ITEMS, else: ITEMS}
 *
 * Their keys are rows of the schema as any others; formulas among them are replaced first, but for
 * the bodies, which are walked anew in each turn.
 */
#include "parser/language/loop.h"

#include "parser/language/word.h"
#include "parser/schema/schema_language.h"
#include "parser/sections/fill.h"
#include <math.h>
#include <string.h>

/* An end that is missed by so little of a step was meant: 0 to 0.3 by 0.1 are 4 turns. */
#define SLACK 1e-6

bool loop_is(const struct node *node)
{
    return node_find(node, "for") || node_find(node, "if");
}

static bool is_body(const struct item *item)
{
    return strcmp(item->key->text, "do") == 0 || strcmp(item->key->text, "else") == 0 ||
           strcmp(item->key->text, "for") == 0;
}

/* The map with the values of its keys, but for those that are read as they stand. */
static const struct node *expand_head(struct expansion *expansion, const struct node *node,
                                      int depth)
{
    struct arena *arena = expansion->reader->arena;
    struct node *head = node_start(arena, node);
    for (const struct item *item = node->first; item && head; item = item->next) {
        const struct node *value =
            is_body(item) ? item->value : expand_node(expansion, item->value, depth + 1);
        if (!node_add(head, arena, item->key, value))
            head = NULL;
    }
    if (!head)
        expand_fail_memory(expansion);
    return head;
}

static const struct node *find_value(const struct node *map, const char *key)
{
    const struct item *item = node_find(map, key);
    return item ? item->value : NULL;
}

static bool has_broken(const struct node *map)
{
    for (const struct item *item = map->first; item; item = item->next)
        if (item->value->kind == NODE_BROKEN)
            return true;
    return false;
}

static void append_body(struct expansion *expansion, const struct node *body, int depth,
                        struct node *list)
{
    if (!body || node_is_null(body) || !expand_count(expansion, body, 1))
        return;
    if (body->kind != NODE_LIST) {
        expand_item(expansion, body, depth, list);
        return;
    }
    for (const struct item *item = body->first; item; item = item->next)
        expand_item(expansion, item->value, depth, list);
}

/* One turn; false ends the loop, since the same error would follow in the others. */
static bool turn(struct expansion *expansion, struct binding *index, const struct node *value,
                 const struct node *body, int depth, struct node *list)
{
    size_t errors = expansion->errors;
    index->value = value;
    append_body(expansion, body, depth, list);
    return expansion->errors == errors && !expansion->stopped;
}

static void repeat_in(struct expansion *expansion, struct binding *index, const struct node *head,
                      int depth, struct node *list)
{
    const struct node *values = find_value(head, "in"), *body = find_value(head, "do");
    bool going = fill_expect(expansion->reader, "in", values, NODE_LIST);
    if (!going)
        expansion->errors++;
    for (const struct item *item = values->first; item && going; item = item->next)
        going = expand_count(expansion, values, 1) &&
                turn(expansion, index, item->value, body, depth, list);
}

static void repeat_count(struct expansion *expansion, struct binding *index,
                         const struct node *head, const struct schema_loop *loop, int depth,
                         struct node *list)
{
    struct arena *arena = expansion->reader->arena;
    const struct node *body = find_value(head, "do"), *end = find_value(head, "to");
    double turns = floor((loop->to - loop->from) / loop->step + SLACK) + 1;
    if (turns > (double)expansion->budget.most) {
        expand_error(expansion, end, "this loop has %g turns; a scene has at most %zu values",
                     turns, expansion->budget.most);
        return;
    }
    bool going = turns >= 1 && expand_count(expansion, end, turns);
    for (double i = 0; i < turns && going; i++) {
        char text[WORD_NUMBER];
        word_write_number(loop->from + i * loop->step, text);
        const char *copy = arena_copy(arena, text, strlen(text));
        const struct node *value = copy ? node_scalar(arena, index->at, copy) : NULL;
        if (!value)
            expand_fail_memory(expansion);
        going = value && turn(expansion, index, value, body, depth, list);
    }
}

/* Whether it says in one way, and one only, how often. */
static bool check_range(struct expansion *expansion, const struct node *head,
                        const struct schema_loop *loop)
{
    const struct node *values = find_value(head, "in"), *from = find_value(head, "from");
    const struct node *to = find_value(head, "to"), *step = find_value(head, "step");
    const struct node *range = from ? from : to ? to : step;
    const struct node *at = node_find(head, "for")->key;
    if (values && range)
        expand_error(expansion, range, "for has both in and a range; give one of them");
    else if (!values && !range)
        expand_error(expansion, at, "for needs from and to, or in");
    else if (!values && !(from && to))
        expand_error(expansion, at, "missing key '%s' in for", from ? "to" : "from");
    else if (!values && loop->step == 0)
        expand_error(expansion, step, "step in for: expected a number that is not 0");
    else
        return true;
    return false;
}

static bool fill(struct expansion *expansion, const char *section, const struct node *head,
                 void *state)
{
    const struct node *at = node_find(head, section)->key;
    if (has_broken(head))
        return false;
    if (fill_section(expansion->reader, schema_only(section), at, head, state))
        return true;
    expansion->errors++;
    return false;
}

static void expand_for(struct expansion *expansion, const struct node *head, int depth,
                       struct node *list)
{
    struct schema_loop loop = {0};
    if (!fill(expansion, "for", head, &loop) || !check_range(expansion, head, &loop))
        return;
    struct binding *index = scope_enter(expansion->scope, find_value(head, "for"));
    if (!index) {
        expansion->errors++;
        return;
    }
    if (find_value(head, "in"))
        repeat_in(expansion, index, head, depth, list);
    else
        repeat_count(expansion, index, head, &loop, depth, list);
    scope_leave(expansion->scope, index);
}

/* Any number but 0 counts as yes. */
static const struct node *with_truth(struct expansion *expansion, const struct node *head)
{
    struct arena *arena = expansion->reader->arena;
    struct node *copy = node_start(arena, head);
    for (const struct item *item = head->first; item && copy; item = item->next) {
        const struct node *value = item->value;
        double number;
        if (strcmp(item->key->text, "if") == 0 && node_is_number(value, &number))
            value = node_scalar(arena, value, number != 0 ? "1" : "0");
        if (!value || !node_add(copy, arena, item->key, value))
            copy = NULL;
    }
    if (!copy)
        expand_fail_memory(expansion);
    return copy;
}

static void expand_if(struct expansion *expansion, const struct node *head, int depth,
                      struct node *list)
{
    struct schema_condition condition = {0};
    const struct node *map = with_truth(expansion, head);
    if (map && fill(expansion, "if", map, &condition))
        append_body(expansion, find_value(map, condition.holds ? "do" : "else"), depth, list);
}

void loop_expand(struct expansion *expansion, const struct node *node, int depth, struct node *list)
{
    const struct node *head = NULL;
    if (expand_count(expansion, node, 1))
        head = expand_head(expansion, node, depth);
    if (!head || expansion->stopped)
        return;
    if (node_find(head, "for"))
        expand_for(expansion, head, depth, list);
    else
        expand_if(expansion, head, depth, list);
}
