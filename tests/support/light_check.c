#include "support/light_check.h"

#include "support/chi_squared.h"
#include "support/random.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

bool sample_light(const struct light *light, ps_vec3 position, float u1, float u2,
                  struct light_sample *sample)
{
    float numbers[1][2] = {{u1, u2}};
    light_sample(light, &position, NULL, (const float(*)[2])numbers, 1, sample);
    return ps_rgb_maximum(sample->weight) > 0.0f;
}

#define PI 3.14159265358979323846
#define RINGS 12
#define SECTORS 16
#define CELLS (RINGS * SECTORS)
#define FINE 24 /* steps along both sides of a cell, for the integral of the density */
#define SAMPLES 200000
#define PHOTONS 1000000
#define FEWEST 8.0 /* expected in a cell; others are pooled */

/* --- geometry, in double --- */

struct vector {
    double x, y, z;
};

static struct vector vector_of(ps_vec3 a)
{
    return (struct vector){a.x, a.y, a.z};
}

static struct vector minus(struct vector a, struct vector b)
{
    return (struct vector){a.x - b.x, a.y - b.y, a.z - b.z};
}

static struct vector cross(struct vector a, struct vector b)
{
    return (struct vector){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(struct vector a, struct vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static ps_vec3 unit(struct vector a)
{
    double length = sqrt(dot(a, a));
    return (ps_vec3){(float)(a.x / length), (float)(a.y / length), (float)(a.z / length)};
}

/* Cramer's rule; INFINITY where the ray misses. */
static double meet_triangle(struct vector a, struct vector b, struct vector c, struct vector origin,
                            struct vector direction)
{
    struct vector ab = minus(b, a), ac = minus(c, a), ao = minus(origin, a);
    struct vector n = cross(ab, ac);
    double determinant = -dot(direction, n);
    if (determinant == 0)
        return INFINITY;
    struct vector m = cross(ao, direction);
    double u = dot(ac, m) / determinant, v = -dot(ab, m) / determinant;
    double t = dot(ao, n) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : INFINITY;
}

bool meet_mesh(const void *geometry, ps_vec3 origin, ps_vec3 direction, float *distance,
               ps_vec3 *normal)
{
    const struct light_mesh *mesh = geometry;
    double nearest = INFINITY;
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        struct vector a = vector_of(mesh->vertices[mesh->triangles[i][0]]);
        struct vector b = vector_of(mesh->vertices[mesh->triangles[i][1]]);
        struct vector c = vector_of(mesh->vertices[mesh->triangles[i][2]]);
        double t = meet_triangle(a, b, c, vector_of(origin), vector_of(direction));
        if (t < nearest) {
            nearest = t;
            *normal = unit(cross(minus(b, a), minus(c, a)));
        }
    }
    *distance = (float)nearest;
    return isfinite(nearest);
}

bool meet_sphere(const void *geometry, ps_vec3 origin, ps_vec3 direction, float *distance,
                 ps_vec3 *normal)
{
    const struct light_sphere *sphere = geometry;
    struct vector from = minus(vector_of(origin), vector_of(sphere->center));
    struct vector d = vector_of(direction);
    double r = sphere->radius, a = dot(d, d), b = dot(from, d), c = dot(from, from) - r * r;
    double discriminant = b * b - a * c;
    if (discriminant < 0)
        return false;
    double root = sqrt(discriminant), t = (-b - root) / a;
    if (t <= 0)
        t = (-b + root) / a;
    *distance = (float)t;
    *normal = unit((struct vector){from.x + t * d.x, from.y + t * d.y, from.z + t * d.z});
    return t > 0;
}

bool meet_infinity(const void *nothing, ps_vec3 origin, ps_vec3 direction, float *distance,
                   ps_vec3 *normal)
{
    (void)nothing;
    (void)origin;
    (void)direction;
    *distance = INFINITY;
    *normal = (ps_vec3){0, 0, 0};
    return true;
}

/* --- directions against their density --- */

/* The test's own frame around the axis. */
struct cone {
    ps_vec3 u, v, axis;
    double versine; /* 1 - cos */
};

static struct cone cone_of(const struct light_view *view)
{
    double sine = sin(view->degrees * PI / 360);
    ps_vec3 axis = view->axis;
    ps_vec3 helper = fabsf(axis.x) < 0.5f ? (ps_vec3){1, 0, 0} : (ps_vec3){0, 1, 0};
    ps_vec3 u = ps_normalize(ps_cross(helper, axis));
    return (struct cone){u, ps_cross(axis, u), axis, 2 * sine * sine};
}

static ps_vec3 direction_at(const struct cone *cone, double ring, double turn)
{
    double below = cone->versine * ring, sine = sqrt(below * (2 - below));
    ps_vec3 direction = ps_scale(cone->axis, (float)(1 - below));
    direction = ps_add_scaled(direction, (float)(sine * cos(2 * PI * turn)), cone->u);
    return ps_normalize(ps_add_scaled(direction, (float)(sine * sin(2 * PI * turn)), cone->v));
}

static size_t cell_of(const struct cone *cone, ps_vec3 direction)
{
    assert_true(fabsf(ps_length(direction) - 1) < 1e-5f);
    struct vector apart = minus(vector_of(direction), vector_of(cone->axis));
    double ring = 0.5 * dot(apart, apart) / cone->versine;
    if (ring > 1.002)
        fail_msg("a direction leaves the cone (%g)", ring);
    double turn = atan2(ps_dot(direction, cone->v), ps_dot(direction, cone->u)) / (2 * PI);
    turn -= floor(turn);
    return (size_t)fmin(ring * RINGS, RINGS - 1) * SECTORS +
           (size_t)fmin(turn * SECTORS, SECTORS - 1);
}

static double pdf_at(const struct light_view *view, ps_vec3 direction)
{
    const struct light *light = view->density ? view->density : view->light;
    float distance;
    ps_vec3 normal;
    if (!view->meet(view->geometry, view->position, direction, &distance, &normal))
        return 0;
    double pdf = light_pdf(light, view->position, direction, distance, normal);
    assert_true(isfinite(pdf) && pdf >= 0);
    return pdf;
}

static double integrate_cell(const struct light_view *view, const struct cone *cone, size_t cell)
{
    double sum = 0;
    for (int i = 0; i < FINE; i++)
        for (int k = 0; k < FINE; k++) {
            double ring = ((double)(cell / SECTORS) + (i + 0.5) / FINE) / RINGS;
            double turn = ((double)(cell % SECTORS) + (k + 0.5) / FINE) / SECTORS;
            sum += pdf_at(view, direction_at(cone, ring, turn));
        }
    return sum / (FINE * FINE) * 2 * PI * cone->versine / CELLS;
}

static bool choose_direction(const struct light_view *view, struct random *random,
                             ps_vec3 *direction)
{
    float u[4];
    for (int i = 0; i < 4; i++)
        u[i] = random_unit(random);
    if (view->of_emission) {
        ps_ray ray;
        ps_vec3 normal;
        ps_rgb flux = light_emit(view->light, u, &ray, &normal);
        *direction = ps_scale(ray.direction, -1);
        return ps_rgb_maximum(flux) > 0;
    }
    struct light_sample sample;
    bool is_lit = sample_light(view->light, view->position, u[0], u[1], &sample);
    *direction = sample.direction;
    return is_lit;
}

/* Puts cells in which few are expected together, in place; returns how many are left. */
static size_t pool(double *observed, double *expected)
{
    double few_observed = 0, few_expected = 0;
    size_t count = 0;
    for (size_t i = 0; i < CELLS; i++)
        if (expected[i] < FEWEST) {
            few_observed += observed[i];
            few_expected += expected[i];
        } else {
            observed[count] = observed[i];
            expected[count++] = expected[i];
        }
    assert_true(count > CELLS / 8); /* or the view is too wide to tell anything */
    if (few_expected < FEWEST)
        count--;
    else
        observed[count] = expected[count] = 0;
    observed[count] += few_observed;
    expected[count] += few_expected;
    return count + 1;
}

double light_view_fit(const struct light_view *view)
{
    double observed[CELLS + 1] = {0}, expected[CELLS + 1] = {0}, lit = 0, integral = 0;
    struct cone cone = cone_of(view);
    struct random random = {17};
    for (int i = 0; i < SAMPLES; i++) {
        ps_vec3 direction;
        if (!choose_direction(view, &random, &direction))
            continue;
        observed[cell_of(&cone, direction)]++;
        lit++;
    }
    for (size_t i = 0; i < CELLS; i++) {
        expected[i] = integrate_cell(view, &cone, i);
        integral += expected[i];
    }
    double share = lit / SAMPLES;
    assert_true(lit > 0);
    if (!view->density && fabs(integral - share) > 0.004 + 4 * sqrt(share * (1 - share) / SAMPLES))
        fail_msg("the pdf integrates to %g, and %g of the samples are lit", integral, share);
    for (size_t i = 0; i < CELLS; i++)
        expected[i] *= lit / integral;
    size_t count = pool(observed, expected);
    double probability = chi_squared_probability(observed, expected, count);
    print_message("%zu cells, pdf's integral %.4f, chi-squared probability %.3g\n", count, integral,
                  probability);
    return probability;
}

void expect_close(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected) + 1e-30))
        fail_msg("%.9g, expected %.9g", value, expected);
}

