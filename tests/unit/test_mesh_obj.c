/* OBJ files: words and lines, corners that share vertices, polygons, parts; files of more than one
 * piece. */
#include "mesh_fixture.h"

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

static void expect_parts(const struct imported *imported, size_t parts)
{
    expect_success(imported);
    assert_int_equal(imported->fragment.object_count, parts);
}

/* --- the text
 * --------------------------------------------------------------------------------------- */

static void all_ways_of_writing_are_read(void **state)
{
    static const char *const texts[] = {
        TRIANGLE "f 1 2 3\n",
        TRIANGLE "f 1 2 3", /* no end of line */
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n",
        "\t v\t0 0  0 \n  v 1 0 0 # one\nv 0 1 0 #\n# f 9 9 9\n\nf  1\t2 3 # 4\n",
        "v 0 0 \\\n0\nv 1 \\\r\n 0 0\nv 0 1 0\nf \\\n1 2 3\n",
        "\xEF\xBB\xBF" TRIANGLE "f 1 2 3\n",
        "f 1 2 3\n" TRIANGLE, /* what comes later can be named, too */
        TRIANGLE "f -3 -2 -1\n",
        TRIANGLE "f 1/ 2// 3\n",
        "v 0 0 0 1\nv 2 0 0 2\nv 0 0.5 0 0.5\nf 1 2 3\n", /* homogeneous */
        "v .0 -0 +0.\nv 10e-1 0 0\nv 0 0.1E1 0\nl 1 2\np 1\nvp 1\ncstype bezier\nf 1 2 3\n",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; i++) {
        struct imported imported = import_text("m.obj", texts[i]);
        expect_parts(&imported, 1);
        assert_int_equal(mesh_of(&imported, 0)->triangle_count, 1);
        expect_vector(corner(&imported, 0, 0, 0), 0, 0, 0);
        expect_vector(corner(&imported, 0, 0, 1), 1, 0, 0);
        expect_vector(corner(&imported, 0, 0, 2), 0, 1, 0);
        release_imported(&imported);
    }
}

