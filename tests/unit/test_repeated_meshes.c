/* Meshes that repeat become instances, and rays meet the same surfaces as before. */
#include "scene/repeated_meshes.h"

#include "parser/psd.h"
#include "scene/scene.h"
#include "support/random.h"
#include "trace/trace.h"
#include <psplat/math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define SIDE 120 /* squares along a side of the mesh */
#define TRIANGLES (2 * SIDE * SIDE)
#define COPIES 12
#define RAYS 4096

/* Which of the scene's materials: plain, a checkerboard in space, mixes of it. */
enum { PLAIN, PATTERN, OUTER, MIXED };

static const char text[] =
    "psd: 1\n"
    "camera: {location: [0, 0, -5], look_at: [0, 0, 0]}\n"
    "materials:\n"
    "  plain: {diffuse: [0.5, 0.4, 0.3]}\n"
    "  pattern: {diffuse: {checker: {colors: [[0.1, 0.1, 0.1], [0.7, 0.7, 0.7]]}}}\n"
    "  outer: {mix: [{material: mixed, weight: 0.5}]}\n"
    "  mixed: {mix: [{material: pattern, weight: 0.5}, {material: plain, weight: 0.5}]}\n"
    "objects: [{sphere: {center: [0, 0, 0], radius: 1, material: plain}}]\n";

/* A wavy square in -1..1, with smooth normals and texture coordinates. */
static void make_mesh(struct mesh_description *mesh)
{
    size_t count = (SIDE + 1) * (SIDE + 1);
    *mesh = (struct mesh_description){
        .vertices = malloc(count * sizeof *mesh->vertices),
        .normals = malloc(count * sizeof *mesh->normals),
        .uv = malloc(count * sizeof *mesh->uv),
        .vertex_count = count,
        .triangles = malloc(TRIANGLES * sizeof *mesh->triangles),
    };
    for (uint32_t i = 0; i < count; i++) {
        uint32_t row = i / (SIDE + 1);
        float u = (float)(i % (SIDE + 1)) / SIDE, v = (float)row / SIDE;
        mesh->vertices[i] = (ps_vec3){2 * u - 1, 2 * v - 1, 0.1f * sinf(9 * u) * sinf(7 * v)};
        mesh->normals[i] =
            (ps_vec3){-0.9f * cosf(9 * u) * sinf(7 * v), -0.7f * sinf(9 * u) * cosf(7 * v), 2};
        mesh->uv[i][0] = u;
        mesh->uv[i][1] = v;
    }
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t at = i / SIDE * (SIDE + 1) + i % SIDE;
        memcpy(mesh->triangles[mesh->triangle_count++], (uint32_t[]){at, at + 1, at + SIDE + 2},
               12);
        memcpy(mesh->triangles[mesh->triangle_count++],
               (uint32_t[]){at, at + SIDE + 2, at + SIDE + 1}, 12);
    }
}

/* Turned, stretched, mirrored, some hidden. */
static struct object_description copy_number(size_t i, size_t material)
{
    float angle = (float)i, size = 0.5f + 0.1f * (float)i, mirror = i % 3 == 2 ? -1.0f : 1.0f;
    return (struct object_description){
        .kind = OBJECT_MESH,
        .material = material,
        .placement = {{size * cosf(angle), size * sinf(angle), 0},
                      {-1.5f * sinf(angle), 1.5f * cosf(angle), 0.3f},
                      {0.2f, 0, mirror},
                      {4 * sinf(3 * angle), 4 * cosf(5 * angle), (float)i - 6}},
        .texture = NO_INDEX,
        .mesh = 0,
        .group = NO_INDEX,
        .hidden = i == 4,
        .front_only = i == 7,
        .origin = {"scene.psd", 1, 1},
    };
}

static void describe(size_t copies, size_t material, struct scene_description *description)
{
    struct diagnostics *sink = diagnostics_create();
    assert_int_equal(psd_read_text("scene.psd", text, sizeof text - 1, sink, description), PS_OK);
    diagnostics_destroy(sink);
    description->meshes = malloc(sizeof *description->meshes);
    make_mesh(&description->meshes[description->mesh_count++]);
    description->objects =
        realloc(description->objects, (copies + 1) * sizeof *description->objects);
    assert_non_null(description->objects);
    for (size_t i = 0; i < copies; i++)
        description->objects[description->object_count++] = copy_number(i, material);
}

static size_t instances_of(size_t copies, size_t material)
{
    struct scene_description description;
    size_t count = 0;
    describe(copies, material, &description);
    assert_true(scene_description_share_meshes(&description));
    for (size_t i = 0; i < description.object_count; i++)
        count += description.objects[i].kind == OBJECT_INSTANCE;
    assert_int_equal(description.group_count, count > 0);
    assert_int_equal(description.object_count, copies + 1);
    scene_description_release(&description);
    return count;
}