/* --- samples --- */

void expect_samples_meet_light(const struct light_view *view, ps_rgb radiance)
{
    struct random random = {23};
    int lit = 0;
    for (int i = 0; i < 10000; i++) {
        struct light_sample sample;
        float u1 = random_unit(&random), u2 = random_unit(&random);
        if (!sample_light(view->light, view->position, u1, u2, &sample))
            continue;
        lit++;
        expect_close(ps_length(sample.direction), 1, 1e-5);
        expect_close(sample.weight.r * sample.pdf, radiance.r, 1e-5);
        expect_close(sample.weight.g * sample.pdf, radiance.g, 1e-5);
        expect_close(sample.weight.b * sample.pdf, radiance.b, 1e-5);
        float distance;
        ps_vec3 normal;
        /* Rounding may take a ray at the rim past it. */
        if (!view->meet(view->geometry, view->position, sample.direction, &distance, &normal) ||
            fabsf(ps_dot(normal, sample.direction)) < 0.02f)
            continue;
        if (isinf(distance))
            assert_true(isinf(sample.distance));
        else
            expect_close(sample.distance, distance, 1e-3);
        expect_close(sample.pdf,
                     light_pdf(view->light, view->position, sample.direction, distance, normal),
                     1e-2);
    }
    assert_true(lit > 100);
}

