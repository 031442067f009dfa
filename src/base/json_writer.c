/* json_writer.c: see json_writer.h. */
#include "base/json_writer.h"

#include "base/text.h"
#include <assert.h>

static void start_item(struct json_writer *writer)
{
    if (!writer->keyed) {
        if (writer->follows)
            fputc(',', writer->stream);
        if (writer->depth > 0 && !writer->compact)
            fprintf(writer->stream, "\n%*s", 2 * writer->depth, "");
    }
    writer->follows = true;
    writer->keyed = false;
}

static void put_text(struct json_writer *writer, const char *text)
{
    fputc('"', writer->stream);
    for (const char *p = text; *p; p++) {
        if ((unsigned char)*p < 0x20)
            fprintf(writer->stream, "\\u%04x", (unsigned)*p);
        else
            fprintf(writer->stream, *p == '"' || *p == '\\' ? "\\%c" : "%c", *p);
    }
    fputc('"', writer->stream);
}

void json_writer_open(struct json_writer *writer, char bracket)
{
    start_item(writer);
    fputc(bracket, writer->stream);
    writer->depth++;
    writer->follows = false;
}

void json_writer_close(struct json_writer *writer, char bracket)
{
    assert(writer->depth > 0 && !writer->keyed);
    writer->depth--;
    if (writer->follows && !writer->compact)
        fprintf(writer->stream, "\n%*s", 2 * writer->depth, "");
    fputc(bracket == '{' ? '}' : ']', writer->stream);
    writer->follows = true;
}

void json_writer_key(struct json_writer *writer, const char *key)
{
    assert(writer->depth > 0 && !writer->keyed);
    start_item(writer);
    put_text(writer, key);
    fputs(writer->compact ? ":" : ": ", writer->stream);
    writer->keyed = true;
}

void json_writer_text(struct json_writer *writer, const char *text)
{
    start_item(writer);
    put_text(writer, text);
}

void json_writer_raw(struct json_writer *writer, const char *text)
{
    start_item(writer);
    fputs(text, writer->stream);
}

void json_writer_number(struct json_writer *writer, double value)
{
    char text[40];
    text_from_number(value, text, sizeof text);
    json_writer_raw(writer, text);
}

void json_writer_text_of(struct json_writer *writer, const char *key, const char *text)
{
    json_writer_key(writer, key);
    json_writer_text(writer, text);
}

void json_writer_raw_of(struct json_writer *writer, const char *key, const char *text)
{
    json_writer_key(writer, key);
    json_writer_raw(writer, text);
}

void json_writer_number_of(struct json_writer *writer, const char *key, double value)
{
    json_writer_key(writer, key);
    json_writer_number(writer, value);
}

void json_writer_open_of(struct json_writer *writer, const char *key, char bracket)
{
    json_writer_key(writer, key);
    json_writer_open(writer, bracket);
}