static void errors_name_the_line(void **state)
{
    static const struct {
        const char *text, *words;
    } cases[] = {
        {TRIANGLE "f 1 2 4\n", "m.obj:4: a face has vertex 4, and there are 3"},
        {TRIANGLE "f 1 2 -4\n", "m.obj:4: a face has vertex 0, and there are 3"},
        {TRIANGLE "f 0 1 2\n", "m.obj:4: a face needs numbers from 1 on"},
        {TRIANGLE "f 1 2 x\n", "m.obj:4: a face needs numbers from 1 on"},
        {TRIANGLE "f 1 2 3.5\n", "m.obj:4: a face needs numbers from 1 on"},
        {TRIANGLE "f 1/1 2/1 3/1\n", "m.obj:4: a face has texture coordinate 1, and there are 0"},
        {TRIANGLE "vn 0 0 1\nf 1//1 2//1 3//2\n", "m.obj:5: a face has normal 2, and there are 1"},
        {TRIANGLE "f 99999999999999999999 1 2\n", "m.obj:4: a face needs numbers"},
        {"v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m.obj:1: v needs three numbers"},
        {"v 0 0 0\nv 1 0 zero\nv 0 1 0\nf 1 2 3\n", "m.obj:2: a number is expected"},
        {TRIANGLE "vn 0 0\nf 1 2 3\n", "m.obj:4: vn needs three numbers"},
        {TRIANGLE "vt\nf 1 2 3\n", "m.obj:4: vt needs a number"},
        {"v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n\\\n9\n", "m.obj:7: a face has vertex 9"},
        {TRIANGLE "f 1 2\nl 1 2 3\n", "m.obj: the file has no triangles"},
        {"# nothing\n", "m.obj: the file has no triangles"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct imported imported = import_text("m.obj", cases[i].text);
        expect_failure(&imported, PS_ERROR_INVALID, cases[i].words);
    }
}

/* --- vertices
 * --------------------------------------------------------------------------------------- */

static size_t vertex_count(const char *text)
{
    struct imported imported = import_text("m.obj", text);
    expect_parts(&imported, 1);
    size_t count = mesh_of(&imported, 0)->vertex_count;
    release_imported(&imported);
    return count;
}

static void corners_that_agree_are_one_vertex(void **state)
{
#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
    (void)state;
    assert_int_equal(vertex_count(SQUARE "f 1 2 3\nf 1 3 4\n"), 4);
    assert_int_equal(vertex_count(SQUARE "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/1 3/1 4/1\n"), 4);
    assert_int_equal(vertex_count(SQUARE "vt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 1/2 3/1 4/1\n"), 5);
    assert_int_equal(
        vertex_count(SQUARE "vn 0 0 1\nvn 0 1 0\nf 1//1 2//1 3//1\nf 1//1 3//2 4//1\n"), 5);
    /* a normal that is none becomes that of the triangle */
    assert_int_equal(vertex_count(SQUARE "vn 0 0 0\nf 1//1 2//1 3//1\nf 1//1 3//1 4//1\n"), 6);
    assert_int_equal(vertex_count(SQUARE "s 1\nf 1 2 3\nf 1 3 4\n"), 4);
    assert_int_equal(vertex_count(SQUARE "s 1\nf 1 2 3\ns 2\nf 1 3 4\n"), 6);
    assert_int_equal(vertex_count(SQUARE "s 1\nf 1 2 3\ns 0\nf 1 3 4\n"), 6);
    assert_int_equal(vertex_count(SQUARE "v 5 5 5\nf 1 2 3\nf 1 3 4\n"), 4); /* in use */
}

static void parts_follow_sections_and_materials(void **state)
{
    (void)state;
    struct imported imported = import_text(
        "m.obj", SQUARE "f 1 2 3\nusemtl a\nf 1 2 3\nusemtl a\nf 1 2 4\no x\nf 1 2 3\ng y\ng x\n"
                        "f 2 3 4\nusemtl b\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\ng z\nusemtl a\n");
    expect_parts(&imported, 4); /* a name that comes back before a triangle begins no part */
    static const size_t triangles[] = {1, 2, 3, 1};
    static const char *const materials[] = {NULL, "a", "a", "b"};
    for (size_t i = 0; i < 4; i++) {
        size_t material = imported.fragment.objects[i].material;
        assert_int_equal(mesh_of(&imported, i)->triangle_count, triangles[i]);
        assert_int_equal(material == NO_INDEX, materials[i] == NULL);
        if (materials[i])
            assert_string_equal(imported.fragment.materials[material].name, materials[i]);
    }
    release_imported(&imported);
}

/* --- polygons
 * --------------------------------------------------------------------------------------- */

static double area_of(const struct imported *imported)
{
    double sum = 0;
    for (size_t i = 0; i < mesh_of(imported, 0)->triangle_count; i++) {
        ps_vec3 a = corner(imported, 0, i, 0);
        ps_vec3 across = ps_cross(ps_subtract(corner(imported, 0, i, 1), a),
                                  ps_subtract(corner(imported, 0, i, 2), a));
        assert_true(across.z > 0); /* all turn as the polygon does */
        sum += 0.5 * (double)across.z;
    }
    return sum;
}

static void polygons_are_cut_within_themselves(void **state)
{
    static const struct {
        const char *text;
        size_t triangles;
        double area;
    } cases[] = {
        {SQUARE "f 1 2 3 4\n", 2, 1},
        {"v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 1 2 3 4\n", 2, 1}, /* concave at 3 */
        {"v 0.5 0.5 0\nv 0 2 0\nv 0 0 0\nv 2 0 0\nf 1 2 3 4\n", 2, 1}, /* at 1 */
        {"v 0 2 0\nv 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nf 1 2 3 4\n", 2, 1}, /* at 4 */
        {"v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\nf 1 2 3 4 5 6 7 "
         "8\n",
         6, 7}, /* a U */
        {"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nf 1 2 3 4 5\n", 3,
         2}, /* a corner on an edge */
        {"v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 2 1 0\nv 2 2 0\nv 1 2 0\n"
         "f 1 2 3 4 1 5 8 7 6 5\n",
         8, 8}, /* with a hole */
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct imported imported = import_text("m.obj", cases[i].text);
        expect_parts(&imported, 1);
        assert_int_equal(mesh_of(&imported, 0)->triangle_count, cases[i].triangles);
        expect_near(area_of(&imported), cases[i].area, 1e-6);
        release_imported(&imported);
    }
}

/* From the first corner to the third, as the file's author sees it in other programs. */
static void convex_squares_keep_their_diagonal(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0.5\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 "
                             "1\nf 1/1 2/2 3/3 4/4\n");
    expect_parts(&imported, 1);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    expect_vector(corner(&imported, 0, 0, 2), 1, 1, 0.5);
    expect_vector(corner(&imported, 0, 1, 1), 1, 1, 0.5);
    expect_vector(corner(&imported, 0, 1, 2), 0, 1, 0);
    for (size_t i = 0; i < mesh->vertex_count;
         i++) { /* texture coordinates stay with their corners */
        expect_near((double)mesh->uv[i][0], (double)mesh->vertices[i].x, 1e-6);
        expect_near((double)mesh->uv[i][1], (double)mesh->vertices[i].y, 1e-6);
    }
    release_imported(&imported);
}

