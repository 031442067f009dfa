/* test_trace.c: what rays meet. A scene of few triangles has a tree for each shape, one of many has
 * one for all of them (trace.c): both must find the same, and let nothing through where triangles
 * touch. */
#include "trace/trace.h"

#include "support/random.h"
#include "support/render_scene.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define RAYS 4096
#define SIDE 10.0f /* of the room, from the origin on */

#define ROOM                                                                                       \
    "psd: 1\n"                                                                                     \
    "camera: {location: [5, 5, 1], look_at: [5, 5, 5]}\n"                                          \
    "materials: {white: {diffuse: [0.7, 0.7, 0.7]}, mirror: {mirror: 0.8},\n"                      \
    "            glass: {dielectric: {ior: 1.5}},\n"                                               \
    "            satin: {glossy: {diffuse: 0.5, specular: 0.2, roughness: 0.3}}}\n"                \
    "objects:\n"                                                                                   \
    "  - box: {corners: [[0, 0, 0], [10, 10, 10]], material: white}\n"                             \
    "  - box: {corners: [[1, 0.5, 2], [4, 3, 5]], material: white}\n"                              \
    "  - box: {corners: [[3, 2, 3], [6, 6, 8]], material: white, rotate: [0, 20, 0]}\n"            \
    "  - sphere: {center: [7, 2, 4], radius: 2, material: white}\n"                                \
    "  - cylinder: {from: [8, 0.5, 8], to: [8, 7, 8], radius: 1, material: white}\n"

/* Far from the room, and more than trees of their own are made for. */
#define MANY_TRIANGLES                                                                             \
    "  - {for: i, from: 0, to: 19, do: {torus: {radius: 3, minor_radius: 1, material: white,\n"    \
    "      translate: [0, =0 - 100 - 10 * i, 0]}}}\n"

struct traced {
    struct scene scene;
    struct trace *trace;
};

/* The tracer keeps the scene's address. */
static void trace_text(const char *text, struct traced *traced)
{
    struct error error;
    traced->scene = scene_of_text(text);
    assert_int_equal(trace_create(&traced->scene, NULL, &traced->trace, &error), PS_OK);
}

static void traced_release(struct traced *traced)
{
    trace_destroy(traced->trace);
    scene_release(&traced->scene);
}

static size_t triangles_of(const struct scene *scene)
{
    size_t triangles = 0;
    for (size_t i = 0; i < scene->world_shape_count; i++)
        triangles += scene->shapes[i].triangle_count;
    return triangles;
}

static ps_vec3 point_in_room(struct random *random)
{
    return (ps_vec3){random_between(random, 0, SIDE), random_between(random, 0, SIDE),
                     random_between(random, 0, SIDE)};
}

static void test_both_trees_find_the_same(void **state)
{
    (void)state;
    static ps_ray rays[RAYS];
    static ps_hit few_hits[RAYS], many_hits[RAYS];
    static uint8_t few_blocked[RAYS], many_blocked[RAYS];
    struct traced few, many;
    struct random random = {1};
    trace_text(ROOM, &few);
    trace_text(ROOM MANY_TRIANGLES, &many);
    assert_true(triangles_of(&few.scene) < 10000 && triangles_of(&many.scene) > 70000);
    for (size_t i = 0; i < RAYS; i++)
        rays[i] = (ps_ray){point_in_room(&random), 0, random_direction(&random),
                           random_between(&random, 1, 10)};
    trace_intersect(few.trace, RAYS_INCOHERENT, rays, NULL, RAYS, few_hits);
    trace_intersect(many.trace, RAYS_INCOHERENT, rays, NULL, RAYS, many_hits);
    trace_occluded(few.trace, rays, RAYS, few_blocked);
    trace_occluded(many.trace, rays, RAYS, many_blocked);
    size_t met = 0;
    for (size_t i = 0; i < RAYS; i++) {
        met += few_hits[i].distance < INFINITY;
        assert_true(few_hits[i].distance == many_hits[i].distance);
        assert_true(few_hits[i].object == many_hits[i].object);
        assert_true(ps_same(few_hits[i].position, many_hits[i].position));
        assert_true(ps_same(few_hits[i].normal, many_hits[i].normal));
        assert_true(few_blocked[i] == (few_hits[i].distance < INFINITY));
        assert_true(few_blocked[i] == many_blocked[i]);
    }
    assert_true(met > RAYS / 2 && met < RAYS);
    traced_release(&few);
    traced_release(&many);
}

/* A point on an edge of the room, or one of its corners. */
static ps_vec3 point_on_edge(struct random *random)
{
    float along = random_unit(random) < 0.1f ? 0.0f : random_between(random, 0, SIDE);
    float a = random_unit(random) < 0.5f ? 0.0f : SIDE,
          b = random_unit(random) < 0.5f ? 0.0f : SIDE;
    float axis = random_between(random, 0, 3);
    if (axis < 1)
        return (ps_vec3){along, a, b};
    return axis < 2 ? (ps_vec3){a, along, b} : (ps_vec3){a, b, along};
}

static void expect_closed(const char *text)
{
    static ps_ray rays[RAYS];
    static ps_hit hits[RAYS];
    struct traced traced;
    struct random random = {2};
    trace_text(text, &traced);
    for (size_t i = 0; i < RAYS; i++) {
        ps_vec3 from = point_in_room(&random);
        ps_vec3 way = ps_subtract(point_on_edge(&random), from);
        rays[i] = (ps_ray){from, 0, ps_normalize(way), INFINITY};
    }
    trace_intersect(traced.trace, RAYS_INCOHERENT, rays, NULL, RAYS, hits);
    for (size_t i = 0; i < RAYS; i++)
        assert_true(hits[i].distance < 2 * SIDE);
    traced_release(&traced);
}

static void test_nothing_gets_through_edges(void **state)
{
    (void)state;
    expect_closed(ROOM);
    expect_closed(ROOM MANY_TRIANGLES);
}

#define MIRRORS                                                                                    \
    "  - sphere: {center: [2, 7, 7], radius: 2, material: mirror}\n"                               \
    "  - box: {corners: [[6, 7, 1], [9, 9, 4]], material: glass}\n"                                \
    "  - sphere: {center: [7, 6, 7], radius: 1.5, material: satin}\n"

/* Where a diffuse surface lies before a mirror, it is not looked through. */
static void test_specular_surfaces_alone(void **state)
{
    (void)state;
    static ps_ray rays[RAYS];
    static ps_hit hits[RAYS], specular[RAYS];
    struct traced traced;
    struct random random = {3};
    size_t met = 0;
    trace_text(ROOM MIRRORS, &traced);
    for (size_t i = 0; i < RAYS; i++)
        rays[i] = (ps_ray){point_in_room(&random), 0, random_direction(&random), INFINITY};
    trace_intersect(traced.trace, RAYS_INCOHERENT, rays, NULL, RAYS, hits);
    trace_intersect_specular(traced.trace, rays, RAYS, specular);
    for (size_t i = 0; i < RAYS; i++) {
        bool is_specular = hits[i].flags & PS_HIT_SPECULAR;
        met += is_specular;
        if (is_specular)
            assert_memory_equal(&specular[i], &hits[i], sizeof hits[i]);
        else
            assert_true(isinf(specular[i].distance) && specular[i].object == PS_NO_OBJECT);
    }
    assert_in_range(met, RAYS / 10, RAYS / 2);
    traced_release(&traced);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_both_trees_find_the_same),
        cmocka_unit_test(test_nothing_gets_through_edges),
        cmocka_unit_test(test_specular_surfaces_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
