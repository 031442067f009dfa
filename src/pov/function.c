/* function.c: POV-Ray's functions that make numbers; see expression.h and the reference of POV-Ray
 * 3.7, "Float Expressions" and "Vector Expressions". */
#include "pov/expression.h"

#include "pov/object.h"
#include "writer/transform.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

/* --- of floats
 * ------------------------------------------------------------------------------------ */

static double degrees_of(double x)
{
    return x * 180.0 / PI;
}

static double radians_of(double x)
{
    return x * PI / 180.0;
}

static double truncated(double x)
{
    return trunc(x);
}

static double divided(double x, double y)
{
    return trunc(x / y);
}

static const struct {
    uint32_t word;
    double (*of_one)(double x);
    double (*of_two)(double x, double y);
} of_floats[] = {
    {POV_abs, fabs, NULL},      {POV_acos, acos, NULL},   {POV_acosh, acosh, NULL},
    {POV_asin, asin, NULL},     {POV_asinh, asinh, NULL}, {POV_atan, atan, NULL},
    {POV_atan2, NULL, atan2},   {POV_atanh, atanh, NULL}, {POV_ceil, ceil, NULL},
    {POV_cos, cos, NULL},       {POV_cosh, cosh, NULL},   {POV_degrees, degrees_of, NULL},
    {POV_div, NULL, divided},   {POV_exp, exp, NULL},     {POV_floor, floor, NULL},
    {POV_int, truncated, NULL}, {POV_ln, log, NULL},      {POV_log, log10, NULL},
    {POV_mod, NULL, fmod},      {POV_pow, NULL, pow},     {POV_radians, radians_of, NULL},
    {POV_sin, sin, NULL},       {POV_sinh, sinh, NULL},   {POV_sqrt, sqrt, NULL},
    {POV_tan, tan, NULL},       {POV_tanh, tanh, NULL},
};

#define OF_FLOATS (sizeof of_floats / sizeof of_floats[0])

static bool read_of_floats(struct pov_reader *reader, const struct pov_token *token, double *result)
{
    for (size_t i = 0; i < OF_FLOATS; i++) {
        if (of_floats[i].word != token->word)
            continue;
        pov_expect(reader, '(');
        double x = pov_read_condition(reader).v[0], y = 0.0;
        if (of_floats[i].of_two) {
            pov_expect(reader, ',');
            y = pov_read_condition(reader).v[0];
        }
        pov_expect(reader, ')');
        *result = of_floats[i].of_two ? of_floats[i].of_two(x, y) : of_floats[i].of_one(x);
        if (!isfinite(*result)) {
            pov_error(reader, token, "%s of these numbers is not a finite one",
                      pov_text(reader, token->word));
            *result = 0.0;
        }
        return true;
    }
    return false;
}

/* --- of vectors
 * ----------------------------------------------------------------------------------- */

/* vdot(a, b) and its like. */
static struct pov_value of_vectors(struct pov_reader *reader, uint32_t word)
{
    bool of_one = word == POV_vlength || word == POV_vnormalize;
    struct vector a, b = {0, 0, 0};
    pov_expect(reader, '(');
    a = pov_read_vector(reader);
    if (!of_one) {
        pov_expect(reader, ',');
        b = pov_read_vector(reader);
    }
    if (word == POV_vaxis_rotate) {
        struct transform turn = transform_identity;
        pov_expect(reader, ',');
        transform_rotate(pov_read_float(reader), b, &turn);
        a = transform_point(&turn, a);
    }
    pov_expect(reader, ')');
    switch (word) {
    case POV_vdot:
        return pov_float(vector_dot(a, b));
    case POV_vlength:
        return pov_float(vector_length(a));
    case POV_vcross:
        return pov_vector(vector_cross(a, b));
    case POV_vnormalize:
        return pov_vector(vector_unit(a));
    case POV_vrotate: {
        struct transform turn = pov_rotation(b);
        return pov_vector(transform_point(&turn, a));
    }
    default:
        return pov_vector(a);
    }
}

/* --- others
 * --------------------------------------------------------------------------------------- */

static double read_extreme(struct pov_reader *reader, bool largest)
{
    pov_expect(reader, '(');
    double result = pov_read_condition(reader).v[0];
    while (pov_accept(reader, ',')) {
        double other = pov_read_condition(reader).v[0];
        result = largest ? fmax(result, other) : fmin(result, other);
    }
    pov_expect(reader, ')');
    return result;
}

/* select(x, below 0, 0 [, above 0]) */
static double read_select(struct pov_reader *reader)
{
    double values[4];
    int count = 0;
    pov_expect(reader, '(');
    do
        values[count++] = pov_read_condition(reader).v[0];
    while (count < 4 && pov_accept(reader, ','));
    pov_expect(reader, ')');
    if (count < 3)
        return 0.0;
    return values[0] < 0.0 ? values[1] : values[0] == 0.0 || count < 4 ? values[2] : values[3];
}

double pov_random(uint32_t *stream)
{
    *stream = *stream * 1812433253u + 12345u;
    return (double)*stream / 4294967295.0;
}

static double read_seed(struct pov_reader *reader)
{
    double start = pov_read_parenthesis(reader);
    if (!pov_grow(reader, (void **)&reader->streams, &reader->stream_capacity,
                  reader->stream_count + 1, sizeof *reader->streams))
        return 0.0;
    reader->streams[reader->stream_count] = fabs(start) < 9e15 ? (uint32_t)(int64_t)start : 0;
    return (double)reader->stream_count++;
}

