/* test_mesh_gltf.c: glTF's materials, nodes and rules, with files in memory. */
#include "mesh_fixture.h"

/* One triangle; texture coordinates after the positions; indices 0, 1, 2. */
static const float triangle[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0.75f};

/* The document around these parts; NULL for the usual ones. */
struct parts {
    const char *material, *node, *extra, *accessors, *views, *primitive, *scene_nodes;
};

static const char usual_accessors[] =
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
    "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}";
static const char usual_views[] = "{\"buffer\":0,\"byteLength\":36},"
                                  "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24}";
static const char usual_primitive[] =
    "{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1},\"material\":0}";

static const char *or_else(const char *text, const char *usual)
{
    return text ? text : usual;
}

static struct imported import_parts_of(const struct mesh_request *request, struct parts parts)
{
    char text[8192];
    snprintf(text, sizeof text,
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":%s}],"
             "\"nodes\":[%s],\"meshes\":[{\"primitives\":[%s]}],"
             "\"materials\":[{\"name\":\"m\"%s}],"
             "\"buffers\":[{\"byteLength\":60,\"uri\":\"my%%20data.bin\"}],"
             "\"bufferViews\":[%s],\"accessors\":[%s],"
             "\"textures\":[{\"source\":0,\"sampler\":0}],\"images\":[{\"uri\":\"a.png\"}],"
             "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33071,\"magFilter\":9728}]%s}",
             or_else(parts.scene_nodes, "[0]"), or_else(parts.node, "{\"mesh\":0}"),
             or_else(parts.primitive, usual_primitive), or_else(parts.material, ""),
             or_else(parts.views, usual_views), or_else(parts.accessors, usual_accessors),
             or_else(parts.extra, ""));
    const struct mesh_memory_file files[] = {text_file("d/m.gltf", text),
                                             {"d/my data.bin", triangle, sizeof triangle},
                                             text_file("d/a.png", PNG_START)};
    return import_files(request, files, 3);
}

static struct imported import_parts(struct parts parts)
{
    struct mesh_request request = request_all("d/m.gltf");
    return import_parts_of(&request, parts);
}

static struct imported import_material(const char *material, const char *extra)
{
    struct imported imported = import_parts((struct parts){.material = material, .extra = extra});
    expect_success(&imported);
    return imported;
}

/* --- geometry --------------------------------------------------------------------------------- */

static void texture_coordinates_are_turned_upwards(void **state)
{
    (void)state;
    struct imported imported = import_material("", "");
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    expect_vector(corner(&imported, 0, 0, 1), 1, 0, 0);
    expect_near(mesh->uv[mesh->triangles[0][0]][1], 1, 1e-6); /* glTF's v goes down */
    expect_near(mesh->uv[mesh->triangles[0][2]][1], 0.25, 1e-6);
    expect_near(mesh->uv[mesh->triangles[0][1]][0], 1, 1e-6);
    release_imported(&imported);
}

static void mesh_of_two_nodes_is_stored_once(void **state)
{
    (void)state;
    struct imported imported = import_parts((struct parts){
        .scene_nodes = "[0,1]",
        .node = "{\"mesh\":0,\"translation\":[5,0,0]},{\"mesh\":0,\"scale\":[2,2,2]}"});
    expect_success(&imported);
    assert_int_equal(imported.fragment.mesh_count, 1);
    assert_int_equal(imported.fragment.object_count, 2);
    expect_vector(corner(&imported, 0, 0, 1), 6, 0, 0);
    expect_vector(corner(&imported, 1, 0, 1), 2, 0, 0);
    release_imported(&imported);
}

static void flat_node_is_dropped(void **state)
{
    (void)state;
    struct imported imported = import_parts((struct parts){
        .scene_nodes = "[0,1]", .node = "{\"mesh\":0},{\"mesh\":0,\"scale\":[0,1,1]}"});
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 1);
    assert_int_equal(imported.report.dropped_triangles, 1);
    release_imported(&imported);
}

/* --- materials -------------------------------------------------------------------------------- */

#define PBR(text) ",\"pbrMetallicRoughness\":{" text "}"

