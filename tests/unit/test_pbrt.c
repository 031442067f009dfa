/* test_pbrt.c: tokens, transforms, spectra, roughness and subdivision of pbrt scenes. */
#include "pbrt/importer.h"
#include "pbrt/lexer.h"
#include "pbrt/roughness.h"
#include "pbrt/shape.h"
#include "pbrt/spectrum.h"
#include "pbrt/version.h"
#include "writer/name_index.h"

#include "unit/scratch.h"
#include <math.h>

/* --- tokens
 * ----------------------------------------------------------------------------------------- */

static void expect_token(struct lexer *lexer, enum token_kind kind, const char *text, int line,
                         int column, int width)
{
    struct token token = lexer_next(lexer);
    if (token.kind != kind)
        fail_msg("token of kind %d, expected %d", token.kind, kind);
    if (text)
        assert_string_equal(token.text, text);
    assert_int_equal(token.origin.line, line);
    assert_int_equal(token.origin.column, column);
    assert_int_equal(token.width, width);
}

static struct lexer lexer_of(const char *text)
{
    return lexer_start("t.pbrt", text, strlen(text));
}

static void test_cuts_tokens(void **state)
{
    (void)state;
    struct lexer lexer =
        lexer_of("\xef\xbb\xbfShape \"float radius\"[-1.5e1]# \"x\n\t\xc3\xa4 \"a\\\"\\n\" .5");
    expect_token(&lexer, TOKEN_WORD, "Shape", 1, 1, 5);
    expect_token(&lexer, TOKEN_STRING, "float radius", 1, 7, 14);
    expect_token(&lexer, TOKEN_OPEN, NULL, 1, 21, 1);
    struct token number = lexer_next(&lexer);
    assert_int_equal(number.kind, TOKEN_NUMBER);
    assert_true(number.number == -15.0);
    expect_token(&lexer, TOKEN_CLOSE, NULL, 1, 28, 1);
    expect_token(&lexer, TOKEN_WORD, "\xc3\xa4", 2, 2, 1); /* one character */
    expect_token(&lexer, TOKEN_STRING, "a\"\n", 2, 4, 7);
    expect_token(&lexer, TOKEN_NUMBER, NULL, 2, 12, 2);
    expect_token(&lexer, TOKEN_END, NULL, 2, 14, 1);
    expect_token(&lexer, TOKEN_END, NULL, 2, 14, 1);
    lexer_release(&lexer);
}

static void expect_bad(const char *text)
{
    struct lexer lexer = lexer_of(text);
    if (lexer_next(&lexer).kind != TOKEN_BAD)
        fail_msg("'%s' is a token", text);
    lexer_release(&lexer);
}

static void test_refuses_bad_tokens(void **state)
{
    (void)state;
    expect_bad("\"open");
    expect_bad("\"line\n\"");
    expect_bad("\"\\q\"");
    expect_bad("\"\xff\"");
    expect_bad("1x");
    expect_bad("-");
    expect_bad("0x10");
    expect_bad("1e999");
    struct lexer lexer = lexer_start("t.pbrt", "\"a\0b\"", 5);
    assert_int_equal(lexer_next(&lexer).kind, TOKEN_BAD);
    lexer_release(&lexer);
}

static int version_of(const char *text)
{
    return version_guess(text, strlen(text));
}

static void test_guesses_versions(void **state)
{
    (void)state;
    assert_int_equal(version_of("Shape \"sphere\""), 0);
    assert_int_equal(version_of("Film \"image\""), 3);
    assert_int_equal(version_of("Film \"rgb\""), 4);
    assert_int_equal(version_of("AreaLightSource \"diffuse\" Material \"matte\""), 3);
    assert_int_equal(version_of("Material \"diffuse\""), 4);
    assert_int_equal(version_of("Shape \"x\" \"bool b\" true"), 4);
}

/* --- transforms
 * ------------------------------------------------------------------------------------- */

static void expect_near(struct vector got, double x, double y, double z)
{
    if (!(fabs(got.x - x) + fabs(got.y - y) + fabs(got.z - z) < 1e-9))
        fail_msg("got %g %g %g, expected %g %g %g", got.x, got.y, got.z, x, y, z);
}

