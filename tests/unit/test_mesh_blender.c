/* test_mesh_blender.c: a glTF file that Blender wrote, against the numbers in its script
 * (tests/data/make_blender_fixture.py). Blender's (x, y, z) is glTF's, and our, (x, z, -y). */
#include "mesh_fixture.h"
#include <png.h>

static struct imported import_blender(void)
{
    struct mesh_request request = request_all(data_path("blender.glb"));
    struct imported imported = import_disk(&request);
    expect_success(&imported);
    return imported;
}

static void camera_stands_and_looks_as_in_blender(void **state)
{
    (void)state;
    struct imported imported = import_blender();
    assert_int_equal(imported.fragment.camera_count, 2);
    const struct camera_description *camera = &imported.fragment.cameras[0];
    assert_string_equal(camera->name, "view");
    assert_int_equal(camera->kind, CAMERA_PERSPECTIVE);
    expect_vector(camera->location, 3, 5, 6);
    /* Straight down, tilted by 60 degrees about x, turned by 30 about z. */
    ps_vec3 forward = ps_normalize(ps_subtract(camera->look_at, camera->location));
    double s60 = sin(M_PI / 3), c60 = 0.5, s30 = 0.5, c30 = sin(M_PI / 3);
    expect_vector(forward, -s60 * s30, -c60, -s60 * c30);
    expect_near(ps_dot(camera->up, forward), 0, 1e-6);
    assert_true(camera->up.y > 0);
    /* 40 degrees across at 16:9. */
    expect_near(camera->vertical_angle, 2 * atan(tan(20 * M_PI / 180) * 9 / 16) * 180 / M_PI, 1e-4);
    assert_true(camera->angle == 0);
    release_imported(&imported);
}

static void orthographic_camera_shows_its_scale(void **state)
{
    (void)state;
    struct imported imported = import_blender();
    const struct camera_description *camera = &imported.fragment.cameras[1];
    assert_string_equal(camera->name, "plan");
    assert_int_equal(camera->kind, CAMERA_ORTHOGRAPHIC);
    expect_near(camera->width, 12, 1e-5);
    expect_vector(camera->location, 0, 10, 0);
    expect_vector(ps_subtract(camera->look_at, camera->location), 0, -1, 0);
    expect_vector(camera->up, 0, 0, -1);
    release_imported(&imported);
}

static void bulbs_give_the_power_of_blender(void **state)
{
    (void)state;
    struct imported imported = import_blender();
    assert_int_equal(imported.fragment.light_count, 4);
    for (size_t i = 0; i < 2; i++) { /* two nodes share one lamp */
        const struct light_description *light = &imported.fragment.lights[i];
        assert_int_equal(light->kind, LIGHT_POINT);
        assert_int_equal(light->unit, UNIT_INTENSITY);
        expect_vector(light->location, i == 0 ? 0 : 3, 4, -1);
        /* 100 W in all directions */
        expect_near(light->amount.r * 4 * M_PI, 100, 1e-3);
        expect_near(light->amount.g * 4 * M_PI, 50, 1e-3);
        expect_near(light->amount.b * 4 * M_PI, 25, 1e-3);
    }
    release_imported(&imported);
}

static void spot_and_sun_are_as_in_blender(void **state)
{
    (void)state;
    struct imported imported = import_blender();
    const struct light_description *spot = &imported.fragment.lights[2];
    assert_int_equal(spot->kind, LIGHT_SPOT);
    expect_vector(spot->location, 2, 3, 0);
    expect_vector(spot->direction, 0, 0, -1);
    expect_vector(spot->point_at, 2, 3, -1);
    expect_near(spot->falloff, 30, 1e-4);
    expect_near(spot->radius, 22.5, 1e-4);
    expect_near(spot->amount.g * 4 * M_PI, 50, 1e-3);
    const struct light_description *sun = &imported.fragment.lights[3];
    assert_int_equal(sun->kind, LIGHT_SUN);
    assert_int_equal(sun->unit, UNIT_IRRADIANCE);
    expect_near(sun->amount.r, 3, 1e-5);
    expect_vector(sun->direction, -sqrt(0.5), -sqrt(0.5), 0);
    release_imported(&imported);
}