static void metalness_chooses_or_mixes(void **state)
{
    (void)state;
    struct imported imported = import_material(
        PBR("\"baseColorFactor\":[0.9,0.6,0.3,1],\"metallicFactor\":1,\"roughnessFactor\":0.4"),
        "");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_METAL);
    expect_color(m->color.colors[0], 0.9, 0.6, 0.3);
    expect_near(m->roughness.colors[0].r, 0.4, 1e-6);
    release_imported(&imported);
    imported = import_material(PBR("\"metallicFactor\":0"), "");
    assert_int_equal(material_named(&imported, "m")->kind, MATERIAL_GLOSSY);
    expect_near(material_named(&imported, "m")->specular.colors[0].r, 0.04, 1e-6);
    release_imported(&imported);
    imported = import_material(PBR("\"metallicFactor\":0.25"), "");
    m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_MIX);
    assert_int_equal(imported.fragment.materials[m->components[0]].kind, MATERIAL_METAL);
    assert_int_equal(imported.fragment.materials[m->components[1]].kind, MATERIAL_GLOSSY);
    expect_near(m->weights[0], 0.25, 1e-6);
    expect_near(m->weights[1], 0.75, 1e-6);
    release_imported(&imported);
}

static void diffuse_only_leaves_the_colour(void **state)
{
    (void)state;
    struct mesh_request request = request_all("d/m.gltf");
    request.diffuse_only = true;
    struct imported imported = import_parts_of(
        &request, (struct parts){.material = PBR("\"baseColorFactor\":[0.9,0.6,0.3,1]")});
    expect_success(&imported);
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_DIFFUSE);
    expect_color(m->color.colors[0], 0.9, 0.6, 0.3);
    release_imported(&imported);
}

static void textures_have_their_channels_and_encodings(void **state)
{
    (void)state;
    struct imported imported = import_material(
        PBR("\"metallicFactor\":0,\"baseColorTexture\":{\"index\":0},"
            "\"metallicRoughnessTexture\":{\"index\":0}") ",\"normalTexture\":{\"index\":0},"
                                                          "\"emissiveFactor\":[1,1,1],"
                                                          "\"emissiveTexture\":{\"index\":0},"
                                                          "\"alphaMode\":\"BLEND\"",
        "");
    const struct material_description *m = material_named(&imported, "m");
    const struct texture_description *textures = imported.fragment.textures;
    assert_int_equal(imported.fragment.texture_count, 2); /* as colour, and as numbers */
    assert_string_equal(textures[m->color.texture].path, "d/a.png");
    assert_int_equal(textures[m->color.texture].wrap_u, WRAP_CLAMP);
    assert_true(textures[m->color.texture].nearest);
    assert_int_equal(m->color.channel, CHANNEL_RGB);
    assert_int_equal(m->opacity.texture, m->color.texture);
    assert_int_equal(m->opacity.channel, CHANNEL_A);
    assert_int_equal(m->emission.texture, m->color.texture);
    assert_int_equal(m->roughness.kind, PIGMENT_IMAGE);
    assert_int_equal(m->roughness.channel, CHANNEL_G);
    assert_int_equal(textures[m->roughness.texture].encoding, ENCODING_LINEAR);
    assert_int_equal(m->normal_map.texture, m->roughness.texture);
    release_imported(&imported);
}

static void metalness_by_a_texture_is_its_blue(void **state)
{
    (void)state;
    struct imported imported = import_material(
        PBR("\"metallicFactor\":0.5,\"metallicRoughnessTexture\":{\"index\":0}"), "");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_MIX);
    assert_true(m->varying);
    assert_int_equal(m->share.kind, PIGMENT_IMAGE);
    assert_int_equal(m->share.channel, CHANNEL_B);
    expect_color(m->share.colors[0], 0.5, 0.5, 0.5);
    assert_int_equal(imported.fragment.materials[m->components[0]].kind, MATERIAL_METAL);
    assert_int_equal(imported.fragment.textures[m->share.texture].encoding, ENCODING_LINEAR);
    assert_string_equal(imported.report.notes, "");
    release_imported(&imported);
}