double irradiance_by_samples(const struct light *light, ps_vec3 position, ps_vec3 normal)
{
    enum { STEPS = 700 };
    double sum = 0;
    struct random random = {19};
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS; k++) {
            struct light_sample sample;
            float u1 = ((float)i + random_unit(&random)) / STEPS;
            float u2 = ((float)k + random_unit(&random)) / STEPS;
            if (sample_light(light, position, u1, u2, &sample))
                sum += sample.weight.r * fmax(0, ps_dot(sample.direction, normal));
        }
    return sum / (STEPS * STEPS);
}

/* --- emission --- */

static void random_four(struct random *random, float u[4])
{
    for (int i = 0; i < 4; i++)
        u[i] = random_unit(random);
}

void expect_flux_is_power(const struct light *light, double tolerance)
{
    double red = 0, green = 0, blue = 0;
    struct random random = {29};
    for (int i = 0; i < SAMPLES; i++) {
        float u[4];
        ps_ray ray;
        ps_vec3 normal;
        random_four(&random, u);
        ps_rgb flux = light_emit(light, u, &ray, &normal);
        assert_true(flux.r >= 0 && flux.g >= 0 && flux.b >= 0);
        assert_true(fabsf(ps_length(ray.direction) - 1) < 1e-5f);
        assert_true(ray.tnear == 0 && isinf(ray.tfar));
        red += flux.r;
        green += flux.g;
        blue += flux.b;
    }
    ps_rgb power = light_power(light);
    expect_close(red / SAMPLES, power.r, tolerance);
    expect_close(green / SAMPLES, power.g, tolerance);
    expect_close(blue / SAMPLES, power.b, tolerance);
}

