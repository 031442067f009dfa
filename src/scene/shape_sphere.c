/* shape_sphere.c: spheres: exact ones, and ellipsoids as meshes; both with the same (u, v).
 *
 * phi = 2 pi u is the longitude from -x, counter-clockwise seen from +y; theta = pi v the angle
 * from -y. The unit outward normal is (-sin theta cos phi, -cos theta, sin theta sin phi).
 */
#include "scene/shape_lathe.h"

#define PI 3.14159265358979323846

/* Of an ellipsoid's mesh. */
#define SEGMENTS_AROUND 128
#define SEGMENTS_UP 64

/* Least sin theta in the derivative by u. */
#define POLE_SINE 1e-3f

static ps_result make_exact(const struct object_description *object, struct shape *shape,
                            struct error *error)
{
    const struct affine *placement = &object->placement;
    shape->kind = SHAPE_SPHERE;
    shape->center = affine_point(placement, object->center);
    shape->radius = (float)object->radius * ps_length(placement->x);
    shape->axes[0] = unit_or_zero(placement->x);
    shape->axes[1] = unit_or_zero(placement->y);
    shape->axes[2] = unit_or_zero(placement->z);
    bool in_range = shape->radius > 0.0f && isfinite(shape->radius) && isfinite(shape->center.x) &&
                    isfinite(shape->center.y) && isfinite(shape->center.z);
    return in_range ? PS_OK : shape_invalid(object, error, "its placement is out of range");
}

/* Ring i, from the pole at -y; those at the poles lie exactly on the axis. */
static struct profile_point sphere_point(float radius, size_t i)
{
    double theta = PI * (double)i / SEGMENTS_UP;
    float sine = i % SEGMENTS_UP == 0 ? 0.0f : (float)sin(theta), cosine = (float)cos(theta);
    return (struct profile_point){
        .radius = radius * sine,
        .height = -radius * cosine,
        .normal_radius = sine,
        .normal_height = -cosine,
        .v = (float)i / SEGMENTS_UP,
    };
}

static ps_result make_ellipsoid(const struct object_description *object, struct shape *shape,
                                struct error *error)
{
    size_t n = SEGMENTS_AROUND, m = SEGMENTS_UP;
    float radius = (float)object->radius;
    ps_result result = shape_allocate(shape, (m - 1) * (n + 1) + 2 * n, 2 * (m - 1) * n,
                                      MESH_NORMALS | MESH_UV, error);
    if (result != PS_OK)
        return result;
    struct lathe lathe = lathe_begin(shape, object->center, (ps_vec3){0, 1, 0}, n);
    struct profile_point point = sphere_point(radius, 0);
    lathe_ring(&lathe, &point);
    for (size_t i = 1; i <= m; i++) {
        point = sphere_point(radius, i);
        lathe_join(&lathe, &point);
    }
    return PS_OK;
}

ps_result shape_sphere(const struct object_description *object,
                       const struct shape_surroundings *surroundings, struct shape *shape,
                       struct error *error)
{
    (void)surroundings;
    if (!is_length(object->radius))
        return shape_invalid(object, error, "radius must be above 0");
    return affine_is_similarity(&object->placement) ? make_exact(object, shape, error)
                                                    : make_ellipsoid(object, shape, error);
}

/* `outward` in the sphere's own axes. */
static ps_vec3 own(const struct shape *shape, ps_vec3 outward)
{
    return (ps_vec3){ps_dot(outward, shape->axes[0]), ps_dot(outward, shape->axes[1]),
                     ps_dot(outward, shape->axes[2])};
}

static float sine_of(ps_vec3 n)
{
    return sqrtf(n.x * n.x + n.z * n.z);
}

void shape_sphere_uv(const struct shape *shape, ps_vec3 outward, float uv[2])
{
    ps_vec3 n = own(shape, outward);
    float turn = atan2f(n.z, -n.x) / (2.0f * PS_PI);
    uv[0] = fminf(turn < 0.0f ? turn + 1.0f : turn, 1.0f);
    uv[1] = fminf(atan2f(sine_of(n), -n.y) / PS_PI, 1.0f);
}

void shape_sphere_tangents(const struct shape *shape, ps_vec3 outward, ps_vec3 *along_u,
                           ps_vec3 *along_v)
{
    ps_vec3 n = own(shape, outward);
    float sine = sine_of(n), cosine = -n.y;
    float cos_phi = sine > 0.0f ? -n.x / sine : 1.0f, sin_phi = sine > 0.0f ? n.z / sine : 0.0f;
    float by_u = 2.0f * PS_PI * shape->radius * fmaxf(sine, POLE_SINE);
    float by_v = PS_PI * shape->radius;
    const ps_vec3 *axes = shape->axes;
    *along_u = ps_add_scaled(ps_scale(axes[0], by_u * sin_phi), by_u * cos_phi, axes[2]);
    *along_v = ps_add_scaled(ps_scale(axes[0], -by_v * cosine * cos_phi), by_v * sine, axes[1]);
    *along_v = ps_add_scaled(*along_v, by_v * cosine * sin_phi, axes[2]);
}