static void glossiness_is_roughness_reversed(void **state)
{
    (void)state;
    struct imported imported =
        import_material(",\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{"
                        "\"diffuseFactor\":[0.5,0.4,0.3,0.2],\"specularFactor\":[0.1,0.2,0.3],"
                        "\"glossinessFactor\":0.75,\"specularGlossinessTexture\":{\"index\":0}}},"
                        "\"alphaMode\":\"BLEND\"",
                        ",\"extensionsUsed\":[\"KHR_materials_pbrSpecularGlossiness\"]");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_GLOSSY);
    expect_color(m->color.colors[0], 0.5, 0.4, 0.3);
    expect_color(m->specular.colors[0], 0.1, 0.2, 0.3);
    expect_near(m->opacity.colors[0].r, 0.2, 1e-6);
    assert_true(m->blended);
    assert_int_equal(m->specular.kind, PIGMENT_IMAGE);
    assert_int_equal(m->roughness.kind, PIGMENT_IMAGE);
    assert_int_equal(m->roughness.channel, CHANNEL_A);
    assert_true(m->roughness.complement);
    expect_near(m->roughness.colors[0].r, 0.75, 1e-6);
    release_imported(&imported);
    imported = import_material(",\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{"
                               "\"glossinessFactor\":0.75}}",
                               "");
    expect_near(material_named(&imported, "m")->roughness.colors[0].r, 0.25, 1e-6);
    release_imported(&imported);
}

static void unlit_shines_in_its_colour(void **state)
{
    (void)state;
    struct imported imported = import_material(
        PBR("\"baseColorFactor\":[0.5,0.4,0.3,1]") ",\"extensions\":{\"KHR_materials_unlit\":{}}",
        "");
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_DIFFUSE);
    expect_color(m->color.colors[0], 0, 0, 0);
    expect_color(m->emission.colors[0], 0.5, 0.4, 0.3);
    release_imported(&imported);
}

static void specular_scales_the_coat(void **state)
{
    (void)state;
    struct imported imported = import_material(
        PBR("\"metallicFactor\":0") ",\"extensions\":{\"KHR_materials_specular\":{"
                                    "\"specularFactor\":0.5,\"specularColorFactor\":[1,2,0]}}",
        "");
    expect_color(material_named(&imported, "m")->specular.colors[0], 0.02, 0.04, 0);
    release_imported(&imported);
}

static void normal_scale_is_kept(void **state)
{
    (void)state;
    struct imported imported =
        import_material(",\"normalTexture\":{\"index\":0,\"scale\":0.5}", "");
    expect_near(material_named(&imported, "m")->normal_map.colors[0].r, 0.5, 1e-6);
    release_imported(&imported);
}

/* Each thing once, with the first material's name. */
static void what_is_left_out_is_told(void **state)
{
    (void)state;
    struct imported imported = import_parts((struct parts){
        .material = ",\"extensions\":{\"KHR_materials_clearcoat\":{\"clearcoatFactor\":0.5},"
                    "\"KHR_materials_sheen\":{\"sheenColorFactor\":[0,0.1,0]},"
                    "\"KHR_materials_anisotropy\":{},"
                    "\"KHR_materials_dispersion\":{\"dispersion\":0}}},"
                    "{\"name\":\"n\",\"extensions\":{\"KHR_materials_clearcoat\":{},"
                    "\"KHR_materials_sheen\":{\"sheenColorFactor\":[1,0,0]}}",
        .primitive = "{\"attributes\":{\"POSITION\":0},\"material\":0},"
                     "{\"attributes\":{\"POSITION\":0},\"material\":1}"});
    expect_success(&imported);
    assert_string_equal(imported.report.notes, "the clearcoat of material m is left out\n"
                                               "the sheen of material m and 1 more is left out");
    release_imported(&imported);
}

static void a_material_counts_once(void **state)
{
    (void)state;
    struct imported imported =
        import_material(",\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{"
                        "\"diffuseFactor\":[2,1,1,1],\"specularFactor\":[2,1,1]}}",
                        "");
    assert_string_equal(imported.report.notes,
                        "what is above 1 in the reflectance of material m is left out");
    release_imported(&imported);
}

static void line_ends_in_names_make_no_lines(void **state)
{
    (void)state;
    struct imported imported = import_parts(
        (struct parts){.material = "},{\"name\":\"a\\nb\","
                                   "\"pbrMetallicRoughness\":{\"baseColorFactor\":[2,1,1,1]}",
                       .primitive = "{\"attributes\":{\"POSITION\":0},\"material\":1}"});
    expect_success(&imported);
    assert_string_equal(imported.report.notes,
                        "what is above 1 in the reflectance of material a?b is left out");
    release_imported(&imported);
}

