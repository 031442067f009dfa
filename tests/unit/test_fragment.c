/* test_fragment.c: what a mesh file brought joins a description; see fragment.h. */
#include "parser_fixture.h"

#include "parser/sections/object.h"
#include <stdlib.h>

/* A reader with a description that has one material, one texture, one mesh and one camera. */
struct place {
    struct scene_description description;
    struct arena arena;
    struct reader reader;
    struct diagnostics *sink;
    struct object_list list;
    struct object_context context;
};

static char *copy_of(const char *text)
{
    char *copy = strdup(text);
    assert_non_null(copy);
    return copy;
}

/* Zeroed, and never of size 0, so that it can be owned. */
static void *items(size_t count, size_t size)
{
    void *memory = calloc(count ? count : 1, size);
    assert_non_null(memory);
    return memory;
}

static void start(struct place *place)
{
    *place = (struct place){.sink = diagnostics_create(), .context.hidden = true};
    assert_non_null(place->sink);
    struct scene_description *d = &place->description;
    place->reader =
        (struct reader){.file = "t", .sink = place->sink, .description = d, .arena = &place->arena};
    place->context.list = &place->list;
    place->context.placement = (struct affine)AFFINE_IDENTITY;
    d->materials = reader_extend(&place->reader, NULL, 0, 1, sizeof *d->materials);
    d->materials[d->material_count++].name = copy_of("mine");
    d->textures = reader_extend(&place->reader, NULL, 0, 1, sizeof *d->textures);
    d->textures[d->texture_count++].path = copy_of("mine.png");
    d->meshes = reader_extend(&place->reader, NULL, 0, 1, sizeof *d->meshes);
    d->mesh_count++;
    d->cameras = reader_extend(&place->reader, NULL, 0, 1, sizeof *d->cameras);
    d->cameras[d->camera_count++].name = copy_of("camera");
}

static void end(struct place *place)
{
    place->description.objects = place->list.items;
    place->description.object_count = place->list.count;
    scene_description_release(&place->description);
    diagnostics_destroy(place->sink);
    arena_release(&place->arena);
}

/* Materials wood (texture 1), unused (texture 0) and gold (normal map 2); objects of wood, of no
 * material, of gold and of wood again. */
static struct scene_description file_content(void)
{
    static const size_t materials[] = {0, NO_INDEX, 2, 0};
    static const char *const names[] = {"wood", "unused", "gold"};
    struct scene_description c = {.mesh_count = 4,
                                  .object_count = 4,
                                  .material_count = 3,
                                  .texture_count = 3,
                                  .light_count = 1,
                                  .camera_count = 2};
    c.meshes = items(4, sizeof *c.meshes);
    c.objects = items(4, sizeof *c.objects);
    c.materials = items(3, sizeof *c.materials);
    c.textures = items(3, sizeof *c.textures);
    c.lights = items(1, sizeof *c.lights);
    c.cameras = items(2, sizeof *c.cameras);
    for (size_t i = 0; i < 4; i++) {
        c.meshes[i].vertices = items(1, sizeof *c.meshes[i].vertices);
        c.meshes[i].vertex_count = i + 10;
        c.objects[i] = (struct object_description){
            .kind = OBJECT_MESH, .mesh = i, .material = materials[i], .placement = AFFINE_IDENTITY};
    }
    for (size_t i = 0; i < 3; i++) {
        c.materials[i].name = copy_of(names[i]);
        c.textures[i].path = copy_of("0.png");
        c.textures[i].path[0] += (char)i;
    }
    for (size_t i = 0; i < 2; i++) {
        c.materials[i].color.kind = PIGMENT_IMAGE;
        c.materials[i].color.texture = 1 - i;
        c.cameras[i].name = copy_of("camera");
    }
    c.materials[2].normal_map = (struct pigment_description){.kind = PIGMENT_IMAGE, .texture = 2};
    c.lights[0].texture = NO_INDEX;
    return c;
}

static size_t append(struct place *place, const size_t replacements[3], size_t otherwise, bool keep)
{
    static const struct node at = {.mark = {1, 1, 1}};
    struct scene_description content = file_content();
    const struct fragment fragment = {&content, replacements, otherwise, keep};
    size_t plain = fragment_append(&place->reader, &at, &fragment, &place->context);
    scene_description_release(&content);
    assert_false(place->reader.out_of_memory);
    return plain;
}

