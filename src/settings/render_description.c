#include "settings/render_description.h"

#include <stdlib.h>

void strategy_choice_release(struct strategy_choice *choice)
{
    for (size_t i = 0; i < choice->parameter_count; i++) {
        free(choice->parameters[i].key);
        free(choice->parameters[i].value);
    }
    free(choice->parameters);
    free(choice->name);
    *choice = (struct strategy_choice){0};
}

void render_description_release(struct render_description *description)
{
    for (int kind = 0; kind < PS_KINDS; kind++)
        strategy_choice_release(&description->strategies[kind]);
}
