/* test_mesh_materials.c: pictures of meshes whose files say in glTF's words what their surface is
 * like.
 *
 * A square of two triangles fills the picture of a parallel camera. Its texture has four texels, of
 * which each quarter of the square shows one; where it lies, and what is multiplied with it, is
 * read off the albedo. A black square in between that is there by a share lets the rest of the
 * light through, whoever asks: camera, shadow rays, shadow maps, light paths.
 */
#include "image/image.h"
#include "support/render_scene.h"
#include "trace/trace.h"
#include "unit/scratch.h"

#include <math.h>

/* Corner by corner, counter-clockwise from the lower left. */
struct square {
    float positions[4][3], uv[4][2], second_uv[4][2];
    uint8_t colors[4][4];
    uint16_t indices[6];
};

static const struct square square = {
    .positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}},
    .uv = {{0, 1}, {1, 1}, {1, 0}, {0, 0}},
    .second_uv = {{0.5f, 0.5f}, {1, 0.5f}, {1, 0}, {0.5f, 0}}, /* the upper right quarter */
    .colors = {{0, 0, 51, 255}, {255, 0, 51, 255}, {255, 0, 51, 0}, {0, 0, 51, 0}},
    .indices = {0, 1, 2, 0, 2, 3},
};

/* Upper left, upper right, lower left, lower right. */
static const float texels[4][4] = {
    {0.1f, 0.5f, 1, 0.25f}, {0.2f, 0.5f, 0, 0.25f}, {0.3f, 0.5f, 1, 0.25f}, {0.4f, 0.5f, 0, 0.25f}};

static const char document[] =
    "{\"asset\":{\"version\":\"2.0\"},\"extensionsUsed\":[\"KHR_materials_unlit\","
    "\"KHR_materials_pbrSpecularGlossiness\"],\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
    "\"TEXCOORD_0\":1,\"TEXCOORD_1\":2%s},\"indices\":4,\"material\":0}]}],"
    "\"materials\":[{\"name\":\"m\",%s}],"
    "\"textures\":[{\"source\":0,\"sampler\":0}],\"images\":[{\"uri\":\"t.exr\"}],"
    "\"samplers\":[{\"magFilter\":9728}],"
    "\"buffers\":[{\"byteLength\":140,\"uri\":\"m.bin\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
    "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32},"
    "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":32},"
    "{\"buffer\":0,\"byteOffset\":112,\"byteLength\":16},"
    "{\"buffer\":0,\"byteOffset\":128,\"byteLength\":12}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
    "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
    "{\"bufferView\":3,\"componentType\":5121,\"normalized\":true,\"count\":4,\"type\":\"VEC4\"},"
    "{\"bufferView\":4,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}]}";

static void write_texture(const char *path)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    struct image image = {.width = 2, .height = 2};
    struct error error;
    for (int channel = 0; channel < 4; channel++) {
        float *samples = image_add_channel(&image, names[channel]);
        assert_non_null(samples);
        for (int i = 0; i < 4; i++)
            samples[i] = texels[i][channel];
    }
    assert_int_equal(image_write_exr(&image, path, IMAGE_UNCOMPRESSED, NULL, &error), PS_OK);
    image_release(&image);
}

/* The scene around "%s", which is the path of the mesh. */
#define AROUND(CAMERA, LIGHTS, MORE, RENDER)                                                       \
    "psd: 1\n"                                                                                     \
    "camera: {" CAMERA ", projection: orthographic, width: 2}\n"                                   \
    "image: {width: 8, height: 8}\n"                                                               \
    "lights:\n" LIGHTS "materials: {white: {diffuse: 1}, glow: {diffuse: 0, emission: 1}}\n"       \
    "objects:\n"                                                                                   \
    "  - mesh: {file: '%s'}\n" MORE "render: {" RENDER "}\n"

#define FROM_FRONT "location: [0, 0, 3], look_at: [0, 0, 0]"
#define SKY "  - sky: {radiance: [1, 1, 1], visible: no}\n"
#define ALONE AROUND(FROM_FRONT, SKY, "", "passes: 4")

