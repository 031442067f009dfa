/* test_services.c: what plugins are told of the scene agrees with what rays and sampling find of
 * it. */
#include "host/host.h"
#include "support/inject.h"
#include "support/lit_room.h"
#include "support/random.h"
#include "support/render_scene.h"
#include <math.h>
#include <psplat/cells.h>
#include <psplat/math.h>
#include <psplat/path.h>
#include <psplat/tile.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define FLOORS                                                                                     \
    "  gloss2: {glossy: {diffuse: [0.5, 0.3, 0.1], specular: [0.2, 0.3, 0.5], roughness: 0.5}}\n"  \
    "  metal: {metal: {color: [0.9, 0.7, 0.5], roughness: 0.6}}\n"                                 \
    "  mix2: {mix: [{material: gloss2, weight: 0.6}, {material: mirror, weight: 0.4}]}\n"

#define HEMISPHERE 40000

/* The hit of a ray from above onto a floor in the plane y = 0, at 50 degrees. */
static ps_hit look_down(const ps_host *host, float x, ps_ray *ray)
{
    ps_hit hit;
    ps_vec3 direction = ps_normalize((ps_vec3){0.3f, -0.9f, 0.6f});
    *ray = (ps_ray){ps_add_scaled((ps_vec3){x, 0, 0}, -2.0f, direction), 0, direction, INFINITY};
    host->intersect(host, ray, 1, &hit);
    assert_true(fabsf(hit.position.y) < 1e-4f && fabsf(hit.position.x - x) < 1e-3f);
    return hit;
}

struct sums {
    double value, pdf, sampled, share;
};

/* The integral of the BSDF over the hemisphere by directions that know nothing of it, and by its
 * own; without mirrors. And what its density adds up to, and how often it draws such directions. */
static struct sums integrate(const ps_host *host, ps_direction direction, const ps_ray *ray,
                             const ps_hit *hit)
{
    struct random random = {7};
    struct sums sums = {0, 0, 0, 0};
    for (int i = 0; i < HEMISPHERE; i++) {
        float numbers[1][4];
        for (int k = 0; k < 4; k++)
            numbers[0][k] = random_between(&random, 0, 1);
        ps_vec3 out = ps_cone_direction(hit->normal, 0.0f, numbers[0][0], numbers[0][1]);
        ps_bsdf_value value;
        ps_bsdf_sample sample;
        host->evaluate_bsdf(host, direction, ray, hit, &out, 1, &value);
        host->sample_bsdf(host, direction, ray, hit, (const float(*)[4])numbers, 1, &sample);
        sums.value += 2 * (double)PS_PI * (double)value.value.g / HEMISPHERE;
        sums.pdf += 2 * (double)PS_PI * (double)value.pdf / HEMISPHERE;
        if (sample.lobe != PS_SPECULAR && ps_dot(sample.direction, hit->normal) > 0) {
            sums.sampled += (double)sample.weight.g / HEMISPHERE;
            sums.share += 1.0 / HEMISPHERE;
        }
    }
    return sums;
}

static void compare_bsdf(const ps_host *host, const char *what, float x)
{
    ps_ray ray;
    ps_hit hit = look_down(host, x, &ray);
    for (int way = 0; way < 2; way++) {
        struct sums sums = integrate(host, (ps_direction)way, &ray, &hit);
        print_message("%s, way %d: value %.4f, sampled %.4f; pdf %.4f, drawn %.4f\n", what, way,
                      sums.value, sums.sampled, sums.pdf, sums.share);
        assert_true(fabs(sums.value - sums.sampled) < 0.02 * fmax(sums.sampled, 0.05));
        assert_true(fabs(sums.pdf - sums.share) < 0.02);
    }
}

/* The value of a lobe that is drawn, over its density, is its weight. */
static void expect_weight(const ps_host *host, float x)
{
    ps_ray ray;
    ps_bsdf_sample sample;
    ps_bsdf_value value;
    static const float numbers[1][4] = {{0.3f, 0.6f, 0.5f, 0.5f}};
    ps_hit hit = look_down(host, x, &ray);
    host->sample_bsdf(host, PS_FROM_CAMERA, &ray, &hit, numbers, 1, &sample);
    host->evaluate_bsdf(host, PS_FROM_CAMERA, &ray, &hit, &sample.direction, 1, &value);
    assert_true(fabsf(value.value.r / value.pdf - sample.weight.r) < 1e-4f * sample.weight.r);
    assert_true(fabsf(value.pdf - sample.pdf) < 1e-4f * sample.pdf);
}