/* Indices are shifted, what nothing uses stays behind, and parts without a material are grey. */
static void test_own_materials(void **state)
{
    (void)state;
    const size_t replacements[] = {NO_INDEX, NO_INDEX, NO_INDEX};
    struct place place;
    start(&place);
    assert_int_equal(append(&place, replacements, NO_INDEX, true), 1);
    const struct scene_description *d = &place.description;
    const struct object_description *o = place.list.items;
    assert_int_equal(place.list.count, 4);
    assert_int_equal(d->material_count, 4);
    assert_string_equal(d->materials[o[0].material].name, "wood");
    assert_true(d->materials[o[1].material].kind == MATERIAL_DIFFUSE &&
                d->materials[o[1].material].color.colors[0].g == 0.5F);
    assert_string_equal(d->materials[o[2].material].name, "gold");
    assert_int_equal(o[3].material, o[0].material);
    assert_int_equal(d->texture_count, 3);
    assert_string_equal(d->textures[d->materials[o[0].material].color.texture].path, "1.png");
    assert_string_equal(d->textures[d->materials[o[2].material].normal_map.texture].path, "2.png");
    assert_int_equal(d->mesh_count, 5);
    assert_int_equal(d->meshes[o[0].mesh].vertex_count, 10);
    assert_int_equal(d->meshes[o[3].mesh].vertex_count, 13);
    assert_true(o[0].hidden);
    assert_int_equal(d->light_count, 1);
    assert_int_equal(d->lights[0].texture, NO_INDEX);
    end(&place);
}

/* The parts of a mix come along, before it, and its indices follow them; a material of which only
 * the name is known is none. */
static void test_mixes_and_absent_materials(void **state)
{
    (void)state;
    static const struct node at = {.mark = {1, 1, 1}};
    const size_t replacements[] = {NO_INDEX, NO_INDEX, NO_INDEX};
    struct place place;
    start(&place);
    struct scene_description content = file_content();
    struct material_description *mix = &content.materials[2];
    mix->kind = MATERIAL_MIX;
    mix->component_count = 2;
    mix->components = items(2, sizeof *mix->components);
    mix->weights = items(2, sizeof *mix->weights);
    mix->components[0] = 1;
    mix->components[1] = 0;
    content.materials[0].kind = MATERIAL_METAL;
    const struct fragment fragment = {&content, replacements, NO_INDEX, true};
    fragment_append(&place.reader, &at, &fragment, &place.context);
    const struct scene_description *d = &place.description;
    const struct material_description *moved = &d->materials[place.list.items[2].material];
    assert_string_equal(moved->name, "gold");
    assert_string_equal(d->materials[moved->components[0]].name, "unused");
    assert_string_equal(d->materials[moved->components[1]].name, "wood");
    assert_true(moved->components[0] < place.list.items[2].material);
    scene_description_release(&content);
    end(&place);
    start(&place);
    content = file_content();
    content.materials[0].kind = MATERIAL_MIX; /* of nothing */
    const struct fragment lacking = {&content, replacements, NO_INDEX, true};
    assert_int_equal(fragment_append(&place.reader, &at, &lacking, &place.context), 3);
    assert_int_equal(place.list.count, 4);
    assert_int_equal(place.description.material_count, 3); /* one grey for all */
    scene_description_release(&content);
    end(&place);
}

static void test_replacements(void **state)
{
    (void)state;
    const size_t replacements[] = {0, NO_INDEX, NO_INDEX};
    struct place place;
    start(&place);
    assert_int_equal(append(&place, replacements, NO_INDEX, true), 1);
    assert_int_equal(place.list.items[0].material, 0);
    assert_string_equal(place.description.materials[place.list.items[2].material].name, "gold");
    assert_int_equal(place.description.texture_count, 2);
    end(&place);
    start(&place);
    assert_int_equal(append(&place, replacements, NO_INDEX, false), 2); /* gold is not wanted */
    assert_int_equal(place.list.count, 4);
    assert_int_equal(place.description.material_count, 2);
    end(&place);
    start(&place);
    const size_t none[] = {NO_INDEX, NO_INDEX, NO_INDEX};
    assert_int_equal(append(&place, none, 0, true), 0); /* material: for all */
    assert_int_equal(place.list.count, 4);
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(place.list.items[i].material, 0);
    assert_int_equal(place.description.texture_count, 1);
    end(&place);
}

static void test_cameras_have_names_of_their_own(void **state)
{
    (void)state;
    const size_t replacements[] = {NO_INDEX, NO_INDEX, NO_INDEX};
    struct place place;
    start(&place);
    append(&place, replacements, NO_INDEX, true);
    append(&place, replacements, NO_INDEX, true);
    assert_int_equal(place.description.camera_count, 5);
    static const char *const names[] = {"camera", "camera 2", "camera 3", "camera 4", "camera 5"};
    for (size_t i = 0; i < 5; i++)
        assert_string_equal(place.description.cameras[i].name, names[i]);
    assert_int_equal(place.description.mesh_count, 9);
    assert_int_equal(place.list.items[4].mesh, 5);
    end(&place);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_own_materials),
        cmocka_unit_test(test_mixes_and_absent_materials),
        cmocka_unit_test(test_replacements),
        cmocka_unit_test(test_cameras_have_names_of_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