/* The text of a scene with a mesh of that material, which has vertex colours where `colored`. */
static const char *scene_with(void **state, const char *around, const char *material, bool colored)
{
    static char scene[4096];
    char text[4096];
    _Static_assert(sizeof square == 140, "no gaps");
    scratch_store(scratch_path(state, "m.bin"), &square, sizeof square);
    write_texture(scratch_path(state, "t.exr"));
    snprintf(text, sizeof text, document, colored ? ",\"COLOR_0\":3" : "", material);
    scratch_store(scratch_path(state, "m.gltf"), text, strlen(text));
    snprintf(scene, sizeof scene, around, scratch_path(state, "m.gltf"));
    return scene;
}

/* What four rays meet, in the middles of the quarters: upper left, upper right, lower left, lower
 * right. */
static void meet(const char *text, ps_hit hits[4])
{
    struct scene scene = scene_of_text(text);
    struct trace *trace;
    struct error error;
    ps_ray rays[4];
    assert_int_equal(trace_create(&scene, NULL, &trace, &error), PS_OK);
    for (int i = 0; i < 4; i++)
        rays[i] =
            (ps_ray){{i % 2 ? 0.5f : -0.5f, i / 2 ? -0.5f : 0.5f, 1}, 0, {0, 0, -1}, INFINITY};
    trace_intersect(trace, RAYS_INCOHERENT, rays, NULL, 4, hits);
    trace_destroy(trace);
    scene_release(&scene);
}

static void expect_albedo(void **state, const char *material, bool colored, char channel,
                          const double expected[4])
{
    ps_hit hits[4];
    meet(scene_with(state, ALONE, material, colored), hits);
    for (int i = 0; i < 4; i++) {
        double albedo = channel == 'r' ? hits[i].albedo.r : hits[i].albedo.b;
        if (!(fabs(albedo - expected[i]) <= 1e-3))
            fail_msg("%c of quarter %d: %g, expected %g", channel, i, albedo, expected[i]);
    }
}

static struct rendering picture_of(void **state, const char *around, const char *material,
                                   const char *const choices[])
{
    return render_text(scene_with(state, around, material, false), 2, choices);
}

static const char *const plain[] = {"estimator=ambient:irradiance=0", NULL};

#define PBR(TEXT) "\"pbrMetallicRoughness\":{\"metallicFactor\":0," TEXT "}"
#define BASE(TEXT) PBR("\"baseColorTexture\":{\"index\":0" TEXT "}")
#define TRANSFORM(TEXT) ",\"extensions\":{\"KHR_texture_transform\":{" TEXT "}}"
#define NO_COAT ",\"extensions\":{\"KHR_materials_specular\":{\"specularFactor\":0}}"

static void test_where_the_texture_lies(void **state)
{
    static const double as_it_is[] = {0.1, 0.2, 0.3, 0.4}, second[] = {0.2, 0.2, 0.2, 0.2};
    static const double moved[] = {0.2, 0.1, 0.4, 0.3}, wide[] = {0.1, 0.1, 0.1, 0.1};
    /* By 90 degrees about the upper left corner, clockwise as it is seen: (v, 1 - u). */
    static const double turned[] = {0.3, 0.1, 0.4, 0.2};
    expect_albedo(state, BASE("") NO_COAT, false, 'r', as_it_is);
    expect_albedo(state, BASE(",\"texCoord\":1") NO_COAT, false, 'r', second);
    expect_albedo(state, BASE(TRANSFORM("\"texCoord\":1")) NO_COAT, false, 'r', second);
    expect_albedo(state, BASE(TRANSFORM("\"offset\":[0.5,0]")) NO_COAT, false, 'r', moved);
    expect_albedo(state, BASE(TRANSFORM("\"scale\":[0.5,0.5]")) NO_COAT, false, 'r', wide);
    expect_albedo(state, BASE(TRANSFORM("\"rotation\":1.5707963")) NO_COAT, false, 'r', turned);
}

/* Of a map whose upper left texel leans by -0.8 along the picture, its lower left one by -0.4. */
static void test_normal_maps_turn_with_the_picture(void **state)
{
    ps_hit hits[4];
    meet(scene_with(state, ALONE, "\"normalTexture\":{\"index\":0}", false), hits);
    assert_true(fabsf(hits[0].normal.x / hits[0].normal.z + 0.8f) < 2e-3f);
    meet(scene_with(state, ALONE, "\"normalTexture\":{\"index\":0,\"scale\":0.5}", false), hits);
    assert_true(fabsf(hits[0].normal.x / hits[0].normal.z + 0.4f) < 2e-3f);
    assert_true(fabsf(hits[0].normal.y) < 2e-3f);
    meet(scene_with(state, ALONE,
                    "\"normalTexture\":{\"index\":0" TRANSFORM("\"rotation\":1.5707963") "}",
                    false),
         hits);
    assert_true(fabsf(hits[0].normal.y / hits[0].normal.z - 0.4f) < 2e-3f); /* its u is down */
    assert_true(fabsf(hits[0].normal.x) < 2e-3f);
}

