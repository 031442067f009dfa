/* test_scene_digest.c: every member of a description counts. Bytes that change nothing are those of
 * pointers, of where things were written, and gaps, which are listed here: a new member shows up as
 * bytes that ought to count. */
#include "base/digest.h"
#include "scene/scene_digest.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

typedef void (*digester)(uint64_t *digest, const void *thing);

static void of_material(uint64_t *digest, const void *thing)
{
    scene_digest_material(digest, thing);
}

static void of_light(uint64_t *digest, const void *thing)
{
    scene_digest_light(digest, thing);
}

static void of_object(uint64_t *digest, const void *thing)
{
    scene_digest_object(digest, thing);
}

static void of_camera(uint64_t *digest, const void *thing)
{
    scene_digest_camera(digest, thing);
}

struct range {
    size_t first, size;
};

static bool is_free(const struct range *free, size_t byte)
{
    bool within = false;
    for (; free->first != SIZE_MAX; free++)
        within |= byte >= free->first && byte - free->first < free->size;
    return within;
}

/* Flips each byte of a thing that is zero. */
static void expect_all_bytes_count(digester digest, void *thing, size_t size,
                                   const struct range *free)
{
    uint64_t before = DIGEST_START;
    unsigned char *bytes = thing;
    digest(&before, thing);
    for (size_t i = 0; i < size; i++) {
        uint64_t after = DIGEST_START;
        if (is_free(free, i))
            continue;
        bytes[i] ^= 1;
        digest(&after, thing);
        bytes[i] ^= 1;
        if (after == before)
            fail_msg("byte %zu of %zu does not count", i, size);
    }
}

#define MEMBER(type, member)                                                                       \
    {                                                                                              \
        offsetof(struct type, member), sizeof(((struct type *)0)->member)                          \
    }
/* The gap that may follow a member, before the next. */
#define GAP(type, member, next)                                                                    \
    {                                                                                              \
        offsetof(struct type, member) + sizeof(((struct type *)0)->member),                        \
            offsetof(struct type, next) - offsetof(struct type, member) -                          \
                sizeof(((struct type *)0)->member)                                                 \
    }
#define PIGMENT_GAPS(of)                                                                           \
    {offsetof(struct material_description, of) + offsetof(struct pigment_description, colors) +    \
         sizeof(((struct pigment_description *)0)->colors),                                        \
     4},                                                                                           \
    {                                                                                              \
        offsetof(struct material_description, of) +                                                \
            offsetof(struct pigment_description, vertex_colors) + sizeof(bool),                    \
            sizeof(float) - 2 * sizeof(bool)                                                       \
    }

static void test_materials(void **state)
{
    (void)state;
    static const struct range free[] = {MEMBER(material_description, name),
                                        MEMBER(material_description, components),
                                        MEMBER(material_description, weights),
                                        MEMBER(material_description, component_count),
                                        MEMBER(material_description, origin),
                                        GAP(material_description, kind, color),
                                        GAP(material_description, absorption, emission),
                                        GAP(material_description, emission_both, opacity),
                                        GAP(material_description, blended, bump),
                                        GAP(material_description, varying, share),
                                        PIGMENT_GAPS(color),
                                        PIGMENT_GAPS(specular),
                                        PIGMENT_GAPS(roughness),
                                        PIGMENT_GAPS(emission),
                                        PIGMENT_GAPS(opacity),
                                        PIGMENT_GAPS(bump),
                                        PIGMENT_GAPS(normal_map),
                                        PIGMENT_GAPS(share),
                                        {SIZE_MAX, 0}};
    struct material_description material;
    memset(&material, 0, sizeof material);
    expect_all_bytes_count(of_material, &material, sizeof material, free);
    size_t component = 3;
    double weight = 0.5;
    uint64_t before = DIGEST_START, after = DIGEST_START;
    material.components = &component;
    material.weights = &weight;
    material.component_count = 1;
    scene_digest_material(&before, &material);
    weight = 0.25;
    scene_digest_material(&after, &material);
    assert_true(before != after);
}

static void test_lights(void **state)
{
    (void)state;
    static const struct range free[] = {MEMBER(light_description, origin),
                                        GAP(light_description, direction, radius),
                                        GAP(light_description, visible, texture),
                                        {SIZE_MAX, 0}};
    struct light_description light;
    memset(&light, 0, sizeof light);
    expect_all_bytes_count(of_light, &light, sizeof light, free);
}

static void test_objects(void **state)
{
    (void)state;
    static const struct range free[] = {MEMBER(object_description, vertices),
                                        MEMBER(object_description, vertex_count),
                                        MEMBER(object_description, triangles),
                                        MEMBER(object_description, triangle_count),
                                        MEMBER(object_description, origin),
                                        GAP(object_description, kind, material),
                                        GAP(object_description, placement, vertices),
                                        GAP(object_description, normal, radius),
                                        GAP(object_description, smooth, segments),
                                        GAP(object_description, hidden, origin),
                                        {SIZE_MAX, 0}};
    struct object_description object;
    memset(&object, 0, sizeof object);
    expect_all_bytes_count(of_object, &object, sizeof object, free);
    ps_vec3 vertex = {1, 2, 3};
    uint64_t before = DIGEST_START, after = DIGEST_START;
    object.vertices = &vertex;
    object.vertex_count = 1;
    scene_digest_object(&before, &object);
    vertex.z = 4;
    scene_digest_object(&after, &object);
    assert_true(before != after);
}

static void test_camera(void **state)
{
    (void)state;
    static const struct range free[] = {GAP(camera, orthographic, location), {SIZE_MAX, 0}};
    struct camera camera;
    memset(&camera, 0, sizeof camera);
    expect_all_bytes_count(of_camera, &camera, sizeof camera, free);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_materials),
        cmocka_unit_test(test_lights),
        cmocka_unit_test(test_objects),
        cmocka_unit_test(test_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
