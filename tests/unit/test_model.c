/* test_model.c: what a lone model is taken for, and the scene that shows it. */
#include "model/model.h"

#include "parser_fixture.h"
#include "unit/locale_fixture.h"
#include <stdlib.h>

#define MOST_BOXES 3

/* Boxes, each a mesh of its own. */
struct content {
    struct scene_description fragment;
    struct object_description objects[MOST_BOXES];
    struct mesh_description meshes[MOST_BOXES];
    ps_vec3 vertices[MOST_BOXES][8];
    uint32_t triangles[MOST_BOXES][12][3];
    struct box box; /* around the first */
};

/* The faces of a box of corners as box_corner numbers them, outwards, those at the low and high x,
 * y, z first. */
static const uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

static void add_box(struct content *content, struct box box, bool inwards, int left_out)
{
    struct scene_description *fragment = &content->fragment;
    size_t index = fragment->object_count++;
    struct mesh_description *mesh = &content->meshes[index];
    mesh->vertices = content->vertices[index];
    mesh->triangles = content->triangles[index];
    for (unsigned i = 0; i < 8; i++)
        mesh->vertices[i] = box_corner(&box, i);
    for (int face = 0; face < 6; face++)
        for (uint32_t half = 0; half < 2 && face != left_out; half++) {
            uint32_t *triangle = mesh->triangles[mesh->triangle_count++];
            triangle[0] = faces[face][0];
            triangle[1 + inwards] = faces[face][1 + half];
            triangle[2 - inwards] = faces[face][2 + half];
        }
    content->objects[index] = (struct object_description){
        .kind = OBJECT_MESH, .mesh = index, .placement = AFFINE_IDENTITY};
    fragment->objects = content->objects;
    fragment->meshes = content->meshes;
    if (index == 0)
        content->box = box;
}

static const struct box hall = {{0, 0, 0}, {6, 3, 5}}, table = {{2, 0, 2}, {3, 0.8F, 3.4F}},
                        cupboard = {{4.9F, 0, 4}, {6, 3, 5}};

static struct room room_of(const struct content *content)
{
    return room_find(&content->fragment, &content->box);
}

static bool is_within(ps_vec3 p, const struct box *box)
{
    return p.x > box->low.x && p.x < box->high.x && p.y > box->low.y && p.y < box->high.y &&
           p.z > box->low.z && p.z < box->high.z;
}

static void test_things_are_no_rooms(void **state)
{
    struct content content = {.box = hall};
    (void)state;
    add_box(&content, hall, false, -1);
    assert_false(room_of(&content).is_room);
    content = (struct content){.box = hall};
    add_box(&content, hall, true, -1); /* inside out */
    assert_false(room_of(&content).is_room);
    const struct box around = {{-1, -1, -1}, {7, 4, 6}};
    content = (struct content){.box = hall};
    add_box(&content, around, false, -1); /* a house, which has an outside */
    add_box(&content, hall, true, -1);
    add_box(&content, table, false, -1);
    assert_false(room_of(&content).is_room);
}

#define CELLS 40 /* at most */

/* A height field of that many cells along each side, from -5 to 5, of which the front is above. */
static void add_ground(struct content *content, uint32_t cells, float (*height)(float x, float z))
{
    static ps_vec3 vertices[(CELLS + 1) * (CELLS + 1)];
    static uint32_t triangles[2 * CELLS * CELLS][3];
    struct mesh_description *mesh = &content->meshes[content->fragment.object_count];
    *mesh = (struct mesh_description){.vertices = vertices, .triangles = triangles};
    for (uint32_t i = 0; i < (cells + 1) * (cells + 1); i++) {
        float x = 10 * (float)(i % (cells + 1)) / (float)cells - 5;
        float z = 10 * (float)(i / (cells + 1)) / (float)cells - 5;
        vertices[i] = (ps_vec3){x, height(x, z), z};
        box_add_point(&content->box, vertices[i]);
    }
    for (uint32_t i = 0; i < cells * cells; i++) {
        uint32_t a = i / cells * (cells + 1) + i % cells, c = a + cells + 1;
        const uint32_t square[2][3] = {{a, c, a + 1}, {a + 1, c, c + 1}};
        memcpy(triangles[mesh->triangle_count], square, sizeof square);
        mesh->triangle_count += 2;
    }
    content->objects[content->fragment.object_count++] =
        (struct object_description){.kind = OBJECT_MESH,
                                    .mesh = (size_t)(mesh - content->meshes),
                                    .placement = AFFINE_IDENTITY};
    content->fragment.objects = content->objects;
    content->fragment.meshes = content->meshes;
}

static float flat(float x, float z)
{
    (void)x;
    (void)z;
    return 0;
}

static float hills(float x, float z)
{
    return 0.7F * sinf(1.3F * x) * cosf(1.1F * z) + 0.1F * sinf(5 * x + 3 * z);
}

static float valley(float x, float z)
{
    return 0.3F * fabsf(x) + 0.1F * sinf(3 * z);
}

/* As of a file with another axis upwards. */
static void turn(struct content *content)
{
    const struct box box = content->box;
    content->box = (struct box)BOX_EMPTY;
    for (size_t i = 0; i < content->fragment.object_count; i++)
        content->objects[i].placement =
            (struct affine){{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, 0}};
    box_add_placed(&content->box, &box, &content->objects[0].placement);
}

