/* choice.c: choices of strategies as the command line writes them. */
#include "render/settings.h"

#include <stdlib.h>
#include <string.h>

static ps_result add_parameter(struct strategy_choice *choice, char *key, char *value,
                               struct error *error)
{
    size_t bytes = (choice->parameter_count + 1) * sizeof *choice->parameters;
    struct parameter_text *parameters = key && value ? realloc(choice->parameters, bytes) : NULL;
    if (!parameters) {
        free(key);
        free(value);
        return error_memory(error, bytes, "parameters");
    }
    choice->parameters = parameters;
    parameters[choice->parameter_count++] = (struct parameter_text){.key = key, .value = value};
    return PS_OK;
}

/* Length of the text up to the next comma outside of brackets. */
static size_t item_length(const char *text)
{
    size_t length = 0;
    int depth = 0;
    for (; text[length] && (text[length] != ',' || depth > 0); length++)
        depth += (text[length] == '[') - (text[length] == ']');
    return length;
}

static ps_result parse_parameter(const char *text, size_t length, struct strategy_choice *choice,
                                 struct error *error)
{
    const char *equals = memchr(text, '=', length);
    if (!equals || equals == text)
        return error_set(error, PS_ERROR_INVALID, "expected KEY=VALUE, got '%.*s'",
                         (int)(length < 80 ? length : 80), text);
    size_t key_length = (size_t)(equals - text);
    for (size_t i = 0; i < choice->parameter_count; i++)
        if (strlen(choice->parameters[i].key) == key_length &&
            strncmp(choice->parameters[i].key, text, key_length) == 0)
            return error_set(error, PS_ERROR_INVALID, "parameter '%s' is given twice",
                             choice->parameters[i].key);
    return add_parameter(choice, strndup(text, key_length),
                         strndup(equals + 1, length - key_length - 1), error);
}

ps_result settings_parse_choice(const char *text, struct strategy_choice *choice,
                                struct error *error)
{
    size_t name_length = strcspn(text, ":");
    *choice = (struct strategy_choice){.name = NULL};
    if (name_length == 0)
        return error_set(error, PS_ERROR_INVALID, "expected NAME[:KEY=VALUE,...], got '%.80s'",
                         text);
    choice->name = strndup(text, name_length);
    ps_result result = choice->name ? PS_OK : error_memory(error, name_length, "a name");
    const char *rest = text + name_length;
    while (*rest && result == PS_OK) {
        size_t length = item_length(rest + 1);
        result = parse_parameter(rest + 1, length, choice, error);
        rest += 1 + length;
    }
    if (result != PS_OK)
        strategy_choice_release(choice);
    return result;
}

/* Moves a parameter over the one of the same key, or to the end. */
static ps_result override_parameter(struct strategy_choice *base, struct parameter_text *parameter,
                                    struct error *error)
{
    for (size_t i = 0; i < base->parameter_count; i++)
        if (strcmp(base->parameters[i].key, parameter->key) == 0) {
            free(base->parameters[i].key);
            free(base->parameters[i].value);
            base->parameters[i] = *parameter;
            *parameter = (struct parameter_text){.key = NULL};
            return PS_OK;
        }
    char *key = parameter->key, *value = parameter->value;
    *parameter = (struct parameter_text){.key = NULL};
    return add_parameter(base, key, value, error);
}

ps_result settings_override(struct strategy_choice *base, struct strategy_choice *choice,
                            struct error *error)
{
    ps_result result = PS_OK;
    if (base->name && strcmp(base->name, choice->name) == 0) {
        for (size_t i = 0; i < choice->parameter_count && result == PS_OK; i++)
            result = override_parameter(base, &choice->parameters[i], error);
        strategy_choice_release(choice);
        return result;
    }
    strategy_choice_release(base);
    *base = *choice;
    *choice = (struct strategy_choice){.name = NULL};
    return result;
}