struct plate {
    ps_vec3 center, normal, u, v;
    double half;
};

static bool meets_plate(const struct plate *plate, const ps_ray *ray)
{
    float cosine = ps_dot(ray->direction, plate->normal);
    float distance = ps_dot(ps_subtract(plate->center, ray->origin), plate->normal) / cosine;
    ps_vec3 at = ps_subtract(ps_add_scaled(ray->origin, distance, ray->direction), plate->center);
    return cosine < 0 && distance > 0 && fabsf(ps_dot(at, plate->u)) < plate->half &&
           fabsf(ps_dot(at, plate->v)) < plate->half;
}

/* A mean, and its standard error squared. */
struct mean {
    double value, variance;
};

static struct mean mean_of(double sum, double sum2, double count)
{
    double value = sum / count;
    return (struct mean){value, (sum2 / count - value * value) / count};
}

static struct mean irradiance_by_photons(const struct light *light, const struct plate *plate)
{
    double sum = 0, sum2 = 0, area = 4 * plate->half * plate->half;
    struct random random = {31};
    for (int i = 0; i < PHOTONS; i++) {
        float u[4];
        ps_ray ray;
        ps_vec3 normal;
        random_four(&random, u);
        ps_rgb flux = light_emit(light, u, &ray, &normal);
        if (!meets_plate(plate, &ray))
            continue;
        sum += flux.r / area;
        sum2 += flux.r / area * flux.r / area;
    }
    return mean_of(sum, sum2, PHOTONS);
}

static struct mean irradiance_of_plate(const struct light *light, const struct plate *plate)
{
    double sum = 0, sum2 = 0;
    struct random random = {37};
    for (int i = 0; i < SAMPLES; i++) {
        float u[4];
        random_four(&random, u);
        ps_vec3 at = ps_add_scaled(plate->center, (float)(plate->half * (2 * u[2] - 1)), plate->u);
        at = ps_add_scaled(at, (float)(plate->half * (2 * u[3] - 1)), plate->v);
        struct light_sample sample;
        if (!sample_light(light, at, u[0], u[1], &sample))
            continue;
        double value = sample.weight.r * fmax(0, ps_dot(sample.direction, plate->normal));
        sum += value;
        sum2 += value * value;
    }
    return mean_of(sum, sum2, SAMPLES);
}

void expect_plate_agrees(const struct light *light, ps_vec3 center, ps_vec3 normal, double half)
{
    ps_vec3 helper = fabsf(normal.x) < 0.5f ? (ps_vec3){1, 0, 0} : (ps_vec3){0, 1, 0};
    ps_vec3 u = ps_normalize(ps_cross(helper, normal));
    struct plate plate = {center, normal, u, ps_cross(normal, u), half};
    struct mean photons = irradiance_by_photons(light, &plate);
    struct mean samples = irradiance_of_plate(light, &plate);
    double error = sqrt(photons.variance + samples.variance);
    print_message("irradiance by photons %.5g, by samples %.5g, standard error %.2g\n",
                  photons.value, samples.value, error);
    assert_true(samples.value > 0 && error < 0.02 * samples.value); /* or it shows nothing */
    assert_true(fabs(photons.value - samples.value) < 4 * error + 1e-5 * samples.value);
}

struct light light_of(const struct light_description *description,
                      const struct sky_picture *picture)
{
    static const struct light_bounds bounds = {{1, 2, 3}, 5};
    struct light light;
    struct error error = {""};
    if (light_create(description, &bounds, picture, &light, &error) != PS_OK)
        fail_msg("%s", error.text);
    return light;
}
