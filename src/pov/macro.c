/* macro.c: macros and functions (reference of POV-Ray 3.7, "User Defined Macros", "User-Defined
 * Functions"); see reader.h.
 *
 * A macro's body is read where it is called. So is a function's: its numbers are computed from the
 * tokens each time.
 */
#include "pov/expression.h"

#include <string.h>

/* "(a, b, ...)" */
static void read_parameters(struct pov_reader *reader, struct pov_macro *macro)
{
    bool raw = reader->raw;
    reader->raw = true; /* also what names a macro elsewhere */
    pov_expect(reader, '(');
    while (!pov_accept(reader, ')') && !reader->stopped) {
        struct pov_token name = pov_next_raw(reader);
        if (name.kind != POV_WORD) {
            pov_unexpected(reader, &name, "the name of a parameter");
        } else if (macro->parameter_count == POV_PARAMETERS) {
            pov_error(reader, &name, "a macro has at most %d parameters", POV_PARAMETERS);
        } else {
            macro->parameters[macro->parameter_count++] = name.word;
        }
        pov_skip_comma(reader);
    }
    reader->raw = raw;
}

/* Moves to behind the #end that closes the macro. */
static void skip_macro(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_frame *frame = &reader->frames[reader->frame_count - 1];
    for (size_t levels = 1; levels > 0; frame->at++) {
        const struct pov_token *at = &frame->tokens->list[frame->at];
        if (at->kind == POV_END) {
            pov_error(reader, token, "the file ends before the #end of this");
            return;
        }
        if (at->kind != POV_DIRECTIVE)
            continue;
        switch (at->word) {
        case POV_if:
        case POV_ifdef:
        case POV_ifndef:
        case POV_while:
        case POV_for:
        case POV_switch:
        case POV_macro:
            levels++;
            break;
        case POV_end:
            levels--;
            break;
        default:
            break;
        }
        reader->steps++;
    }
}

void pov_define_macro(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_macro macro = {0};
    struct pov_token name = pov_next_raw(reader);
    if (name.kind != POV_WORD || name.word < POV_WORD_COUNT) {
        pov_unexpected(reader, &name, "a name that is not reserved");
        return;
    }
    macro.name = name.word;
    read_parameters(reader, &macro);
    if (reader->stopped)
        return;
    const struct pov_frame *frame = &reader->frames[reader->frame_count - 1];
    macro.tokens = frame->tokens;
    macro.start = frame->at;
    skip_macro(reader, token);
    struct pov_macro *kept = pov_copy(reader, &macro, sizeof macro);
    struct pov_value *place = kept ? pov_lookup(reader, macro.name) : NULL;
    if (kept && !place)
        place = pov_bind(reader, macro.name, false, NULL);
    if (place)
        *place = (struct pov_value){.kind = POV_VALUE_MACRO, .macro = kept};
}

/* --- arguments
 * ------------------------------------------------------------------------------------ */

struct argument {
    struct pov_value value, *shared; /* shared: of a name that is the whole argument */
};

static bool argument_ends(const struct pov_reader *reader)
{
    const struct pov_token *next = pov_peek(reader);
    return pov_is(next, ',') || pov_is(next, ')');
}

static bool read_argument(struct pov_reader *reader, struct argument *argument)
{
    struct pov_token token = pov_next(reader);
    *argument = (struct argument){0};
    if (token.kind == POV_WORD && argument_ends(reader))
        argument->shared = pov_lookup(reader, token.word);
    if (!argument->shared) {
        pov_unread(reader, token);
        argument->value = pov_read_value(reader);
    }
    return !reader->stopped;
}