/* The density of going back is that of coming from there. */
static void expect_reverse(const ps_host *host, float x)
{
    ps_ray ray, other;
    ps_bsdf_value there, back;
    ps_hit hit = look_down(host, x, &ray), same;
    ps_vec3 out = ps_normalize((ps_vec3){-0.5f, 0.7f, 0.2f});
    ps_vec3 towards = ps_scale(ray.direction, -1.0f);
    other = (ps_ray){ps_add_scaled(hit.position, 2.0f, out), 0, ps_scale(out, -1.0f), INFINITY};
    host->intersect(host, &other, 1, &same);
    host->evaluate_bsdf(host, PS_FROM_CAMERA, &ray, &hit, &out, 1, &there);
    host->evaluate_bsdf(host, PS_FROM_CAMERA, &other, &same, &towards, 1, &back);
    assert_true(fabsf(there.reverse_pdf - back.pdf) < 1e-3f * back.pdf);
    assert_true(fabsf(there.pdf - back.reverse_pdf) < 1e-3f * there.pdf);
    out.y = -out.y; /* into the floor */
    host->evaluate_bsdf(host, PS_FROM_CAMERA, &ray, &hit, &out, 1, &there);
    assert_true(there.pdf == 0 && ps_rgb_maximum(there.value) == 0);
}

static void look_at_surfaces(const ps_host *host)
{
    static const struct {
        const char *what;
        float x, roughness;
    } floors[] = {{"diffuse", 0, 1}, {"gloss", 10, 0.5f}, {"metal", 20, 0.6f}, {"mix", 30, 0}};
    for (int i = 0; i < 4; i++) {
        ps_ray ray;
        compare_bsdf(host, floors[i].what, floors[i].x);
        expect_reverse(host, floors[i].x);
        assert_true(fabsf(look_down(host, floors[i].x, &ray).roughness - floors[i].roughness) <
                    1e-6f);
    }
    expect_weight(host, 0);
    expect_weight(host, 20);
}

#define FLOOR(x0, x1, material)                                                                    \
    "  - quad: {corners: [[" x0 ", 0, 5], [" x1 ", 0, 5], [" x1 ", 0, -5], [" x0                   \
    ", 0, -5]], material: " material "}\n"

static void test_bsdf_is_what_is_sampled(void **state)
{
    (void)state;
    with_host_of(SCENE_HEAD FLOORS LIGHTS POINT "objects:\n" FLOOR("-5", "5", "white")
                     FLOOR("5", "15", "gloss2") FLOOR("15", "25", "metal")
                         FLOOR("25", "35", "mix2"),
                 look_at_surfaces);
}

/* --- lights ----------------------------------------------------------------------------------- */

#define SAMPLES 20000

static bool sees(const ps_host *host, const ps_hit *hit, const ps_light_sample *sample)
{
    ps_ray ray = ps_leave_surface(hit->position, hit->geometric_normal, sample->direction, 1e-4f);
    uint8_t blocked;
    ray.tfar = sample->distance < INFINITY ? 0.999f * sample->distance : INFINITY;
    host->occluded(host, &ray, 1, &blocked);
    return !blocked;
}

/* What a white floor reflects up is its irradiance, times albedo / pi. */
static void compare_light(const ps_host *host)
{
    ps_ray ray;
    ps_hit hit = look_down(host, 0.5f, &ray);
    struct random random = {3};
    double by_samples = 0, reflected = 0, far = 0;
    for (int i = 0; i < SAMPLES; i++) {
        float numbers[1][4];
        uint64_t index = (uint64_t)i;
        ps_light_sample sample;
        ps_rgb radiance;
        for (int k = 0; k < 4; k++)
            numbers[0][k] = random_between(&random, 0, 1);
        host->sample_light(host, &hit.position, (const float(*)[4])numbers, 1, &sample);
        float cosine = ps_dot(sample.direction, hit.normal);
        if (ps_rgb_maximum(sample.irradiance) > 0 && cosine > 0 && sees(host, &hit, &sample))
            by_samples += (double)(sample.irradiance.g * cosine) / SAMPLES;
        if (sample.distance < INFINITY) {
            ps_vec3 seen = ps_add_scaled(hit.position, sample.distance, sample.direction);
            far = fmax(far, (double)ps_length(ps_subtract(seen, sample.position)));
        }
        assert_true(ps_dot(sample.normal, sample.direction) <= 0);
        assert_true(sample.light < host->light_count(host));
        host->direct_radiance(host, &ray, &hit, PS_STREAM_PLUGIN, 0, &index, 1, &radiance);
        reflected += (double)radiance.g / SAMPLES;
    }
    double irradiance = reflected * (double)PS_PI / 0.7;
    print_message("irradiance by samples %.4f, by what is reflected %.4f\n", by_samples,
                  irradiance);
    assert_true(fabs(by_samples - irradiance) < 0.02 * irradiance);
    assert_true(far < 1e-3);
}

