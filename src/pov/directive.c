/* directive.c: executes directives (reference of POV-Ray 3.7, "Language Directives"); see reader.h.
 *
 * A branch that is not taken is skipped token by token, up to the #else or #end that belongs to it.
 * A loop goes back in the list of tokens.
 */
#include "pov/expression.h"
#include "pov/object.h"

#include <math.h>
#include <string.h>

static struct pov_frame *top(struct pov_reader *reader)
{
    return &reader->frames[reader->frame_count - 1];
}

/* --- skipping
 * ----------------------------------------------------------------------------------- */

static bool opens_block(uint32_t word)
{
    return word == POV_if || word == POV_ifdef || word == POV_ifndef || word == POV_while ||
           word == POV_for || word == POV_switch || word == POV_macro;
}

static bool is_branch(uint32_t word)
{
    return word == POV_else || word == POV_elseif || word == POV_case || word == POV_range;
}

/* Skips to the #end that closes `levels` blocks, or, where that is asked for, to a branch of the
 * innermost; returns that directive. POV_END: reported. */
static struct pov_token skip(struct pov_reader *reader, const struct pov_token *from, size_t levels,
                             bool to_branch)
{
    struct pov_frame *frame = top(reader);
    for (;;) {
        struct pov_token token = frame->tokens->list[frame->at];
        size_t most = reader->options->most_steps ? reader->options->most_steps : POV_MOST_STEPS;
        if (token.kind == POV_END || ++reader->steps > most) {
            pov_error(reader, from,
                      token.kind == POV_END ? "the file ends before the #end of this"
                                            : "too many tokens were read");
            token.kind = POV_END;
            return token;
        }
        frame->at++;
        if (token.kind != POV_DIRECTIVE)
            continue;
        if (opens_block(token.word))
            levels++;
        else if ((token.word == POV_end && --levels == 0) ||
                 (to_branch && levels == 1 && is_branch(token.word)))
            return token;
    }
}

static void push_block(struct pov_reader *reader, const struct pov_token *token,
                       struct pov_block block)
{
    if (reader->block_count == POV_MOST_BLOCKS) {
        pov_error(reader, token, "conditions and loops are in each other more than %d deep",
                  POV_MOST_BLOCKS);
        return;
    }
    block.token = *token;
    reader->blocks[reader->block_count++] = block;
}

/* --- conditions
 * --------------------------------------------------------------------------------- */

/* "(NAME)", also of an element. */
static bool read_is_defined(struct pov_reader *reader)
{
    pov_expect(reader, '(');
    struct pov_token name = pov_next_raw(reader);
    if (name.kind != POV_WORD)
        pov_unexpected(reader, &name, "a name");
    struct pov_value *value = name.kind == POV_WORD ? pov_lookup(reader, name.word) : NULL;
    if (value && value->kind == POV_VALUE_ARRAY)
        value = pov_element(reader, &name, value);
    pov_expect(reader, ')');
    return value && value->kind != POV_VALUE_NONE;
}

static bool read_condition_of(struct pov_reader *reader, uint32_t word)
{
    if (word == POV_ifdef || word == POV_ifndef)
        return read_is_defined(reader) == (word == POV_ifdef);
    return pov_read_parenthesis(reader) != 0.0;
}

static void begin_if(struct pov_reader *reader, const struct pov_token *token)
{
    bool holds = read_condition_of(reader, token->word);
    while (!holds && !reader->stopped) {
        struct pov_token branch = skip(reader, token, 1, true);
        if (branch.kind == POV_END || branch.word == POV_end)
            return;
        holds = branch.word == POV_else ||
                (branch.word == POV_elseif && pov_read_parenthesis(reader) != 0.0);
    }
    push_block(reader, token, (struct pov_block){.kind = POV_BLOCK_IF});
}

static void begin_switch(struct pov_reader *reader, const struct pov_token *token)
{
    double value = pov_read_parenthesis(reader);
    bool found = false;
    while (!found && !reader->stopped) {
        struct pov_token branch = skip(reader, token, 1, true);
        if (branch.kind == POV_END || branch.word == POV_end)
            return;
        if (branch.word == POV_else) {
            found = true;
        } else if (branch.word == POV_case) {
            found = fabs(value - pov_read_parenthesis(reader)) <= 1e-10;
        } else {
            pov_expect(reader, '(');
            double low = pov_read_condition(reader).v[0];
            pov_expect(reader, ',');
            double high = pov_read_condition(reader).v[0];
            pov_expect(reader, ')');
            found = value >= low && value <= high;
        }
    }
    push_block(reader, token, (struct pov_block){.kind = POV_BLOCK_SWITCH});
}

