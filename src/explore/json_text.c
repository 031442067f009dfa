#include "explore/json_text.h"

#include "parser/yaml/encoding.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

char *json_text_copy(const struct json *string)
{
    char *copy = json_unescape(&string->text);
    if (copy && !utf8_is_valid(copy, strlen(copy))) {
        free(copy);
        return NULL;
    }
    return copy;
}

/* With U+FFFD, three bytes, for each byte that is no part of a character; NULL when out of
 * memory. */
static char *mended(const char *text)
{
    size_t left = strlen(text);
    char *copy = malloc(3 * left + 1), *out = copy;
    while (copy && left > 0) {
        uint32_t code;
        size_t bytes = utf8_decode(text, left, &code);
        memcpy(out, bytes > 0 ? text : "\xef\xbf\xbd", bytes > 0 ? bytes : 3);
        out += bytes > 0 ? bytes : 3;
        text += bytes > 0 ? bytes : 1;
        left -= bytes > 0 ? bytes : 1;
    }
    if (copy)
        *out = '\0';
    return copy;
}

void json_text_write(struct json_writer *writer, const char *text)
{
    if (!text) {
        json_writer_raw(writer, "null");
    } else if (utf8_is_valid(text, strlen(text))) {
        json_writer_text(writer, text);
    } else {
        char *copy = mended(text);
        json_writer_text(writer, copy ? copy : "");
        free(copy);
    }
}

void json_text_write_of(struct json_writer *writer, const char *key, const char *text)
{
    json_writer_key(writer, key);
    json_text_write(writer, text);
}

void json_number_write(struct json_writer *writer, double value)
{
    if (isfinite(value))
        json_writer_number(writer, value);
    else
        json_writer_raw(writer, "null");
}

void json_number_write_of(struct json_writer *writer, const char *key, double value)
{
    json_writer_key(writer, key);
    json_number_write(writer, value);
}

bool json_buffer_begin(struct json_buffer *buffer)
{
    *buffer = (struct json_buffer){.writer = {.compact = true}};
    buffer->writer.stream = open_memstream(&buffer->text, &buffer->length);
    return buffer->writer.stream != NULL;
}

char *json_buffer_end(struct json_buffer *buffer)
{
    if (fclose(buffer->writer.stream) == 0)
        return buffer->text;
    free(buffer->text);
    return NULL;
}
