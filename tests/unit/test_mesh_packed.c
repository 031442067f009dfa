/* test_mesh_packed.c: glTF whose numbers are not plain floats: integers, meshopt, Draco; instances;
 * pictures that only an extension names. */
#include "image/raster.h"
#include "mesh_fixture.h"

/* What every file here holds: (0, 0, 0), (2, 0, 0), (0, 4, 0), (0, 0, 1); triangles 0 1 2 and 0 2
 * 3. */
static const double corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {0, 0, 1}};

struct document {
    const char *extensions; /* that are required */
    const char *nodes, *primitive, *accessors, *views, *extra;
    const void *bytes;
    size_t size;
    const char *buffer; /* its name, or NULL: m.bin */
};

static struct imported import_document(const struct document *document)
{
    static char text[131072];
    const char *buffer = document->buffer ? document->buffer : "m.bin";
    char path[64];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"extensionsRequired\":[%s],\"extensionsUsed\":[%s],"
             "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[%s],"
             "\"meshes\":[{\"primitives\":[%s]}],\"accessors\":[%s],\"bufferViews\":[%s],"
             "\"buffers\":[{\"uri\":\"%s\",\"byteLength\":%zu}]%s}",
             document->extensions, document->extensions,
             document->nodes ? document->nodes : "{\"mesh\":0}", document->primitive,
             document->accessors, document->views, buffer, document->size,
             document->extra ? document->extra : "");
    snprintf(path, sizeof path, "d/%s", buffer);
    const struct mesh_memory_file files[] = {text_file("d/m.gltf", text),
                                             {path, document->bytes, document->size},
                                             text_file("d/a.webp", "RIFF....WEBPVP8 ......"),
                                             text_file("d/a.png", PNG_START)};
    struct mesh_request request = request_all("d/m.gltf");
    return import_files(&request, files, 4);
}

/* Its triangles have these corners, whatever their numbers. */
static void expect_corners(const struct imported *imported, double tolerance)
{
    static const int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    const struct mesh_description *mesh = mesh_of(imported, 0);
    assert_int_equal(mesh->triangle_count, 2);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            ps_vec3 p = mesh->vertices[mesh->triangles[i][k]];
            const double *expected = corners[triangles[i][k]];
            expect_near((double)p.x, expected[0], tolerance);
            expect_near((double)p.y, expected[1], tolerance);
            expect_near((double)p.z, expected[2], tolerance);
        }
}

static void expect_document(const struct document *document, double tolerance)
{
    struct imported imported = import_document(document);
    expect_success(&imported);
    expect_corners(&imported, tolerance);
    release_imported(&imported);
}

static void refuse_document(const struct document *document, const char *words)
{
    struct imported imported = import_document(document);
    expect_failure(&imported, PS_ERROR_INVALID, words);
}

/* --- integers
 * ---------------------------------------------------------------------------------- */

/* Positions as shorts every 8 bytes; normals as bytes every 4; texture coordinates as shorts
 * without a sign. */
static const struct {
    int16_t positions[4][4];
    int8_t normals[4][4];
    uint16_t uv[4][2], indices[6];
} integers = {{{0, 0, 0, 0}, {2, 0, 0, 0}, {0, 4, 0, 0}, {0, 0, 1, 0}},
              {{0, 0, 127, 0}, {0, 0, 127, 0}, {0, 0, -128, 0}, {0, 127, 0, 0}},
              {{0, 0}, {65535, 0}, {0, 65535}, {0, 13107}},
              {0, 1, 2, 0, 2, 3}};

static const struct document of_integers = {
    .extensions = "\"KHR_mesh_quantization\"",
    .primitive = "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":3,"
                 "\"material\":0}",
    .accessors = "{\"bufferView\":0,\"componentType\":5122,\"count\":4,\"type\":\"VEC3\"},"
                 "{\"bufferView\":1,\"componentType\":5120,\"normalized\":true,\"count\":4,"
                 "\"type\":\"VEC3\"},"
                 "{\"bufferView\":2,\"componentType\":5123,\"normalized\":true,\"count\":4,"
                 "\"type\":\"VEC2\"},"
                 "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}",
    .views = "{\"buffer\":0,\"byteLength\":32,\"byteStride\":8},"
             "{\"buffer\":0,\"byteOffset\":32,\"byteLength\":16,\"byteStride\":4},"
             "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":16},"
             "{\"buffer\":0,\"byteOffset\":64,\"byteLength\":12}",
    .extra = ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
             "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"a.png\"}]",
    .bytes = &integers,
    .size = sizeof integers,
};

