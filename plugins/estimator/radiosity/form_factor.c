#include "form_factor.h"

#include <stddef.h>

/* Cuts off what lies below the horizon (Sutherland and Hodgman 1974); of three corners at most four
 * are left. */
static size_t cut_at_horizon(ps_vec3 n, const ps_vec3 corners[3], ps_vec3 cut[4])
{
    size_t count = 0;
    for (size_t i = 0; i < 3; i++) {
        ps_vec3 here = corners[i], next = corners[(i + 1) % 3];
        float height = ps_dot(n, here), next_height = ps_dot(n, next);
        if (height >= 0.0f)
            cut[count++] = here;
        if ((height > 0.0f && next_height < 0.0f) || (height < 0.0f && next_height > 0.0f))
            cut[count++] =
                ps_add_scaled(here, height / (height - next_height), ps_subtract(next, here));
    }
    return count;
}

/* theta n . g of the edge from a to b, both seen from the origin. */
static float edge_share(ps_vec3 n, ps_vec3 a, ps_vec3 b)
{
    ps_vec3 across = ps_cross(a, b);
    float length = ps_length(across);
    return length > 0.0f ? atan2f(length, ps_dot(a, b)) * ps_dot(n, across) / length : 0.0f;
}

float form_factor_triangle(ps_vec3 x, ps_vec3 n, const ps_vec3 corners[3])
{
    ps_vec3 seen[3], cut[4];
    for (int i = 0; i < 3; i++)
        seen[i] = ps_subtract(corners[i], x);
    /* Seen from the front, its corners run clockwise around the line of sight. */
    if (!(ps_dot(ps_cross(seen[0], seen[1]), seen[2]) < 0.0f))
        return 0.0f;
    size_t count = cut_at_horizon(n, seen, cut);
    float sum = 0.0f;
    for (size_t i = 0; i < count; i++)
        sum -= edge_share(n, cut[i], cut[(i + 1) % count]);
    return ps_max(sum / (2.0f * PS_PI), 0.0f);
}
