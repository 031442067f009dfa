#include "parser/yaml/quote.h"

#include "parser/yaml/encoding.h"
#include <assert.h>
#include <stdbool.h>
#include <string.h>

/* What encoding_check refuses, and breaks of lines, which would be folded. */
static bool needs_escape(uint32_t code)
{
    return code < 0x20 || (code >= 0x7f && code < 0xa0) || code == 0x2028 || code == 0x2029 ||
           code == 0xfeff || code == 0xfffe || code == 0xffff;
}

void yaml_quote(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (size_t left = strlen(text), used; left > 0; left -= used, text += used) {
        uint32_t code = 0;
        used = utf8_decode(text, left, &code);
        assert(used > 0);
        if (code == '"' || code == '\\')
            fputc('\\', stream);
        if (needs_escape(code))
            fprintf(stream, "\\u%04X", (unsigned)code);
        else
            fwrite(text, 1, used, stream);
    }
    fputc('"', stream);
}