static void cut_polygons_keep_what_their_corners_have(void **state)
{
    (void)state;
    struct imported imported = import_text(
        "m.obj",
        "v 0 0 0\nv 3 0 0\nv 3 3 0\nv 2 1 0\nv 0 3 0\nvt 0 0\nvt 3 0\nvt 3 3\nvt 2 1\nvt 0 3\n"
        "vn 0 0 1\nvn 3 0 1\nvn 3 3 1\nvn 2 1 1\nvn 0 3 1\nf 1/1/1 2/2/2 3/3/3 4/4/4 5/5/5\n");
    expect_parts(&imported, 1);
    const struct mesh_description *mesh = mesh_of(&imported, 0);
    assert_int_equal(mesh->triangle_count, 3);
    assert_int_equal(mesh->vertex_count, 5);
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        ps_vec3 at = mesh->vertices[i];
        expect_near((double)mesh->uv[i][0], (double)at.x, 1e-6);
        expect_near((double)mesh->uv[i][1], (double)at.y, 1e-6);
        expect_vector(mesh->normals[i], (double)at.x, (double)at.y, 1);
    }
    release_imported(&imported);
}

static void crossing_polygons_lose_what_has_no_area(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.obj", SQUARE "f 1 2 3 4\nf 1 3 2 4\nf 1 2 1 2\nf 1 1 1 1 1\n");
    expect_success(&imported);
    for (size_t i = 0; i < mesh_of(&imported, 0)->triangle_count; i++)
        assert_true(fabs((double)front_of(&imported, 0, i).z) > 0.99);
    release_imported(&imported);
}

/* --- colours
 * ---------------------------------------------------------------------------------------- */