#define WHITE_FLOOR "objects:\n" FLOOR("-5", "5", "white")

static void test_light_samples_add_up(void **state)
{
    (void)state;
    static const char *const lights[] = {SPOT,     POINT,     SUN,
                                         WIDE_SUN, RECTANGLE, SPOT RECTANGLE WIDE_SUN POINT};
    for (size_t i = 0; i < sizeof lights / sizeof lights[0]; i++) {
        char text[4096];
        snprintf(text, sizeof text, "%s%s%s%s", SCENE_HEAD, LIGHTS, lights[i], WHITE_FLOOR);
        with_host_of(text, compare_light);
    }
}

#define GROUP_RAYS 300

/* Light of both groups adds up to that of all lights, ray by ray, whatever the other rays ask
 * for. */
static void add_groups(const ps_host *host, double sums[4])
{
    ps_ray rays[GROUP_RAYS];
    ps_hit hits[GROUP_RAYS];
    uint8_t groups[GROUP_RAYS];
    uint64_t indices[GROUP_RAYS];
    ps_rgb some[3][GROUP_RAYS], all[GROUP_RAYS];
    for (uint32_t i = 0; i < GROUP_RAYS; i++) {
        hits[i] = look_down(host, -3.0f + 0.02f * (float)i, &rays[i]);
        indices[i] = i;
    }
    host->direct_radiance(host, rays, hits, PS_STREAM_PLUGIN, 0, indices, GROUP_RAYS, all);
    for (uint32_t turn = 0; turn < 3; turn++) { /* none, soft lights and others, by turns */
        for (uint32_t i = 0; i < GROUP_RAYS; i++)
            groups[i] = (uint8_t)((i + turn) % 3);
        host->direct_radiance_of(host, rays, hits, groups, PS_STREAM_PLUGIN, 0, indices, GROUP_RAYS,
                                 some[turn]);
    }
    for (uint32_t i = 0; i < GROUP_RAYS; i++) {
        float by_group[3];
        for (uint32_t turn = 0; turn < 3; turn++)
            by_group[(i + turn) % 3] = some[turn][i].g;
        assert_true(by_group[0] == 0.0f);
        sums[PS_LIGHTS_SOFT] += (double)by_group[PS_LIGHTS_SOFT];
        sums[PS_LIGHTS_OTHERS] += (double)by_group[PS_LIGHTS_OTHERS];
        float sum = by_group[PS_LIGHTS_SOFT] + by_group[PS_LIGHTS_OTHERS];
        assert_true(fabsf(sum - all[i].g) <= 1e-5f * all[i].g);
    }
}

static void add_both_groups(const ps_host *host)
{
    double sums[4] = {0, 0, 0, 0};
    add_groups(host, sums);
    assert_true(sums[PS_LIGHTS_SOFT] > 0 && sums[PS_LIGHTS_OTHERS] > 0);
}

static void add_others(const ps_host *host)
{
    double sums[4] = {0, 0, 0, 0};
    add_groups(host, sums);
    assert_true(sums[PS_LIGHTS_SOFT] == 0 && sums[PS_LIGHTS_OTHERS] > 0);
}

#define MANY_POINTS POINT POINT POINT POINT POINT POINT POINT POINT POINT

/* By lights that are all asked, and by many of which each point chooses some. */
static void test_groups_of_lights_add_up(void **state)
{
    (void)state;
    with_host_of(SCENE_HEAD LIGHTS SPOT RECTANGLE WIDE_SUN POINT SKY WHITE_FLOOR, add_both_groups);
    with_host_of(SCENE_HEAD LIGHTS MANY_POINTS MANY_POINTS MANY_POINTS WIDE_SUN SKY WHITE_FLOOR,
                 add_both_groups);
    with_host_of(SCENE_HEAD LIGHTS SPOT RECTANGLE WIDE_SUN WHITE_FLOOR, add_others);
}

