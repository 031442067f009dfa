/* param.h: parameter tables.
 *
 * A table is the only statement of a parameter: the core parses and checks a value against it and
 * writes it into the state; lists, man pages and editors' help derive from it. A member of the
 * state has the type that its row names:
 *
 *   PS_PARAM_BOOL              int32_t, 0 or 1
 *   PS_PARAM_INT               int64_t
 *   PS_PARAM_NUMBER            double
 *   PS_PARAM_VEC3              ps_vec3
 *   PS_PARAM_COLOR             ps_rgb
 *   PS_PARAM_STRING            const char *, owned by the core, valid until destroy returns
 *   PS_PARAM_CHOICE            int32_t, index into `choices`
 *   PS_PARAM_NUMBER_OR_CHOICE  ps_number_or_choice
 */
#ifndef PSPLAT_PARAM_H
#define PSPLAT_PARAM_H

#include <math.h>
#include <psplat/types.h>

typedef enum ps_param_type {
    PS_PARAM_BOOL = 0,
    PS_PARAM_INT = 1,
    PS_PARAM_NUMBER = 2,
    PS_PARAM_VEC3 = 3,
    PS_PARAM_COLOR = 4,
    PS_PARAM_STRING = 5,
    PS_PARAM_CHOICE = 6,
    PS_PARAM_NUMBER_OR_CHOICE = 7
} ps_param_type;

typedef struct ps_number_or_choice {
    double number;  /* meaningful where choice is negative */
    int32_t choice; /* index into `choices`, or -1: a number was given */
    int32_t reserved;
} ps_number_or_choice;

#define PS_PARAM_OPEN_MIN 1u /* the minimum itself is not allowed */
#define PS_PARAM_OPEN_MAX 2u
#define PS_PARAM_EXPERT                                                                            \
    4u /* its default is right for all but experiments: lists show it on request */
#define PS_PARAM_WHOLE 8u /* of numbers: whole ones alone */

typedef struct ps_param {
    const char *name;
    uint32_t type;  /* ps_param_type */
    uint32_t flags; /* PS_PARAM_... */
    uint64_t offset;
    const char *default_value; /* as a user would write it; NULL: the parameter is required */
    double minimum, maximum; /* of numbers, or of each component; unbounded: -INFINITY, INFINITY */
    const char *const *choices; /* NULL-terminated, for the two choice types; else NULL */
    const char *unit;           /* "" where there is none */
    const char *help;           /* one line, no full stop */
} ps_param;

/* The type_ of a row, if the member is of that type; otherwise the row does not compile. */
#define PS_TYPE_OF_MEMBER(state, member, type_)                                                    \
    _Generic(((state *)0)->member, PS_MEMBER_OF_##type_ : (type_))
#define PS_MEMBER_OF_PS_PARAM_BOOL int32_t
#define PS_MEMBER_OF_PS_PARAM_INT int64_t
#define PS_MEMBER_OF_PS_PARAM_NUMBER double
#define PS_MEMBER_OF_PS_PARAM_VEC3 ps_vec3
#define PS_MEMBER_OF_PS_PARAM_COLOR ps_rgb
#define PS_MEMBER_OF_PS_PARAM_STRING const char *
#define PS_MEMBER_OF_PS_PARAM_CHOICE int32_t
#define PS_MEMBER_OF_PS_PARAM_NUMBER_OR_CHOICE ps_number_or_choice

/* Rows of a table; the parameter is named as the member that it fills. PS_ROW has all members, for
 * rows whose type takes no flags below. */
#define PS_ROW(state, member, type_, default_, minimum_, maximum_, flags_, choices_, unit_, help_) \
    {                                                                                              \
        .name = #member, .type = PS_TYPE_OF_MEMBER(state, member, type_), .flags = (flags_),       \
        .offset = offsetof(state, member), .default_value = (default_), .minimum = (minimum_),     \
        .maximum = (maximum_), .choices = (choices_), .unit = (unit_), .help = (help_)             \
    }
#define PS_BOOL(state, member, default_, help_)                                                    \
    PS_ROW(state, member, PS_PARAM_BOOL, default_, 0, 1, 0, NULL, "", help_)
#define PS_INT(state, member, default_, minimum_, maximum_, unit_, help_)                          \
    PS_ROW(state, member, PS_PARAM_INT, default_, minimum_, maximum_, 0, NULL, unit_, help_)
#define PS_NUMBER(state, member, default_, minimum_, maximum_, flags_, unit_, help_)               \
    PS_ROW(state, member, PS_PARAM_NUMBER, default_, minimum_, maximum_, flags_, NULL, unit_, help_)
#define PS_VEC3(state, member, default_, unit_, help_)                                             \
    PS_ROW(state, member, PS_PARAM_VEC3, default_, -INFINITY, INFINITY, 0, NULL, unit_, help_)
#define PS_COLOR(state, member, default_, minimum_, maximum_, unit_, help_)                        \
    PS_ROW(state, member, PS_PARAM_COLOR, default_, minimum_, maximum_, 0, NULL, unit_, help_)
#define PS_STRING(state, member, default_, help_)                                                  \
    PS_ROW(state, member, PS_PARAM_STRING, default_, 0, 0, 0, NULL, "", help_)
#define PS_CHOICE(state, member, default_, choices_, help_)                                        \
    PS_ROW(state, member, PS_PARAM_CHOICE, default_, 0, 0, 0, choices_, "", help_)
#define PS_NUMBER_OR(state, member, default_, minimum_, maximum_, flags_, choices_, unit_, help_)  \
    PS_ROW(state, member, PS_PARAM_NUMBER_OR_CHOICE, default_, minimum_, maximum_, flags_,         \
           choices_, unit_, help_)

#endif