static void colors_must_be_of_all(void **state)
{
    (void)state;
    struct imported imported =
        import_text("m.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
    expect_parts(&imported, 1);
    assert_non_null(mesh_of(&imported, 0)->colors);
    expect_near((double)mesh_of(&imported, 0)->colors[1][1], 1, 1e-6);
    release_imported(&imported);
    for (int first = 0; first < 2; first++) { /* the first has none, or the last */
        imported = import_text("m.obj", first ? "v 0 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n"
                                              : "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n");
        expect_parts(&imported, 1);
        assert_null(mesh_of(&imported, 0)->colors);
        assert_non_null(strstr(imported.report.notes, "some vertices have colours"));
        release_imported(&imported);
    }
}

/* --- more than one piece
 * ----------------------------------------------------------------------------- */

#define SIDE 400 /* squares along a side: some 5 MiB of text */

/* Rows of squares, each row a part and its vertices just before it; indices count back in every
 * second row. */
static char *write_grid(bool wrong)
{
    size_t size = (size_t)(SIDE + 1) * (SIDE + 1) * 100, length = 0;
    char *text = malloc(size);
    assert_non_null(text);
    for (int y = 0; y <= SIDE; y++) {
        for (int x = 0; x <= SIDE; x++)
            length +=
                (size_t)snprintf(text + length, size - length, "v %.6f %.6f 0\n", x / 8.0, y / 8.0);
        if (y > 0)
            length += (size_t)snprintf(text + length, size - length, "usemtl row%d\n", y % 7);
        for (int x = 0; x < SIDE && y > 0; x++) {
            int before = (y - 1) * (SIDE + 1) + x + 1, above = before + SIDE + 1;
            int shift = y % 2 ? 0 : -(y + 1) * (SIDE + 1) - 1;
            length +=
                (size_t)snprintf(text + length, size - length, "f %d %d %d %d\n", before + shift,
                                 before + 1 + shift, above + 1 + shift, above + shift);
        }
    }
    if (wrong)
        length += (size_t)snprintf(text + length, size - length, "f 1 2 3 999999999\n");
    assert_true(length > 4u << 20 && length < size);
    return text;
}

static void pieces_fit_together(void **state)
{
    (void)state;
    char *text = write_grid(false);
    struct imported imported = import_text("m.obj", text);
    expect_parts(&imported, SIDE);
    for (size_t row = 0; row < SIDE; row++) {
        const struct mesh_description *mesh = mesh_of(&imported, row);
        char name[16];
        snprintf(name, sizeof name, "row%zu", (row + 1) % 7);
        assert_string_equal(
            imported.fragment.materials[imported.fragment.objects[row].material].name, name);
        assert_int_equal(mesh->triangle_count, 2 * SIDE);
        assert_int_equal(mesh->vertex_count, 2 * (SIDE + 1));
        for (size_t x = 0; x < SIDE; x++) {
            expect_vector(corner(&imported, row, 2 * x, 0), (double)x / 8, (double)row / 8, 0);
            expect_vector(corner(&imported, row, 2 * x, 2), (double)(x + 1) / 8,
                          (double)(row + 1) / 8, 0);
            expect_vector(corner(&imported, row, 2 * x + 1, 2), (double)x / 8,
                          (double)(row + 1) / 8, 0);
        }
    }
    release_imported(&imported);
    free(text);
}

static void errors_of_late_pieces_name_their_line(void **state)
{
    (void)state;
    char *text = write_grid(true), words[100];
    snprintf(words, sizeof words, "m.obj:%d: a face has vertex 999999999, and there are %d",
             (SIDE + 1) * (SIDE + 1) + SIDE * (SIDE + 1) + 1, (SIDE + 1) * (SIDE + 1));
    struct imported imported = import_text("m.obj", text);
    expect_failure(&imported, PS_ERROR_INVALID, words);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_ways_of_writing_are_read),
        cmocka_unit_test(errors_name_the_line),
        cmocka_unit_test(corners_that_agree_are_one_vertex),
        cmocka_unit_test(parts_follow_sections_and_materials),
        cmocka_unit_test(polygons_are_cut_within_themselves),
        cmocka_unit_test(convex_squares_keep_their_diagonal),
        cmocka_unit_test(cut_polygons_keep_what_their_corners_have),
        cmocka_unit_test(crossing_polygons_lose_what_has_no_area),
        cmocka_unit_test(colors_must_be_of_all),
        cmocka_unit_test(pieces_fit_together),
        cmocka_unit_test(errors_of_late_pieces_name_their_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
