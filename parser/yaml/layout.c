/* layout.c: from token to token, with the gaps between them written anew.
 *
 * What stands first on a line gets its column from the block that it is in; what a gap of one line
 * becomes follows from the tokens at its ends. Everything else is copied.
 */
#include "parser/yaml/layout.h"

#include "parser/yaml/builder.h"
#include "parser/yaml/encoding.h"
#include "parser/yaml/tokens.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <yaml.h>

#define STEP 2 /* columns */
#define MOST_LEVELS (2 * DEEPEST_NESTING + 2)

/* A column, and what became of it. */
struct move {
    size_t from, to;
};

enum level_kind { LEVEL_MAP, LEVEL_LIST, LEVEL_LIST_IN_COLUMN_OF_MAP };

struct layout {
    const char *text;
    FILE *stream;
    size_t column;            /* of what is written next */
    size_t at;                /* up to there the text is done */
    const struct token *last; /* that was written; NULL: none */
    bool wrote_line_end;      /* of a text of several lines, with it */
    bool began;               /* something is written */
    bool overflows;           /* deeper than what document_read takes */
    struct move blocks[MOST_LEVELS];
    enum level_kind kinds[MOST_LEVELS];
    size_t depth;
    struct move flows[MOST_LEVELS], flow_lines[MOST_LEVELS];
    size_t flow_depth;
    struct move line;              /* where the line at hand begins */
    struct move seen[MOST_LEVELS]; /* columns in which lines begin, for comments; ascending */
    size_t seen_count;
};

/* --- writing
 * ------------------------------------------------------------------------------------------ */

static void write_bytes(struct layout *layout, const char *bytes, size_t length)
{
    fwrite(bytes, 1, length, layout->stream);
    layout->began = true;
    for (size_t i = 0; i < length; i++)
        layout->column += ((unsigned char)bytes[i] & 0xc0) != 0x80;
}

static void write_line_end(struct layout *layout)
{
    fputc('\n', layout->stream);
    layout->column = 0;
}

static void write_blanks_to(struct layout *layout, size_t column)
{
    for (; layout->column < column; layout->column++)
        fputc(' ', layout->stream);
}

static size_t moved(struct move move, size_t column)
{
    return column + move.to > move.from ? column + move.to - move.from : 0;
}

/* --- comments and empty lines
 * ------------------------------------------------------------------------- */

static size_t count_blanks(const char *text, size_t length)
{
    size_t count = 0;
    while (count < length && (text[count] == ' ' || text[count] == '\t'))
        count++;
    return count;
}

/* A line: its length without blanks at its end, with them, and with its break, which the last one
 * lacks. */
struct line {
    size_t length, text, whole;
    bool ends;
};

static struct line line_at(const char *text, size_t length)
{
    size_t end = 0, line_break = 0;
    while (end < length && line_break == 0) {
        line_break = line_break_length(text + end, length - end);
        end += line_break == 0;
    }
    struct line line = {end, end, end + line_break, line_break > 0};
    while (line.length > 0 && (text[line.length - 1] == ' ' || text[line.length - 1] == '\t'))
        line.length--;
    return line;
}

static void see(struct layout *layout, size_t from, size_t to)
{
    while (layout->seen_count > 0 && layout->seen[layout->seen_count - 1].from >= from)
        layout->seen_count--;
    if (layout->seen_count < MOST_LEVELS)
        layout->seen[layout->seen_count++] = (struct move){from, to};
}

/* Where what stands first on a line of a bracket goes: it stays below what it was below. */
static size_t column_in_flow(const struct layout *layout, size_t column)
{
    size_t top = layout->flow_depth - 1;
    return moved(column > layout->flows[top].from ? layout->flows[top] : layout->flow_lines[top],
                 column);
}

/* A comment goes with the line below it if it stands in the same column, or else with those above.
 * Between the columns of two of them it stays there, or gets that of the deeper one. */
static size_t comment_column(const struct layout *layout, size_t column, const struct move *next)
{
    if (layout->flow_depth > 0)
        return column_in_flow(layout, column);
    if (next && column == next->from)
        return next->to;
    size_t deepest = SIZE_MAX;
    for (size_t i = layout->seen_count; i-- > 0; deepest = layout->seen[i].to)
        if (layout->seen[i].from <= column) {
            size_t to = moved(layout->seen[i], column);
            return to < deepest ? to : deepest;
        }
    return column;
}

static void write_comment_behind(struct layout *layout, const char *text, size_t length)
{
    size_t blanks = count_blanks(text, length);
    size_t column = moved(layout->line, layout->last->end_column + blanks);
    if (blanks == 1 || column <= layout->column)
        column = layout->column + 1;
    write_blanks_to(layout, column);
    write_bytes(layout, text + blanks, length - blanks);
}