#define RAYS 400000
#define PLACE_RADIUS 0.25f

/* The share of light paths that pass through a ball around the place, over the area that it
 * shows. */
static double density_by_rays(const ps_host *host, ps_vec3 place)
{
    struct random random = {11};
    int passed = 0;
    for (int i = 0; i < RAYS; i++) {
        float numbers[1][4];
        ps_ray ray;
        ps_rgb power, same_power;
        ps_light_sample start;
        for (int k = 0; k < 4; k++)
            numbers[0][k] = random_between(&random, 0, 1);
        host->emit_points(host, (const float(*)[4])numbers, 1, &ray, &power, &start);
        host->emit_light(host, (const float(*)[4])numbers, 1, &ray, &same_power);
        assert_true(ps_same((ps_vec3){power.r, power.g, power.b},
                            (ps_vec3){same_power.r, same_power.g, same_power.b}));
        assert_true(ps_length(ps_subtract(ray.origin, start.position)) < 0.01f);
        assert_true(start.light < host->light_count(host) && start.probability > 0);
        ps_vec3 way = ps_subtract(place, ray.origin);
        float along = ps_dot(way, ray.direction);
        passed += along > 0 && ps_dot(way, way) - along * along < PLACE_RADIUS * PLACE_RADIUS;
    }
    return (double)passed / RAYS / (double)(PS_PI * PLACE_RADIUS * PLACE_RADIUS);
}

/* Points that sample_light draws have the density that they tell, and by their arrival that of
 * light paths. */
static void compare_densities(const ps_host *host)
{
    static const ps_vec3 place = {0.6f, 1.2f, -0.4f};
    struct random random = {12};
    double arrived = 0;
    for (int i = 0; i < SAMPLES; i++) {
        float numbers[1][4];
        ps_light_sample point;
        ps_light_density density;
        for (int k = 0; k < 4; k++)
            numbers[0][k] = random_between(&random, 0, 1);
        host->sample_light(host, &place, (const float(*)[4])numbers, 1, &point);
        host->light_densities(host, &place, &point, 1, &density);
        float expected = point.probability * point.pdf;
        bool shines = ps_rgb_maximum(point.irradiance) > 0;
        assert_true(!shines || density.arrival > 0);
        assert_true(fabsf(density.direct - expected) < 1e-3f * expected + 1e-9f);
        arrived += shines ? (double)density.arrival / SAMPLES : 0;
    }
    double passed = density_by_rays(host, place);
    print_message("light paths at a place: %.5f by densities, %.5f by rays\n", arrived, passed);
    assert_true(fabs(arrived - passed) <
                0.08 * passed); /* a tight spotlight varies over the ball */
}

static void test_densities_are_those_of_light_paths(void **state)
{
    (void)state;
    static const char *const lights[] = {SPOT, TIGHT_SPOT, POINT,
                                         SUN,  WIDE_SUN,   RECTANGLE,
                                         BALL, SKY,        SPOT RECTANGLE WIDE_SUN POINT};
    for (size_t i = 0; i < sizeof lights / sizeof lights[0]; i++) {
        char text[4096];
        snprintf(text, sizeof text, "%s%s%s%s", SCENE_HEAD, LIGHTS, lights[i], WHITE_FLOOR);
        with_host_of(text, compare_densities);
    }
}

/* Light from all around and from a disc of it: both draw the directions of the disc. */
static void look_at_sun_and_sky(const ps_host *host)
{
    static const ps_vec3 place = {0, 1, 0};
    ps_light_density sum, towards_sky;
    float sun = 0, sky = 0;
    for (int i = 0; i < 100; i++) {
        const float numbers[1][4] = {{0.3f, 0.6f, (float)i / 100, 0}};
        ps_light_sample point;
        ps_light light = {.size = sizeof light};
        host->sample_light(host, &place, numbers, 1, &point);
        host->light(host, point.light, &light);
        *(light.kind == PS_LIGHT_SUN ? &sun : &sky) = point.probability * point.pdf;
        if (light.kind != PS_LIGHT_SUN)
            continue;
        point.light = PS_NO_LIGHT;
        host->light_densities(host, &place, &point, 1, &sum);
        point.direction = ps_scale(point.direction, -1.0f);
        host->light_densities(host, &place, &point, 1, &towards_sky);
    }
    assert_true(sun > 0 && sky > 0);
    assert_true(fabsf(sum.direct - sun - sky) < 1e-4f * sum.direct);
    assert_true(fabsf(towards_sky.direct - sky) < 1e-4f * sky);
    assert_true(sum.arrival == towards_sky.arrival && sum.arrival > 0);
}