/* Reads "(...)"; false: reported. */
static bool read_arguments(struct pov_reader *reader, const struct pov_token *token,
                           const struct pov_macro *macro, struct argument *arguments)
{
    pov_expect(reader, '(');
    for (int i = 0; i < macro->parameter_count && !reader->stopped; i++) {
        if (i > 0 && !pov_accept(reader, ',')) {
            pov_error(reader, token, "%.60s needs %d arguments, here are %d",
                      pov_text(reader, token->word), macro->parameter_count, i);
            return false;
        }
        if (!read_argument(reader, &arguments[i]))
            return false;
    }
    return pov_expect(reader, ')');
}

/* A level with the arguments by the parameters' names. False: reported. */
static bool begin_call(struct pov_reader *reader, const struct pov_token *token,
                       const struct pov_macro *macro, const struct argument *arguments)
{
    if (!pov_push_frame(reader, token, macro->tokens, macro->start, false))
        return false;
    for (int i = 0; i < macro->parameter_count; i++) {
        struct pov_value *place = pov_bind(reader, macro->parameters[i], true, arguments[i].shared);
        if (!place)
            return false;
        if (!arguments[i].shared)
            *place = arguments[i].value;
    }
    return true;
}

void pov_call_macro(struct pov_reader *reader, const struct pov_token *token,
                    const struct pov_macro *macro)
{
    size_t frames = reader->declaring;
    struct argument arguments[POV_PARAMETERS];
    if (!pov_enter(reader, token))
        return;
    reader->declaring = 0;
    if (read_arguments(reader, token, macro, arguments))
        begin_call(reader, token, macro, arguments);
    reader->declaring = frames;
    pov_leave(reader);
}

/* --- functions
 * ------------------------------------------------------------------------------------ */

struct pov_value pov_define_function(struct pov_reader *reader)
{
    static const uint32_t usual[] = {POV_x, POV_y, POV_z};
    struct pov_macro function = {0};
    struct pov_token next = pov_next(reader);
    pov_unread(reader, next);
    if (pov_is(&next, '(')) {
        read_parameters(reader, &function);
    } else {
        function.parameter_count = 3;
        memcpy(function.parameters, usual, sizeof usual);
    }
    if (!pov_is(&next, '{') && !pov_is(&next, '('))
        while (!pov_is(&next, '{') && next.kind != POV_END) { /* function WIDTH, HEIGHT { ... } */
            next = pov_next(reader);
            function.unsupported = true;
        }
    else
        pov_expect(reader, '{');
    const struct pov_frame *frame = &reader->frames[reader->frame_count - 1];
    function.tokens = frame->tokens;
    function.start = frame->at;
    const struct pov_token *first = &frame->tokens->list[frame->at];
    function.unsupported = function.unsupported || pov_is_word(first, POV_internal) ||
                           !(pov_begins_number(reader, first) || first->kind == POV_WORD);
    bool raw = reader->raw;
    reader->raw = true;
    pov_skip_block(reader);
    reader->raw = raw;
    struct pov_macro *kept = pov_copy(reader, &function, sizeof function);
    return kept ? (struct pov_value){.kind = POV_VALUE_FUNCTION, .macro = kept}
                : (struct pov_value){0};
}

struct pov_value pov_call_function(struct pov_reader *reader, const struct pov_token *token,
                                   const struct pov_macro *function)
{
    struct pov_value result = pov_float(0.0);
    struct argument arguments[POV_PARAMETERS];
    if (!pov_enter(reader, token))
        return result;
    if (function->unsupported)
        pov_error(reader, token, "the function '%.60s' can't be computed here",
                  pov_text(reader, token->word));
    size_t frames = reader->declaring;
    reader->declaring = 0;
    if (!reader->stopped && read_arguments(reader, token, function, arguments) &&
        begin_call(reader, token, function, arguments)) {
        size_t level = reader->frame_count;
        result.number = pov_read_condition(reader);
        if (reader->frame_count != level)
            pov_error(reader, token, "a macro or function does not end where it began");
        pov_expect(reader, '}');
        if (!reader->stopped)
            pov_pop_frame(reader);
    }
    reader->declaring = frames;
    pov_leave(reader);
    return result;
}