/* Once, so that there is room for what else is to be told. */
static void third_set_is_told_once(void **state)
{
    (void)state;
    struct imported imported = import_material(
        PBR("\"baseColorTexture\":{\"index\":0,\"texCoord\":2}") ",\"normalTexture\":{\"index\":0,"
                                                                 "\"texCoord\":3}",
        "");
    assert_string_equal(
        imported.report.notes,
        "a texture by a third set of coordinates, or one beyond, is laid by the first");
    release_imported(&imported);
}

static void texture_transform_is_kept(void **state)
{
    (void)state;
    struct imported imported = import_material(
        PBR("\"baseColorTexture\":{\"index\":0,\"extensions\":{\"KHR_texture_transform\":"
            "{\"offset\":[0.25,0.125],\"scale\":[2,4]}}}"),
        ",\"extensionsUsed\":[\"KHR_texture_transform\"]");
    const struct pigment_description *color = &material_named(&imported, "m")->color;
    expect_near(color->scale_u, 2, 1e-6);
    expect_near(color->scale_v, 4, 1e-6);
    expect_near(color->offset_u, 0.25, 1e-6);
    /* v downwards: v' = 4 v + 0.125; upwards: w' = 1 - v' = 4 w - 3.125. */
    expect_near(color->offset_v, -3.125, 1e-6);
    release_imported(&imported);
}

static void alpha_mode_decides_on_opacity(void **state)
{
    (void)state;
    struct imported imported = import_material(PBR("\"baseColorFactor\":[1,1,1,0.3]"), "");
    expect_near(material_named(&imported, "m")->opacity.colors[0].r, 1, 1e-6);
    release_imported(&imported);
    imported =
        import_material(PBR("\"baseColorFactor\":[1,1,1,0.3]") ",\"alphaMode\":\"BLEND\"", "");
    expect_near(material_named(&imported, "m")->opacity.colors[0].r, 0.3, 1e-6);
    assert_true(material_named(&imported, "m")->blended);
    release_imported(&imported);
    imported = import_material(
        PBR("\"baseColorFactor\":[1,1,1,0.3]") ",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25", "");
    assert_true(material_named(&imported, "m")->opacity.colors[0].r >= 0.5f);
    assert_false(material_named(&imported, "m")->blended);
    release_imported(&imported);
}

static void known_extensions_may_be_required(void **state)
{
    (void)state;
    struct imported imported = import_material(
        "", ",\"extensionsRequired\":[\"KHR_lights_punctual\",\"KHR_materials_ior\","
            "\"KHR_materials_emissive_strength\",\"KHR_materials_transmission\","
            "\"KHR_materials_volume\",\"KHR_texture_transform\"]");
    release_imported(&imported);
}

static void transmission_is_glass(void **state)
{
    (void)state;
    struct mesh_request request = request_all("d/m.gltf");
    request.unit = 10;
    struct imported imported = import_parts_of(
        &request,
        (struct parts){
            .material =
                PBR("\"baseColorFactor\":[0.9,0.8,0.7,1]") ",\"extensions\":{"
                                                           "\"KHR_materials_transmission\":{"
                                                           "\"transmissionFactor\":1},"
                                                           "\"KHR_materials_ior\":{\"ior\":1.33},"
                                                           "\"KHR_materials_volume\":"
                                                           "{\"attenuationDistance\":2,"
                                                           "\"attenuationColor\":[0.25,0.5,1]}}",
            .extra = ",\"extensionsUsed\":[\"KHR_materials_transmission\",\"KHR_materials_ior\","
                     "\"KHR_materials_volume\"]"});
    expect_success(&imported);
    const struct material_description *m = material_named(&imported, "m");
    assert_int_equal(m->kind, MATERIAL_DIELECTRIC);
    expect_near(m->ior, 1.33, 1e-6);
    expect_color(m->color.colors[0], 0.9, 0.8, 0.7);
    expect_color(m->absorption, -log(0.25) / 20, -log(0.5) / 20, 0); /* 2 file units are 20 */
    release_imported(&imported);
}