static void test_densities_from_afar_add_up(void **state)
{
    (void)state;
    with_host_of(SCENE_HEAD LIGHTS WIDE_SUN "  - sky: {radiance: 0.2}\n" WHITE_FLOOR,
                 look_at_sun_and_sky);
}

static void look_at_objects(const ps_host *host)
{
    assert_int_equal(host->light_of_object(host, 0), PS_NO_LIGHT);
    assert_int_equal(host->light_of_object(host, 1), 0);
    static const int32_t shown[] = {1, 0, 1, 0, 0};
    for (uint32_t i = 0; i < 5; i++)
        assert_int_equal(host->is_shown(host, i), shown[i]);
}

static void test_objects_that_shine_or_are_hidden(void **state)
{
    (void)state;
    with_host_of(SCENE_HEAD
                 "  lamp: {diffuse: 0, emission: 1}\n" WHITE_FLOOR
                 "  - sphere: {center: [0, 5, 0], radius: 1, material: lamp, camera: no}\n"
                 "  - instance: {of: pair}\n"
                 "  - instance: {of: one, camera: no}\n"
                 "groups:\n"
                 "  pair: [{sphere: {center: [0, 2, 0], radius: 1, material: white}},\n"
                 "         {sphere: {center: [3, 2, 0], radius: 1, material: white, camera: no}}]\n"
                 "  one: [{sphere: {center: [6, 2, 0], radius: 1, material: white}}]\n",
                 look_at_objects);
}

/* The point of a triangle is where a ray at right angles to it meets the surface, with all that a
 * ray learns of it. */
static void compare_point(const ps_host *host, const ps_triangle *triangle, uint32_t number,
                          uint32_t back)
{
    const ps_surface_point point = {triangle->object, number, 0.3f, 0.25f, back};
    const ps_vec3 *corners = triangle->vertices;
    ps_vec3 expected = ps_add_scaled(ps_add_scaled(ps_scale(corners[0], 0.45f), 0.3f, corners[1]),
                                     0.25f, corners[2]);
    ps_ray ray;
    ps_hit at, met;
    host->surface_points(host, &point, 1, &ray, &at);
    host->intersect(host, &ray, 1, &met);
    assert_int_equal(at.object, triangle->object);
    assert_int_equal(met.object, triangle->object);
    assert_int_equal(at.material, met.material);
    assert_int_equal(at.flags, met.flags);
    assert_int_equal((at.flags & PS_HIT_BACK) != 0, back);
    /* A sphere's triangles are up to 2 % of its radius from it. */
    assert_true(ps_length(ps_subtract(at.position, expected)) < 0.02f);
    assert_true(ps_length(ps_subtract(at.position, met.position)) < 1e-4f);
    assert_true(ps_dot(at.geometric_normal, met.geometric_normal) > 0.9999f);
    assert_true(ps_dot(at.normal, met.normal) > 0.9999f);
    assert_true(ps_dot(at.geometric_normal, triangle->normal) * (back ? -1.0f : 1.0f) > 0.98f);
    assert_true(fabsf(at.albedo.g - met.albedo.g) < 1e-3f);
}

static void look_at_points(const ps_host *host)
{
    uint32_t number = 0, object = PS_NO_OBJECT, objects = 0;
    for (uint64_t i = 0; i < host->triangle_count(host); i++) {
        ps_triangle triangle;
        host->triangles(host, i, 1, &triangle);
        if (triangle.object != object) {
            number = 0;
            objects++;
        }
        object = triangle.object;
        compare_point(host, &triangle, number, 0);
        compare_point(host, &triangle, number++, 1);
    }
    assert_int_equal(objects, 6);
}