static void many_copies_are_instances(void **state)
{
    const size_t enough = REPEATED_TRIANGLES / TRIANGLES + 1;
    (void)state;
    assert_true(enough < COPIES);
    assert_int_equal(instances_of(COPIES, PLAIN), COPIES);
    assert_int_equal(instances_of(enough, PLAIN), enough);
    assert_int_equal(instances_of(enough - 1, PLAIN), 0);
}

static void make_material(struct scene_description *description, bool bump)
{
    struct material_description *material = &description->materials[PLAIN];
    struct pigment_description *pigment = bump ? &material->bump : &material->normal_map;
    pigment->kind = PIGMENT_IMAGE;
}

static void bumps_need_their_scale(void **state)
{
    (void)state;
    for (int bump = 0; bump < 2; bump++) {
        struct scene_description description;
        describe(COPIES, PLAIN, &description);
        make_material(&description, bump);
        assert_true(scene_description_share_meshes(&description));
        assert_int_equal(description.group_count, 0); /* each placement stretches it */
        for (size_t i = 1; i < description.object_count; i++)
            description.objects[i].placement =
                affine_of((ps_vec3){-2, -2, -2}, (ps_vec3){10, 20, 30}, (ps_vec3){(float)i, 0, 0});
        assert_true(scene_description_share_meshes(&description));
        assert_int_equal(description.group_count, bump ? 0 : 1);
        scene_description_release(&description);
    }
}

static void patterns_in_space_stay(void **state)
{
    (void)state;
    assert_int_equal(instances_of(COPIES, PATTERN), 0);
    assert_int_equal(instances_of(COPIES, MIXED), 0);
    assert_int_equal(instances_of(COPIES, OUTER), 0);
}

/* --- what rays meet
 * ----------------------------------------------------------------------------------- */

static void trace_copies(bool shared, enum ray_kind kind, const ps_ray *rays, ps_hit *hits)
{
    struct scene_description description;
    struct scene scene;
    struct trace *trace;
    struct error error;
    describe(COPIES, PLAIN, &description);
    if (shared)
        assert_true(scene_description_share_meshes(&description));
    assert_int_equal(scene_create(&description, &scene, NULL, &error), PS_OK);
    assert_int_equal(scene.instance_count, shared ? COPIES : 0);
    assert_int_equal(scene.object_count, COPIES + 1);
    assert_int_equal(trace_create(&scene, NULL, &trace, &error), PS_OK);
    trace_intersect(trace, kind, rays, NULL, RAYS, hits);
    trace_destroy(trace);
    scene_release(&scene);
    scene_description_release(&description);
}

static bool is_near(ps_vec3 a, ps_vec3 b, float tolerance)
{
    return ps_length(ps_subtract(a, b)) <= tolerance;
}

/* Rays that graze an edge may choose the other side. */
static void compare(enum ray_kind kind)
{
    static ps_ray rays[RAYS];
    static ps_hit copies[RAYS], instances[RAYS];
    struct random random = {7};
    size_t met = 0, other = 0;
    for (size_t i = 0; i < RAYS; i++) {
        ps_vec3 from = ps_scale(random_direction(&random), 15);
        ps_vec3 to = ps_scale(random_direction(&random), random_between(&random, 0, 6));
        rays[i] = (ps_ray){from, 0, ps_normalize(ps_subtract(to, from)), INFINITY};
    }
    trace_copies(false, kind, rays, copies);
    trace_copies(true, kind, rays, instances);
    for (size_t i = 0; i < RAYS; i++) {
        const ps_hit *a = &copies[i], *b = &instances[i];
        bool same = a->object == PS_NO_OBJECT
                        ? b->object == PS_NO_OBJECT
                        : a->object == b->object && is_near(a->position, b->position, 1e-4f) &&
                              is_near(a->normal, b->normal, 1e-3f) &&
                              is_near(a->geometric_normal, b->geometric_normal, 1e-3f) &&
                              fabsf(a->uv[0] - b->uv[0]) < 1e-3f &&
                              fabsf(a->uv[1] - b->uv[1]) < 1e-3f;
        met += a->object != PS_NO_OBJECT;
        other += !same;
    }
    assert_true(met > RAYS / 4 && met < RAYS);
    if (other > RAYS / 500)
        fail_msg("%zu of %d rays meet something else", other, RAYS);
}

static void rays_meet_the_same(void **state)
{
    (void)state;
    compare(RAYS_INCOHERENT);
    compare(RAYS_CAMERA); /* which some do not see, or from the front alone */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(many_copies_are_instances),
        cmocka_unit_test(patterns_in_space_stay),
        cmocka_unit_test(bumps_need_their_scale),
        cmocka_unit_test(rays_meet_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
