/* emit.c: see emit.h. */
#include "parser/schema/emit.h"

#include "base/text.h"

static void start_item(struct emitter *emitter)
{
    if (!emitter->keyed) {
        if (emitter->follows)
            fputc(',', emitter->stream);
        if (emitter->depth > 0)
            fprintf(emitter->stream, "\n%*s", 2 * emitter->depth, "");
    }
    emitter->follows = true;
    emitter->keyed = false;
}

static void put_text(struct emitter *emitter, const char *text)
{
    fputc('"', emitter->stream);
    for (const char *p = text; *p; p++) {
        if ((unsigned char)*p < 0x20)
            fprintf(emitter->stream, "\\u%04x", (unsigned)*p);
        else
            fprintf(emitter->stream, *p == '"' || *p == '\\' ? "\\%c" : "%c", *p);
    }
    fputc('"', emitter->stream);
}

void emit_open(struct emitter *emitter, char bracket)
{
    start_item(emitter);
    fputc(bracket, emitter->stream);
    emitter->depth++;
    emitter->follows = false;
}

void emit_close(struct emitter *emitter, char bracket)
{
    emitter->depth--;
    if (emitter->follows)
        fprintf(emitter->stream, "\n%*s", 2 * emitter->depth, "");
    fputc(bracket == '{' ? '}' : ']', emitter->stream);
    emitter->follows = true;
}

void emit_key(struct emitter *emitter, const char *key)
{
    start_item(emitter);
    put_text(emitter, key);
    fputs(": ", emitter->stream);
    emitter->keyed = true;
}

void emit_text(struct emitter *emitter, const char *text)
{
    start_item(emitter);
    put_text(emitter, text);
}

void emit_raw(struct emitter *emitter, const char *text)
{
    start_item(emitter);
    fputs(text, emitter->stream);
}

void emit_number(struct emitter *emitter, double value)
{
    char text[40];
    text_from_number(value, text, sizeof text);
    emit_raw(emitter, text);
}

void emit_text_of(struct emitter *emitter, const char *key, const char *text)
{
    emit_key(emitter, key);
    emit_text(emitter, text);
}

void emit_raw_of(struct emitter *emitter, const char *key, const char *text)
{
    emit_key(emitter, key);
    emit_raw(emitter, text);
}

void emit_number_of(struct emitter *emitter, const char *key, double value)
{
    emit_key(emitter, key);
    emit_number(emitter, value);
}

void emit_open_of(struct emitter *emitter, const char *key, char bracket)
{
    emit_key(emitter, key);
    emit_open(emitter, bracket);
}