static void test_points_of_triangles(void **state)
{
    (void)state;
    with_host_of(
        SCENE_HEAD
        "  striped: {diffuse: {checker: {colors: [0.2, 0.7]}}}\n" WHITE_FLOOR
        "  - sphere: {center: [0, 4, 0], radius: 1, material: white}\n"
        "  - instance: {of: pair, translate: [4, 0, 0]}\n"
        "  - instance: {of: pair, scale: [-1, 1, 1], rotate: [0, 40, 0], translate: [-4, 0, 2]}\n"
        "groups:\n"
        "  pair: [{sphere: {center: [0, 2, 0], radius: 0.5, material: white}},\n"
        "         {box: {corners: [[1, 1, 0], [2, 2, 1]], material: striped}}]\n",
        look_at_points);
}

static void look_at_hole(const ps_host *host)
{
    uint32_t holes = 0;
    for (int i = 0; i < 100; i++) {
        const ps_surface_point point = {0, 0, 0.09f * (float)(i % 10), 0.01f * (float)(i / 10), 0};
        ps_ray ray;
        ps_hit hit;
        host->surface_points(host, &point, 1, &ray, &hit);
        holes += hit.object == PS_NO_OBJECT && !(hit.distance < INFINITY);
    }
    assert_true(holes > 20 && holes < 80);
}

static void test_points_in_holes(void **state)
{
    (void)state;
    with_host_of(
        "psd: 1\n"
        "camera: {location: [0, 5, 5], look_at: [0, 0, 0], angle: 60}\n"
        "image: {width: 16, height: 16}\n"
        "materials: {net: {diffuse: 0.5, opacity: {checker: {colors: [0, 1]}}}}\n"
        "lights: [{point: {location: [0, 9, 0], intensity: 1}}]\n"
        "objects:\n"
        "  - quad: {corners: [[-4, 0, 4], [4, 0, 4], [4, 0, -4], [-4, 0, -4]], material: net}\n",
        look_at_hole);
}

static void expect_darkness(const ps_host *host)
{
    static const ps_vec3 place = {0, 1, 0};
    static const float numbers[1][4] = {{0.5f, 0.5f, 0.5f, 0.5f}};
    ps_light_sample sample;
    host->sample_light(host, &place, numbers, 1, &sample);
    assert_true(ps_rgb_maximum(sample.irradiance) == 0);
}

static void test_no_light_gives_no_sample(void **state)
{
    (void)state;
    with_host_of(SCENE_HEAD WHITE_FLOOR, expect_darkness);
}

/* --- triangles -------------------------------------------------------------------------------- */

/* Area and triangles by object, for batches of that size. */
static void add_areas(const ps_host *host, size_t batch, double areas[8], size_t counts[8])
{
    ps_triangle triangles[64];
    uint64_t first = 0;
    for (size_t n; (n = host->triangles(host, first, batch, triangles)) > 0; first += n)
        for (size_t i = 0; i < n; i++) {
            const ps_triangle *t = &triangles[i];
            ps_vec3 across = ps_cross(ps_subtract(t->vertices[1], t->vertices[0]),
                                      ps_subtract(t->vertices[2], t->vertices[0]));
            assert_true(t->object < 8);
            assert_true(fabsf(ps_length(across) - 2 * t->area) < 1e-4f * t->area);
            assert_true(ps_dot(across, t->normal) > 1.999f * t->area);
            areas[t->object] += (double)t->area;
            counts[t->object]++;
        }
    assert_int_equal(first, host->triangle_count(host));
    assert_int_equal(host->triangles(host, first, 1, triangles), 0);
}

static void look_at_triangles(const ps_host *host)
{
    double expected[5] = {100, 24, 4 * (double)PS_PI, 4 * 4, 4 * 4 * (double)PS_PI};
    for (size_t batch = 1; batch <= 64; batch += 21) {
        double areas[8] = {0};
        size_t counts[8] = {0};
        add_areas(host, batch, areas, counts);
        for (int i = 0; i < 5; i++)
            assert_true(fabs(areas[i] / expected[i] - 1) < 1e-5);
        assert_true(counts[0] == 2 && counts[1] == 12 && counts[2] == PS_SPHERE_TRIANGLES);
        assert_true(areas[5] == 0);
    }
    /* Each of a sphere's looks outwards. */
    static ps_triangle ball[PS_SPHERE_TRIANGLES];
    assert_int_equal(host->triangles(host, 14, PS_SPHERE_TRIANGLES, ball), PS_SPHERE_TRIANGLES);
    for (size_t i = 0; i < PS_SPHERE_TRIANGLES; i++) {
        ps_vec3 out = ps_subtract(ball[i].vertices[0], (ps_vec3){0, 5, 0});
        assert_true(ps_dot(out, ball[i].normal) > 0);
        assert_true(fabsf(ps_length(out) - 1) < 0.02f);
    }
}