/* Red grows from left to right, alpha from the top down; blue is 0.2. */
static void test_vertex_colors_multiply(void **state)
{
    static const double red[] = {0.25, 0.75, 0.25, 0.75}, blue[] = {0.1, 0.1, 0.1, 0.1};
    static const double both[] = {0.025, 0.15, 0.075, 0.3}, white[] = {1, 1, 1, 1};
    static const char factor[] = PBR("\"baseColorFactor\":[1,1,0.5,1]") NO_COAT;
    expect_albedo(state, factor, false, 'r', white);
    expect_albedo(state, factor, true, 'r', red);
    expect_albedo(state, factor, true, 'b', blue);
    expect_albedo(state, BASE("") NO_COAT, true, 'r', both);
}

/* A metal has no diffuse albedo; blue is the metalness. */
static void test_metal_in_places(void **state)
{
    static const double dull[] = {0, 0.9, 0, 0.9}, half[] = {0.45, 0.9, 0.45, 0.9};
    expect_albedo(state,
                  "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.9,0.9,1],"
                  "\"metallicRoughnessTexture\":{\"index\":0}}" NO_COAT,
                  false, 'r', dull);
    expect_albedo(state,
                  "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.9,0.9,1],"
                  "\"metallicFactor\":0.5,\"metallicRoughnessTexture\":{\"index\":0}}" NO_COAT,
                  false, 'r', half);
}

/* As constants that say the same. */
static void test_metal_in_places_is_metal(void **state)
{
    static const char *const choices[] = {"estimator=pathtrace:samples=64", "bounces=all", NULL};
    static const char around[] =
        AROUND(FROM_FRONT, "  - sun: {direction: [1, 0, -2], irradiance: [3, 3, 3], angle: 60}\n",
               "", "passes: 64");
#define COPPER(TEXT)                                                                               \
    "\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.5,0.2,1],\"metallicFactor\":" TEXT "}"
    struct rendering varied = picture_of(
        state, around, COPPER("0.5,\"metallicRoughnessTexture\":{\"index\":0}"), choices);
    struct rendering metal =
        picture_of(state, around, COPPER("0.5,\"roughnessFactor\":0.5"), choices);
    struct rendering dull = picture_of(state, around, COPPER("0,\"roughnessFactor\":0.5"), choices);
    double expected[] = {mean_of_all(&metal.image, "G"), mean_of_all(&dull.image, "G")};
    assert_true(fabs(expected[0] - expected[1]) > 0.2 * expected[1]);
    for (size_t i = 0; i < 2; i++) {
        double mean = mean_of(&varied.image, "G", 4 * i + 1, 0, 2, 8);
        if (!(fabs(mean / expected[i] - 1) < 0.03))
            fail_msg("half %zu: %g, expected %g", i, mean, expected[i]);
    }
    rendering_release(&varied);
    rendering_release(&metal);
    rendering_release(&dull);
}

static void test_specular_and_glossiness(void **state)
{
    static const double as_it_is[] = {0.1, 0.2, 0.3, 0.4};
    expect_albedo(state,
                  "\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{"
                  "\"specularFactor\":[0,0,0],\"diffuseTexture\":{\"index\":0}}}",
                  false, 'r', as_it_is);
}

/* It shows what is on it whatever the light. */
static void test_unlit(void **state)
{
    static const double as_it_is[] = {0.1, 0.2, 0.3, 0.4};
    struct rendering rendering =
        picture_of(state, ALONE, BASE("") ",\"extensions\":{\"KHR_materials_unlit\":{}}", plain);
    for (size_t i = 0; i < 4; i++) {
        double mean = mean_of(&rendering.image, "R", 4 * (i % 2) + 1, 4 * (i / 2) + 1, 2, 2);
        assert_true(fabs(mean - as_it_is[i]) < 1e-3);
    }
    rendering_release(&rendering);
}

