/* parser.c: the stream of tokens, over files that include each other; see parser.h. */
#include "pbrt/parser.h"

#include "base/file.h"
#include "base/suggestion.h"
#include "base/text.h"
#include "pbrt/state.h"
#include <stdlib.h>
#include <string.h>

static void close_file(struct parser *parser)
{
    struct parser_file *file = &parser->files[--parser->depth];
    lexer_release(&file->lexer);
    parser->imports_ended += file->is_import;
    if (file->text)
        file_release(file->text);
    free(file->text);
}

/* At the end of a file goes on with the one that includes it. */
void parser_advance(struct parser *parser)
{
    while (true) {
        parser->token = lexer_next(&parser->files[parser->depth - 1].lexer);
        if (parser->token.kind != TOKEN_END || parser->depth == 1)
            return;
        close_file(parser);
    }
}

static bool is_open(const struct parser *parser, const struct file_text *text)
{
    for (size_t i = 1; i < parser->depth; i++)
        if (parser->files[i].text->device == text->device &&
            parser->files[i].text->serial == text->serial)
            return true;
    const struct pbrt_options *options = parser->importer->options;
    return options->device == text->device && options->serial == text->serial && text->serial != 0;
}

/* NULL: reported. */
static struct file_text *read_file(struct parser *parser, const char *path,
                                   const struct origin *origin, int width)
{
    struct importer *importer = parser->importer;
    struct file_text *text = calloc(1, sizeof *text);
    struct error error;
    if (!text) {
        importer_no_memory(importer);
        return NULL;
    }
    ps_result result =
        file_read_regular(path, importer->options->folder, FILE_LARGEST, text, &error);
    if (result == PS_OK && !is_open(parser, text))
        return text;
    if (result == PS_OK)
        importer_error(importer, origin, width, "'%.200s' includes itself", path);
    else
        importer_error(importer, origin, width, "%.200s: %s", path, error.text);
    file_release(text);
    free(text);
    return NULL;
}

void parser_include(struct parser *parser, const char *name, bool is_import,
                    const struct origin *origin, int width)
{
    struct importer *importer = parser->importer;
    importer->stopped = true; /* unless all goes well: what follows would mean nothing */
    if (text_has_suffix(name, ".gz")) {
        importer_error(importer, origin, width,
                       "'%.200s' is compressed: unpack it, and include what comes out", name);
        return;
    }
    if (parser->depth > PARSER_DEEPEST_INCLUDE || parser->includes == PARSER_MOST_INCLUDES) {
        importer_error(importer, origin, width,
                       "files include each other more than %d deep, or %d times in all",
                       PARSER_DEEPEST_INCLUDE, PARSER_MOST_INCLUDES);
        return;
    }
    char *path = importer_file_path(importer, name);
    struct file_text *text = path ? read_file(parser, path, origin, width) : NULL;
    const char *shown =
        text ? diagnostics_add_source(importer->sink, path, text->bytes, text->length) : NULL;
    if (text && (!shown || !diagnostics_set_includer(importer->sink, shown, origin)))
        importer_no_memory(importer);
    free(path);
    if (!text || importer->no_memory) {
        if (text)
            file_release(text);
        free(text);
        return;
    }
    importer->stopped = is_import && !state_push(importer, MARK_IMPORT, origin, width);
    parser->includes++;
    parser->files[parser->depth++] =
        (struct parser_file){lexer_start(shown, text->bytes, text->length), text, is_import};
}

/* False: nothing can be read after this. */
static bool read_directive(struct parser *parser)
{
    struct importer *importer = parser->importer;
    struct token *token = &parser->token;
    char word[64], hint[SUGGESTION_TEXT];
    if (token->kind != TOKEN_WORD) {
        importer_error(importer, &token->origin, token->width, "%s",
                       token->kind == TOKEN_BAD ? token->text
                                                : "expected a directive such as Shape");
        return false;
    }
    snprintf(word, sizeof word, "%s", token->text);
    struct origin origin = token->origin;
    int width = token->width;
    if (directive_run(parser, word, &origin, width))
        return !importer->stopped;
    directive_suggest(word, hint);
    importer_error(importer, &origin, width, "unknown directive '%s'%s", word, hint);
    return false;
}

/* After the last directive of an imported file, whose end was seen before that was carried out. */
static void restore_state(struct parser *parser)
{
    const struct token *token = &parser->token;
    for (; parser->imports_ended > 0 && !parser->importer->stopped; parser->imports_ended--)
        state_pop(parser->importer, MARK_IMPORT, &token->origin, token->width);
}

void parser_read(struct importer *importer, const char *name, const char *text, size_t length)
{
    struct parser *parser = calloc(1, sizeof *parser);
    if (!parser) {
        importer_no_memory(importer);
        return;
    }
    parser->importer = importer;
    parser->files[0] = (struct parser_file){.lexer = lexer_start(name, text, length)};
    parser->depth = 1;
    parser_advance(parser);
    while (parser->token.kind != TOKEN_END && read_directive(parser))
        restore_state(parser);
    while (parser->depth > 0)
        close_file(parser);
    free(parser);
}
