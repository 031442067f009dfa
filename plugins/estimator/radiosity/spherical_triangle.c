#include "spherical_triangle.h"

/* Unit; the part of x at right angles to y, which is unit too. */
static ps_vec3 across(ps_vec3 x, ps_vec3 y)
{
    ps_vec3 part = ps_add_scaled(x, -ps_dot(x, y), y);
    float length = ps_length(part);
    return length > 0.0f ? ps_scale(part, 1.0f / length) : (ps_vec3){0, 0, 0};
}

/* Between the arcs from a to b and from a to c. */
static float angle_at(ps_vec3 a, ps_vec3 b, ps_vec3 c)
{
    ps_vec3 to_b = across(b, a), to_c = across(c, a);
    return atan2f(ps_length(ps_cross(to_b, to_c)), ps_dot(to_b, to_c));
}

/* Van Oosterom and Strackee 1983: without the difference of the sum of the angles and pi, which
 * small ones lose. */
static float solid_angle(ps_vec3 a, ps_vec3 b, ps_vec3 c)
{
    float volume = fabsf(ps_dot(a, ps_cross(b, c)));
    float rest = 1.0f + ps_dot(a, b) + ps_dot(b, c) + ps_dot(c, a);
    float angle = 2.0f * atan2f(volume, rest);
    return volume > 0.0f ? angle : 0.0f;
}

struct spherical_triangle spherical_triangle(const ps_vec3 corners[3])
{
    struct spherical_triangle triangle;
    for (int i = 0; i < 3; i++) {
        float length = ps_length(corners[i]);
        triangle.corners[i] =
            length > 0.0f ? ps_scale(corners[i], 1.0f / length) : (ps_vec3){0, 0, 0};
    }
    const ps_vec3 *c = triangle.corners;
    triangle.alpha = angle_at(c[0], c[1], c[2]);
    triangle.solid_angle = solid_angle(c[0], c[1], c[2]);
    return triangle;
}

static float root_of_rest(float x)
{
    return sqrtf(ps_max(0.0f, 1.0f - x * x));
}

ps_vec3 spherical_triangle_sample(const struct spherical_triangle *triangle, const float numbers[2])
{
    ps_vec3 a = triangle->corners[0], b = triangle->corners[1], c = triangle->corners[2];
    float alpha = triangle->alpha, beta = angle_at(b, c, a), gamma = angle_at(c, a, b);
    float excess = alpha + beta + gamma - PS_PI, angle = numbers[0] * excess - alpha;
    float s = sinf(angle), t = cosf(angle), cos_alpha = cosf(alpha), sin_alpha = sinf(alpha);
    float u = t - cos_alpha, v = s + sin_alpha * ps_dot(a, b);
    float below = (v * s + u * t) * sin_alpha;
    float q = below != 0.0f ? ((v * t - u * s) * cos_alpha - v) / below : 1.0f;
    q = ps_max(-1.0f, ps_min(1.0f, q));
    ps_vec3 cut = ps_add_scaled(ps_scale(a, q), root_of_rest(q), across(c, a));
    float z = 1.0f - numbers[1] * (1.0f - ps_dot(cut, b));
    return ps_normalize(ps_add_scaled(ps_scale(b, z), root_of_rest(z), across(cut, b)));
}
