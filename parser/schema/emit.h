/* emit.h: writes JSON, indented, piece by piece.
 *
 * A key goes before each value in an object; pieces must fit together, which is the caller's duty.
 */
#ifndef PARSER_SCHEMA_EMIT_H
#define PARSER_SCHEMA_EMIT_H

#include <stdbool.h>
#include <stdio.h>

/* Zeroed but for the stream: at the start. Errors of the stream are the caller's to find. */
struct emitter {
    FILE *stream;
    int depth;
    bool follows; /* on an item, so that a comma is due */
    bool keyed;   /* a key waits for its value */
};

/* `bracket` is { or [. */
void emit_open(struct emitter *emitter, char bracket);
void emit_close(struct emitter *emitter, char bracket);
void emit_key(struct emitter *emitter, const char *key);
void emit_text(struct emitter *emitter, const char *text);
/* Something that is JSON already. */
void emit_raw(struct emitter *emitter, const char *text);
void emit_number(struct emitter *emitter, double value);

/* A key with its value. */
void emit_text_of(struct emitter *emitter, const char *key, const char *text);
void emit_raw_of(struct emitter *emitter, const char *key, const char *text);
void emit_number_of(struct emitter *emitter, const char *key, double value);
void emit_open_of(struct emitter *emitter, const char *key, char bracket);

#endif
