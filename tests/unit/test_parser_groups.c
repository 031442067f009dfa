/* test_parser_groups.c: groups and their instances. */
#include "parser_fixture.h"

#undef MATERIALS
#define MATERIALS "materials: {white: {diffuse: 0.5}, black: {diffuse: 0}}\n"

#define SPHERE "sphere: {center: [0, 0, 0], radius: 1, material: white"

static void test_groups_are_flat(void **state)
{
    (void)state;
    struct scene_description d =
        parse_good(HEAD "objects:\n"
                        "  - group:\n"
                        "      translate: [10, 0, 0]\n"
                        "      objects:\n"
                        "        - " SPHERE ", translate: [1, 0, 0]}\n"
                        "        - group: {scale: 2, camera: no, objects: [" SPHERE
                        ", translate: [0, 3, 0]}]}\n"
                        "        - instance: {of: ball, rotate: [0, 90, 0]}\n"
                        "  - " SPHERE "}\n"
                        "groups: {ball: [" SPHERE ", translate: [5, 0, 0]}]}\n");
    const struct object_description *o = d.objects;
    assert_int_equal(d.object_count, 4);
    assert_true(o[0].placement.translation.x == 11 && !o[0].hidden);
    assert_true(o[1].placement.translation.x == 10 && o[1].placement.translation.y == 6);
    assert_true(o[1].placement.x.x == 2 && o[1].hidden);
    assert_int_equal(o[2].kind, OBJECT_INSTANCE);
    assert_true(o[2].group == 0 && o[2].material == NO_INDEX && o[2].placement.translation.x == 10);
    assert_int_equal(o[3].kind, OBJECT_SPHERE);
    assert_true(o[3].placement.translation.x == 0 && !o[3].hidden);
    assert_int_equal(d.group_count, 1);
    assert_string_equal(d.groups[0].name, "ball");
    assert_true(d.groups[0].objects[0].placement.translation.x == 5);
    scene_description_release(&d);
}

/* Instances in groups become copies, of which the later group may come first in the file. */
static void test_groups_hold_no_instances(void **state)
{
    (void)state;
    struct scene_description d = parse_good(
        HEAD
        "groups:\n"
        "  two: [instance: {of: one, material: black, translate: [0, 7, 0], camera: no},\n"
        "        instance: {of: one, scale: 3}]\n"
        "  one: [box: {corners: [[0, 0, 0], [1, 1, 1]], material: white, translate: [1, 0, 0]},\n"
        "        triangles: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], triangles: [[0, 1, 2]],\n"
        "                    material: white}]\n"
        "objects: [instance: {of: two, material: black}]\n");
    assert_int_equal(d.groups[0].object_count, 4);
    assert_int_equal(d.groups[1].object_count, 2);
    const struct object_description *o = d.groups[0].objects;
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(o[i].kind, i % 2 ? OBJECT_MESH : OBJECT_BOX);
        assert_string_equal(d.materials[o[i].material].name, i < 2 ? "black" : "white");
        assert_true(o[i].hidden == (i < 2));
    }
    assert_true(o[0].placement.translation.x == 1 && o[0].placement.translation.y == 7);
    assert_true(o[2].placement.translation.x == 3 && o[2].placement.y.y == 3);
    assert_true(o[0].vertices != o[2].vertices && o[2].vertices[1].y == 1);
    assert_int_equal(d.mesh_count, 1);
    assert_true(o[1].mesh == 0 && o[3].mesh == 0 && d.meshes[0].triangles[0][1] == 1);
    assert_string_equal(d.materials[d.objects[0].material].name, "black");
    scene_description_release(&d);
}

static void test_wrong_groups(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "groups: {a: [instance: {of: b}], b: [instance: {of: a}]}\n",
         "5:53: error: group 'a' contains itself\n"},
        {HEAD "groups: {a: [group: {objects: [instance: {of: a}]}]}\n",
         "5:47: error: group 'a' contains itself\n"},
        {HEAD "groups: {a: 5, b: [c: {}]}\nobjects: [instance: {of: aa}, instance: {of: [a]}, "
              "group: {}, group: {objects: 5, scale: 0}]\n",
         "5:13: error: expected a list for a, got text\n"
         "5:20: error: unknown object kind 'c'; known are quad, box, triangles, sphere, cylinder, "
         "cone, disc, plane, torus, height_field, mesh, group, instance\n"
         "6:26: error: undefined group 'aa'; did you mean 'a'?\n"
         "6:46: error: of in instance: expected the name of a group, got a list\n"
         "6:52: error: missing key 'objects' in group\n"
         "6:80: error: expected a list for objects, got text\n"
         "6:90: error: a factor of scale is 0\n"}};
    EXPECT_ALL(cases);
}

/* `count` groups, each of which holds an instance of the next; the last holds a sphere. */
static void expect_deep(bool outermost_first, size_t count, const char *expected)
{
    char text[8192] = HEAD "groups:\n";
    for (size_t i = 0; i < count; i++) {
        size_t inside = outermost_first ? count - 1 - i : i;
        size_t used = strlen(text);
        if (inside > 0)
            snprintf(text + used, sizeof text - used, "  g%zu: [instance: {of: g%zu}]\n", inside,
                     inside - 1);
        else
            snprintf(text + used, sizeof text - used, "  g0: [" SPHERE "}]\n");
    }
    if (expected) {
        expect_bytes(text, strlen(text), expected);
        return;
    }
    struct scene_description d = parse_good(text);
    assert_int_equal(d.groups[0].object_count, 1);
    scene_description_release(&d);
}

static void test_deep_groups(void **state)
{
    (void)state;
    expect_deep(true, 33, NULL);
    expect_deep(false, 33, NULL);
    expect_deep(true, 34, "38:23: error: groups in groups are nested deeper than 32\n");
    expect_deep(false, 34, "39:24: error: groups in groups are nested deeper than 32\n");
}

/* Ten times ten times ten ... */
static void test_bombs(void **state)
{
    (void)state;
    char text[8192] = HEAD "groups:\n  g0: [" SPHERE "}]\n";
    for (int level = 1; level <= 9; level++) {
        size_t used = strlen(text);
        used += (size_t)snprintf(text + used, sizeof text - used, "  g%d: [", level);
        for (int i = 0; i < 10; i++)
            used += (size_t)snprintf(text + used, sizeof text - used, "%sinstance: {of: g%d}",
                                     i ? ", " : "", level - 1);
        snprintf(text + used, sizeof text - used, "]\n");
    }
    expect_bytes(text, strlen(text), "12:168: error: more than 1000000 objects in one scene\n");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_groups_are_flat), cmocka_unit_test(test_groups_hold_no_instances),
        cmocka_unit_test(test_wrong_groups),    cmocka_unit_test(test_deep_groups),
        cmocka_unit_test(test_bombs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