/* The gap up to a token that stands first on its line, or to the text's end. */
static void write_lines(struct layout *layout, size_t end, const struct move *next)
{
    bool empty = false;
    if (layout->last && !layout->wrote_line_end) {
        const char *rest = layout->text + layout->at;
        struct line line = line_at(rest, end - layout->at);
        if (line.length > 0)
            write_comment_behind(layout, rest, line.length);
        write_line_end(layout);
        layout->at += line.whole;
    }
    while (layout->at < end) {
        const char *text = layout->text + layout->at;
        struct line line = line_at(text, end - layout->at);
        size_t blanks = count_blanks(text, line.length);
        layout->at += line.whole;
        if (line.length > 0) {
            if (empty)
                write_line_end(layout);
            write_blanks_to(layout, comment_column(layout, blanks, next));
            write_bytes(layout, text + blanks, line.length - blanks);
            write_line_end(layout);
        }
        empty = line.length == 0 && (empty || (line.ends && layout->began));
    }
    if (empty && next)
        write_line_end(layout);
}

/* --- tokens
 * ------------------------------------------------------------------------------------------- */

static bool is_open(const struct token *token)
{
    return token->type == YAML_FLOW_SEQUENCE_START_TOKEN ||
           token->type == YAML_FLOW_MAPPING_START_TOKEN;
}

static bool is_close(const struct token *token)
{
    return token->type == YAML_FLOW_SEQUENCE_END_TOKEN ||
           token->type == YAML_FLOW_MAPPING_END_TOKEN;
}

/* Whether a blank stands between two tokens of a line; `gap`: there is one now. */
static bool wants_blank(const struct token *last, const struct token *next, bool gap)
{
    /* {a: }: where a value is left out, the blank may tell the colon from a part of the key. */
    if (last->type == YAML_VALUE_TOKEN && (is_close(next) || next->type == YAML_FLOW_ENTRY_TOKEN))
        return gap;
    if (is_open(last) || is_close(next) || next->type == YAML_FLOW_ENTRY_TOKEN)
        return false;
    if (next->type == YAML_VALUE_TOKEN) /* *name: is a name with a colon to others than libyaml */
        return gap && last->type != YAML_SCALAR_TOKEN && !is_close(last);
    if (last->type == YAML_VALUE_TOKEN || last->type == YAML_FLOW_ENTRY_TOKEN)
        return true;
    return gap;
}

static void push_block(struct layout *layout, struct move move, enum level_kind kind)
{
    if (layout->depth == MOST_LEVELS) {
        layout->overflows = true;
        return;
    }
    layout->kinds[layout->depth] = kind;
    layout->blocks[layout->depth++] = move;
}

static bool is_in_list_in_column(const struct layout *layout)
{
    return layout->depth > 0 && layout->kinds[layout->depth - 1] == LEVEL_LIST_IN_COLUMN_OF_MAP;
}

/* The column of a token that stands first on its line. `opens`: it begins a block. */
static size_t first_column(struct layout *layout, const struct token *token, bool opens)
{
    if (layout->flow_depth > 0)
        return column_in_flow(layout, token->column);
    if (layout->depth == 0)
        return 0;
    struct move block = layout->blocks[layout->depth - 1];
    if (opens)
        return block.to + STEP;
    if (token->type == YAML_BLOCK_ENTRY_TOKEN && layout->kinds[layout->depth - 1] == LEVEL_MAP) {
        push_block(layout, (struct move){token->column, block.to + STEP},
                   LEVEL_LIST_IN_COLUMN_OF_MAP);
        return block.to + STEP;
    }
    return token->column == block.from ? block.to : block.to + STEP;
}

/* A text of several lines: those behind the first move by as much as the block, or the line that it
 * begins on. */
static void write_token(struct layout *layout, const struct token *token)
{
    const char *text = layout->text + token->start;
    size_t length = token->end - token->start;
    bool is_block = token->type == YAML_SCALAR_TOKEN && (*text == '|' || *text == '>');
    struct move move = layout->line;
    if (is_block)
        move = layout->depth > 0 ? layout->blocks[layout->depth - 1] : (struct move){0, 0};
    for (size_t done = 0; done < length;) {
        const char *at = text + done;
        struct line line = line_at(at, length - done);
        size_t blanks = 0;
        while (done > 0 && blanks < line.text && at[blanks] == ' ')
            blanks++;
        /* Blanks of empty lines may belong to the text of a block. */
        if (done > 0 && (is_block || line.length > 0))
            write_blanks_to(layout, moved(move, blanks));
        write_bytes(layout, at + blanks, line.text - blanks);
        if (line.ends && (at[line.text] == '\r' || at[line.text] == '\n'))
            write_line_end(layout);
        else
            write_bytes(layout, at + line.text, line.whole - line.text);
        done += line.whole;
        layout->wrote_line_end = line.ends && done == length;
    }
}

