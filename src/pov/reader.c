/* reader.c: see reader.h. */
#include "pov/reader.h"

#include <stdlib.h>
#include <string.h>

/* --- messages and memory
 * ------------------------------------------------------------------------ */

const char *pov_file(const struct pov_reader *reader)
{
    return reader->frame_count > 0 ? reader->frames[reader->frame_count - 1].tokens->file : NULL;
}

static struct origin origin_of(const char *file, const struct pov_token *token)
{
    return (struct origin){file, (int)token->line, (int)token->column};
}

/* Only the first: what follows an error in a program means little. */
void pov_error(struct pov_reader *reader, const struct pov_token *token, const char *format, ...)
{
    if (reader->stopped)
        return;
    struct origin origin = origin_of(pov_file(reader), token);
    va_list arguments;
    va_start(arguments, format);
    diagnostics_report_list(reader->sink, SEVERITY_ERROR, &origin, token->width, format, arguments);
    va_end(arguments);
    reader->stopped = true;
}

static void warn(struct pov_reader *reader, const char *file, const struct pov_token *token,
                 const char *format, va_list arguments)
{
    struct origin origin = origin_of(file, token);
    if (!reader->stopped &&
        !warnings_report(&reader->warnings, reader->sink, &origin, token->width, format, arguments))
        pov_no_memory(reader);
}

void pov_warn(struct pov_reader *reader, const struct pov_token *token, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    warn(reader, pov_file(reader), token, format, arguments);
    va_end(arguments);
}

void pov_warn_at(struct pov_reader *reader, const char *file, const struct pov_token *token,
                 const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    warn(reader, file, token, format, arguments);
    va_end(arguments);
}

void pov_no_memory(struct pov_reader *reader)
{
    if (!reader->no_memory)
        diagnostics_report(reader->sink, SEVERITY_ERROR, NULL, 0, "out of memory");
    reader->no_memory = reader->stopped = true;
}

static size_t most_memory(const struct pov_reader *reader)
{
    return reader->options->most_memory ? reader->options->most_memory : POV_MOST_MEMORY;
}

size_t pov_memory_left(const struct pov_reader *reader)
{
    return most_memory(reader) - reader->memory;
}

bool pov_charge(struct pov_reader *reader, size_t count, size_t size)
{
    if (reader->stopped)
        return false;
    if (count > pov_memory_left(reader) / size) {
        diagnostics_report(reader->sink, SEVERITY_ERROR, NULL, 0,
                           "the scene's values and meshes need more than %zu MiB, the most that is "
                           "allowed",
                           most_memory(reader) >> 20);
        reader->stopped = true;
        return false;
    }
    reader->memory += count * size;
    return true;
}

void *pov_allocate(struct pov_reader *reader, size_t count, size_t size)
{
    if (!pov_charge(reader, count, size))
        return NULL;
    void *bytes = arena_allocate(&reader->arena, count * size + 1);
    if (!bytes)
        pov_no_memory(reader);
    return bytes;
}

void *pov_copy(struct pov_reader *reader, const void *from, size_t size)
{
    void *bytes = pov_allocate(reader, 1, size);
    if (bytes)
        memcpy(bytes, from, size);
    return bytes;
}

bool pov_grow(struct pov_reader *reader, void **items, size_t *capacity, size_t wanted, size_t size)
{
    if (scene_text_grow(items, capacity, wanted, size))
        return true;
    pov_no_memory(reader);
    return false;
}

bool pov_enter(struct pov_reader *reader, const struct pov_token *token)
{
    if (reader->depth == POV_DEEPEST) {
        pov_error(reader, token,
                  "parentheses, braces and directives stand in each other more than "
                  "%d deep",
                  POV_DEEPEST);
        return false;
    }
    reader->depth++;
    return true;
}

void pov_leave(struct pov_reader *reader)
{
    reader->depth--;
}

/* --- tokens
 * ------------------------------------------------------------------------------------- */

static struct pov_token end_of(const struct pov_reader *reader)
{
    const struct pov_frame *frame = &reader->frames[reader->frame_count - 1];
    struct pov_token token = frame->tokens->list[frame->at];
    token.kind = POV_END;
    return token;
}

static bool count_step(struct pov_reader *reader, const struct pov_token *token)
{
    size_t most = reader->options->most_steps ? reader->options->most_steps : POV_MOST_STEPS;
    if (++reader->steps <= most)
        return true;
    pov_error(reader, token,
              "more than %zu tokens were read, those of loops and macros each time: "
              "does a loop not end?",
              most);
    return false;
}

static struct pov_token take_pushed(struct pov_reader *reader)
{
    reader->has_pushed = false;
    return reader->pushed;
}

