/* json_rewrite.c: a tree that was read, as text again, in two walks: one measures, one writes. */
#include "base/json_reader.h"

#include <stdlib.h>
#include <string.h>

struct writer {
    char *text; /* NULL: measure only */
    size_t length;
};

static void put(struct writer *writer, const char *bytes, size_t length)
{
    if (writer->text && length > 0)
        memcpy(writer->text + writer->length, bytes, length);
    writer->length += length;
}

static void put_text(struct writer *writer, const char *text)
{
    put(writer, text, strlen(text));
}

static void put_string(struct writer *writer, const struct json_text *text)
{
    put_text(writer, "\"");
    put(writer, text->start, text->length);
    put_text(writer, "\"");
}

static void put_value(struct writer *writer, const struct json *value);

static void put_items(struct writer *writer, const struct json *value)
{
    bool is_object = value->kind == JSON_OBJECT, first = true;
    put_text(writer, is_object ? "{" : "[");
    for (const struct json *item = value->items; item; item = item->next) {
        if (item->hidden)
            continue;
        if (!first)
            put_text(writer, ",");
        first = false;
        if (is_object) {
            put_string(writer, &item->key);
            put_text(writer, ":");
        }
        put_value(writer, item);
    }
    if (value->appended) {
        if (!first)
            put_text(writer, ",");
        put_text(writer, value->appended);
    }
    put_text(writer, is_object ? "}" : "]");
}

static void put_value(struct writer *writer, const struct json *value)
{
    if (value->replacement)
        put_text(writer, value->replacement);
    else if (value->kind == JSON_OBJECT || value->kind == JSON_ARRAY)
        put_items(writer, value);
    else if (value->kind == JSON_STRING)
        put_string(writer, &value->text);
    else
        put(writer, value->text.start, value->text.length);
}

char *json_rewrite(const struct json *root, size_t *length)
{
    struct writer writer = {0};
    put_value(&writer, root);
    writer.text = malloc(writer.length + 1);
    if (!writer.text)
        return NULL;
    writer.length = 0;
    put_value(&writer, root);
    writer.text[writer.length] = '\0';
    *length = writer.length;
    return writer.text;
}
