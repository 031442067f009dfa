/* arithmetic.c: recursive descent, evaluating while it reads.
 *
 * No tree is built: an expression is used once. Every rule returns a number; after the first error
 * all rules return at once, so that no rule checks the others. Depth is capped, since a scalar of
 * a million parentheses must not overflow the stack.
 */
#include "parser/language/arithmetic.h"

#include "base/text.h"
#include "parser/language/function.h"
#include "parser/language/word.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEEPEST_EXPRESSION 64
#define LONGEST_NUMBER 64
#define PI 3.14159265358979323846

struct expression {
    const char *text;
    const struct arithmetic_names *names;
    size_t at;
    int depth;
    bool failed;
    size_t failed_at;
    struct error *error;
};

static double read_value(struct expression *expression);

/* Keeps the first error only; the message must have been written if this returns true. */
static bool fail_at(struct expression *expression, size_t at)
{
    if (expression->failed)
        return false;
    expression->failed = true;
    expression->failed_at = at;
    return true;
}

static double fail(struct expression *expression, size_t at, const char *message)
{
    if (fail_at(expression, at))
        error_set(expression->error, PS_ERROR_INVALID, "%s", message);
    return 0;
}

static double finite_or_fail(struct expression *expression, size_t at, double value)
{
    return isfinite(value) ? value : fail(expression, at, "the result is not a finite number");
}

static char peek(struct expression *expression)
{
    while (!expression->failed && expression->text[expression->at] != '\0' &&
           strchr(WORD_BLANKS, expression->text[expression->at]))
        expression->at++;
    return expression->failed ? '\0' : expression->text[expression->at];
}

static bool accept(struct expression *expression, char character)
{
    if (peek(expression) != character || character == '\0')
        return false;
    expression->at++;
    return true;
}

static double fail_unexpected(struct expression *expression, const char *expected)
{
    peek(expression);
    size_t at = expression->at;
    char got[2] = {expression->text[at], '\0'};
    if (!fail_at(expression, at))
        return 0;
    if (got[0] == '\0')
        error_set(expression->error, PS_ERROR_INVALID, "expected %s at the end", expected);
    else
        error_set(expression->error, PS_ERROR_INVALID, "expected %s, got '%s'", expected, got);
    return 0;
}

static void expect(struct expression *expression, char character)
{
    char quoted[4] = {'\'', character, '\'', '\0'};
    if (!accept(expression, character))
        fail_unexpected(expression, quoted);
}

static double read_number(struct expression *expression)
{
    const char *start = expression->text + expression->at;
    size_t length = word_number_length(start);
    char number[LONGEST_NUMBER + 1] = {0};
    double value;
    if (length <= LONGEST_NUMBER)
        memcpy(number, start, length);
    if (!text_to_number(number, &value))
        return fail(expression, expression->at, "this is not a number");
    expression->at += length;
    return value;
}

static void fail_count(struct expression *expression, size_t at, const struct function *function,
                       size_t count)
{
    char most[32] = "";
    if (function->most > function->fewest)
        snprintf(most, sizeof most, " to %zu", function->most);
    if (fail_at(expression, at))
        error_set(expression->error, PS_ERROR_INVALID, "%s takes %zu%s argument%s, got %zu",
                  function->name, function->fewest, most, function->most == 1 ? "" : "s", count);
}

static double apply(struct expression *expression, const struct function *function, size_t at)
{
    double arguments[FUNCTION_MOST_ARGUMENTS];
    size_t count = 0;
    expect(expression, '(');
    do {
        double value = read_value(expression);
        if (count < FUNCTION_MOST_ARGUMENTS)
            arguments[count] = value;
        count++;
    } while (accept(expression, ','));
    expect(expression, ')');
    if (count < function->fewest || count > function->most)
        fail_count(expression, at, function, count);
    if (expression->failed)
        return 0;
    return finite_or_fail(expression, at, function_apply(function, arguments, count));
}

static void suggest(const struct expression *expression, struct suggestion *suggestion)
{
    if (expression->names)
        expression->names->suggest(expression->names->user, suggestion);
    suggestion_consider(suggestion, "pi");
    function_suggest(suggestion);
}

static double fail_unknown(struct expression *expression, size_t at, const char *word)
{
    struct suggestion suggestion = suggestion_start(word);
    char hint[SUGGESTION_TEXT];
    if (!fail_at(expression, at))
        return 0;
    if (word[1]) /* any name is near to a single letter */
        suggest(expression, &suggestion);
    suggestion_text(&suggestion, hint);
    error_set(expression->error, PS_ERROR_INVALID, "unknown name '%s' in arithmetic%s", word, hint);
    return 0;
}

