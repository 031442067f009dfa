/* directive_transform.c: directives that change the current transform (pbrt-v4 file format,
 * "Transformations"). */
#include "pbrt/directive.h"

#include "pbrt/state.h"
#include <stdlib.h>
#include <string.h>

static void identity(const struct call *call)
{
    if (!call->importer->state.only_end_time)
        call->importer->state.ctm = transform_identity;
}

static void translate(const struct call *call)
{
    double n[3];
    if (!call_numbers(call, n, 3))
        return;
    struct transform map = transform_translate(n[0], n[1], n[2]);
    state_transform(call->importer, &map);
}

static void scale(const struct call *call)
{
    double n[3];
    if (!call_numbers(call, n, 3))
        return;
    struct transform map = transform_scale(n[0], n[1], n[2]);
    if (n[0] == 0.0 || n[1] == 0.0 || n[2] == 0.0)
        call_stop(call, "factors can't be 0");
    state_transform(call->importer, &map);
}

static void rotate(const struct call *call)
{
    double n[4];
    struct transform map;
    if (!call_numbers(call, n, 4))
        return;
    if (transform_rotate(n[0], (struct vector){n[1], n[2], n[3]}, &map))
        state_transform(call->importer, &map);
    else
        call_stop(call, "the axis has no length");
}

static void look_at(const struct call *call)
{
    double n[9];
    struct transform map;
    if (!call_numbers(call, n, 9))
        return;
    if (transform_look_at((struct vector){n[0], n[1], n[2]}, (struct vector){n[3], n[4], n[5]},
                          (struct vector){n[6], n[7], n[8]}, &map))
        state_transform(call->importer, &map);
    else
        call_stop(call, "the two points are one, or up lies along the view");
}

static void matrix(const struct call *call)
{
    double n[16];
    struct transform map;
    if (!call_numbers(call, n, 16))
        return;
    if (!transform_from_columns(n, &map)) {
        call_stop(call, "a matrix that is not affine has no counterpart");
        return;
    }
    if (strcmp(call->word, "Transform") == 0)
        identity(call);
    state_transform(call->importer, &map);
}

static void coordinate_system(const struct call *call)
{
    char *name = call_text(call);
    if (name)
        state_name_coordinates(call->importer, name, &call->importer->state.ctm);
    free(name);
}

static void coordinate_transform(const struct call *call)
{
    char *name = call_text(call);
    const struct transform *found = name ? state_find_coordinates(call->importer, name) : NULL;
    if (found)
        call->importer->state.ctm = *found;
    else if (name)
        importer_warn(call->importer, call->origin, call->width,
                      "there is no coordinate system '%.100s': the transform stays, as in pbrt",
                      name);
    free(name);
}

static void moving(const struct call *call)
{
    importer_warn(call->importer, call->origin, call->width,
                  "%s: nothing moves here; all stays where it starts", call->word);
}

static void active_transform(const struct call *call)
{
    struct token *token = &call->parser->token;
    static const char *const times[] = {"StartTime", "EndTime", "All"};
    for (size_t i = 0; i < 3 && token->kind == TOKEN_WORD; i++)
        if (strcmp(token->text, times[i]) == 0) {
            call->importer->state.only_end_time = i == 1;
            moving(call);
            parser_advance(call->parser);
            return;
        }
    call_stop(call, "expected StartTime, EndTime or All");
}

static void transform_times(const struct call *call)
{
    double n[2];
    if (call_numbers(call, n, 2))
        moving(call);
}

static void reverse_orientation(const struct call *call)
{
    call->importer->state.reverse = !call->importer->state.reverse;
}

static const struct directive directives[] = {
    {"Identity", ANYWHERE, identity},
    {"Translate", ANYWHERE, translate},
    {"Scale", ANYWHERE, scale},
    {"Rotate", ANYWHERE, rotate},
    {"LookAt", ANYWHERE, look_at},
    {"Transform", ANYWHERE, matrix},
    {"ConcatTransform", ANYWHERE, matrix},
    {"CoordinateSystem", ANYWHERE, coordinate_system},
    {"CoordSysTransform", ANYWHERE, coordinate_transform},
    {"ActiveTransform", ANYWHERE, active_transform},
    {"TransformTimes", BEFORE_WORLD, transform_times},
    {"ReverseOrientation", ANYWHERE, reverse_orientation},
};

const struct directive_table directives_of_transforms = {directives,
                                                         sizeof directives / sizeof directives[0]};