static void unit_and_placement_carry_cameras_and_lights(void **state)
{
    (void)state;
    struct mesh_request request = request_all(data_path("blender.glb"));
    request.unit = 100;
    request.placement = (struct affine){
        {0, 0, -2}, {0, 2, 0}, {2, 0, 0}, {1000, 0, 0}}; /* twice as large, turned */
    struct imported imported = import_disk(&request);
    expect_success(&imported);
    expect_vector(imported.fragment.cameras[0].location, 2200, 1000, -600);
    expect_near(imported.fragment.cameras[1].width, 12 * 200, 1e-2);
    const struct light_description *bulb = &imported.fragment.lights[0];
    expect_vector(bulb->location, 800, 800, 0);
    expect_near(bulb->amount.r * 4 * M_PI, 100 * 200.0 * 200, 100);
    expect_near(imported.fragment.lights[3].amount.r, 3, 1e-5);
    expect_vector(imported.fragment.lights[3].direction, 0, -sqrt(0.5), sqrt(0.5));
    release_imported(&imported);
}

static void child_stands_in_its_parent(void **state)
{
    (void)state;
    struct imported imported = import_blender();
    /* child: (1, 0, 0) in the parent, half as high; parent: twice as large, turned by 90 degrees
     * about z, at (1, 2, 3). The corner (0, 0, 1) of the child: (1, 0, 0.5), then (2, 0, 1), then
     * (0, 2, 1), then (1, 4, 4); for us (1, 4, -4). Its corner (1, 0, 0): (1, 6, 3), for us (1, 3,
     * -6). */
    const struct object_description *child = &imported.fragment.objects[1];
    expect_vector(affine_point(&child->placement, (ps_vec3){0, 1, 0}), 1, 4, -4);
    expect_vector(affine_point(&child->placement, (ps_vec3){1, 0, 0}), 1, 3, -6);
    release_imported(&imported);
}

static ps_vec3 middle_of(const struct imported *imported, size_t object)
{
    const struct mesh_description *mesh = mesh_of(imported, object);
    ps_vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < mesh->vertex_count; i++)
        sum = ps_add(
            sum, affine_point(&imported->fragment.objects[object].placement, mesh->vertices[i]));
    return ps_scale(sum, 1.0f / (float)mesh->vertex_count);
}

/* Plain (2) and mirrored (3) tetrahedra share a mesh: all its triangles and normals look outwards,
 * once the scene has turned those of the placement that mirrors. */
static void mirrored_object_keeps_its_front(void **state)
{
    (void)state;
    struct imported imported = import_blender();
    assert_true(affine_determinant(&imported.fragment.objects[3].placement) < 0);
    for (size_t object = 2; object <= 3; object++) {
        const struct mesh_description *mesh = mesh_of(&imported, object);
        const struct affine *placement = &imported.fragment.objects[object].placement;
        float turn = affine_determinant(placement) < 0 ? -1 : 1;
        ps_vec3 middle = middle_of(&imported, object);
        for (size_t i = 0; i < mesh->triangle_count; i++) {
            ps_vec3 outwards = ps_subtract(corner(&imported, object, i, 0), middle);
            assert_true(ps_dot(front_of(&imported, object, i), outwards) > 0);
        }
        assert_non_null(mesh->normals);
        for (size_t i = 0; i < mesh->vertex_count; i++) {
            ps_vec3 outwards = ps_subtract(affine_point(placement, mesh->vertices[i]), middle);
            assert_true(turn * ps_dot(affine_normal(placement, mesh->normals[i]), outwards) > 0);
        }
    }
    release_imported(&imported);
}

static void materials_are_as_in_blender(void **state)
{
    (void)state;
    struct imported imported = import_blender();
    const struct material_description *metal = material_named(&imported, "metal");
    assert_int_equal(metal->kind, MATERIAL_METAL);
    expect_color(metal->color.colors[0], 0.9, 0.6, 0.2);
    expect_near(metal->roughness.colors[0].r, 0.25, 1e-6);
    const struct material_description *rough = material_named(&imported, "rough");
    assert_int_equal(rough->kind, MATERIAL_GLOSSY);
    expect_color(rough->color.colors[0], 0.2, 0.4, 0.6);
    expect_color(rough->specular.colors[0], 0.04, 0.04, 0.04);
    expect_near(rough->roughness.colors[0].r, 0.75, 1e-6);
    const struct material_description *glowing = material_named(&imported, "glowing");
    expect_color(glowing->emission.colors[0], 8, 4, 2);
    assert_int_equal(imported.fragment.material_count, 4);
    assert_string_equal(imported.fragment.objects[0].origin.file, "scene.psd");
    release_imported(&imported);
}