static void integers_stand_for_numbers(void **state)
{
    (void)state;
    struct imported imported = import_document(&of_integers);
    expect_success(&imported);
    expect_corners(&imported, 0);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_non_null(mesh->normals);
    expect_vector(mesh->normals[mesh->triangles[0][1]], 0, 0, 1);
    expect_vector(mesh->normals[mesh->triangles[0][2]], 0, 0, -1);
    assert_non_null(mesh->uv);
    expect_near((double)mesh->uv[mesh->triangles[0][1]][0], 1, 0);
    expect_near((double)mesh->uv[mesh->triangles[1][2]][1], 0.8, 1e-6); /* v goes upwards here */
    assert_string_equal(imported.report.notes, "");
    release_imported(&imported);
}

static void bad_integers_are_refused(void **state)
{
    (void)state;
    struct document document = of_integers;
    document.views = "{\"buffer\":0,\"byteLength\":24,\"byteStride\":8},"
                     "{\"buffer\":0,\"byteOffset\":32,\"byteLength\":16,\"byteStride\":4},"
                     "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":16},"
                     "{\"buffer\":0,\"byteOffset\":64,\"byteLength\":12}";
    refuse_document(&document, "beyond its view");
    document = of_integers;
    document.size = 40;
    refuse_document(&document, "cut short");
    document = of_integers;
    document.accessors = "{\"componentType\":5122,\"count\":400000000,\"type\":\"VEC3\"}";
    refuse_document(&document, "64 times");
    document.accessors = "{\"componentType\":5126,\"count\":9007199254740991,\"type\":\"VEC3\"}";
    refuse_document(&document, "64 times");
    document.accessors = "{\"bufferView\":77,\"componentType\":5122,\"count\":4,\"type\":\"VEC3\"}";
    refuse_document(&document, "a view that the file lacks");
    document.accessors = "{\"bufferView\":0,\"componentType\":5122,\"count\":0,\"type\":\"VEC3\"}";
    refuse_document(&document, "no elements");
    document = of_integers;
    document.buffer = "m.gltf";
    refuse_document(&document, "names this file itself");
}

/* What is unpacked must not hide what lies beside the mesh. */
static void names_of_unpacked_files_are_free(void **state)
{
    (void)state;
    struct document document = of_integers;
    document.buffer = "psplat-unpacked-0.bin";
    expect_document(&document, 0);
}

/* Many accessors of one view, each of which is unpacked. */
static void unpacking_is_bounded(void **state)
{
    static const char primitive[] = "{\"attributes\":{\"POSITION\":%d}}";
    static const char accessor[] =
        "{\"bufferView\":0,\"componentType\":5120,\"count\":10000,\"type\":\"VEC3\"}";
    static const char bytes[30000];
    char primitives[4096] = "", accessors[6000] = "";
    (void)state;
    for (int i = 0; i < 50; i++) {
        size_t used = strlen(primitives), used_too = strlen(accessors);
        if (i > 0) {
            primitives[used++] = ',';
            accessors[used_too++] = ',';
        }
        snprintf(primitives + used, sizeof primitives - used, primitive, i);
        snprintf(accessors + used_too, sizeof accessors - used_too, accessor);
    }
    struct document document = of_integers;
    document.primitive = primitives;
    document.accessors = accessors;
    document.views = "{\"buffer\":0,\"byteLength\":30000}";
    document.extra = "";
    document.bytes = bytes;
    document.size = sizeof bytes;
    refuse_document(&document, "64 times as large");
}

/* --- meshopt, from its own encoder
 * --------------------------------------------------------------- */

