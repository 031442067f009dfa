#include "plugin/kind.h"

#include "settings/kinds.h"
#include <string.h>

#define KIND_ROW(kind_, name_, summary_, default_) [kind_] = {name_, summary_, default_},
const struct kind kinds[PS_KINDS] = {STRATEGY_KINDS(KIND_ROW)};

ps_kind kind_parse(const char *text, const char **rest)
{
    size_t length = strcspn(text, "=");
    int kind = 0;
    while (kind < PS_KINDS &&
           (strlen(kinds[kind].name) != length || strncmp(kinds[kind].name, text, length) != 0))
        kind++;
    *rest = text[length] ? text + length + 1 : NULL;
    return (ps_kind)kind;
}