static void decode_png(const struct texture_description *texture, unsigned char pixels[2][4][3])
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_memory(&image, texture->bytes, texture->byte_count));
    assert_int_equal(image.width, 4);
    assert_int_equal(image.height, 2);
    image.format = PNG_FORMAT_RGB;
    assert_true(png_image_finish_read(&image, NULL, pixels, 0, NULL));
}

/* The corner at Blender's (-4, -4) has (u, v) = (0, 0) and the red of the picture's bottom left. */
static void texture_lies_the_right_way_up(void **state)
{
    (void)state;
    struct imported imported = import_blender();
    const struct material_description *textured = material_named(&imported, "textured");
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    unsigned char pixels[2][4][3];
    static const unsigned char expected[2][2][3] = {{{255, 0, 0}, {0, 255, 0}},
                                                    {{0, 0, 255}, {255, 255, 255}}};
    assert_int_equal(textured->color.kind, PIGMENT_IMAGE);
    assert_int_equal(textured->color.texture, 0);
    assert_int_equal(imported.fragment.texture_count, 1);
    decode_png(&imported.fragment.textures[0], pixels);
    assert_non_null(mesh->uv);
    assert_int_equal(mesh->vertex_count, 4);
    for (size_t i = 0; i < 4; i++) {
        ps_vec3 place = affine_point(&imported.fragment.objects[0].placement, mesh->vertices[i]);
        int right = place.x > 0, above = place.z < 0; /* Blender's y > 0 */
        expect_near(mesh->uv[i][0], right, 1e-6);
        expect_near(mesh->uv[i][1], above, 1e-6);
        assert_memory_equal(pixels[1 - above][3 * right], expected[above][right], 3);
    }
    release_imported(&imported);
}

static void only_what_is_asked_for_comes(void **state)
{
    (void)state;
    struct mesh_request request = request_all(data_path("blender.glb"));
    request.geometry = request.materials = request.lights = false;
    struct imported imported = import_disk(&request);
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 0);
    assert_int_equal(imported.fragment.mesh_count, 0);
    assert_int_equal(imported.fragment.material_count, 0);
    assert_int_equal(imported.fragment.light_count, 0);
    assert_int_equal(imported.fragment.camera_count, 2);
    release_imported(&imported);
    request.geometry = true;
    request.camera = false;
    imported = import_disk(&request);
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 5);
    assert_true(imported.fragment.objects[0].material == NO_INDEX);
    assert_int_equal(imported.fragment.camera_count, 0);
    release_imported(&imported);
}

/* Blender's default scene, as COLLADA and FBX (in centimetres): a cube of side 2, a camera and a
 * bulb. The files are the fuzzer's, which come after a byte that names the format. */
