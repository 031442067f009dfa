/* function.c: a table. Angles are in radians, as in C and POV-Ray. */
#include "parser/language/function.h"

#include "base/sample.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

#define PI 3.14159265358979323846
#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static double radians(double degrees_)
{
    return degrees_ * (PI / 180);
}

static double degrees(double radians_)
{
    return radians_ * (180 / PI);
}

/* With the sign of the divisor, so that patterns go on below 0; fmod's has that of x. */
static double modulo(double x, double y)
{
    return x - y * floor(x / y);
}

static double smallest(const double *arguments, size_t count)
{
    double value = arguments[0];
    for (size_t i = 1; i < count; i++)
        value = fmin(value, arguments[i]);
    return value;
}

static double largest(const double *arguments, size_t count)
{
    double value = arguments[0];
    for (size_t i = 1; i < count; i++)
        value = fmax(value, arguments[i]);
    return value;
}

static double clamp(const double *arguments, size_t count)
{
    (void)count;
    return fmin(fmax(arguments[0], arguments[1]), arguments[2]);
}

/* Noise without a state, so that a number does not depend on what was asked for before. */
static double noise(const double *arguments, size_t count)
{
    uint32_t hash = (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        double argument = arguments[i] + 0.0; /* -0 is 0 */
        uint64_t bits;
        memcpy(&bits, &argument, sizeof bits);
        hash = sample_hash(bits ^ (uint64_t)hash * UINT64_C(0x9e3779b97f4a7c15));
    }
    return hash * 0x1p-32;
}

static const struct function functions[] = {
    {"sqrt", 1, 1, sqrt, NULL, NULL},       {"abs", 1, 1, fabs, NULL, NULL},
    {"sin", 1, 1, sin, NULL, NULL},         {"cos", 1, 1, cos, NULL, NULL},
    {"tan", 1, 1, tan, NULL, NULL},         {"asin", 1, 1, asin, NULL, NULL},
    {"acos", 1, 1, acos, NULL, NULL},       {"atan", 1, 1, atan, NULL, NULL},
    {"atan2", 2, 2, NULL, atan2, NULL},     {"radians", 1, 1, radians, NULL, NULL},
    {"degrees", 1, 1, degrees, NULL, NULL}, {"exp", 1, 1, exp, NULL, NULL},
    {"ln", 1, 1, log, NULL, NULL},          {"pow", 2, 2, NULL, pow, NULL},
    {"floor", 1, 1, floor, NULL, NULL},     {"ceil", 1, 1, ceil, NULL, NULL},
    {"round", 1, 1, round, NULL, NULL},     {"mod", 2, 2, NULL, modulo, NULL},
    {"min", 2, 8, NULL, NULL, smallest},    {"max", 2, 8, NULL, NULL, largest},
    {"clamp", 3, 3, NULL, NULL, clamp},     {"rand", 1, 3, NULL, NULL, noise},
};

const struct function *function_find(const char *name)
{
    for (size_t i = 0; i < COUNT(functions); i++)
        if (strcmp(name, functions[i].name) == 0)
            return &functions[i];
    return NULL;
}

double function_apply(const struct function *function, const double *arguments, size_t count)
{
    if (function->unary)
        return function->unary(arguments[0]);
    if (function->binary)
        return function->binary(arguments[0], arguments[1]);
    return function->any(arguments, count);
}

void function_suggest(struct suggestion *suggestion)
{
    for (size_t i = 0; i < COUNT(functions); i++)
        suggestion_consider(suggestion, functions[i].name);
}