/* Whether there is more behind the end of a file's tokens: what includes it. */
static bool end_file(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_frame *frame = &reader->frames[reader->frame_count - 1];
    if (reader->block_count > frame->blocks) {
        const struct pov_block *block = &reader->blocks[reader->block_count - 1];
        pov_error(reader, &block->token, "the file ends before the #end of this");
        return false;
    }
    if (!frame->is_file)
        pov_error(reader, token, "the file ends within a macro or function");
    if (!frame->is_file || reader->frame_count == 1)
        return false;
    pov_pop_frame(reader);
    return true;
}

struct pov_token pov_next(struct pov_reader *reader)
{
    while (!reader->stopped) {
        if (reader->has_pushed)
            return take_pushed(reader);
        struct pov_frame *frame = &reader->frames[reader->frame_count - 1];
        struct pov_token token = frame->tokens->list[frame->at];
        if (token.kind == POV_END) {
            if (!end_file(reader, &token))
                return token;
            continue;
        }
        frame->at++;
        if (!count_step(reader, &token))
            break;
        if (token.kind == POV_BAD) {
            pov_error(reader, &token, "%s", token.text);
        } else if (token.kind == POV_DIRECTIVE) {
            if (!pov_directive(reader, &token)) {
                reader->frames[reader->frame_count - 1].at--;
                return token;
            }
        } else if (token.kind == POV_WORD && !reader->raw) {
            const struct pov_value *value = pov_lookup(reader, token.word);
            if (!value || value->kind != POV_VALUE_MACRO)
                return token;
            pov_call_macro(reader, &token, value->macro);
        } else {
            return token;
        }
    }
    return end_of(reader);
}

struct pov_token pov_next_raw(struct pov_reader *reader)
{
    bool was = reader->raw;
    reader->raw = true;
    struct pov_token token = pov_next(reader);
    reader->raw = was;
    return token;
}

void pov_unread(struct pov_reader *reader, struct pov_token token)
{
    if (token.kind == POV_END || token.kind == POV_DIRECTIVE) /* read again as they are */
        return;
    reader->pushed = token;
    reader->has_pushed = true;
}

const struct pov_token *pov_peek(const struct pov_reader *reader)
{
    const struct pov_frame *frame = &reader->frames[reader->frame_count - 1];
    return reader->has_pushed ? &reader->pushed : &frame->tokens->list[frame->at];
}

bool pov_is(const struct pov_token *token, uint32_t symbol)
{
    return token->kind == POV_SYMBOL && token->symbol == symbol;
}

bool pov_is_word(const struct pov_token *token, enum pov_word word)
{
    return token->kind == POV_WORD && token->word == (uint32_t)word;
}

bool pov_accept(struct pov_reader *reader, uint32_t symbol)
{
    struct pov_token token = pov_next(reader);
    if (pov_is(&token, symbol))
        return true;
    pov_unread(reader, token);
    return false;
}

bool pov_accept_word(struct pov_reader *reader, enum pov_word word)
{
    struct pov_token token = pov_next(reader);
    if (pov_is_word(&token, word))
        return true;
    pov_unread(reader, token);
    return false;
}

const char *pov_text(const struct pov_reader *reader, uint32_t word)
{
    return reader->words.texts[word];
}

void pov_unexpected(struct pov_reader *reader, const struct pov_token *token, const char *expected)
{
    switch (token->kind) {
    case POV_END:
        pov_error(reader, token, "expected %s, but the file ends", expected);
        break;
    case POV_WORD:
        pov_error(reader, token,
                  pov_lookup(reader, token->word) || token->word < POV_WORD_COUNT
                      ? "expected %s, got '%.60s'"
                      : "expected %s, got '%.60s', which is not declared",
                  expected, pov_text(reader, token->word));
        break;
    case POV_DIRECTIVE:
        pov_error(reader, token, "expected %s, got #%.60s", expected,
                  pov_text(reader, token->word));
        break;
    case POV_SYMBOL:
        pov_error(reader, token, "expected %s, got '%s'", expected,
                  token->symbol == POV_LESS_EQUAL      ? "<="
                  : token->symbol == POV_GREATER_EQUAL ? ">="
                  : token->symbol == POV_NOT_EQUAL     ? "!="
                                                       : (char[2]){(char)token->symbol, '\0'});
        break;
    default:
        pov_error(reader, token, "expected %s, got a %s", expected,
                  token->kind == POV_STRING ? "text" : "number");
    }
}

bool pov_expect(struct pov_reader *reader, uint32_t symbol)
{
    struct pov_token token = pov_next(reader);
    if (pov_is(&token, symbol))
        return true;
    pov_unexpected(reader, &token, (char[4]){'\'', (char)symbol, '\'', '\0'});
    return false;
}

void pov_skip_block(struct pov_reader *reader)
{
    for (size_t depth = 1; depth > 0;) {
        struct pov_token token = pov_next(reader);
        if (token.kind == POV_END) {
            pov_unexpected(reader, &token, "'}'");
            return;
        }
        depth += pov_is(&token, '{');
        depth -= pov_is(&token, '}');
    }
}

void pov_skip_braces(struct pov_reader *reader)
{
    if (pov_accept(reader, '{'))
        pov_skip_block(reader);
}