static const unsigned char meshopt[] =
    {160, 0,   0, 0,  1,   60,  0,  0,   0,   128, 127, 0,   0,   1,   15,  0, 0,   0, 255, 255, 1,
     15,  0,   0, 0,  128, 127, 0,  0,   1,   3,   0,   0,   0,   255, 1,   3, 0,   0, 0,   126, 0,
     0,   0,   0, 0,  0,   0,   0,  0,   0,   0,   0,   0,   0,   0,   0,   0, 0,   0, 0,   0,   0,
     0,   0,   0, 0,  0,   0,   0,  0,   0,   0, /* 73: floats */
     224, 240, 0, 0,  118, 135, 86, 103, 120, 169, 134, 101, 137, 104, 152, 1, 105, 0, 0, /* 19 */
     208, 0,   4, 4,  6,   8,   4,  0,   0,   0,   0,                                     /* 11 */
     160, 0,   1, 60, 0,   0,   0,  8,   7,   0,   1,   59,  0,   0,   0,   4, 3,   0, 1,   15,  0,
     0,   0,   8, 7,  0,   1,   59, 0,   0,   0,   4,   3,   0,   1,   3,   0, 0,   0, 8,   0,   1,
     59,  0,   0, 0,  4,   3,   0,  0,   0,   0,   0,   0,   0,   0,   0,   0, 0,   0, 0,   0,   0,
     0,   0,   0, 0,  0,   0,   0,  0,   245, 0,   0,   0,   245, 0,   0,   0, 245};

#define PACKED(offset, length, count, stride, mode, more)                                          \
    "{\"buffer\":1,\"byteLength\":48,\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,"   \
    "\"byteOffset\":" #offset ",\"byteLength\":" #length ",\"count\":" #count                      \
    ",\"byteStride\":" #stride ",\"mode\":\"" mode "\"" more "}}}"
#define FLOATS PACKED(0, 73, 4, 12, "ATTRIBUTES", "")
#define TRIANGLES PACKED(73, 19, 6, 2, "TRIANGLES", "")

static struct document of_meshopt(const char *views)
{
    return (struct document){
        .extensions = "\"EXT_meshopt_compression\"",
        .primitive = "{\"attributes\":{\"POSITION\":0},\"indices\":1}",
        .accessors = "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
                     "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}",
        .views = views,
        .bytes = meshopt,
        .size = sizeof meshopt,
    };
}

/* Whether this build has the library. */
static bool has_meshopt(void)
{
    const struct document document = of_meshopt(FLOATS "," TRIANGLES);
    struct imported imported = import_document(&document);
    bool lacks = imported.result != PS_OK && strstr(imported.error.text, "built without");
    if (imported.result == PS_OK)
        release_imported(&imported);
    return !lacks;
}

static void meshopt_is_unpacked(void **state)
{
    (void)state;
    if (!has_meshopt())
        skip();
    struct document document = of_meshopt(FLOATS "," TRIANGLES);
    expect_document(&document, 0);
    document = of_meshopt(FLOATS "," PACKED(92, 11, 6, 2, "INDICES", ""));
    expect_document(&document, 0);
    document = of_meshopt(
        PACKED(103, 80, 4, 12, "ATTRIBUTES", ",\"filter\":\"EXPONENTIAL\"") "," TRIANGLES);
    expect_document(&document, 1e-3);
    document = of_meshopt(FLOATS "," TRIANGLES "," TRIANGLES "," FLOATS);
    document.accessors =
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"sparse\":{"
        "\"count\":1,\"indices\":{\"bufferView\":2,\"byteOffset\":2,\"componentType\":5123},"
        "\"values\":{\"bufferView\":3,\"byteOffset\":12}}},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}";
    expect_document(&document, 0);
}

