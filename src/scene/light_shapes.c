/* light_shapes.c: rectangles and discs as triangles that shine. */
#include "scene/light_kinds.h"

ps_rgb light_surface_radiance(const struct light_description *description, double area)
{
    bool is_flat = description->kind == LIGHT_RECTANGLE || description->kind == LIGHT_DISC;
    double sides = is_flat && description->both_sides ? 2.0 : 1.0;
    if (description->unit != UNIT_POWER)
        return description->amount;
    if (!(area > 0.0))
        return (ps_rgb){0, 0, 0};
    return ps_rgb_scale(description->amount, (float)(1.0 / (PI_DOUBLE * area * sides)));
}

void light_rectangle_triangles(const struct light_description *description, ps_vec3 vertices[4],
                               uint32_t triangles[2][3])
{
    static const float corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    static const uint32_t halves[2][3] = {{0, 1, 2}, {0, 2, 3}};
    for (int i = 0; i < 4; i++) {
        ps_vec3 along = ps_scale(description->half_edges[0], corners[i][0]);
        along = ps_add_scaled(along, corners[i][1], description->half_edges[1]);
        vertices[i] = ps_add(description->location, along);
    }
    for (int i = 0; i < 6; i++)
        triangles[i / 3][i % 3] = halves[i / 3][i % 3];
}

void light_disc_triangles(const struct light_description *description, size_t segments,
                          ps_vec3 *vertices, uint32_t (*triangles)[3])
{
    ps_vec3 u, v;
    ps_frame(ps_normalize(description->direction), &u, &v);
    double step = 2.0 * PI_DOUBLE / (double)segments;
    /* A polygon's area is N/2 R^2 sin(2 pi / N). */
    double radius = description->radius * sqrt(step / sin(step));
    vertices[0] = description->location;
    for (size_t i = 0; i < segments; i++) {
        ps_vec3 along = ps_scale(u, (float)(radius * cos(step * (double)i)));
        along = ps_add_scaled(along, (float)(radius * sin(step * (double)i)), v);
        vertices[i + 1] = ps_add(description->location, along);
        triangles[i][0] = 0;
        triangles[i][1] = (uint32_t)i + 1;
        triangles[i][2] = (uint32_t)((i + 1) % segments) + 1;
    }
}