/* #else, #elseif, #case and #range that a taken branch runs into. */
static void meet_branch(struct pov_reader *reader, const struct pov_token *token)
{
    const struct pov_block *block =
        reader->block_count > top(reader)->blocks ? &reader->blocks[reader->block_count - 1] : NULL;
    bool of_switch = token->word == POV_case || token->word == POV_range;
    if (!block || (block->kind != POV_BLOCK_IF && block->kind != POV_BLOCK_SWITCH) ||
        (block->kind == POV_BLOCK_IF && of_switch)) {
        pov_error(reader, token, "#%s without the directive that it belongs to",
                  pov_text(reader, token->word));
    } else if (block->kind == POV_BLOCK_IF) {
        if (skip(reader, token, 1, false).kind != POV_END)
            reader->block_count--;
    } else if (of_switch) { /* falls through */
        pov_expect(reader, '(');
        pov_read_condition(reader);
        if (token->word == POV_range && pov_accept(reader, ','))
            pov_read_condition(reader);
        pov_expect(reader, ')');
    }
}

/* --- loops
 * -------------------------------------------------------------------------------------- */

static void begin_while(struct pov_reader *reader, const struct pov_token *token)
{
    size_t start = top(reader)->at;
    if (pov_read_parenthesis(reader) != 0.0)
        push_block(reader, token, (struct pov_block){.kind = POV_BLOCK_WHILE, .start = start});
    else if (!reader->stopped)
        skip(reader, token, 1, false);
}

static bool is_beyond(const struct pov_block *block)
{
    double at = block->index->kind == POV_VALUE_NUMBER ? block->index->number.v[0] : NAN;
    return !(block->step > 0.0 ? at < block->last + 1e-10 : at > block->last - 1e-10);
}

static void begin_for(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_block block = {.kind = POV_BLOCK_FOR, .step = 1.0};
    pov_expect(reader, '(');
    struct pov_token name = pov_next_raw(reader);
    if (name.kind != POV_WORD || name.word < POV_WORD_COUNT)
        pov_unexpected(reader, &name, "a name");
    pov_expect(reader, ',');
    double first = pov_read_condition(reader).v[0];
    pov_expect(reader, ',');
    block.last = pov_read_condition(reader).v[0];
    if (pov_accept(reader, ','))
        block.step = pov_read_condition(reader).v[0];
    pov_expect(reader, ')');
    if (block.step == 0.0)
        pov_error(reader, token, "#for: the step is 0");
    if (reader->stopped)
        return;
    block.index = pov_lookup(reader, name.word);
    if (!block.index)
        block.index = pov_bind(reader, name.word, true, NULL);
    if (!block.index)
        return;
    *block.index = pov_float(first);
    block.start = top(reader)->at;
    if (is_beyond(&block))
        skip(reader, token, 1, false);
    else
        push_block(reader, token, block);
}

/* #end, of whatever is open. */
static void end_block(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_frame *frame = top(reader);
    if (reader->block_count == frame->blocks) {
        if (frame->is_file)
            pov_error(reader, token, "#end without the directive that it ends");
        else
            pov_pop_frame(reader);
        return;
    }
    struct pov_block *block = &reader->blocks[reader->block_count - 1];
    size_t behind = frame->at;
    bool again = false;
    if (block->kind == POV_BLOCK_WHILE) {
        frame->at = block->start;
        again = pov_read_parenthesis(reader) != 0.0;
    } else if (block->kind == POV_BLOCK_FOR) {
        if (block->index->kind == POV_VALUE_NUMBER)
            block->index->number.v[0] += block->step;
        frame->at = block->start;
        again = !is_beyond(block);
    }
    if (again || reader->stopped)
        return;
    frame->at = behind;
    reader->block_count--;
}

/* #break: of the innermost loop or switch. */
static void leave_block(struct pov_reader *reader, const struct pov_token *token)
{
    size_t levels = 0, least = top(reader)->blocks;
    while (reader->block_count > least) {
        enum pov_block_kind kind = reader->blocks[--reader->block_count].kind;
        levels++;
        if (kind != POV_BLOCK_IF) {
            skip(reader, token, levels, false);
            return;
        }
    }
    pov_error(reader, token, "#break outside of #while, #for and #switch");
}

/* --- names
 * -------------------------------------------------------------------------------------- */

static struct pov_value read_declared_value(struct pov_reader *reader)
{
    size_t frames = reader->declaring, blocks = reader->declaring_blocks;
    reader->declaring = reader->frame_count;
    reader->declaring_blocks = reader->block_count;
    struct pov_value value = pov_read_value(reader);
    reader->declaring = frames;
    reader->declaring_blocks = blocks;
    return value;
}

/* A semicolon in this place, not one that comes after other directives. */
static void skip_semicolon(struct pov_reader *reader)
{
    if (!pov_is(pov_peek(reader), ';'))
        return;
    if (!reader->has_pushed)
        top(reader)->at++;
    reader->has_pushed = false;
}