static void write_gap(struct layout *layout, const struct token *token, bool opens)
{
    size_t length = token->start - layout->at;
    bool first =
        !layout->last || layout->wrote_line_end || line_at(layout->text + layout->at, length).ends;
    if (!first) {
        if (wants_blank(layout->last, token, length > 0))
            write_blanks_to(layout, layout->column + 1);
        return;
    }
    const struct move next = {token->column, first_column(layout, token, opens)};
    write_lines(layout, token->start, &next);
    write_blanks_to(layout, next.to);
    layout->line = next;
    if (layout->flow_depth == 0)
        see(layout, next.from, next.to);
}

static void open_flow(struct layout *layout, struct move move)
{
    if (layout->flow_depth == MOST_LEVELS) {
        layout->overflows = true;
        return;
    }
    layout->flow_lines[layout->flow_depth] = layout->line;
    layout->flows[layout->flow_depth++] = move;
}

static void take_visible(struct layout *layout, const struct token *token, int opening)
{
    write_gap(layout, token, opening != YAML_NO_TOKEN);
    const struct move move = {token->column, layout->column};
    if (opening != YAML_NO_TOKEN) {
        push_block(layout, move,
                   opening == YAML_BLOCK_MAPPING_START_TOKEN ? LEVEL_MAP : LEVEL_LIST);
        see(layout, move.from, move.to);
    }
    layout->wrote_line_end = false;
    write_token(layout, token);
    layout->at = token->end;
    layout->last = token;
    if (is_open(token))
        open_flow(layout, move);
    else if (is_close(token) && layout->flow_depth > 0)
        layout->flow_depth--;
}

static void close_block(struct layout *layout)
{
    if (is_in_list_in_column(layout))
        layout->depth--;
    if (layout->depth > 0)
        layout->depth--;
}

static void take_tokens(struct layout *layout, struct token *tokens, size_t count)
{
    int opening = YAML_NO_TOKEN;
    for (size_t i = 0; i < count && !layout->overflows; i++) {
        struct token *token = &tokens[i];
        bool opens = token->type == YAML_BLOCK_MAPPING_START_TOKEN ||
                     token->type == YAML_BLOCK_SEQUENCE_START_TOKEN;
        bool is_key = token->type == YAML_KEY_TOKEN && layout->flow_depth == 0;
        if (opens)
            opening = token->type;
        else if (token->type == YAML_BLOCK_END_TOKEN)
            close_block(layout);
        if (is_key && opening == YAML_NO_TOKEN && is_in_list_in_column(layout))
            layout->depth--;
        if (token->end == token->start || opens || token->type == YAML_BLOCK_END_TOKEN)
            continue;
        /* Blanks of the next line that libyaml counts to a text of several lines. */
        while (token->end > token->start + 1 && layout->text[token->end - 1] == ' ')
            token->end--;
        take_visible(layout, token, opening);
        opening = YAML_NO_TOKEN;
    }
}

static ps_result write_layout(struct layout *layout, const char *text, size_t length)
{
    struct token *tokens;
    size_t count;
    ps_result result = tokens_scan(text, length, &tokens, &count);
    if (result != PS_OK)
        return result;
    layout->text = text;
    take_tokens(layout, tokens, count);
    write_lines(layout, length, NULL);
    free(tokens);
    return PS_OK;
}

ps_result layout_text(const char *text, size_t length, char **laid_out, size_t *laid_out_length)
{
    struct layout layout = {.stream = open_memstream(laid_out, laid_out_length)};
    if (!layout.stream)
        return PS_ERROR_MEMORY;
    ps_result result = write_layout(&layout, text, length);
    if (fclose(layout.stream) != 0 && result == PS_OK)
        result = PS_ERROR_MEMORY;
    if (result == PS_OK &&
        (layout.overflows || !tokens_same_meaning(text, length, *laid_out, *laid_out_length))) {
        free(*laid_out);
        *laid_out = malloc(length + 1);
        *laid_out_length = length;
        if (*laid_out)
            memcpy(*laid_out, text, length);
        return *laid_out ? PS_OK : PS_ERROR_MEMORY;
    }
    if (result != PS_OK)
        free(*laid_out);
    return result;
}