static void test_transforms_points(void **state)
{
    (void)state;
    struct transform turn, move = transform_translate(1, 2, 3), view, inverse;
    assert_true(transform_rotate(90, (struct vector){0, 0, 2}, &turn));
    assert_false(transform_rotate(90, (struct vector){0, 0, 0}, &turn));
    struct transform both = transform_compose(&move, &turn);
    expect_near(transform_point(&both, (struct vector){1, 0, 0}), 1, 3, 3);
    expect_near(transform_direction(&both, (struct vector){1, 0, 0}), 0, 1, 0);
    assert_true(transform_invert(&both, &inverse));
    expect_near(transform_point(&inverse, (struct vector){1, 3, 3}), 1, 0, 0);
    assert_true(transform_look_at((struct vector){0, 0, -5}, (struct vector){0, 0, 0},
                                  (struct vector){0, 1, 0}, &view));
    expect_near(transform_point(&view, (struct vector){1, 2, 0}), 1, 2,
                5); /* left-handed: x is to the right */
    assert_true(fabs(transform_determinant(&view) - 1) < 1e-12);
    assert_false(transform_look_at((struct vector){0, 0, 0}, (struct vector){0, 1, 0},
                                   (struct vector){0, 2, 0}, &view));
    struct transform flat = transform_scale(1, 0, 1);
    assert_false(transform_invert(&flat, &inverse));
}

static void test_reads_matrices_by_columns(void **state)
{
    (void)state;
    const double numbers[16] = {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 8, 6, 4, 2};
    const double projective[16] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    struct transform map;
    assert_true(transform_from_columns(numbers, &map));
    expect_near(transform_point(&map, (struct vector){1, 1, 1}), 5, 4, 3);
    assert_false(transform_from_columns(projective, &map));
}

static void test_keeps_sides_of_normals(void **state)
{
    (void)state;
    struct transform mirror = transform_scale(1, 1, -3);
    struct vector n = transform_normal(&mirror, (struct vector){0, 0, 1});
    assert_true(n.z < 0); /* as the image of the side is */
    n = transform_normal(&mirror, (struct vector){1, 0, 0});
    assert_true(n.x > 0);
}

/* --- spectra
 * ---------------------------------------------------------------------------------------- */

static void expect_rgb(const double rgb[3], double r, double g, double b, double within)
{
    if (!(fabs(rgb[0] - r) <= within && fabs(rgb[1] - g) <= within && fabs(rgb[2] - b) <= within))
        fail_msg("got %g %g %g, expected %g %g %g", rgb[0], rgb[1], rgb[2], r, g, b);
}

static void test_turns_spectra_to_colors(void **state)
{
    (void)state;
    double even[] = {300, 0.5, 900, 0.5}, red[] = {360, 0, 590, 0, 610, 1, 830, 1}, rgb[3];
    struct spectrum spectrum = {.kind = SPECTRUM_SAMPLED, .samples = even, .count = 2};
    spectrum_reflectance(&spectrum, rgb);
    expect_rgb(rgb, 0.5, 0.5, 0.5, 1e-12);
    spectrum_illuminant(&spectrum, 3, rgb); /* the white of equal energy, of luminance 1/2 */
    expect_rgb(rgb, 0.6025, 0.474, 0.4545, 0.01);
    spectrum_illuminant(&spectrum, 4, rgb); /* of luminance 1 */
    expect_rgb(rgb, 1.205, 0.948, 0.909, 0.02);
    spectrum = (struct spectrum){.kind = SPECTRUM_SAMPLED, .samples = red, .count = 4};
    spectrum_reflectance(&spectrum, rgb);
    assert_true(rgb[0] > 0.5 && rgb[1] < 0.1 && rgb[2] < 0.1);
}

static void test_knows_names_and_temperatures(void **state)
{
    (void)state;
    struct spectrum spectrum, k;
    double rgb[3];
    assert_true(spectrum_named("stdillum-D65", &spectrum));
    spectrum_illuminant(&spectrum, 4, rgb);
    expect_rgb(rgb, 1, 1, 1, 2e-3);
    assert_true(spectrum_named("stdillum-A", &spectrum));
    spectrum_illuminant(&spectrum, 4, rgb);
    double lamp = rgb[0] / rgb[2];
    spectrum = (struct spectrum){.kind = SPECTRUM_BLACKBODY, .temperature = 2856, .scale = 1};
    spectrum_illuminant(&spectrum, 4, rgb); /* which is what A is */
    assert_true(fabs(rgb[0] / rgb[2] / lamp - 1) < 0.05);
    spectrum = (struct spectrum){.kind = SPECTRUM_BLACKBODY, .temperature = 5500, .scale = 3};
    spectrum_illuminant(&spectrum, 3, rgb); /* its largest value is the scale, near 527 nm */
    assert_true(rgb[1] > 2.7 && rgb[1] < 3.1);
    assert_true(spectrum_named("metal-Au-eta", &spectrum) && spectrum_named("metal-Au-k", &k));
    spectrum_conductor(&spectrum, &k, rgb);
    assert_true(rgb[0] > 0.9 && rgb[1] > 0.65 && rgb[2] < 0.5);
    assert_false(spectrum_named("metal-Xx-eta", &spectrum));
}