static double read_rand(struct pov_reader *reader, const struct pov_token *token)
{
    double stream = pov_read_parenthesis(reader);
    if (stream >= 0.0 && stream < (double)reader->stream_count)
        return pov_random(&reader->streams[(size_t)stream]);
    pov_error(reader, token, "rand: expected a value of seed(...)");
    return 0.0;
}

/* defined(NAME) */
static double read_defined(struct pov_reader *reader)
{
    pov_expect(reader, '(');
    struct pov_token name = pov_next_raw(reader);
    struct pov_value *value = name.kind == POV_WORD ? pov_lookup(reader, name.word) : NULL;
    if (value && value->kind == POV_VALUE_ARRAY)
        value = pov_element(reader, &name, value);
    pov_expect(reader, ')');
    return value && value->kind != POV_VALUE_NONE;
}

/* dimensions(ARRAY), dimension_size(ARRAY, i) */
static double read_dimensions(struct pov_reader *reader, const struct pov_token *token)
{
    double result = 0.0;
    pov_expect(reader, '(');
    struct pov_token name = pov_next_raw(reader);
    struct pov_value *value = name.kind == POV_WORD ? pov_lookup(reader, name.word) : NULL;
    value = value ? pov_element(reader, &name, value) : NULL;
    if (!value || value->kind != POV_VALUE_ARRAY) {
        pov_unexpected(reader, &name, "the name of an array");
        return 0.0;
    }
    const struct pov_array *array =
        value->array; /* as it is now: a macro in what follows may make the name another thing */
    result = array->dimensions;
    if (token->word == POV_dimension_size) {
        pov_expect(reader, ',');
        double i = pov_read_float(reader);
        if (!(i >= 1.0 && i <= result))
            pov_error(reader, token, "dimension_size: the array has %g dimensions", result);
        else
            result = (double)array->sizes[(int)i - 1];
    }
    pov_expect(reader, ')');
    return result;
}

static double read_of_strings(struct pov_reader *reader, const struct pov_token *token)
{
    pov_expect(reader, '(');
    const char *a = pov_read_string(reader), *b = "";
    char *end;
    double result = 0.0;
    if (token->word == POV_strcmp) {
        pov_expect(reader, ',');
        b = pov_read_string(reader);
    }
    pov_expect(reader, ')');
    if (!a || !b)
        return 0.0;
    switch (token->word) {
    case POV_strcmp:
        result = (strcmp(a, b) > 0) - (strcmp(a, b) < 0);
        break;
    case POV_strlen:
        result = (double)strlen(a);
        break;
    case POV_asc:
        result = (unsigned char)*a;
        break;
    case POV_val:
        result = strtod(a, &end);
        break;
    default:
        break; /* file_exists: a scene can't ask what files there are */
    }
    return isfinite(result) ? result : 0.0;
}

/* What asks for the shape of an object, which is not known while the scene is read. */
static void refuse(struct pov_reader *reader, const struct pov_token *token)
{
    pov_error(reader, token, "%s has no counterpart here: objects can't be asked",
              pov_text(reader, token->word));
}

static bool is_other(uint32_t word)
{
    static const uint32_t words[] = {
        POV_max,          POV_min,        POV_select,         POV_seed,        POV_rand,
        POV_defined,      POV_strcmp,     POV_strlen,         POV_asc,         POV_val,
        POV_vdot,         POV_vcross,     POV_vnormalize,     POV_vlength,     POV_vrotate,
        POV_vaxis_rotate, POV_dimensions, POV_dimension_size, POV_file_exists, POV_trace,
        POV_inside,       POV_max_extent, POV_min_extent,     POV_vturbulence};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (words[i] == word)
            return true;
    return false;
}

bool pov_is_function(uint32_t word)
{
    for (size_t i = 0; i < OF_FLOATS; i++)
        if (of_floats[i].word == word)
            return true;
    return is_other(word);
}

bool pov_read_function(struct pov_reader *reader, const struct pov_token *token,
                       struct pov_number *result)
{
    struct pov_value value = pov_float(0.0);
    double number = 0.0;
    if (read_of_floats(reader, token, &number)) {
        *result = pov_float(number).number;
        return true;
    }
    if (!is_other(token->word))
        return false;
    switch (token->word) {
    case POV_max:
    case POV_min:
        value = pov_float(read_extreme(reader, token->word == POV_max));
        break;
    case POV_select:
        value = pov_float(read_select(reader));
        break;
    case POV_seed:
        value = pov_float(read_seed(reader));
        break;
    case POV_rand:
        value = pov_float(read_rand(reader, token));
        break;
    case POV_defined:
        value = pov_float(read_defined(reader));
        break;
    case POV_dimensions:
    case POV_dimension_size:
        value = pov_float(read_dimensions(reader, token));
        break;
    case POV_strcmp:
    case POV_strlen:
    case POV_asc:
    case POV_val:
    case POV_file_exists:
        value = pov_float(read_of_strings(reader, token));
        break;
    case POV_trace:
    case POV_inside:
    case POV_max_extent:
    case POV_min_extent:
    case POV_vturbulence:
        refuse(reader, token);
        break;
    default:
        value = of_vectors(reader, token->word);
    }
    *result = value.number;
    return true;
}
