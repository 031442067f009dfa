#include "parser/yaml/tokens.h"

#include <stdlib.h>
#include <string.h>
#include <yaml.h>

/* libyaml counts characters; tokens come in order, so that a cursor finds their bytes. */
struct cursor {
    size_t character, byte;
};

static size_t find_byte(struct cursor *cursor, const char *text, size_t length, size_t character)
{
    if (character < cursor->character)
        *cursor = (struct cursor){0};
    while (cursor->character < character && cursor->byte < length) {
        cursor->byte++;
        while (cursor->byte < length && ((unsigned char)text[cursor->byte] & 0xc0) == 0x80)
            cursor->byte++;
        cursor->character++;
    }
    return cursor->byte;
}

static bool append(struct token **tokens, size_t *count, size_t *room, struct token token)
{
    if (*count == *room) {
        size_t larger = *room ? 2 * *room : 256;
        struct token *moved = realloc(*tokens, larger * sizeof *moved);
        if (!moved)
            return false;
        *tokens = moved;
        *room = larger;
    }
    (*tokens)[(*count)++] = token;
    return true;
}

static ps_result scan(yaml_parser_t *parser, const char *text, size_t length, struct token **tokens,
                      size_t *count)
{
    struct cursor starts = {0}, ends = {0};
    size_t room = 0;
    int type = YAML_NO_TOKEN;
    while (type != YAML_STREAM_END_TOKEN) {
        yaml_token_t token;
        if (!yaml_parser_scan(parser, &token))
            return parser->error == YAML_MEMORY_ERROR ? PS_ERROR_MEMORY : PS_ERROR_INVALID;
        type = (int)token.type;
        const struct token place = {
            .type = type,
            .start = find_byte(&starts, text, length, token.start_mark.index),
            .end = find_byte(&ends, text, length, token.end_mark.index),
            .column = token.start_mark.column,
            .end_column = token.end_mark.column,
        };
        yaml_token_delete(&token);
        if (!append(tokens, count, &room, place))
            return PS_ERROR_MEMORY;
    }
    return PS_OK;
}

ps_result tokens_scan(const char *text, size_t length, struct token **tokens, size_t *count)
{
    yaml_parser_t parser;
    *tokens = NULL;
    *count = 0;
    if (!yaml_parser_initialize(&parser))
        return PS_ERROR_MEMORY;
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, length);
    ps_result result = scan(&parser, text, length, tokens, count);
    yaml_parser_delete(&parser);
    if (result != PS_OK) {
        free(*tokens);
        *tokens = NULL;
    }
    return result;
}

/* --- meaning
 * ------------------------------------------------------------------------------------------ */

static bool is_same_name(const yaml_char_t *a, const yaml_char_t *b)
{
    return a && b ? strcmp((const char *)a, (const char *)b) == 0 : a == b;
}

static bool is_same_event(const yaml_event_t *a, const yaml_event_t *b)
{
    if (a->type != b->type)
        return false;
    switch (a->type) {
    case YAML_SCALAR_EVENT:
        return is_same_name(a->data.scalar.anchor, b->data.scalar.anchor) &&
               is_same_name(a->data.scalar.tag, b->data.scalar.tag) &&
               a->data.scalar.style == b->data.scalar.style &&
               a->data.scalar.length == b->data.scalar.length &&
               memcmp(a->data.scalar.value, b->data.scalar.value, a->data.scalar.length) == 0;
    case YAML_SEQUENCE_START_EVENT:
        return is_same_name(a->data.sequence_start.anchor, b->data.sequence_start.anchor) &&
               is_same_name(a->data.sequence_start.tag, b->data.sequence_start.tag);
    case YAML_MAPPING_START_EVENT:
        return is_same_name(a->data.mapping_start.anchor, b->data.mapping_start.anchor) &&
               is_same_name(a->data.mapping_start.tag, b->data.mapping_start.tag);
    case YAML_ALIAS_EVENT:
        return is_same_name(a->data.alias.anchor, b->data.alias.anchor);
    default:
        return true;
    }
}

static bool have_same_events(yaml_parser_t *a, yaml_parser_t *b)
{
    bool same = true, ended = false;
    while (same && !ended) {
        yaml_event_t of_a, of_b;
        if (!yaml_parser_parse(a, &of_a))
            return false;
        same = yaml_parser_parse(b, &of_b) != 0;
        if (same) {
            same = is_same_event(&of_a, &of_b);
            ended = of_a.type == YAML_STREAM_END_EVENT;
            yaml_event_delete(&of_b);
        }
        yaml_event_delete(&of_a);
    }
    return same;
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static bool have_same_characters(const char *a, size_t a_length, const char *b, size_t b_length)
{
    const char *a_end = a + a_length, *b_end = b + b_length;
    for (;; a++, b++) {
        while (a < a_end && is_blank(*a))
            a++;
        while (b < b_end && is_blank(*b))
            b++;
        if (a == a_end || b == b_end)
            return a == a_end && b == b_end;
        if (*a != *b)
            return false;
    }
}

bool tokens_same_meaning(const char *a, size_t a_length, const char *b, size_t b_length)
{
    yaml_parser_t parsers[2];
    if (!have_same_characters(a, a_length, b, b_length) || !yaml_parser_initialize(&parsers[0]))
        return false;
    bool same = false;
    if (yaml_parser_initialize(&parsers[1])) {
        yaml_parser_set_input_string(&parsers[0], (const unsigned char *)a, a_length);
        yaml_parser_set_input_string(&parsers[1], (const unsigned char *)b, b_length);
        same = have_same_events(&parsers[0], &parsers[1]);
        yaml_parser_delete(&parsers[1]);
    }
    yaml_parser_delete(&parsers[0]);
    return same;
}
