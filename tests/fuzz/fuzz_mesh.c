/* fuzz_mesh.c: feeds arbitrary bytes to the mesh importer (libFuzzer).
 *
 * The first byte chooses the format, and what to ask for; the rest is the file. After "\n%%\n"
 * comes its companion: the MTL of an OBJ, the .bin of a glTF. Nothing is read from the disk. assimp
 * may crash on what it is given, in the importer's child; the importer may not, and must keep its
 * promise: every index of the fragment is in range, every number finite, and a failure says why and
 * leaves nothing. No coverage comes back from the child, so inputs are changes of the corpus and
 * little else: sound files of each format, and what broke the importer once, in
 * tests/fuzz/corpus_mesh.
 */
#include "import/import.h"

#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
const char *__asan_default_options(void);

/* Names in the reports of children that crash would take most of the time. */
const char *__asan_default_options(void)
{
    return "symbolize=0";
}

static void require(bool condition)
{
    if (!condition)
        abort();
}

static bool is_finite(ps_vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static void check_meshes(const struct scene_description *fragment)
{
    for (size_t i = 0; i < fragment->mesh_count; i++) {
        const struct mesh_description *mesh = &fragment->meshes[i];
        require(mesh->triangle_count > 0);
        for (size_t j = 0; j < mesh->triangle_count; j++)
            for (int k = 0; k < 3; k++)
                require(mesh->triangles[j][k] < mesh->vertex_count);
        for (size_t j = 0; j < mesh->vertex_count; j++) {
            require(is_finite(mesh->vertices[j]));
            require(!mesh->normals || is_finite(mesh->normals[j]));
            require(!mesh->uv || (isfinite(mesh->uv[j][0]) && isfinite(mesh->uv[j][1])));
            require(!mesh->second_uv ||
                    (isfinite(mesh->second_uv[j][0]) && isfinite(mesh->second_uv[j][1])));
            for (int k = 0; mesh->colors && k < 4; k++)
                require(mesh->colors[j][k] >= 0 && mesh->colors[j][k] <= 1);
        }
    }
}

static void check_pigment(const struct scene_description *fragment,
                          const struct pigment_description *pigment)
{
    require(pigment->kind != PIGMENT_IMAGE || pigment->texture < fragment->texture_count);
    require(isfinite(pigment->colors[0].r) && isfinite(pigment->colors[0].g) &&
            isfinite(pigment->colors[0].b));
    require(isfinite(pigment->scale_u) && isfinite(pigment->scale_v) &&
            isfinite(pigment->cross_u) && isfinite(pigment->cross_v) &&
            isfinite(pigment->offset_u) && isfinite(pigment->offset_v));
    require(!pigment->vertex_colors || pigment->uv_set == 0);
}

static void check_material(const struct scene_description *fragment, size_t index)
{
    const struct material_description *material = &fragment->materials[index];
    require(material->name != NULL);
    check_pigment(fragment, &material->color);
    check_pigment(fragment, &material->specular);
    check_pigment(fragment, &material->roughness);
    check_pigment(fragment, &material->emission);
    check_pigment(fragment, &material->opacity);
    check_pigment(fragment, &material->bump);
    check_pigment(fragment, &material->normal_map);
    check_pigment(fragment, &material->share);
    for (size_t i = 0; i < material->component_count; i++)
        require(material->components[i] < index && isfinite(material->weights[i]));
}

static void check_fragment(const struct scene_description *fragment)
{
    check_meshes(fragment);
    for (size_t i = 0; i < fragment->object_count; i++) {
        const struct object_description *object = &fragment->objects[i];
        require(object->kind == OBJECT_MESH && object->mesh < fragment->mesh_count);
        require(object->material == NO_INDEX || object->material < fragment->material_count);
        require(is_finite(object->placement.translation));
    }
    for (size_t i = 0; i < fragment->material_count; i++)
        check_material(fragment, i);
    for (size_t i = 0; i < fragment->camera_count; i++)
        require(is_finite(fragment->cameras[i].location) && fragment->cameras[i].name);
    for (size_t i = 0; i < fragment->light_count; i++)
        require(is_finite(fragment->lights[i].location));
}

static const struct {
    const char *path, *companion;
} formats[] = {
    {"m.obj", "m.mtl"}, {"m.gltf", "m.bin"}, {"m.glb", "m.bin"},
    {"m.ply", "m.png"}, {"m.stl", "m.png"},  {"m.off", "m.png"},
    {"m.dae", "m.png"}, {"m.fbx", "m.png"},  {"m.3ds", "m.png"},
};

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char separator[] = "\n%%\n";
    if (size == 0)
        return 0;
    size_t format = data[0] % (sizeof formats / sizeof formats[0]);
    const uint8_t *file = data + 1, *end = data + size;
    const uint8_t *split = memmem(file, size - 1, separator, sizeof separator - 1);
    const uint8_t *companion = split ? split + sizeof separator - 1 : end;
    const struct mesh_memory_file files[] = {
        {formats[format].path, file, (size_t)((split ? split : end) - file)},
        {formats[format].companion, companion, (size_t)(end - companion)},
    };
    const struct mesh_request request = {
        .path = formats[format].path,
        .geometry = !(data[0] & 0x80),
        .materials = true,
        .camera = true,
        .lights = true,
        .unit = 0.5,
        .bump_scale = 1,
        .smooth_angle = data[0] & 0x40 ? 40 : 0,
        .up = 2,
        .placement = AFFINE_IDENTITY,
        .seconds = 1,
        .origin = {"fuzz.psd", 1, 1},
    };
    struct scene_description fragment;
    struct mesh_report report;
    struct error error = {.text = ""};
    if (mesh_import_memory(&request, files, 2, &fragment, &report, &error) == PS_OK)
        check_fragment(&fragment);
    else
        require(error.text[0] != '\0' && fragment.objects == NULL);
    scene_description_release(&fragment);
    return 0;
}