static void default_scene_is_alike_in_other_formats(void **state)
{
    (void)state;
    static const struct {
        const char *file, *path;
        double unit, watts;
    } cases[] = {{"../fuzz/corpus_mesh/dae", "m.dae", 1, 1000},
                 {"../fuzz/corpus_mesh/fbx", "m.fbx", 0.01, 1000}};
    static char bytes[65536];
    for (size_t i = 0; i < 2; i++) {
        FILE *stream = fopen(data_path(cases[i].file), "rb");
        assert_non_null(stream);
        size_t length = fread(bytes, 1, sizeof bytes, stream);
        fclose(stream);
        struct mesh_request request = request_all(cases[i].path);
        request.unit = cases[i].unit;
        struct mesh_memory_file file = {cases[i].path, bytes + 1, length - 1};
        struct imported imported = import_files(&request, &file, 1);
        expect_success(&imported);
        const struct camera_description *camera = &imported.fragment.cameras[0];
        assert_int_equal(imported.fragment.camera_count, 1);
        expect_near(camera->location.x, 7.3589, 1e-4);
        expect_near(camera->location.y, 4.9583, 1e-4);
        expect_near(camera->location.z, 6.9258, 1e-4);
        ps_vec3 forward = ps_normalize(ps_subtract(camera->look_at, camera->location));
        expect_near(forward.x, -0.6516, 1e-4);
        expect_near(forward.y, -0.4453, 1e-4);
        expect_near(camera->angle, 39.5978, 1e-3);
        assert_int_equal(imported.fragment.light_count, 1);
        assert_int_equal(imported.fragment.lights[0].kind, LIGHT_POINT);
        expect_near(imported.fragment.lights[0].location.y, 5.9039, 1e-4);
        expect_near(imported.fragment.lights[0].amount.r * 4 * M_PI, cases[i].watts, 1e-2);
        assert_int_equal(mesh_of(&imported, 0)->triangle_count, 12);
        expect_near(fabs(corner(&imported, 0, 0, 0).y), 1, 1e-4);
        expect_color(material_named(&imported, "Material")->color.colors[0], 0.8, 0.8, 0.8);
        release_imported(&imported);
    }
}

/* A spot of 100 W, in a file in centimetres, as Blender writes its cone; and a sun. */
#define DAE_LIGHTS                                                                                 \
    "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "      \
    "version=\"1.4.1\"><asset><unit meter=\"0.01\"/><up_axis>Y_UP</up_axis></asset>"               \
    "<library_lights><light id=\"a\" name=\"a\"><technique_common><spot><color>100 50 0</color>"   \
    "<falloff_angle>60</falloff_angle><falloff_exponent>0.15</falloff_exponent></spot>"            \
    "</technique_common></light><light id=\"b\" name=\"b\"><technique_common><directional>"        \
    "<color>3 3 3</color></directional></technique_common></light></library_lights>"               \
    "<library_visual_scenes><visual_scene id=\"s\"><node id=\"na\" name=\"na\">"                   \
    "<translate>0 200 0</translate><instance_light url=\"#a\"/></node>"                            \
    "<node id=\"nb\" name=\"nb\"><instance_light url=\"#b\"/></node></visual_scene>"               \
    "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"

static void lights_of_collada_are_watts(void **state)
{
    (void)state;
    struct mesh_request request = request_all("m.dae");
    struct mesh_memory_file file = {"m.dae", DAE_LIGHTS, sizeof DAE_LIGHTS - 1};
    request.unit = 10;
    struct imported imported = import_files(&request, &file, 1);
    expect_success(&imported);
    assert_int_equal(imported.fragment.light_count, 2);
    const struct light_description *spot = &imported.fragment.lights[0];
    assert_int_equal(spot->kind, LIGHT_SPOT);
    expect_near(spot->location.y, 20, 1e-4);
    expect_near(spot->amount.r * 4 * M_PI, 100 * 10 * 10, 1e-2);
    expect_near(spot->amount.g * 4 * M_PI, 50 * 10 * 10, 1e-2);
    expect_near(spot->falloff, 30, 1e-3);
    expect_near(spot->radius, 30, 1e-3);
    assert_int_equal(imported.fragment.lights[1].kind, LIGHT_SUN);
    expect_near(imported.fragment.lights[1].amount.r, 3, 1e-5);
    release_imported(&imported);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_stands_and_looks_as_in_blender),
        cmocka_unit_test(orthographic_camera_shows_its_scale),
        cmocka_unit_test(bulbs_give_the_power_of_blender),
        cmocka_unit_test(spot_and_sun_are_as_in_blender),
        cmocka_unit_test(unit_and_placement_carry_cameras_and_lights),
        cmocka_unit_test(child_stands_in_its_parent),
        cmocka_unit_test(mirrored_object_keeps_its_front),
        cmocka_unit_test(materials_are_as_in_blender),
        cmocka_unit_test(texture_lies_the_right_way_up),
        cmocka_unit_test(default_scene_is_alike_in_other_formats),
        cmocka_unit_test(lights_of_collada_are_watts),
        cmocka_unit_test(only_what_is_asked_for_comes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
