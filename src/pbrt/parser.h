/* parser.h: reads the directives of a pbrt scene, in their order, and has each carried out. */
#ifndef PBRT_PARSER_H
#define PBRT_PARSER_H

#include "pbrt/importer.h"

/* Files that include each other, and includes in all: as many as psd(5) allows. */
#define PARSER_DEEPEST_INCLUDE 16
#define PARSER_MOST_INCLUDES 4096

/* Where the parser stands: files that include each other, the innermost last. */
struct parser_file {
    struct lexer lexer;
    struct file_text *text; /* owned; NULL of the main file */
    bool is_import;         /* its changes of the graphics state end with it */
};

struct parser {
    struct importer *importer;
    struct parser_file files[PARSER_DEEPEST_INCLUDE + 1];
    size_t depth; /* files that are open */
    size_t includes;
    size_t imports_ended; /* of which the state is still to be restored */
    struct token token;   /* the next one */
};

/* Reads the whole text; `name` stands in messages, and outlives the importer's sink. Errors are in
 * the sink. */
void parser_read(struct importer *importer, const char *name, const char *text, size_t length);

/* Tokens of the open files, as one stream. */
void parser_advance(struct parser *parser);
/* Opens a file that goes before what follows. What an imported one does to the graphics state ends
 * with it. */
void parser_include(struct parser *parser, const char *name, bool is_import,
                    const struct origin *origin, int width);

/* Carries out a directive, whose word was read. False: there is no such directive. */
bool directive_run(struct parser *parser, const char *word, const struct origin *origin, int width);

/* The nearest name of a directive, for a message: SUGGESTION_TEXT characters. */
void directive_suggest(const char *word, char *text);

#endif