/* Reads ".x" to ".z", or ".r" to ".b"; -1: there is none. */
static int read_component(struct expression *expression)
{
    static const char components[] = "xyzrgb";
    const char *text = expression->text + expression->at;
    if (text[0] != '.')
        return -1;
    const char *found = text[1] ? strchr(components, text[1]) : NULL;
    if (!found || word_is_letter(text[2]) || word_is_digit(text[2])) {
        fail(expression, expression->at + 1, "expected x, y, z, r, g or b after the '.'");
        return -1;
    }
    expression->at += 2;
    return (int)(found - components) % 3;
}

static double read_name(struct expression *expression, size_t at, const char *word)
{
    const struct arithmetic_names *names = expression->names;
    double value = 0;
    struct error error;
    error.text[0] = '\0';
    if (!names)
        return fail_unknown(expression, at, word);
    int component = read_component(expression);
    if (expression->failed)
        return 0;
    enum arithmetic_found found = names->find(names->user, word, component, &value, &error);
    if (found == ARITHMETIC_UNKNOWN)
        return fail_unknown(expression, at, word);
    return found == ARITHMETIC_FOUND ? value : fail(expression, at, error.text);
}

static double read_word(struct expression *expression)
{
    char word[WORD_NAME];
    size_t start = expression->at, length = word_name_length(expression->text + start);
    word_copy_name(expression->text + start, length, word);
    expression->at += length;
    if (strcmp(word, "pi") == 0)
        return PI;
    const struct function *function = function_find(word);
    return function ? apply(expression, function, start) : read_name(expression, start, word);
}

static double read_primary(struct expression *expression)
{
    char next = peek(expression);
    if (word_is_digit(next) || next == '.')
        return read_number(expression);
    if (word_is_letter(next))
        return read_word(expression);
    if (!accept(expression, '('))
        return fail_unexpected(expression, "a number");
    double value = read_value(expression);
    expect(expression, ')');
    return value;
}

static double read_unary(struct expression *expression)
{
    if (++expression->depth > DEEPEST_EXPRESSION)
        fail(expression, expression->at, "the arithmetic is nested too deeply");
    double value = 0;
    if (accept(expression, '-')) {
        value = -read_unary(expression);
    } else if (accept(expression, '+')) {
        value = read_unary(expression);
    } else if (!expression->failed) {
        value = read_primary(expression);
        if (accept(expression, '^')) {
            size_t at = expression->at - 1;
            value = finite_or_fail(expression, at, pow(value, read_unary(expression)));
        }
    }
    expression->depth--;
    return value;
}

static double read_product(struct expression *expression)
{
    double value = read_unary(expression);
    for (;;) {
        if (accept(expression, '*')) {
            size_t at = expression->at - 1;
            value = finite_or_fail(expression, at, value * read_unary(expression));
        } else if (accept(expression, '/')) {
            size_t at = expression->at - 1;
            double divisor = read_unary(expression);
            value = divisor == 0 ? fail(expression, at, "division by zero")
                                 : finite_or_fail(expression, at, value / divisor);
        } else {
            return value;
        }
    }
}

static double read_sum(struct expression *expression)
{
    double value = read_product(expression);
    for (;;) {
        size_t at = expression->at;
        if (accept(expression, '+'))
            value += read_product(expression);
        else if (accept(expression, '-'))
            value -= read_product(expression);
        else
            return value;
        value = finite_or_fail(expression, at, value);
    }
}

static bool accept_text(struct expression *expression, const char *text)
{
    peek(expression);
    size_t length = strlen(text);
    if (expression->failed || strncmp(expression->text + expression->at, text, length) != 0)
        return false;
    expression->at += length;
    return true;
}

static double read_value(struct expression *expression)
{
    double value = read_sum(expression);
    if (accept_text(expression, "<="))
        return value <= read_sum(expression);
    if (accept_text(expression, ">="))
        return value >= read_sum(expression);
    if (accept_text(expression, "=="))
        return value == read_sum(expression);
    if (accept_text(expression, "!="))
        return value != read_sum(expression);
    if (accept(expression, '<'))
        return value < read_sum(expression);
    if (accept(expression, '>'))
        return value > read_sum(expression);
    return value;
}

ps_result arithmetic_evaluate(const char *text, const struct arithmetic_names *names, double *value,
                              size_t *position, struct error *error)
{
    struct expression expression = {.text = text, .names = names, .error = error};
    double result = read_value(&expression);
    if (peek(&expression) != '\0')
        fail_unexpected(&expression, "an operator");
    if (expression.failed) {
        *position = expression.failed_at;
        return PS_ERROR_INVALID;
    }
    *value = result;
    return PS_OK;
}

bool arithmetic_is_reserved(const char *name)
{
    return strcmp(name, "pi") == 0 || function_find(name);
}