static void emission_shines_from_both_sides_of_a_double_sided_material(void **state)
{
    (void)state;
    struct imported imported = import_material(",\"emissiveFactor\":[1,0.5,0]", "");
    expect_color(material_named(&imported, "m")->emission.colors[0], 1, 0.5, 0);
    assert_false(material_named(&imported, "m")->emission_both);
    release_imported(&imported);
    imported = import_material(",\"emissiveFactor\":[1,0.5,0],\"doubleSided\":true", "");
    assert_true(material_named(&imported, "m")->emission_both);
    release_imported(&imported);
}

static void no_material_is_none(void **state)
{
    (void)state;
    struct imported imported =
        import_parts((struct parts){.primitive = "{\"attributes\":{\"POSITION\":0}}"});
    expect_success(&imported);
    assert_int_equal(imported.fragment.material_count, 0);
    assert_true(imported.fragment.objects[0].material == NO_INDEX);
    release_imported(&imported);
}

/* The first corner, by an index that is the first byte of the positions, goes to the third. */
static void sparse_accessors_are_followed(void **state)
{
    (void)state;
    struct imported imported = import_parts((struct parts){
        .views = "{\"buffer\":0,\"byteLength\":36},"
                 "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24},"
                 "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":1},"
                 "{\"buffer\":0,\"byteOffset\":24,\"byteLength\":12}",
        .accessors =
            "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
            "\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":2,\"componentType\":5121},"
            "\"values\":{\"bufferView\":3}}},"
            "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}"});
    expect_failure(&imported, PS_ERROR_INVALID, "no triangles");
}

static void skins_and_colours_are_no_hindrance(void **state)
{
    (void)state;
    struct imported imported = import_parts((struct parts){
        .node = "{\"mesh\":0,\"skin\":0}",
        .extra = ",\"skins\":[{\"joints\":[0]}],\"animations\":[{\"channels\":7}]",
        .primitive = "{\"attributes\":{\"POSITION\":0,\"COLOR_1\":99,\"JOINTS_0\":98,"
                     "\"WEIGHTS_0\":97,\"TEXCOORD_2\":96},\"targets\":[{\"POSITION\":95}]}"});
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 1);
    release_imported(&imported);
}

/* --- rules ------------------------------------------------------------------------------------ */

static void expect_refused(struct parts parts, const char *words)
{
    struct imported imported = import_parts(parts);
    expect_failure(&imported, PS_ERROR_INVALID, words);
}

static void broken_accessors_are_refused(void **state)
{
    (void)state;
    static const char second[] =
        ",{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}";
    static const char *const cases[] = {
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}",
        "{\"bufferView\":0,\"byteOffset\":9007199254740990,\"componentType\":5126,"
        "\"count\":3,\"type\":\"VEC3\"}",
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4294967295,\"type\":\"VEC3\"}",
        "{\"bufferView\":0,\"componentType\":5126,\"count\":-1,\"type\":\"VEC3\"}",
        "{\"bufferView\":7,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}",
        "{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}",
        "{\"bufferView\":0,\"componentType\":5123,\"count\":3,\"type\":\"VEC3\"}",
        "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"MAT4\"}",
        "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"sparse\":{\"count\":1}}",
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char text[512];
        snprintf(text, sizeof text, "%s%s", cases[i], second);
        expect_refused((struct parts){.accessors = text}, "d/m.gltf: ");
    }
    expect_refused((struct parts){.views = "{\"buffer\":0,\"byteOffset\":40,\"byteLength\":36},"
                                           "{\"buffer\":0,\"byteLength\":24}"},
                   "d/m.gltf: ");
}

static void lines_are_left_out(void **state)
{
    (void)state;
    struct imported imported = import_parts((struct parts){
        .primitive =
            "{\"attributes\":{\"POSITION\":0},\"mode\":2},{\"attributes\":{\"POSITION\":0}}"});
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 1);
    release_imported(&imported);
}

/* The bytes from 3 to 14 of the positions, as indices: (0, 0, 0) thrice, which has no area, and
 * (0, 0, 128), which is not there. */
