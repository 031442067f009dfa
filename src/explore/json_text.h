/* json_text.h: texts from and to JSON, which is UTF-8 whatever files are called; and JSON in
 * memory. */
#ifndef EXPLORE_JSON_TEXT_H
#define EXPLORE_JSON_TEXT_H

#include "base/json_reader.h"
#include "base/json_writer.h"

/* A string's characters, to be freed; NULL where that is no UTF-8, holds NUL, or memory is out. */
char *json_text_copy(const struct json *string);

/* Writes a text, in which what is not UTF-8 becomes U+FFFD. NULL becomes null. */
void json_text_write(struct json_writer *writer, const char *text);
void json_text_write_of(struct json_writer *writer, const char *key, const char *text);

/* Writes a number, or null where it is not finite. */
void json_number_write(struct json_writer *writer, double value);
void json_number_write_of(struct json_writer *writer, const char *key, double value);

/* JSON that grows in memory, in one line. */
struct json_buffer {
    struct json_writer writer; /* its stream is NULL where memory is out */
    char *text;
    size_t length;
};

/* False when out of memory. Ended by json_buffer_end, in any case where it returned true. */
bool json_buffer_begin(struct json_buffer *buffer);

/* The text, to be freed; NULL when out of memory. */
char *json_buffer_end(struct json_buffer *buffer);

#endif
