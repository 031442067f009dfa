/* document.c: passes libyaml's events to the builder.
 *
 * libyaml's own document interface would be shorter, but it builds the whole tree before anyone
 * can judge its depth (80 KB of '[' take it seconds), and forgets which scalars were plain.
 */
#include "parser/yaml/document.h"

#include "parser/yaml/encoding.h"
#include <yaml.h>

static struct mark mark_at(const struct builder *builder, const yaml_mark_t *position)
{
    int first = position->line == 0 ? builder->start.column : 1;
    return (struct mark){builder->start.line + (int)position->line, first + (int)position->column,
                         1};
}

static struct mark mark_event(const struct builder *builder, const yaml_event_t *event)
{
    struct mark mark = mark_at(builder, &event->start_mark);
    const yaml_mark_t *start = &event->start_mark, *end = &event->end_mark;
    bool word = event->type == YAML_SCALAR_EVENT || event->type == YAML_ALIAS_EVENT;
    if (word && end->line == start->line && end->column > start->column)
        mark.width = (int)(end->column - start->column);
    return mark;
}

static struct properties properties_of(const yaml_char_t *anchor, const yaml_char_t *tag)
{
    return (struct properties){(const char *)anchor, (const char *)tag};
}

static void take_document_start(struct builder *builder, const yaml_event_t *event)
{
    if (!builder->root)
        return;
    builder_report(builder, mark_event(builder, event),
                   "a second document starts here; a scene is one document");
    builder->result = PS_ERROR_INVALID;
}

static void take_scalar(struct builder *builder, const yaml_event_t *event)
{
    builder_scalar(builder, mark_event(builder, event),
                   properties_of(event->data.scalar.anchor, event->data.scalar.tag),
                   (const char *)event->data.scalar.value, event->data.scalar.length,
                   event->data.scalar.style == YAML_PLAIN_SCALAR_STYLE);
}

static void take_event(struct builder *builder, const yaml_event_t *event)
{
    switch (event->type) {
    case YAML_DOCUMENT_START_EVENT:
        take_document_start(builder, event);
        break;
    case YAML_SCALAR_EVENT:
        take_scalar(builder, event);
        break;
    case YAML_SEQUENCE_START_EVENT:
        builder_start(
            builder, mark_event(builder, event),
            properties_of(event->data.sequence_start.anchor, event->data.sequence_start.tag),
            NODE_LIST);
        break;
    case YAML_MAPPING_START_EVENT:
        builder_start(
            builder, mark_event(builder, event),
            properties_of(event->data.mapping_start.anchor, event->data.mapping_start.tag),
            NODE_MAP);
        break;
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        builder_end(builder);
        break;
    case YAML_ALIAS_EVENT:
        builder_alias(builder, mark_event(builder, event), (const char *)event->data.alias.anchor);
        break;
    default:
        break;
    }
}

/* libyaml sees the end of a text on a line of its own, where something else may stand. */
static struct mark within(const struct document *document, struct mark mark)
{
    struct mark end = document->start;
    encoding_advance(document->text, document->length, &end.line, &end.column);
    return mark.line > end.line ? end : mark;
}

/* libyaml points at where it noticed; its context says where that which is wrong began. */
static void fail_yaml(struct builder *builder, const struct document *document,
                      const yaml_parser_t *parser)
{
    if (parser->error == YAML_MEMORY_ERROR) {
        builder->result = PS_ERROR_MEMORY;
        return;
    }
    struct mark mark = within(document, mark_at(builder, &parser->problem_mark));
    struct mark context = within(document, mark_at(builder, &parser->context_mark));
    const char *problem = parser->problem ? parser->problem : "this is not YAML";
    if (parser->context)
        builder_report(builder, mark, "%s, %s that begins at line %d, column %d", problem,
                       parser->context, context.line, context.column);
    else
        builder_report(builder, mark, "%s", problem);
    builder->result = PS_ERROR_INVALID;
}

static void read_events(struct builder *builder, const struct document *document,
                        yaml_parser_t *parser)
{
    bool ended = false;
    while (!ended && builder->result == PS_OK) {
        yaml_event_t event;
        if (!yaml_parser_parse(parser, &event)) {
            fail_yaml(builder, document, parser);
            return;
        }
        ended = event.type == YAML_STREAM_END_EVENT;
        take_event(builder, &event);
        yaml_event_delete(&event);
    }
}

ps_result document_read(const struct document *document, struct diagnostics *sink,
                        struct arena *arena, struct budget *budget, const struct node **root)
{
    struct builder builder = {.file = document->file,
                              .start = document->start,
                              .sink = sink,
                              .arena = arena,
                              .budget = budget};
    yaml_parser_t parser;
    if (!yaml_parser_initialize(&parser))
        return PS_ERROR_MEMORY;
    yaml_parser_set_input_string(&parser, (const unsigned char *)document->text, document->length);
    read_events(&builder, document, &parser);
    yaml_parser_delete(&parser);
    if (!builder.root && builder.result == PS_OK) /* an empty text */
        builder_scalar(&builder, document->start, (struct properties){0}, "", 0, true);
    *root = builder.root;
    return builder.result;
}