static void test_remaps_roughness(void **state)
{
    (void)state;
    assert_true(fabs(roughness_from(0.25, false, 4) - 0.5) < 1e-12);
    assert_true(fabs(roughness_from(0.0625, true, 4) - 0.5) < 1e-12);
    assert_true(fabs(roughness_from(1, true, 3) - 1) <
                1e-12); /* alpha 1.62, of which 1 is the most */
    assert_true(fabs(roughness_from(0.1, true, 3) - sqrt(0.46176)) < 1e-3);
    assert_true(roughness_from(0, true, 4) == 0.0);
}

/* --- names
 * ------------------------------------------------------------------------------------------ */

static void test_finds_the_latest_of_a_name(void **state)
{
    (void)state;
    struct name_index index = {0};
    const uint64_t a = name_index_hash("a"), b = name_index_hash("b");
    assert_true(name_index_find(&index, a) == NAME_INDEX_NONE);
    for (int i = 0; i < 1000; i++)
        assert_true(name_index_add(&index, i % 2 ? b : a));
    assert_int_equal(name_index_find(&index, a), 998);
    assert_int_equal(name_index_before(&index, 998), 996);
    assert_true(name_index_before(&index, 0) == NAME_INDEX_NONE);
    name_index_cut(&index, 2);
    assert_int_equal(name_index_find(&index, a), 0);
    assert_int_equal(name_index_find(&index, b), 1);
    name_index_cut(&index, 1);
    assert_true(name_index_find(&index, b) == NAME_INDEX_NONE);
    name_index_release(&index);
}

/* --- subdivision
 * ------------------------------------------------------------------------------------ */

static void test_subdivides_an_octahedron(void **state)
{
    (void)state;
    static const uint32_t triangles[8][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1},
                                             {5, 2, 1}, {5, 3, 2}, {5, 4, 3}, {5, 1, 4}};
    static const struct vector points[6] = {{0, 0, 1},  {1, 0, 0},  {0, 1, 0},
                                            {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    const struct pbrt_options options = {0};
    struct importer importer = {.options = &options, .sink = diagnostics_create()};
    const struct statement statement = {.kind = "loopsubdiv"};
    struct mesh mesh;
    assert_non_null(importer.sink);
    assert_true(mesh_allocate(&mesh, 6, false, false, 8));
    memcpy(mesh.points, points, sizeof points);
    memcpy(mesh.triangles, triangles, sizeof triangles);
    assert_true(subdivision_refine(&importer, &statement, &mesh, 2));
    assert_int_equal(mesh.triangle_count, 8 * 16);
    assert_int_equal(mesh.vertex_count, 2 + 8 * 16 / 2); /* Euler */
    /* A corner's limit: valence 4, whose neighbours sum to 0: 1 - 4 / (4 + 3 / (8 * 3/32)) = 1/2 of
     * it; the rule of a level keeps limits where they are. */
    expect_near(mesh.points[0], 0, 0, 0.5);
    expect_near(mesh.points[1], 0.5, 0, 0);
    /* pbrt's normals point inwards here. */
    expect_near(mesh.normals[0], 0, 0, -1);
    for (size_t i = 0; i < mesh.vertex_count; i++)
        assert_true(vector_dot(mesh.normals[i], mesh.points[i]) <
                    -0.9 * vector_length(mesh.points[i]));
    assert_false(subdivision_refine(&importer, &statement, &mesh, 12));
    mesh_release(&mesh);
    diagnostics_destroy(importer.sink);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cuts_tokens),
        cmocka_unit_test(test_refuses_bad_tokens),
        cmocka_unit_test(test_guesses_versions),
        cmocka_unit_test(test_transforms_points),
        cmocka_unit_test(test_reads_matrices_by_columns),
        cmocka_unit_test(test_keeps_sides_of_normals),
        cmocka_unit_test(test_turns_spectra_to_colors),
        cmocka_unit_test(test_knows_names_and_temperatures),
        cmocka_unit_test(test_remaps_roughness),
        cmocka_unit_test(test_finds_the_latest_of_a_name),
        cmocka_unit_test(test_subdivides_an_octahedron),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