static void test_triangles_have_the_scenes_area(void **state)
{
    (void)state;
    with_host_of(
        SCENE_HEAD
        "groups:\n  pair:\n"
        "    - quad: {corners: [[0, 0, 2], [2, 0, 2], [2, 0, 0], [0, 0, 0]], material: red}\n"
        "    - sphere: {center: [0, 1, 0], radius: 1, material: red}\n" LIGHTS POINT
        "objects:\n" FLOOR(
            "-5", "5",
            "white") "  - box: {corners: [[6, 0, 0], [8, 2, 2]], material: white}\n"
                     "  - sphere: {center: [0, 5, 0], radius: 1, material: white}\n"
                     "  - instance: {of: pair, scale: [-2, 2, 2], translate: [20, 0, 0]}\n",
        look_at_triangles);
}

/* --- the camera and its picture --------------------------------------------------------------- */

static void count_tile(void *user, uint64_t index, uint32_t worker)
{
    uint32_t *visits = user;
    (void)worker;
    visits[index]++;
}

/* A tile that is there shows the same; of a module's shorter struct, nothing behind its end is
 * written to. */
static void look_at_tile_surfaces(const ps_host *host)
{
    const ps_tile *there = host->tile(host, 0);
    ps_tile seen;
    uint32_t visits[1] = {0};
    memset(&seen, 0x5a, sizeof seen);
    host->tile_surfaces(host, 0, offsetof(ps_tile, radiance_r), &seen);
    const unsigned char *behind = (const unsigned char *)&seen.radiance_r;
    for (size_t i = 0; i < sizeof seen - offsetof(ps_tile, radiance_r); i++)
        assert_int_equal(behind[i], 0x5a);
    host->tile_surfaces(host, 0, sizeof seen, &seen);
    assert_null(seen.radiance_r);
    for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++) {
        assert_true(seen.object[lane] == there->object[lane] && seen.weight[lane] == 0.0f);
        assert_true(ps_same(ps_tile_position(&seen, lane), ps_tile_position(there, lane)));
        assert_true(seen.throughput_g[lane] == there->throughput_g[lane]);
    }
    assert_int_equal(host->for_each_picture_tile(host, count_tile, visits), PS_OK);
    assert_int_equal(visits[0], 1);
}

static ps_result look_at_picture(void *user, struct render *render, struct error *error)
{
    (void)user;
    (void)error;
    const ps_host *host = &render->hosts[PS_ESTIMATOR].host;
    ps_camera camera = {.size = sizeof camera};
    static ps_ray rays[PS_TILE_PIXELS];
    static ps_hit hits[PS_TILE_PIXELS];
    uint32_t x, y, tile, lane, seen = 0;
    host->camera(host, &camera);
    assert_true(camera.width == 16 && camera.height == 9 && camera.projection == PS_PERSPECTIVE);
    host->tile_hits(host, 0, rays, hits);
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        const ps_tile *pixels = host->tile(host, 0);
        if (!host->pixel(host, 0, i, &x, &y))
            continue;
        assert_true(host->tile_of(host, x, y, &tile, &lane) && tile == 0 && lane == i);
        assert_true((hits[i].object == PS_NO_OBJECT) == (pixels->object[i] == PS_NO_OBJECT));
        if (pixels->object[i] == PS_NO_OBJECT)
            continue;
        ps_vec3 position = ps_tile_position(pixels, i);
        float place[1][2];
        assert_true(ps_same(position, hits[i].position) && hits[i].object == pixels->object[i]);
        ps_vec3 met = ps_add_scaled(rays[i].origin, hits[i].distance, rays[i].direction);
        assert_true(ps_length(ps_subtract(met, position)) < 1e-4f);
        host->project(host, &position, 1, place);
        assert_true(fabsf(place[0][0] - (float)x - 0.5f) < 1e-2f);
        assert_true(fabsf(place[0][1] - (float)y - 0.5f) < 1e-2f);
        ps_vec3 towards = ps_add_scaled(camera.corner, place[0][0], camera.across);
        towards = ps_normalize(ps_add_scaled(towards, place[0][1], camera.down));
        assert_true(ps_dot(towards, ps_normalize(ps_subtract(position, camera.position))) >
                    0.9999f);
        seen++;
    }
    assert_true(seen > 50);
    look_at_tile_surfaces(host);
    assert_false(host->tile_of(host, 16, 0, &tile, &lane));
    const ps_vec3 behind = ps_add_scaled(camera.position, -1.0f, camera.forward);
    float nowhere[1][2];
    host->project(host, &behind, 1, nowhere);
    assert_true(isnan(nowhere[0][0]));
    return PS_OK;
}

