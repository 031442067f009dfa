/* json_writer.h: writes JSON, indented or in one line, piece by piece.
 *
 * A key goes before each value in an object; pieces must fit together, which is the caller's duty.
 */
#ifndef BASE_JSON_WRITER_H
#define BASE_JSON_WRITER_H

#include <stdbool.h>
#include <stdio.h>

/* Zeroed but for the stream, and `compact`: at the start. Errors of the stream are the caller's to
 * find. */
struct json_writer {
    FILE *stream;
    int depth;
    bool follows; /* on an item, so that a comma is due */
    bool keyed;   /* a key waits for its value */
    bool compact; /* in one line */
};

/* `bracket` is { or [. */
void json_writer_open(struct json_writer *writer, char bracket);
void json_writer_close(struct json_writer *writer, char bracket);
void json_writer_key(struct json_writer *writer, const char *key);
void json_writer_text(struct json_writer *writer, const char *text);
/* Something that is JSON already. */
void json_writer_raw(struct json_writer *writer, const char *text);
void json_writer_number(struct json_writer *writer, double value);

/* A key with its value. */
void json_writer_text_of(struct json_writer *writer, const char *key, const char *text);
void json_writer_raw_of(struct json_writer *writer, const char *key, const char *text);
void json_writer_number_of(struct json_writer *writer, const char *key, double value);
void json_writer_open_of(struct json_writer *writer, const char *key, char bracket);

#endif
