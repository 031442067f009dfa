/* test_known_scenes.c: the mesh files of scenes that everyone in this field has come out right.
 *
 * $PSPLAT_SHARED/scenes holds McGuire's Cornell boxes and the LBNL conference room, unpacked.
 */
#include "external.h"
#include "unit/mesh_fixture.h"

static struct imported import_scene(const char *name)
{
    static char path[4096];
    snprintf(path, sizeof path, "%s/scenes/%s", getenv("PSPLAT_SHARED"), name);
    struct mesh_request request = request_all(path);
    struct imported imported = import_disk(&request);
    expect_success(&imported);
    return imported;
}

static void cornell_boxes_come_out_right(void **state)
{
    (void)state;
    struct imported imported = import_scene("cornell-mcguire/CornellBox-Mirror.obj");
    assert_int_equal(material_named(&imported, "tallBox")->kind, MATERIAL_MIRROR);
    expect_color(material_named(&imported, "light")->emission.colors[0], 17, 12, 4);
    assert_true(front_of(&imported, 7, 0).y < -0.9f); /* the lamp shines down */
    release_imported(&imported);
    imported = import_scene("cornell-mcguire/CornellBox-Sphere.obj");
    assert_int_equal(material_named(&imported, "leftSphere")->kind, MATERIAL_MIRROR);
    assert_int_equal(material_named(&imported, "rightSphere")->kind, MATERIAL_DIELECTRIC);
    expect_near(material_named(&imported, "rightSphere")->ior, 2.5, 1e-6);
    release_imported(&imported);
    imported = import_scene("cornell-mcguire/CornellBox-Glossy.obj");
    assert_int_equal(material_named(&imported, "shortBox")->kind, MATERIAL_GLOSSY);
    assert_int_equal(material_named(&imported, "floor")->kind, MATERIAL_DIFFUSE);
    release_imported(&imported);
}

static void conference_room_is_whole(void **state)
{
    (void)state;
    struct imported imported = import_scene("conference/conference.obj");
    size_t triangles = 0;
    for (size_t i = 0; i < imported.fragment.object_count; i++)
        triangles += mesh_of(&imported, i)->triangle_count;
    assert_int_equal(triangles + imported.report.dropped_triangles, 331179);
    assert_int_equal(imported.fragment.material_count, 35);
    release_imported(&imported);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cornell_boxes_come_out_right),
        cmocka_unit_test(conference_room_is_whole),
    };
    if (!external_files_are_there("scenes"))
        return EXTERNAL_SKIPPED;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