static void triangles_of_absent_vertices_are_counted(void **state)
{
    (void)state;
    char accessors[512];
    snprintf(accessors, sizeof accessors,
             "%s,{\"bufferView\":0,\"byteOffset\":3,\"componentType\":5121,\"count\":12,"
             "\"type\":\"SCALAR\"}",
             usual_accessors);
    struct imported imported = import_parts(
        (struct parts){.accessors = accessors,
                       .primitive = "{\"attributes\":{\"POSITION\":0}},"
                                    "{\"attributes\":{\"POSITION\":0},\"indices\":2}"});
    expect_success(&imported);
    assert_int_equal(imported.fragment.object_count, 1);
    assert_int_equal(imported.report.dropped_triangles, 4);
    release_imported(&imported);
}

static void broken_meshes_are_refused(void **state)
{
    (void)state;
    static const char *const primitives[] = {
        "{\"attributes\":{\"NORMAL\":0}}",
        "",
        "{\"attributes\":{\"POSITION\":0},\"indices\":1}",
        "{\"attributes\":{\"POSITION\":0},\"mode\":7}",
    };
    for (size_t i = 0; i < sizeof primitives / sizeof primitives[0]; i++)
        expect_refused((struct parts){.primitive = primitives[i]}, "d/m.gltf: ");
    expect_refused((struct parts){.primitive = "{\"attributes\":{\"POSITION\":0},\"material\":9}"},
                   "material");
    expect_refused((struct parts){.extra = ",\"extensionsRequired\":[\"EXT_of_tomorrow\"]"},
                   "EXT_of_tomorrow");
}

static void broken_trees_are_refused(void **state)
{
    (void)state;
    expect_refused((struct parts){.node = "{\"mesh\":0,\"children\":[0]}"}, "two parents");
    expect_refused((struct parts){.node = "{\"children\":[1]},{\"children\":[0]}"}, "two parents");
    expect_refused((struct parts){.node = "{\"children\":[1,1]},{\"mesh\":0}"}, "two parents");
    expect_refused((struct parts){.node = "{\"mesh\":0,\"children\":[5]}"}, "lacks");
    expect_refused((struct parts){.node = "{\"mesh\":3}"}, "lacks");
    expect_refused((struct parts){.scene_nodes = "[]"}, "no triangles");
    expect_refused((struct parts){.scene_nodes = "{}"}, "array");
    char deep[6000] = "";
    for (int i = 0; i < 256; i++)
        snprintf(deep + strlen(deep), sizeof deep - strlen(deep), "{\"children\":[%d]},", i + 1);
    strcat(deep, "{\"mesh\":0}");
    expect_refused((struct parts){.node = deep}, "256 deep");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texture_coordinates_are_turned_upwards),
        cmocka_unit_test(mesh_of_two_nodes_is_stored_once),
        cmocka_unit_test(flat_node_is_dropped),
        cmocka_unit_test(metalness_chooses_or_mixes),
        cmocka_unit_test(diffuse_only_leaves_the_colour),
        cmocka_unit_test(textures_have_their_channels_and_encodings),
        cmocka_unit_test(metalness_by_a_texture_is_its_blue),
        cmocka_unit_test(glossiness_is_roughness_reversed),
        cmocka_unit_test(unlit_shines_in_its_colour),
        cmocka_unit_test(specular_scales_the_coat),
        cmocka_unit_test(normal_scale_is_kept),
        cmocka_unit_test(what_is_left_out_is_told),
        cmocka_unit_test(a_material_counts_once),
        cmocka_unit_test(line_ends_in_names_make_no_lines),
        cmocka_unit_test(third_set_is_told_once),
        cmocka_unit_test(texture_transform_is_kept),
        cmocka_unit_test(alpha_mode_decides_on_opacity),
        cmocka_unit_test(known_extensions_may_be_required),
        cmocka_unit_test(transmission_is_glass),
        cmocka_unit_test(emission_shines_from_both_sides_of_a_double_sided_material),
        cmocka_unit_test(no_material_is_none),
        cmocka_unit_test(sparse_accessors_are_followed),
        cmocka_unit_test(skins_and_colours_are_no_hindrance),
        cmocka_unit_test(broken_accessors_are_refused),
        cmocka_unit_test(lines_are_left_out),
        cmocka_unit_test(triangles_of_absent_vertices_are_counted),
        cmocka_unit_test(broken_meshes_are_refused),
        cmocka_unit_test(broken_trees_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
