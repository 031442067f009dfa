/* fuzz_psd.c: feeds arbitrary bytes to the scene parser (libFuzzer).
 *
 *     clang -fsanitize=fuzzer,address,undefined ... && ./fuzz_psd tests/fuzz/corpus_psd
 *
 * Beyond crashes and leaks it checks the parser's promise: a failure has an error in the sink, a
 * success has none and holds what a scene needs.
 */
#include "parser/psd.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition)
        abort();
}

static void check_pigment(const struct scene_description *description,
                          const struct pigment_description *pigment)
{
    require(pigment->kind != PIGMENT_IMAGE || pigment->texture < description->texture_count);
}

static void check_materials(const struct scene_description *description)
{
    for (size_t i = 0; i < description->material_count; i++) {
        const struct material_description *material = &description->materials[i];
        check_pigment(description, &material->color);
        check_pigment(description, &material->emission);
        check_pigment(description, &material->bump);
        require((material->kind == MATERIAL_MIX) == (material->component_count > 0));
        for (size_t j = 0; j < material->component_count; j++)
            require(material->components[j] < i && material->weights[j] > 0);
    }
}

static void check_objects(const struct scene_description *description,
                          const struct object_description *objects, size_t count, bool in_group)
{
    for (size_t i = 0; i < count; i++) {
        const struct object_description *object = &objects[i];
        struct affine inverse;
        require(affine_invert(&object->placement, &inverse));
        if (object->kind == OBJECT_INSTANCE)
            require(!in_group && object->group < description->group_count);
        else
            require(object->material < description->material_count);
        require(object->kind != OBJECT_MESH || object->mesh < description->mesh_count);
        for (size_t j = 0; j < object->triangle_count; j++)
            for (int k = 0; k < 3; k++)
                require(object->triangles[j][k] < object->vertex_count);
    }
}

static void check_description(const struct scene_description *description)
{
    require(description->image.width >= 1 && description->image.height >= 1);
    require(description->camera_count >= 1);
    for (size_t i = 0; i < description->camera_count; i++) {
        const struct camera_description *camera = &description->cameras[i];
        int sizes = (camera->angle > 0) + (camera->vertical_angle > 0) + (camera->width > 0);
        require(camera->name && sizes == 1);
    }
    check_materials(description);
    check_objects(description, description->objects, description->object_count, false);
    for (size_t i = 0; i < description->group_count; i++)
        check_objects(description, description->groups[i].objects,
                      description->groups[i].object_count, true);
}

static void discard_printed(const struct diagnostics *sink)
{
    FILE *stream = fopen("/dev/null", "w");
    if (stream) {
        diagnostics_print(sink, stream);
        fclose(stream);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct diagnostics *sink = diagnostics_create();
    if (!sink)
        return 0;
    struct scene_description description;
    ps_result result = psd_read_text("fuzz.psd", (const char *)data, size, sink, &description);
    require((result == PS_OK) == (diagnostics_error_count(sink) == 0));
    if (result == PS_OK)
        check_description(&description);
    scene_description_release(&description);
    discard_printed(sink);
    diagnostics_destroy(sink);
    return 0;
}
