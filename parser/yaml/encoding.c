/* encoding.c: decodes UTF-8, and judges a text before libyaml sees it.
 *
 * libyaml finds bad bytes too, but reports them by byte offset, without a line; and it compares
 * each %TAG directive with all others, so that a file of nothing else takes hours. One pass over
 * the text ahead of it settles both.
 */
#include "parser/yaml/encoding.h"

#include <string.h>

/* A scene needs none, or %YAML. */
#define MOST_DIRECTIVES 16

static const struct {
    uint8_t mask, lead;
    uint32_t smallest; /* anything below is an overlong form */
} forms[] = {{0x80, 0x00, 0}, {0xe0, 0xc0, 0x80}, {0xf0, 0xe0, 0x800}, {0xf8, 0xf0, 0x10000}};

size_t utf8_decode(const char *text, size_t length, uint32_t *code)
{
    const unsigned char *bytes = (const unsigned char *)text;
    for (size_t n = 1; n <= 4 && n <= length; n++) {
        if ((bytes[0] & forms[n - 1].mask) != forms[n - 1].lead)
            continue;
        uint32_t value = bytes[0] & (uint8_t)~forms[n - 1].mask;
        for (size_t i = 1; i < n; i++) {
            if ((bytes[i] & 0xc0) != 0x80)
                return 0;
            value = value << 6 | (bytes[i] & 0x3fu);
        }
        if (value < forms[n - 1].smallest || value > 0x10ffff ||
            (value >= 0xd800 && value <= 0xdfff))
            return 0;
        *code = value;
        return n;
    }
    return 0;
}

bool utf8_is_valid(const char *text, size_t length)
{
    size_t used = 1;
    for (size_t at = 0; at < length && used > 0; at += used) {
        uint32_t code;
        used = utf8_decode(text + at, length - at, &code);
    }
    return used > 0;
}

size_t line_break_length(const char *text, size_t length)
{
    uint32_t code;
    if (length == 0 || !strchr("\n\r\xc2\xe2", text[0]))
        return 0; /* decided without decoding: this runs over whole files */
    size_t bytes = utf8_decode(text, length, &code);
    if (bytes == 0)
        return 0;
    if (code == '\r')
        return length > 1 && text[1] == '\n' ? 2 : 1;
    return code == '\n' || code == 0x85 || code == 0x2028 || code == 0x2029 ? bytes : 0;
}

void encoding_advance(const char *text, size_t length, int *line, int *column)
{
    for (size_t at = 0; at < length;) {
        size_t line_break = line_break_length(text + at, length - at);
        uint32_t code;
        size_t bytes = line_break > 0 ? line_break : utf8_decode(text + at, length - at, &code);
        at += bytes > 0 ? bytes : 1;
        *line += line_break > 0;
        *column = line_break > 0 ? 1 : *column + 1;
    }
}

size_t byte_order_mark_length(const char *text, size_t length)
{
    return length >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
}

static bool is_allowed(uint32_t code)
{
    if (code < 0xa0)
        return code == '\t' || code == '\n' || code == '\r' || code == 0x85 ||
               (code >= 0x20 && code <= 0x7e);
    return code != 0xfeff && code != 0xfffe && code != 0xffff;
}

static ps_result reject_character(struct diagnostics *sink, const struct origin *origin,
                                  size_t bytes, unsigned char byte, uint32_t code)
{
    if (bytes == 0)
        diagnostics_report(sink, SEVERITY_ERROR, origin, 1,
                           "byte 0x%02x is not UTF-8; save the scene as UTF-8", byte);
    else
        diagnostics_report(sink, SEVERITY_ERROR, origin, 1, "character U+%04X is not allowed",
                           (unsigned)code);
    return PS_ERROR_INVALID;
}

ps_result encoding_check(const char *file, const char *text, size_t length,
                         struct diagnostics *sink)
{
    struct origin origin = {.file = file, .line = 1, .column = 1};
    size_t directives = 0;
    for (size_t at = byte_order_mark_length(text, length); at < length;) {
        uint32_t code = 0;
        size_t bytes = utf8_decode(text + at, length - at, &code);
        if (bytes == 0 || !is_allowed(code))
            return reject_character(sink, &origin, bytes, (unsigned char)text[at], code);
        if (code == '%' && origin.column == 1 && ++directives > MOST_DIRECTIVES) {
            diagnostics_report(sink, SEVERITY_ERROR, &origin, 1, "more than %d directives ('%%')",
                               MOST_DIRECTIVES);
            return PS_ERROR_INVALID;
        }
        size_t line_break = line_break_length(text + at, length - at);
        origin.line += line_break > 0;
        origin.column = line_break > 0 ? 1 : origin.column + 1;
        at += line_break > 0 ? line_break : bytes;
    }
    return PS_OK;
}