static void damaged_meshopt_is_refused(void **state)
{
    static const char *const views[] = {
        PACKED(0, 60, 4, 12, "ATTRIBUTES", "") "," TRIANGLES,
        PACKED(0, 73, 4, 12, "ATTRIBUTES", ",\"filter\":\"OCTAHEDRAL\"") "," TRIANGLES,
        PACKED(0, 73, 4, 12, "ATTRIBUTES", ",\"filter\":\"SHARPEN\"") "," TRIANGLES,
        PACKED(0, 73, 4, 13, "ATTRIBUTES", "") "," TRIANGLES,
        PACKED(0, 73, 4, 12, "POINTS", "") "," TRIANGLES,
        FLOATS "," PACKED(73, 19, 5, 2, "TRIANGLES", ""),
        FLOATS "," PACKED(73, 9, 6, 2, "TRIANGLES", ""),
        FLOATS "," PACKED(73, 19, 6, 3, "TRIANGLES", ""),
        PACKED(0, 73, 1000000, 12, "ATTRIBUTES", "") "," TRIANGLES,
        PACKED(0, 7300, 4, 12, "ATTRIBUTES", "") "," TRIANGLES,
    };
    (void)state;
    if (!has_meshopt())
        skip();
    for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
        const struct document document = of_meshopt(views[i]);
        struct imported imported = import_document(&document);
        expect_failure(&imported, PS_ERROR_INVALID, "d/m.gltf: glTF: ");
    }
}

/* --- Draco, from its own encoder
 * ------------------------------------------------------------------ */

static const unsigned char draco[] = {
    68,  82, 65, 67, 79,  2,   2,  1, 0, 0, 0,  2,  4, 1,  0,  1, 2,   0,  2, 3,  1,   1,
    0,   9,  3,  0,  0,   2,   0,  1, 1, 0, 15, 3,  1, 16, 47, 1, 48,  3,  0, 80, 130, 248,
    255, 1,  0,  0,  224, 255, 15, 0, 0, 0, 0,  64, 0, 0,  0,  1, 0,   0,  0, 0,  255, 63,
    0,   0,  0,  0,  0,   0,   0,  0, 0, 0, 0,  0,  0, 0,  0,  0, 128, 64, 14};

static void draco_is_unpacked(void **state)
{
    struct document document = {
        .extensions = "\"KHR_draco_mesh_compression\"",
        .primitive = "{\"attributes\":{\"POSITION\":0,\"TANGENT\":2},\"indices\":1,\"extensions\":{"
                     "\"KHR_draco_mesh_compression\":{\"bufferView\":0,"
                     "\"attributes\":{\"POSITION\":0,\"TANGENT\":9}}}}",
        .accessors = "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
                     "{\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
                     "{\"componentType\":5126,\"count\":4,\"type\":\"VEC4\"}",
        .views = "{\"buffer\":0,\"byteLength\":85}",
        .bytes = draco,
        .size = sizeof draco,
    };
    (void)state;
    struct imported imported = import_document(&document);
    if (imported.result != PS_OK && strstr(imported.error.text, "Draco mesh compression not"))
        skip(); /* assimp was built without */
    expect_success(&imported);
    expect_corners(&imported, 1e-3);
    release_imported(&imported);
    document.primitive =
        "{\"attributes\":{\"POSITION\":0,\"NORMAL\":2},\"indices\":1,\"extensions\":{"
        "\"KHR_draco_mesh_compression\":{\"bufferView\":0,"
        "\"attributes\":{\"POSITION\":0,\"NORMAL\":9}}}}";
    document.accessors = "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
                         "{\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
                         "{\"componentType\":5120,\"count\":4,\"type\":\"VEC3\"}";
    imported = import_document(&document);
    expect_success(&imported);
    expect_corners(&imported, 1e-3);
    assert_non_null(strstr(imported.report.notes, "compressed by Draco are left out"));
    release_imported(&imported);
    document.size = 50;
    document.views = "{\"buffer\":0,\"byteLength\":50}";
    refuse_document(&document, "d/m.gltf: ");
}

/* --- instances
 * ----------------------------------------------------------------------------------- */

/* Rotations are a half turn about y and none, as bytes; scales are floats. */
static const struct {
    float positions[4][3];
    uint16_t indices[6], unused[2];
    float translations[2][3], scales[2][3];
    int8_t rotations[2][4];
} instanced = {{{0, 0, 0}, {2, 0, 0}, {0, 4, 0}, {0, 0, 1}},
               {0, 1, 2, 0, 2, 3},
               {0, 0},
               {{10, 0, 0}, {0, 20, 0}},
               {{1, 1, 1}, {2, 3, 4}},
               {{0, 127, 0, 0}, {0, 0, 0, 127}}};

