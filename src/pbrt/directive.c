/* directive.c: finds directives by their words, and what they take; see directive.h and
 * parser.h. */
#include "pbrt/directive.h"

#include "base/suggestion.h"
#include <stdlib.h>
#include <string.h>

void call_stop(const struct call *call, const char *message)
{
    importer_error(call->importer, call->origin, call->width, "%s: %s", call->word, message);
    call->importer->stopped = true;
}

bool call_numbers(const struct call *call, double *numbers, size_t count)
{
    struct token *token = &call->parser->token;
    bool opened = token->kind == TOKEN_OPEN;
    if (opened)
        parser_advance(call->parser);
    for (size_t i = 0; i < count; i++, parser_advance(call->parser)) {
        numbers[i] = token->number;
        if (token->kind == TOKEN_NUMBER && token->number >= -1e30 && token->number <= 1e30)
            continue;
        importer_error(call->importer, &token->origin, token->width,
                       "%s: expected %zu numbers, got %zu", call->word, count, i);
        call->importer->stopped = true;
        return false;
    }
    if (!opened)
        return true;
    if (token->kind != TOKEN_CLOSE) {
        importer_error(call->importer, &token->origin, token->width,
                       "%s: expected ] behind %zu numbers", call->word, count);
        call->importer->stopped = true;
        return false;
    }
    parser_advance(call->parser);
    return true;
}

char *call_text(const struct call *call)
{
    struct token *token = &call->parser->token;
    if (token->kind != TOKEN_STRING) {
        importer_error(call->importer, &token->origin, token->width,
                       "%s: expected a text in quotes", call->word);
        call->importer->stopped = true;
        return NULL;
    }
    char *text = strdup(token->text);
    if (!text)
        importer_no_memory(call->importer);
    else
        parser_advance(call->parser);
    return text;
}

bool call_statement(const struct call *call, bool has_kind, struct statement *statement)
{
    struct parser *parser = call->parser;
    *statement = (struct statement){.directive = call->word,
                                    .textures = call->importer->texture_count,
                                    .origin = *call->origin,
                                    .width = call->width};
    if (has_kind) {
        statement->kind = call_text(call);
        if (!statement->kind)
            return false;
    }
    /* The parameters' lookahead is that of the file: an included one may end behind them. */
    struct parser_file *file = &parser->files[parser->depth - 1];
    if (!statement_read(call->importer, &file->lexer, &parser->token, statement)) {
        call->importer->stopped = true;
        statement_release(statement);
        return false;
    }
    if (parser->token.kind == TOKEN_END && parser->depth > 1)
        parser_advance(parser);
    return true;
}

static const struct directive_table *const tables[] = {
    &directives_of_transforms, &directives_of_levels, &directives_of_statements};

#define TABLE_COUNT (sizeof tables / sizeof tables[0])

static const struct directive *find(const char *word)
{
    for (size_t i = 0; i < TABLE_COUNT; i++)
        for (size_t j = 0; j < tables[i]->count; j++)
            if (strcmp(tables[i]->rows[j].word, word) == 0)
                return &tables[i]->rows[j];
    return NULL;
}

void directive_suggest(const char *word, char *text)
{
    struct suggestion suggestion = suggestion_start(word);
    for (size_t i = 0; i < TABLE_COUNT; i++)
        for (size_t j = 0; j < tables[i]->count; j++)
            suggestion_consider(&suggestion, tables[i]->rows[j].word);
    suggestion_text(&suggestion, text);
}

bool directive_run(struct parser *parser, const char *word, const struct origin *origin, int width)
{
    struct importer *importer = parser->importer;
    const struct directive *directive = find(word);
    if (!directive)
        return false;
    const struct call call = {parser, importer, directive->word, origin, width};
    if (directive->where == (importer->in_world ? BEFORE_WORLD : IN_WORLD)) {
        call_stop(&call, importer->in_world ? "it must stand before WorldBegin"
                                            : "it must stand behind WorldBegin");
        return true;
    }
    parser_advance(parser);
    directive->run(&call);
    return true;
}