static void expect_no_room(float (*height)(float x, float z), bool has_cubes, bool is_turned)
{
    const struct box cubes[2] = {{{-3, 0, -3}, {-1, 2, -1}}, {{1, 0, 0}, {4, 3, 3}}};
    struct content content = {.box = BOX_EMPTY};
    add_ground(&content, height == flat ? 1 : CELLS, height);
    for (int i = 0; i < 2 && has_cubes; i++) {
        add_box(&content, cubes[i], false, -1);
        box_add_box(&content.box, &cubes[i]);
    }
    if (is_turned)
        turn(&content);
    assert_false(room_of(&content).is_room);
}

static void test_ground_is_no_room(void **state)
{
    (void)state;
    for (int i = 0; i < 4; i++) {
        expect_no_room(flat, i & 1, i & 2);
        expect_no_room(hills, i & 1, i & 2);
        expect_no_room(valley, i & 1, false);
    }
}

/* In the one corner that is free, where a cupboard fills that one which would come first. */
static void test_camera_stands_inside(void **state)
{
    struct content content = {.box = hall};
    (void)state;
    add_box(&content, hall, true, -1);
    add_box(&content, table, false, -1);
    add_box(&content, cupboard, false, -1);
    struct room room = room_of(&content);
    assert_true(room.is_room && is_within(room.location, &hall) && is_within(room.look_at, &hall));
    assert_false(is_within(room.location, &cupboard));
    assert_true(is_within(room.lamp, &hall) && room.lamp.y > 1.5F && room.lamp_radius < 0.5);
}

static void test_camera_looks_through_the_open_side(void **state)
{
    (void)state;
    for (int face = 0; face < 6; face++) {
        struct content content = {.box = hall};
        add_box(&content, hall, true, face);
        struct room room = room_of(&content);
        const float out[6] = {hall.low.x - room.location.x, room.location.x - hall.high.x,
                              hall.low.y - room.location.y, room.location.y - hall.high.y,
                              hall.low.z - room.location.z, room.location.z - hall.high.z};
        assert_true(room.is_room);
        assert_true(out[face] > 0);
    }
}

/* --- the scene
 * ------------------------------------------------------------------------------------ */

static void expect_in(const char *text, const char *part, bool expected)
{
    if ((strstr(text, part) != NULL) != expected)
        fail_msg("'%s' is %s in:\n%s", part, expected ? "not" : "", text);
}

static void test_scene_has_what_the_model_lacks(void **state)
{
    (void)state;
    for (int i = 0; i < 16; i++) {
        struct model model = {.box = hall,
                              .up = 1,
                              .has_materials = i & 1,
                              .has_camera = i & 2,
                              .has_lights = i & 4,
                              .room = {.is_room = i & 8, .angle = 40, .lamp_radius = 0.1}};
        char *text = model_scene_text(&model, "m.obj");
        bool ground = !(i & 2) && !(i & 4) && !(i & 8);
        assert_non_null(text);
        expect_in(text, "material: grey", !(i & 1));
        expect_in(text, "\ncamera:", !(i & 2));
        expect_in(text, "materials, camera", i & 2);
        expect_in(text, "lights: []", i & 4);
        expect_in(text, ", lights]", i & 4);
        expect_in(text, "sky:", !(i & 4) && !(i & 8));
        expect_in(text, "- sphere:", !(i & 4) && (i & 8));
        expect_in(text, "plane:", ground);
        free(text);
    }
}

/* Places have digits enough to be told from each other, and no more. */
static void test_digits_of_places(void **state)
{
    struct model model = {.box = {{123455.5F, 0, 0}, {123456.5F, 1, 1}}, .up = 1};
    (void)state;
    char *text = model_scene_text(&model, "m.obj");
    assert_non_null(text);
    expect_in(text, "translate: [123456, 0, 0.5]", true);
    free(text);
    model.room = (struct room){.is_room = true, .location = {123456.5F, 1, -2}, .angle = 40.5};
    text = model_scene_text(&model, "m.obj");
    assert_non_null(text);
    expect_in(text, "location: [123456.5, 1, -2]", true);
    free(text);
    model.box = (struct box){{-1, 0, -1}, {1, 1, 1}};
    model.room.location = (ps_vec3){0.300000012F, 0.123456F, 0};
    text = model_scene_text(&model, "m.obj");
    assert_non_null(text);
    expect_in(text, "location: [0.3, 0.1235, 0]", true);
    free(text);
}

static void test_scene_in_a_comma_locale(void **state)
{
    const struct model model = {.box = {{-1, 0, -1}, {1, 2.5F, 1}}, .up = 1};
    if (!use_locale(state, "de_DE.UTF-8", ",")) {
        print_message("skipped: no locale de_DE.UTF-8 here\n");
        return;
    }
    char *text = model_scene_text(&model, "m.obj");
    assert_non_null(text);
    expect_in(text, "sky: {radiance: 0.45}", true);
    assert_string_equal(localeconv()->decimal_point, ",");
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_things_are_no_rooms),
        cmocka_unit_test(test_ground_is_no_room),
        cmocka_unit_test(test_camera_stands_inside),
        cmocka_unit_test(test_camera_looks_through_the_open_side),
        cmocka_unit_test(test_scene_has_what_the_model_lacks),
        cmocka_unit_test(test_digits_of_places),
        LOCALE_TEST(test_scene_in_a_comma_locale),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