static const struct document of_instances = {
    .extensions = "\"EXT_mesh_gpu_instancing\"",
    .nodes = "{\"mesh\":0,\"translation\":[0,0,100],\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
             "\"attributes\":{\"TRANSLATION\":2,\"SCALE\":3,\"ROTATION\":4,\"_ID\":7}}}}",
    .primitive = "{\"attributes\":{\"POSITION\":0},\"indices\":1}",
    .accessors = "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
                 "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
                 "{\"bufferView\":2,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"
                 "{\"bufferView\":2,\"byteOffset\":24,\"componentType\":5126,\"count\":2,"
                 "\"type\":\"VEC3\"},"
                 "{\"bufferView\":3,\"componentType\":5120,\"normalized\":true,\"count\":2,"
                 "\"type\":\"VEC4\"}",
    .views = "{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":12},"
             "{\"buffer\":0,\"byteOffset\":64,\"byteLength\":48},"
             "{\"buffer\":0,\"byteOffset\":112,\"byteLength\":8}",
    .bytes = &instanced,
    .size = sizeof instanced,
};

static void instances_are_placed(void **state)
{
    (void)state;
    struct imported imported = import_document(&of_instances);
    expect_success(&imported);
    assert_int_equal(imported.fragment.mesh_count, 1);
    assert_int_equal(imported.fragment.object_count, 2);
    const struct affine *turned = &imported.fragment.objects[0].placement;
    expect_vector(affine_point(turned, (ps_vec3){1, 2, 3}), 9, 2, 97);
    const struct affine *scaled = &imported.fragment.objects[1].placement;
    expect_vector(affine_point(scaled, (ps_vec3){1, 1, 1}), 2, 23, 104);
    release_imported(&imported);
}

/* By the specification an accessor without a view is zeros. */
static void accessors_without_a_view_are_zeros(void **state)
{
    (void)state;
    struct document document = of_integers;
    document.accessors =
        "{\"bufferView\":0,\"componentType\":5122,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5120,\"normalized\":true,\"count\":4,\"type\":"
        "\"VEC3\"},"
        "{\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
        "{\"componentType\":5123,\"normalized\":true,\"count\":4,\"type\":\"VEC3\"}";
    document.primitive =
        "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2,\"COLOR_0\":4},"
        "\"indices\":3,\"material\":0}";
    struct imported imported = import_document(&document);
    expect_success(&imported);
    expect_corners(&imported, 0);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_non_null(mesh->uv);
    assert_non_null(mesh->colors);
    for (size_t i = 0; i < mesh->vertex_count; i++)
        expect_near((double)mesh->uv[i][0], 0, 0);
    release_imported(&imported);
    document.accessors = "{\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}";
    document.primitive = "{\"attributes\":{\"POSITION\":0}}";
    refuse_document(&document, "no triangles"); /* but a point */
    document = of_instances;
    document.nodes = "{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{"
                     "\"TRANSLATION\":2}}}}";
    document.accessors =
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"},"
        "{\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}";
    imported = import_document(&document);
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 2);
    expect_vector(imported.fragment.objects[1].placement.translation, 0, 0, 0);
    release_imported(&imported);
}

/* A thousand and one nodes with a mesh of a thousand primitives each. */
static void objects_without_instances_are_bounded(void **state)
{
    static char nodes[40000], primitives[60000];
    const char *const primitive = "{\"attributes\":{\"POSITION\":0},\"indices\":1}";
    (void)state;
    size_t length = (size_t)snprintf(nodes, sizeof nodes, "{\"children\":[1");
    for (int i = 2; i <= 1001; i++)
        length += (size_t)snprintf(nodes + length, sizeof nodes - length, ",%d", i);
    length += (size_t)snprintf(nodes + length, sizeof nodes - length, "]}");
    for (int i = 1; i <= 1001; i++)
        length += (size_t)snprintf(nodes + length, sizeof nodes - length, ",{\"mesh\":0}");
    length = (size_t)snprintf(primitives, sizeof primitives, "%s", primitive);
    for (int i = 1; i < 1000; i++)
        length +=
            (size_t)snprintf(primitives + length, sizeof primitives - length, ",%s", primitive);
    struct document document = of_instances;
    document.nodes = nodes;
    document.primitive = primitives;
    refuse_document(&document, "1000000 objects");
}