static void test_pixels_are_where_the_camera_sees_them(void **state)
{
    (void)state;
    static const char *const choices[] = {"injection=photon:count=10", NULL};
    inspect_text(SCENE_HEAD LIGHTS SPOT ROOM_OBJECTS, choices, look_at_picture, NULL);
}

/* --- names ------------------------------------------------------------------------------------ */

static void look_at_names(const ps_host *host)
{
    const ps_cells *cells = host->extension(host, PS_CELLS_EXTENSION);
    assert_non_null(cells);
    assert_true(cells->size == sizeof *cells);
    assert_null(host->extension(host, "psplat.cells/2"));
    assert_null(host->extension(host, ""));
}

static void test_extensions_go_by_name(void **state)
{
    (void)state;
    with_host_of(SCENE_HEAD WHITE_FLOOR, look_at_names);
}

/* A caller that was built before a struct grew gets what it knows of, and nothing past it. */
static void look_at_sizes(const ps_host *host)
{
    ps_light whole = {.size = sizeof whole}, part;
    memset(&part, 0x55, sizeof part);
    part.size = offsetof(ps_light, position);
    host->light(host, 0, &whole);
    host->light(host, 0, &part);
    assert_true(part.kind == whole.kind && part.cos_cone == whole.cos_cone);
    for (size_t i = offsetof(ps_light, position); i < sizeof part; i++)
        assert_int_equal(((const uint8_t *)&part)[i], 0x55);
}

static void test_callers_get_what_they_know(void **state)
{
    (void)state;
    with_host_of(SCENE_HEAD LIGHTS SPOT WHITE_FLOOR, look_at_sizes);
}

/* Kinds draw from streams of their own, but for the streams that have a purpose. */
static ps_result look_at_streams(void *user, struct render *render, struct error *error)
{
    (void)user;
    (void)error;
    static const uint64_t index = 5;
    for (int a = 0; a < PS_KINDS; a++)
        for (int b = 0; b < a; b++) {
            float one[1][4], other[1][4];
            const ps_host *first = &render->hosts[a].host, *second = &render->hosts[b].host;
            first->samples(first, PS_STREAM_PLUGIN, 0, &index, 1, one);
            second->samples(second, PS_STREAM_PLUGIN, 0, &index, 1, other);
            assert_true(one[0][0] != other[0][0]);
            first->samples(first, PS_STREAM_PATH, 0, &index, 1, one);
            second->samples(second, PS_STREAM_PATH, 0, &index, 1, other);
            assert_true(one[0][0] == other[0][0]);
        }
    return PS_OK;
}

static void test_streams_are_apart(void **state)
{
    (void)state;
    static const char *const choices[] = {"injection=photon:count=10", NULL};
    inspect_text(SCENE_HEAD LIGHTS SPOT ROOM_OBJECTS, choices, look_at_streams, NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bsdf_is_what_is_sampled),
        cmocka_unit_test(test_light_samples_add_up),
        cmocka_unit_test(test_groups_of_lights_add_up),
        cmocka_unit_test(test_densities_are_those_of_light_paths),
        cmocka_unit_test(test_densities_from_afar_add_up),
        cmocka_unit_test(test_objects_that_shine_or_are_hidden),
        cmocka_unit_test(test_points_of_triangles),
        cmocka_unit_test(test_points_in_holes),
        cmocka_unit_test(test_no_light_gives_no_sample),
        cmocka_unit_test(test_triangles_have_the_scenes_area),
        cmocka_unit_test(test_pixels_are_where_the_camera_sees_them),
        cmocka_unit_test(test_extensions_go_by_name),
        cmocka_unit_test(test_callers_get_what_they_know),
        cmocka_unit_test(test_streams_are_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
