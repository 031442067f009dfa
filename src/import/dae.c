/* dae.c: the tags of COLLADA, without any meaning. */
#include "import/format.h"

#include <stdlib.h>
#include <string.h>

static ps_result complain(const struct mesh_file *file, const char *what, struct error *error)
{
    return error_set(error, PS_ERROR_INVALID, "%s: COLLADA: %s", file->path, what);
}

static bool starts(const char *at, const char *text)
{
    return strncmp(at, text, strlen(text)) == 0;
}

/* What follows `end` in the text; the end of all where it is missing. */
static const char *skip_past(const char *at, const char *end)
{
    const char *found = strstr(at, end);
    return found ? found + strlen(end) : at + strlen(at);
}

/* From behind a "<" to behind its ">", which may also stand in quotes. */
static const char *skip_tag(const char *at)
{
    char quote = '\0';
    for (; *at; at++) {
        if (quote)
            quote = *at == quote ? '\0' : quote;
        else if (*at == '"' || *at == '\'')
            quote = *at;
        else if (*at == '>')
            return at + 1;
    }
    return at;
}

static bool announces_too_much(const struct mesh_file *file, const char *tag, const char *end)
{
    for (const char *at = tag; at + 7 < end; at++)
        if (starts(at, "count=") && strtoull(at + 7, NULL, 10) > file->length)
            return true;
    return false;
}

ps_result dae_check(const struct mesh_file *file, struct error *error)
{
    int depth = 0;
    for (const char *at = skip_past(file->bytes, "<"); *at; at = skip_past(at, "<")) {
        if (starts(at, "!--")) {
            at = skip_past(at, "-->");
            continue;
        }
        if (starts(at, "![CDATA[")) {
            at = skip_past(at, "]]>");
            continue;
        }
        const char *tag = at;
        at = skip_tag(at);
        if (announces_too_much(file, tag, at))
            return complain(file, "an array of more numbers than there are", error);
        if (*tag == '/')
            depth--;
        else if (*tag != '?' && *tag != '!' && !(at - tag >= 2 && at[-2] == '/'))
            depth++;
        if (depth > MESH_NESTING)
            return complain(file, "nested more than 256 deep", error);
    }
    return PS_OK;
}