/* #declare and #local. */
static void declare(struct pov_reader *reader, const struct pov_token *token)
{
    struct pov_token name = pov_next_raw(reader);
    size_t frames = reader->frame_count;
    bool local = token->word == POV_local;
    if (pov_is_word(&name, POV_deprecated)) { /* deprecated [once] ["why"] NAME */
        name = pov_next_raw(reader);
        if (pov_is_word(&name, POV_once))
            name = pov_next_raw(reader);
        if (name.kind == POV_STRING)
            name = pov_next_raw(reader);
    }
    if (name.kind != POV_WORD || name.word < POV_WORD_COUNT) {
        pov_unexpected(reader, &name, "a name that is not reserved");
        return;
    }
    struct pov_value *place = pov_lookup(reader, name.word), *element = NULL;
    if (place && place->kind == POV_VALUE_ARRAY) {
        element = pov_element(reader, &name, place);
        element = element == place ? NULL : element;
    }
    struct pov_array *array =
        element ? place->array : NULL; /* a macro in the value may make the name another thing */
    pov_expect(reader, '=');
    struct pov_value value = read_declared_value(reader);
    if (reader->stopped || value.kind == POV_VALUE_NONE)
        return;
    if (element) {
        *element = value;
        array->held = value.kind;
    } else {
        bool known = place && (!local || pov_is_own(reader, name.word));
        place = known ? pov_lookup(reader, name.word) : pov_bind(reader, name.word, local, NULL);
        if (place)
            *place = value;
    }
    if (reader->frame_count == frames)
        skip_semicolon(reader);
}

static void undefine(struct pov_reader *reader, const struct pov_token *token)
{
    (void)token;
    struct pov_token name = pov_next_raw(reader);
    if (name.kind == POV_WORD)
        pov_unbind(reader, name.word);
    else
        pov_unexpected(reader, &name, "a name");
}

/* --- the rest
 * ----------------------------------------------------------------------------------- */

static void include(struct pov_reader *reader, const struct pov_token *token)
{
    const char *name = pov_read_string(reader);
    if (name && !reader->stopped)
        pov_include(reader, token, name);
}

/* Nothing behind the number is looked at: a directive there may ask for the version. */
static void set_version(struct pov_reader *reader, const struct pov_token *token)
{
    (void)token;
    struct pov_token next = pov_next(reader);
    double version = next.number;
    if (next.kind != POV_NUMBER) {
        pov_unread(reader, next);
        version = pov_read_float(reader);
    }
    if (version > 0.0)
        reader->version = version;
    skip_semicolon(reader);
}

/* #debug, #warning, #error, #render, #statistics. */
static void say(struct pov_reader *reader, const struct pov_token *token)
{
    const char *text = pov_read_string(reader);
    if (!text)
        return;
    if (token->word == POV_error)
        pov_error(reader, token, "#error: %.300s", text);
    else if (token->word == POV_warning)
        pov_warn(reader, token, "#warning: %.300s", text);
}

static void refuse_files(struct pov_reader *reader, const struct pov_token *token)
{
    pov_error(reader, token, "#%s: a scene that is imported can't read and write files of data",
              pov_text(reader, token->word));
}

static void read_default(struct pov_reader *reader, const struct pov_token *token)
{
    (void)token;
    pov_read_default(reader);
}

static const struct {
    uint32_t word;
    void (*execute)(struct pov_reader *reader, const struct pov_token *token);
} directives[] = {
    {POV_if, begin_if},          {POV_ifdef, begin_if},
    {POV_ifndef, begin_if},      {POV_switch, begin_switch},
    {POV_else, meet_branch},     {POV_elseif, meet_branch},
    {POV_case, meet_branch},     {POV_range, meet_branch},
    {POV_while, begin_while},    {POV_for, begin_for},
    {POV_end, end_block},        {POV_break, leave_block},
    {POV_declare, declare},      {POV_local, declare},
    {POV_undef, undefine},       {POV_macro, pov_define_macro},
    {POV_include, include},      {POV_version, set_version},
    {POV_default, read_default}, {POV_debug, say},
    {POV_warning, say},          {POV_error, say},
    {POV_render, say},           {POV_statistics, say},
    {POV_fopen, refuse_files},   {POV_fclose, refuse_files},
    {POV_read, refuse_files},    {POV_write, refuse_files},
};

static void execute(struct pov_reader *reader, const struct pov_token *token)
{
    for (size_t i = 0; i < sizeof directives / sizeof directives[0]; i++)
        if (directives[i].word == token->word) {
            directives[i].execute(reader, token);
            return;
        }
    pov_error(reader, token, "there is no directive #%.60s", pov_text(reader, token->word));
}

/* Whether a directive ends the value that a #declare of the same level reads. */
static bool ends_value(const struct pov_reader *reader, uint32_t word)
{
    if (reader->declaring != reader->frame_count)
        return false;
    if (word == POV_if || word == POV_ifdef || word == POV_ifndef || word == POV_switch)
        return false;
    if (word == POV_end || word == POV_break || is_branch(word))
        return reader->block_count <= reader->declaring_blocks;
    return true;
}

bool pov_directive(struct pov_reader *reader, const struct pov_token *token)
{
    if (ends_value(reader, token->word))
        return false;
    size_t frames = reader->declaring, blocks = reader->declaring_blocks;
    bool raw = reader->raw;
    if (!pov_enter(reader, token))
        return true;
    reader->declaring = 0;
    reader->raw = false;
    execute(reader, token);
    reader->declaring = frames;
    reader->declaring_blocks = blocks;
    reader->raw = raw;
    pov_leave(reader);
    return true;
}
