#include "parser/language/assignment.h"

#include "parser/yaml/encoding.h"
#include <string.h>

/* Moves the mark behind the text. */
static void advance(struct mark *mark, const char *text, size_t length)
{
    encoding_advance(text, length, &mark->line, &mark->column);
}

static char *join(struct arena *arena, const char *const *texts, size_t count, size_t *length)
{
    *length = 0;
    for (size_t i = 0; i < count; i++)
        *length += strlen(texts[i]) + 1;
    char *joined = arena_allocate(arena, *length + 1), *end = joined;
    for (size_t i = 0; i < count && joined; i++) {
        size_t bytes = strlen(texts[i]);
        memcpy(end, texts[i], bytes);
        end[bytes] = '\n';
        end += bytes + 1;
    }
    return joined;
}

/* Takes one text, which starts at the mark, and moves that to the next one. */
static bool split(struct reader *reader, const char *option, const char *text, struct mark *mark,
                  struct assignment *assignment)
{
    const char *equals = strchr(text, '=');
    struct mark start = {mark->line, mark->column, 1};
    size_t key_length = equals ? (size_t)(equals - text) : strlen(text);
    *assignment = (struct assignment){.file = option, .key_mark = start};
    assignment->key = arena_copy(reader->arena, text, key_length);
    advance(mark, text, key_length + (equals ? 1 : 0));
    assignment->key_mark.width = mark->column - start.column - (equals ? 1 : 0);
    assignment->value_mark = *mark;
    assignment->value = equals ? arena_copy(reader->arena, equals + 1, strlen(equals + 1)) : "";
    advance(mark, assignment->value ? assignment->value : "",
            assignment->value ? strlen(assignment->value) : 0);
    advance(mark, "\n", 1);
    if (!assignment->key || !assignment->value) {
        reader->out_of_memory = true;
        return false;
    }
    if (equals && equals > text)
        return true;
    const struct node at = {.kind = NODE_SCALAR, .mark = assignment->key_mark, .file = option};
    reader_error(reader, &at, "expected NAME=VALUE, got '%s'", text);
    return false;
}

bool assignments_read(struct reader *reader, const char *option, const char *const *texts,
                      size_t count, struct assignments *assignments)
{
    size_t length;
    struct mark mark = {1, 1, 1};
    *assignments = (struct assignments){0};
    if (count == 0)
        return true;
    char *joined = join(reader->arena, texts, count, &length);
    assignments->items = arena_allocate(reader->arena, count * sizeof *assignments->items);
    const char *file = reader_add_file(reader, option);
    if (!joined || !assignments->items || !file ||
        !diagnostics_add_source(reader->sink, option, joined, length)) {
        reader->out_of_memory = true;
        return false;
    }
    if (encoding_check(option, joined, length, reader->sink) != PS_OK)
        return false;
    bool good = true;
    for (size_t i = 0; i < count; i++)
        good =
            split(reader, file, texts[i], &mark, &assignments->items[assignments->count++]) && good;
    return good;
}

const struct node *assignment_value(struct reader *reader, const struct assignment *assignment,
                                    struct budget *budget)
{
    const struct document document = {.file = assignment->file,
                                      .start = assignment->value_mark,
                                      .text = assignment->value,
                                      .length = strlen(assignment->value)};
    const struct node *root = NULL;
    ps_result result = document_read(&document, reader->sink, reader->arena, budget, &root);
    if (result == PS_ERROR_MEMORY)
        reader->out_of_memory = true;
    return result == PS_OK ? root : NULL;
}

const struct node *assignment_key(struct reader *reader, const struct assignment *assignment,
                                  size_t start, size_t length)
{
    struct node like = {
        .kind = NODE_SCALAR, .mark = assignment->key_mark, .file = assignment->file};
    struct mark end;
    advance(&like.mark, assignment->key, start);
    end = like.mark;
    advance(&end, assignment->key + start, length);
    like.mark.width = end.line == like.mark.line && end.column > like.mark.column
                          ? end.column - like.mark.column
                          : 1;
    const char *text = arena_copy(reader->arena, assignment->key + start, length);
    const struct node *node = text ? node_scalar(reader->arena, &like, text) : NULL;
    if (!node)
        reader->out_of_memory = true;
    return node;
}
