#include "hemisphere_mesh.h"

#define COLLINEAR 1e-6f /* sine of the angle between an edge's ends, below which it has no share */

/* --- one edge --- */

/* First and second derivatives of theta n.c / |c|, c = r1 x r2, by the point's x and y. */
struct edge_derivatives {
    float x, y, xx, xy, yy;
};

/* Integrals over the angle phi from the foot of the perpendicular on the edge's line, between both
 * ends. */
struct angle_integrals {
    float cos2, sin_cos;             /* of cos^2, sin cos */
    float cos4, sin_cos3, sin2_cos2; /* of cos^4, sin cos^3, sin^2 cos^2 */
};

/* `angle`: between both ends, whose sines and cosines are given. */
static struct angle_integrals integrate(float angle, float sin_a, float cos_a, float sin_b,
                                        float cos_b)
{
    float cos2_a = cos_a * cos_a, cos2_b = cos_b * cos_b;
    float cos2 = 0.5f * (angle + sin_b * cos_b - sin_a * cos_a);
    float cos4 = 0.25f * (3.0f * cos2 + sin_b * cos_b * cos2_b - sin_a * cos_a * cos2_a);
    return (struct angle_integrals){
        .cos2 = cos2,
        .sin_cos = 0.5f * (sin_b * sin_b - sin_a * sin_a),
        .cos4 = cos4,
        .sin_cos3 = 0.25f * (cos2_a * cos2_a - cos2_b * cos2_b),
        .sin2_cos2 = cos2 - cos4,
    };
}

/* With r(t) = r1 + t e, e = r2 - r1, theta / |c| is the integral of 1 / |r|^2 over t in [0, 1], and
 * n.c changes by n x e. Its derivatives are integrals of
 *
 *     2 r / |r|^4     and     8 r r^T / |r|^6 - 2 / |r|^4
 *
 * which, with r = h (a + tan(phi) b) and a, b the directions to the foot and along the edge, become
 * those of angle_integrals. */
static int differentiate_edge(ps_vec3 r1, ps_vec3 r2, struct edge_derivatives *edge)
{
    ps_vec3 e = ps_subtract(r2, r1), c = ps_cross(r1, r2);
    float area = ps_length(c), distance_1 = ps_length(r1), distance_2 = ps_length(r2);
    if (!(area > COLLINEAR * distance_1 * distance_2))
        return 0;
    float length = ps_length(e), h = area / length;
    ps_vec3 b = ps_scale(e, 1.0f / length);
    float from = ps_dot(r1, b), to = ps_dot(r2, b);
    ps_vec3 a = ps_scale(ps_add_scaled(r1, -from, b), 1.0f / h);
    float angle = atan2f(area, ps_dot(r1, r2));
    struct angle_integrals of =
        integrate(angle, from / distance_1, h / distance_1, to / distance_2, h / distance_2);
    float inverse = angle / area, first = 2.0f / (area * h), second = 2.0f / (area * h * h);
    float gx = first * (a.x * of.cos2 + b.x * of.sin_cos);
    float gy = first * (a.y * of.cos2 + b.y * of.sin_cos);
    float hxx = a.x * a.x * of.cos4 + 2.0f * a.x * b.x * of.sin_cos3 + b.x * b.x * of.sin2_cos2;
    float hxy =
        a.x * a.y * of.cos4 + (a.x * b.y + a.y * b.x) * of.sin_cos3 + b.x * b.y * of.sin2_cos2;
    float hyy = a.y * a.y * of.cos4 + 2.0f * a.y * b.y * of.sin_cos3 + b.y * b.y * of.sin2_cos2;
    *edge = (struct edge_derivatives){
        .x = -e.y * inverse + c.z * gx,
        .y = e.x * inverse + c.z * gy,
        .xx = -2.0f * e.y * gx + c.z * second * (4.0f * hxx - of.cos2),
        .xy = e.x * gx - e.y * gy + c.z * second * 4.0f * hxy,
        .yy = 2.0f * e.x * gy + c.z * second * (4.0f * hyy - of.cos2),
    };
    return 1;
}

/* --- the mesh --- */

