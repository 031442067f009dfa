/* arithmetic.c: recursive descent, evaluating while it reads.
 *
 * No tree is built: an expression is used once. Every rule returns a number; after the first error
 * all rules return at once, so that no rule checks the others. Depth is capped, since a scalar of
 * a million parentheses must not overflow the stack.
 */
#include "parser/arithmetic.h"

#include "base/text.h"
#include "parser/suggestion.h"
#include <math.h>
#include <stdbool.h>
#include <string.h>

#define DEEPEST_EXPRESSION 64
#define LONGEST_WORD 64
#define MOST_ARGUMENTS 2
#define PI 3.14159265358979323846

struct expression {
    const char *text;
    size_t at;
    int depth;
    bool failed;
    size_t failed_at;
    struct error *error;
};

static double radians(double degrees_)
{
    return degrees_ * (PI / 180);
}

static double degrees(double radians_)
{
    return radians_ * (180 / PI);
}

/* One of `unary` and `binary` is set. */
static const struct function {
    const char *name;
    double (*unary)(double);
    double (*binary)(double, double);
} functions[] = {{"sqrt", sqrt, NULL},       {"sin", sin, NULL},  {"cos", cos, NULL},
                 {"tan", tan, NULL},         {"abs", fabs, NULL}, {"radians", radians, NULL},
                 {"degrees", degrees, NULL}, {"min", NULL, fmin}, {"max", NULL, fmax}};
#define FUNCTION_COUNT (sizeof functions / sizeof functions[0])

static double read_sum(struct expression *expression);

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
           strchr(" \t\n", expression->text[expression->at]))
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

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static bool is_letter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

static size_t number_length(const char *text)
{
    size_t n = 0;
    while (is_digit(text[n]) || text[n] == '.')
        n++;
    if (text[n] == 'e' || text[n] == 'E') {
        size_t exponent = n + 1;
        if (text[exponent] == '+' || text[exponent] == '-')
            exponent++;
        while (is_digit(text[exponent]))
            n = ++exponent;
    }
    return n;
}

static double read_number(struct expression *expression)
{
    const char *start = expression->text + expression->at;
    size_t length = number_length(start);
    char number[LONGEST_WORD + 1] = {0};
    double value;
    if (length <= LONGEST_WORD)
        memcpy(number, start, length);
    if (!text_to_number(number, &value))
        return fail(expression, expression->at, "this is not a number");
    expression->at += length;
    return value;
}

static double apply(struct expression *expression, const struct function *function, size_t at)
{
    double arguments[MOST_ARGUMENTS];
    size_t count = 0, wanted = function->binary ? 2 : 1;
    expect(expression, '(');
    do {
        double value = read_sum(expression);
        if (count < MOST_ARGUMENTS)
            arguments[count] = value;
        count++;
    } while (accept(expression, ','));
    expect(expression, ')');
    if (count != wanted && fail_at(expression, at))
        error_set(expression->error, PS_ERROR_INVALID, "%s takes %zu argument%s, got %zu",
                  function->name, wanted, wanted == 1 ? "" : "s", count);
    if (expression->failed)
        return 0;
    double value = function->binary ? function->binary(arguments[0], arguments[1])
                                    : function->unary(arguments[0]);
    return finite_or_fail(expression, at, value);
}

static double fail_unknown(struct expression *expression, size_t at, const char *word)
{
    struct suggestion suggestion = suggestion_start(word);
    suggestion_consider(&suggestion, "pi");
    for (size_t i = 0; i < FUNCTION_COUNT; i++)
        suggestion_consider(&suggestion, functions[i].name);
    if (fail_at(expression, at)) {
        char hint[SUGGESTION_TEXT];
        suggestion_text(&suggestion, hint);
        error_set(expression->error, PS_ERROR_INVALID, "unknown name '%s' in arithmetic%s", word,
                  hint);
    }
    return 0;
}

static double read_word(struct expression *expression)
{
    size_t start = expression->at, length = 0;
    char word[LONGEST_WORD + 1] = {0};
    while (is_letter(expression->text[expression->at])) {
        if (length < LONGEST_WORD)
            word[length++] = expression->text[expression->at];
        expression->at++;
    }
    if (strcmp(word, "pi") == 0)
        return PI;
    for (size_t i = 0; i < FUNCTION_COUNT; i++)
        if (strcmp(word, functions[i].name) == 0)
            return apply(expression, &functions[i], start);
    return fail_unknown(expression, start, word);
}

static double read_primary(struct expression *expression)
{
    char next = peek(expression);
    if (is_digit(next) || next == '.')
        return read_number(expression);
    if (is_letter(next))
        return read_word(expression);
    if (!accept(expression, '('))
        return fail_unexpected(expression, "a number");
    double value = read_sum(expression);
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

ps_result arithmetic_evaluate(const char *text, double *value, size_t *position,
                              struct error *error)
{
    struct expression expression = {.text = text, .error = error};
    double result = read_sum(&expression);
    if (peek(&expression) != '\0')
        fail_unexpected(&expression, "an operator");
    if (expression.failed) {
        *position = expression.failed_at;
        return PS_ERROR_INVALID;
    }
    *value = result;
    return PS_OK;
}