/* --- what is there in part
 * ----------------------------------------------------------------------- */

#define BLEND(ALPHA) PBR("\"baseColorFactor\":[0,0,0," ALPHA "]") NO_COAT ",\"alphaMode\":\"BLEND\""

/* A wall behind the square; one across from there, whose light reaches it through the square
 * alone. */
#define QUAD(Z, SIZE, MATERIAL)                                                                    \
    "  - quad: {corners: [[-" SIZE ", -" SIZE ", " Z "], [" SIZE ", -" SIZE ", " Z "], [" SIZE     \
    ", " SIZE ", " Z "], [-" SIZE ", " SIZE ", " Z "]], material: " MATERIAL "}\n"
#define FROM_BEHIND "location: [0, 0, -0.2], look_at: [0, 0, -1]"
#define SUN "  - sun: {direction: [0, 0, -1], irradiance: [1, 1, 1], angle: 0}\n"
#define LAMP "  - point: {location: [0, 0, 1], intensity: 3}\n"

static double mean_light(void **state, const char *around, const char *material,
                         const char *const choices[], const char *channel)
{
    struct rendering rendering = picture_of(state, around, material, choices);
    double mean = mean_of_all(&rendering.image, channel);
    rendering_release(&rendering);
    return mean;
}

/* A surface of opacity 0.3, where one of 0 lets all pass. */
static void expect_share(void **state, const char *around, const char *const choices[],
                         const char *channel)
{
    double all = mean_light(state, around, BLEND("0"), choices, channel);
    double some = mean_light(state, around, BLEND("0.3"), choices, channel);
    if (!(all > 0 && fabs(some / all - 0.7) <= 0.03))
        fail_msg("%s of %s: %g of %g came through", channel, choices[0], some, all);
}

static void test_shares_of_light(void **state)
{
    static const char *const paths[] = {"estimator=pathtrace:samples=64", NULL};
    static const char *const both[] = {"estimator=bdpt:samples=16", NULL};
    static const char *const splats[] = {"estimator=splat", "injection=photon:count=20000", NULL};
    expect_share(state, AROUND(FROM_FRONT, SKY, QUAD("-1", "1", "glow"), "passes: 64"), plain, "G");
    expect_share(state, AROUND(FROM_BEHIND, SUN, QUAD("-1", "1", "white"), "passes: 64"), plain,
                 "direct.G");
    expect_share(
        state, AROUND(FROM_BEHIND, LAMP, QUAD("-1", "1", "white"), "passes: 64, direct: shadowmap"),
        plain, "direct.G");
#define ROOM                                                                                       \
    AROUND(FROM_BEHIND, LAMP, QUAD("-1", "1", "white") QUAD("2", "0.5", "white"), "passes: 4")
    expect_share(state, ROOM, paths, "indirect.G");
    expect_share(state, ROOM, both, "indirect.G");
    expect_share(state, ROOM, splats, "indirect.G");
}

/* A lamp of which a part is there shines by that part. */
static void test_lamp_that_is_there_in_part(void **state)
{
#define GLOW(ALPHA) "\"emissiveFactor\":[1,1,1],\"doubleSided\":true," BLEND(ALPHA)
    static const char around[] =
        AROUND(FROM_BEHIND, LAMP, QUAD("-1", "1", "white"), "passes: 16, light_samples: 16");
    double all = mean_light(state, around, GLOW("1"), plain, "direct.G");
    double none = mean_light(state, around, GLOW("0"), plain, "direct.G");
    double some = mean_light(state, around, GLOW("0.3"), plain, "direct.G");
    if (!(fabs(some / (0.3 * all + 0.7 * none) - 1) < 0.03))
        fail_msg("%g, between %g and %g", some, none, all);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_where_the_texture_lies),
        SCRATCH_TEST(test_normal_maps_turn_with_the_picture),
        SCRATCH_TEST(test_vertex_colors_multiply),
        SCRATCH_TEST(test_metal_in_places),
        SCRATCH_TEST(test_metal_in_places_is_metal),
        SCRATCH_TEST(test_specular_and_glossiness),
        SCRATCH_TEST(test_unlit),
        SCRATCH_TEST(test_shares_of_light),
        SCRATCH_TEST(test_lamp_that_is_there_in_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