static size_t vertex_of(const struct hemisphere *hemisphere, uint32_t ring, uint32_t sector)
{
    return (size_t)ring * hemisphere->sectors + sector % hemisphere->sectors;
}

/* The radiance of a triangle: that of its farthest vertex. */
static ps_rgb radiance_of(const struct hemisphere *hemisphere, size_t a, size_t b, size_t c)
{
    const ps_vec3 *hits = hemisphere->hits;
    float da = ps_dot(hits[a], hits[a]), db = ps_dot(hits[b], hits[b]);
    float dc = ps_dot(hits[c], hits[c]);
    return hemisphere->radiance[da >= db ? (da >= dc ? a : c) : (db >= dc ? b : c)];
}

/* Between rings j and j + 1 and sectors k and k + 1 there are two triangles: one with the edge on
 * the inner ring, one with that on the outer ring. */
static ps_rgb inner_triangle(const struct hemisphere *hemisphere, uint32_t j, uint32_t k)
{
    return radiance_of(hemisphere, vertex_of(hemisphere, j, k), vertex_of(hemisphere, j + 1, k),
                       vertex_of(hemisphere, j, k + 1));
}

static ps_rgb outer_triangle(const struct hemisphere *hemisphere, uint32_t j, uint32_t k)
{
    return radiance_of(hemisphere, vertex_of(hemisphere, j + 1, k),
                       vertex_of(hemisphere, j + 1, k + 1), vertex_of(hemisphere, j, k + 1));
}

/* The polygon inside of the innermost ring. */
static ps_rgb cap(const struct hemisphere *hemisphere)
{
    ps_rgb sum = {0, 0, 0};
    for (uint32_t k = 0; k < hemisphere->sectors; k++)
        sum = ps_rgb_add(sum, hemisphere->radiance[k]);
    return ps_rgb_scale(sum, 1.0f / (float)hemisphere->sectors);
}

/* Adds the share of an edge, which `left` lies to the left of as seen from above. */
static void add_edge(const struct hemisphere *hemisphere, size_t from, size_t to, ps_rgb left,
                     ps_rgb right, struct hemisphere_derivatives *sum)
{
    ps_rgb jump = ps_rgb_scale(ps_rgb_add(left, ps_rgb_scale(right, -1.0f)), 0.5f);
    struct edge_derivatives edge;
    if ((jump.r == 0.0f && jump.g == 0.0f && jump.b == 0.0f) ||
        !differentiate_edge(hemisphere->hits[from], hemisphere->hits[to], &edge))
        return;
    float luminance = ps_luminance(jump);
    sum->gradient_x = ps_rgb_add(sum->gradient_x, ps_rgb_scale(jump, edge.x));
    sum->gradient_y = ps_rgb_add(sum->gradient_y, ps_rgb_scale(jump, edge.y));
    sum->xx += luminance * edge.xx;
    sum->xy += luminance * edge.xy;
    sum->yy += luminance * edge.yy;
}

/* Beyond the outermost ring, all is taken to be as on its inner side. */
struct hemisphere_derivatives hemisphere_derivatives(const struct hemisphere *hemisphere)
{
    struct hemisphere_derivatives sum = {{0, 0, 0}, {0, 0, 0}, 0, 0, 0};
    uint32_t sectors = hemisphere->sectors;
    ps_rgb inside = cap(hemisphere);
    for (uint32_t j = 0; j + 1 < hemisphere->rings; j++)
        for (uint32_t k = 0; k < sectors; k++) {
            size_t here = vertex_of(hemisphere, j, k), out = vertex_of(hemisphere, j + 1, k);
            size_t next = vertex_of(hemisphere, j, k + 1);
            ps_rgb inner = inner_triangle(hemisphere, j, k);
            add_edge(hemisphere, here, out, inner, outer_triangle(hemisphere, j, k + sectors - 1),
                     &sum);
            add_edge(hemisphere, out, next, inner, outer_triangle(hemisphere, j, k), &sum);
            add_edge(hemisphere, here, next, j == 0 ? inside : outer_triangle(hemisphere, j - 1, k),
                     inner, &sum);
        }
    return sum;
}