static void bad_instances_are_refused(void **state)
{
    (void)state;
    struct document document = of_instances;
    document.nodes = "{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{"
                     "\"TRANSLATION\":2,\"ROTATION\":0}}}}";
    refuse_document(&document, "fit");
    document.nodes = "{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{"
                     "\"TRANSLATION\":77}}}}";
    refuse_document(&document, "accessor");
}

static void instances_without_a_place_stand_as_the_node(void **state)
{
    struct document document = of_instances;
    document.nodes = "{\"mesh\":0,\"translation\":[0,0,100],\"extensions\":{"
                     "\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"_ID\":2}}}}";
    (void)state;
    struct imported imported = import_document(&document);
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 1);
    expect_vector(affine_point(&imported.fragment.objects[0].placement, (ps_vec3){1, 2, 3}), 1, 2,
                  103);
    release_imported(&imported);
}

/* All nodes have the same translations. */
static void instances_are_bounded(void **state)
{
    static const float translations[90000][3];
    char nodes[4096];
    (void)state;
    size_t length =
        (size_t)snprintf(nodes, sizeof nodes, "{\"children\":[1,2,3,4,5,6,7,8,9,10,11,12]}");
    for (int i = 0; i < 12; i++)
        length += (size_t)snprintf(nodes + length, sizeof nodes - length,
                                   ",{\"mesh\":0,\"extensions\":{\"EXT_mesh_gpu_instancing\":{"
                                   "\"attributes\":{\"TRANSLATION\":1}}}}");
    struct document document = of_instances;
    document.nodes = nodes;
    document.primitive = "{\"attributes\":{\"POSITION\":0}}";
    document.accessors =
        "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"componentType\":5126,\"count\":90000,\"type\":\"VEC3\"}";
    document.views = "{\"buffer\":0,\"byteLength\":1080000}";
    document.bytes = translations;
    document.size = sizeof translations;
    refuse_document(&document, "1000000 objects");
}

/* --- pictures
 * ------------------------------------------------------------------------------------- */

static struct imported import_texture(const char *texture)
{
    char extra[1024];
    struct document document = of_integers;
    snprintf(extra, sizeof extra,
             ",\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
             "\"textures\":[%s],\"images\":[{\"uri\":\"a.png\"},{\"uri\":\"a.webp\"}],"
             "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33648}]",
             texture);
    document.extra = extra;
    struct imported imported = import_document(&document);
    expect_success(&imported);
    return imported;
}

static void webp_is_preferred_where_it_is_read(void **state)
{
    bool is_read = strstr(raster_kinds, "WebP") != NULL;
    (void)state;
    struct imported imported =
        import_texture("{\"source\":0,\"extensions\":{\"EXT_texture_webp\":{\"source\":1}}}");
    assert_int_equal(imported.fragment.texture_count, 1);
    assert_string_equal(imported.fragment.textures[0].path, is_read ? "d/a.webp" : "d/a.png");
    release_imported(&imported);
    imported =
        import_texture("{\"sampler\":0,\"extensions\":{\"EXT_texture_webp\":{\"source\":1}}}");
    if (is_read) {
        assert_int_equal(imported.fragment.textures[0].wrap_u, WRAP_CLAMP);
        assert_int_equal(imported.fragment.textures[0].wrap_v, WRAP_MIRROR);
    } else {
        assert_non_null(strstr(imported.report.notes, "WebP"));
    }
    release_imported(&imported);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(integers_stand_for_numbers),
        cmocka_unit_test(bad_integers_are_refused),
        cmocka_unit_test(names_of_unpacked_files_are_free),
        cmocka_unit_test(unpacking_is_bounded),
        cmocka_unit_test(meshopt_is_unpacked),
        cmocka_unit_test(damaged_meshopt_is_refused),
        cmocka_unit_test(draco_is_unpacked),
        cmocka_unit_test(instances_are_placed),
        cmocka_unit_test(accessors_without_a_view_are_zeros),
        cmocka_unit_test(objects_without_instances_are_bounded),
        cmocka_unit_test(bad_instances_are_refused),
        cmocka_unit_test(instances_without_a_place_stand_as_the_node),
        cmocka_unit_test(instances_are_bounded),
        cmocka_unit_test(webp_is_preferred_where_it_is_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
