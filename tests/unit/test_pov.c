/* test_pov.c: the language of POV-Ray scenes, and what becomes of their objects. */
#include "pov/polygons.h"
#include "pov/pov.h"
#include "pov/tokens.h"
#include "writer/mesh.h"

#include "unit/scratch.h"
#include <math.h>

/* --- tokens
 * --------------------------------------------------------------------------------------- */

static void test_cuts_tokens(void **state)
{
    (void)state;
    static const char text[] =
        "/* a /* nested */ */ Foo 1.5e1 .5 5. // x\n#declare \"a\\\"b\" <= \xe4 ";
    struct pov_words words = {0};
    struct pov_tokens tokens = {0};
    struct arena arena = {0};
    assert_true(pov_words_start(&words));
    assert_true(pov_tokens_cut(&tokens, "t.pov", text, strlen(text), 100, &words, &arena));
    pov_tokens_release(&tokens);
    assert_false(pov_tokens_cut(&tokens, "t.pov", text, strlen(text), 8, &words, &arena));
    assert_int_equal(tokens.count, 8);
    pov_tokens_release(&tokens);
    assert_true(pov_tokens_cut(&tokens, "t.pov", text, strlen(text), 9, &words, &arena));
    const struct pov_token *t = tokens.list;
    static const int kinds[] = {POV_WORD,   POV_NUMBER, POV_NUMBER, POV_NUMBER, POV_DIRECTIVE,
                                POV_STRING, POV_SYMBOL, POV_BAD,    POV_END};
    assert_int_equal(tokens.count, sizeof kinds / sizeof kinds[0]);
    for (size_t i = 0; i < tokens.count; i++)
        assert_int_equal(t[i].kind, kinds[i]);
    assert_true(t[0].word >= POV_WORD_COUNT && strcmp(words.texts[t[0].word], "Foo") == 0);
    assert_true(t[1].number == 15.0 && t[2].number == 0.5 && t[3].number == 5.0);
    assert_int_equal(t[4].word, POV_declare);
    assert_int_equal(t[4].line, 2);
    assert_string_equal(t[5].text, "a\"b");
    assert_int_equal(t[6].symbol, POV_LESS_EQUAL);
    pov_tokens_release(&tokens);
    pov_words_release(&words);
    arena_release(&arena);
}

/* --- scenes
 * --------------------------------------------------------------------------------------- */

/* The .psd of a text, to be freed; NULL: it has an error, of which `message` says the first. */
static char *convert(const char *text, char message[512])
{
    const struct pov_options options = {.folder = "/no/such/folder",
                                        .base = "t",
                                        .scene_folder = "",
                                        .from_output = "",
                                        .most_steps = 100000,
                                        .most_memory = (size_t)1 << 24};
    struct diagnostics *sink = diagnostics_create();
    struct written_scene scene;
    char *result = NULL;
    assert_non_null(sink);
    message[0] = '\0';
    ps_result code = pov_convert("t.pov", text, strlen(text), &options, sink, &scene);
    assert_int_equal(code == PS_OK, scene.text != NULL);
    assert_int_equal(code == PS_OK, diagnostics_error_count(sink) == 0);
    if (scene.text)
        result = strdup(scene.text);
    FILE *out = fmemopen(message, 511, "w");
    diagnostics_print(sink, out);
    fclose(out);
    written_scene_release(&scene);
    diagnostics_destroy(sink);
    return result;
}

static void expect(const char *text, const char *part)
{
    char message[512] = "";
    char *scene = convert(text, message);
    if (!scene || !strstr(scene, part))
        fail_msg("'%s' became\n%s\n%s\nwithout '%s'", text, scene ? scene : "", message, part);
    free(scene);
}

static void expect_error(const char *text, const char *part)
{
    char message[512] = "";
    char *scene = convert(text, message);
    if (scene || !strstr(message, part))
        fail_msg("'%s' became\n%s\n%s\nwithout '%s'", text, scene ? scene : "", message, part);
    free(scene);
}

/* The scene can be made, with a warning, and does not hold the other part. */
static void expect_warning(const char *text, const char *part, const char *absent)
{
    char message[512] = "";
    char *scene = convert(text, message);
    if (!scene || !strstr(message, part) || strstr(scene, absent))
        fail_msg("'%s' became\n%s\n%s\nwithout '%s', or with '%s'", text, scene ? scene : "",
                 message, part, absent);
    free(scene);
}

/* That the expression is that number, by the radius of a sphere. */
static void expect_number(const char *expression, const char *number)
{
    char text[512], part[64];
    snprintf(text, sizeof text, "#declare V = %s; sphere { 0, V }", expression);
    snprintf(part, sizeof part, "radius: %s,", number);
    expect(text, part);
}

static void expect_vector(const char *expression, const char *vector)
{
    char text[512], part[64];
    snprintf(text, sizeof text, "#declare V = %s; sphere { V, 1 }", expression);
    snprintf(part, sizeof part, "center: %s,", vector);
    expect(text, part);
}

static void test_computes_numbers(void **state)
{
    (void)state;
    expect_number("1 + 2*3 - 8/4", "5");
    expect_number("-(2 - 5)*2", "6");
    expect_number("pow(2, 3) + mod(7, 4) + int(1.7)", "12");
    expect_number("degrees(pi)/10 + sin(0) + atan2(0, 1)", "18");
    expect_number("min(3, 2, 4) + max(1, 5)", "7");
    expect_number("(1 < 2 & 3 >= 3 ? 4 : 5)", "4");
    expect_number("(1 = 2 | 1 != 1 ? 4 : 5)", "5");
    expect_number("vlength(<3, 4, 0>) + vdot(x + y, <1, 2, 3>)", "8");
    expect_number("<5, 6, 7>.y + (rgb <0.5, 1, 2>).blue", "8");
    expect_number("strlen(concat(\"ab\", str(1.25, 0, 1), chr(65))) + val(\"2.5\")", "8.5");
    expect_number("(strcmp(\"a\", \"a\") = 0) + asc(\"A\")", "66");
    expect_number("select(-1, 2, 3) + select(1, 2, 3, 4)", "6");
    expect_vector("<1, 2, 3>*2 + 1", "[3, 5, -7]");
    expect_vector("<1 2 3>", "[1, 2, -3]");
    expect_vector("vcross(x, y) + vnormalize(2*x)", "[1, 0, -1]");
    expect_vector("vrotate(x, z*90) + vaxis_rotate(x, y, 90)", "[0, 1, 1]");
    expect_number("1e-3*1000", "1");
    expect_error("sphere { 0, 1/0 }", "division by zero");
    expect_error("sphere { 0, sqrt(-1) }", "sqrt");
    expect_error("sphere { 0, Foo }", "'Foo', which is not declared");
}

/* The numbers are those of POV-Ray 3.7's own rand(seed(3)). */
static void test_draws_the_numbers_of_povray(void **state)
{
    (void)state;
    expect("#declare R = seed(3); sphere { <rand(R), rand(R), rand(R)>, 1 }",
           "center: [0.26597288, 0.5282362, -0.4995482]");
}

static void test_executes_directives(void **state)
{
    (void)state;
    expect_number("0 #declare V = 1; #while (V < 8) #declare V = V*2; #end", "8");
    expect("#declare S = 0; #for (I, 1, 4) #declare S = S + I; #end sphere { 0, S }",
           "radius: 10,");
    expect("#declare S = 0; #for (I, 4, 1, -2) #declare S = S + I; #end sphere { 0, S }",
           "radius: 6,");
    expect("#if (0) #if (1) x #else y #end #elseif (1) sphere { 0, 3 } #else z #end", "radius: 3,");
    expect("#switch (3) #case (1) a #break #range (2, 4) sphere { 0, 4 } #break #else b #end",
           "radius: 4,");
    expect("#ifdef (A) a #else #ifndef (B) sphere { 0, 5 } #end #end", "radius: 5,");
    expect("#declare I = 0; #while (1) #declare I = I + 1; #if (I > 6) #break #end #end sphere { "
           "0, I }",
           "radius: 7,");
    expect("#declare A = array[2][3] {{1, 2, 3}, {4, 5, 6}} #declare A[0][1] = 9;"
           "sphere { <A[1][2], A[0][1], dimension_size(A, 2)>, 1 }",
           "center: [6, 9, -3]");
    expect("#declare A = array[2] { <1, 2> <3, 4> } sphere { A[1], 1 }", "center: [3, 4, 0]");
    expect("#declare A = array[1] { \"abc\" } #declare B = A; #declare L = strlen(B[0]); sphere { "
           "0, L }",
           "radius: 3,");
    expect("#declare A = 1 #declare B = A + 1 sphere { 0, B }", "radius: 2,");
    expect("#declare U = union { #declare R = 2; sphere { 0, R } #if (R > 1) sphere { x, 3 } #end "
           "} object { U }",
           "radius: 3,");
    expect(
        "#declare A = array[2] #declare A[1] = \"ab\"; #declare L = strlen(A[1]); sphere { 0, L }",
        "radius: 2,");
    expect("#macro Str(A) A #end #macro M(Str) sphere { 0, Str } #end M(3)", "radius: 3,");
    expect("#declare A = 1; #undef A #ifndef (A) sphere { 0, 2 } #end", "radius: 2,");
    expect("#version 3.5; sphere { 0, version }", "radius: 3.5,");
    expect("#version 3.5 #declare V = version; sphere { 0, V }", "radius: 3.5,");
    expect("#version 3.5 #if (version = 3.5) sphere { 0, 2 } #end", "radius: 2,");
    /* A macro in the value makes the name another thing than the array whose element is assigned or
     * asked for. */
    static const char other[] = "#declare A = array[2]; #macro M() #declare A = 5; 1 #end ";
    char text[256];
    snprintf(text, sizeof text, "%s#declare A[0] = M(); sphere { 0, A }", other);
    expect(text, "radius: 5,");
    snprintf(text, sizeof text, "%s sphere { 0, dimension_size(A, M()) }", other);
    expect(text, "radius: 2,");
    expect_error("#if (1) sphere { 0, 1 }",
                 "t.pov:1:1: error: the file ends before the #end of this");
    expect_error("#end", "#end without");
    expect_error("#foo", "no directive #foo");
    expect_error("#error \"why\"", "#error: why");
    expect_error("#fopen F \"x\" write", "can't read and write files");
}

static void test_calls_macros(void **state)
{
    (void)state;
    expect("#macro Ball(P, R) sphere { P, R } #end Ball(<1, 2, 3>, 0.5)",
           "[1, 2, -3], radius: 0.5,");
    expect("#macro Twice(A) A*2 #end sphere { 0, Twice(3) + Twice(Twice(1)) }", "radius: 10,");
    expect("#macro Fac(N) #if (N < 2) 1 #else N*Fac(N - 1) #end #end sphere { 0, Fac(5) }",
           "radius: 120,");
    expect("#macro Set(A, B) #declare A = B; #end #declare V = 1; Set(V, 7) sphere { 0, V }",
           "radius: 7,");
    expect("#macro L() #local A = 3; A #end #declare A = 1; #declare B = L(); sphere { 0, A + B }",
           "radius: 4,");
    expect("#declare F = function(a, b) { a*b + 1 } sphere { 0, F(2, 3) }", "radius: 7,");
    expect("#declare F = function { x + y*10 } sphere { 0, F(2, 3, 0) }", "radius: 32,");
    expect_error("#macro M(A) A #end sphere { 0, M() }", "expected a value");
    expect_error("#macro M() M() #end M()", "deep");
}

static void test_ends_what_does_not_end(void **state)
{
    (void)state;
    expect_error("#while (1) #end", "does a loop not end?");
    expect_error("#for (I, 0, 1e9) #end", "does a loop not end?");
    expect_error("#declare A = array[1000][1000][1000]", "16 MiB, the most that is allowed");
    expect_error("#declare A = array[1e10]", "at most 1e9 elements");
    expect_error("#declare S = \"ab\"; #while (1) #declare S = concat(S, S); #end", "longer than");
    expect_error("#declare U = sphere { 0, 1 } #for (I, 1, 40) #declare U = union { object { U } "
                 "object { U } }"
                 "#end object { U }",
                 "more than 1000000 objects");
    expect_error(
        "#declare U = sphere { 0, 1 } #for (I, 1, 400) #declare U = union { object { U } } #end"
        " object { U }",
        "deep");
    char text[2048] = "sphere { 0, ";
    memset(text + strlen(text), '(', 1000);
    expect_error(text, "more than 150 deep");
    static char tokens[750000]; /* of 24 bytes each, though they cost few steps */
    memset(tokens, '(', sizeof tokens - 1);
    expect_error(tokens, "16 MiB, the most that is allowed");
    expect_error("union {", "the file ends");
    expect_error("/* a", "a comment that does not end");
    expect_error("sphere { 0, 1 pigment { image_map { png \"a", "a text that does not end");
}

/* --- objects
 * -------------------------------------------------------------------------------------- */

static void test_places_objects(void **state)
{
    (void)state;
    expect("sphere { 0, 1 translate <1, 2, 3> }", "matrix: [1, 0, 0, 1, 0, 1, 0, 2, 0, 0, -1, -3]");
    expect("sphere { 0, 1 scale <2, 3, 4> rotate z*90 }",
           "matrix: [0, -3, 0, 0, 2, 0, 0, 0, 0, 0, -4, 0]");
    expect("box { <0, 1, 2>, <3, 4, 5> }", "box: {corners: [[0, 1, -2], [3, 4, -5]]");
    expect("plane { <0, 0, 2>, 3 }", "plane: {normal: [0, 0, -1], distance: 3,");
    expect("plane { y, 1 translate y scale 2 }", "plane: {normal: [0, 1, 0], distance: 4,");
    expect("cylinder { 0, y, 2 open }",
           "cylinder: {from: [0, 0, 0], to: [0, 1, 0], radius: 2, open: yes");
    expect("cone { 0, 1, y, 0 }",
           "cone: {from: [0, 0, 0], from_radius: 1, to: [0, 1, 0], to_radius: 0");
    expect("torus { 2, 0.5 }", "torus: {radius: 2, minor_radius: 0.5");
    expect("disc { 0, z, 2, 1 }",
           "disc: {center: [0, 0, 0], normal: [0, 0, -1], radius: 2, hole: 1");
    expect("triangle { 0, x, y }", "triangles: {vertices: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]");
    expect("smooth_triangle { 0, z, x, z, y, z }", "normals: [[0, 0, 1]");
    expect("mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 2> } }",
           "triangles: [[0, 1, 2]]");
    expect("mesh { triangle { 0, x, y uv_vectors <0, 0>, <1, 0>, <0, 1> } }",
           "uv: [[0, 0], [1, 0], [0, 1]]");
    expect("polygon { 5, 0, x, x + y, y, 0 }", "triangles: [[0, 1, 2], [3, 4, 5]]");
    expect("lathe { linear_spline 2, <1, 0>, <1, 1> }", "{file: \"t-mesh-0.ply\"");
    expect("prism { 0, 1, 4, <0, 0>, <1, 0>, <0, 1>, <0, 0> }", "triangles: {vertices");
    expect("sor { 4, <1, -1>, <1, 0>, <1, 1>, <1, 2> }", "mesh-0.ply");
    expect("superellipsoid { <1, 1> }", "mesh-0.ply");
    expect("union { sphere { 0, 1 } translate x pigment { rgb 1 } }", "diffuse: 0.6");
    expect("#declare S = sphere { 0, 1 } object { S translate x }", "matrix: [1, 0, 0, 1,");
    expect("union { sphere { 0, 1 pigment { rgb <1, 0, 0> } } pigment { rgb 1 } }",
           "diffuse: [0.6, 0, 0]");
    expect("blob { threshold 1 sphere { 0, 1, 1 } } sphere { 0, 2 }", "radius: 2");
    expect_error("mesh2 { vertex_vectors { 3, 0, x, y } face_indices { 1, <0, 1, 3> } }",
                 "outside");
    expect_error("sphere { 0, 1 foo }", "expected a transform, texture or other modifier");
}

/* Vertices of the first mesh file. */
static const float *vertices_of(const struct written_scene *scene, size_t *count)
{
    const char *bytes = scene->files[0].bytes, *line = strstr(bytes, "element vertex ");
    const char *start = strstr(bytes, "end_header\n");
    assert_true(line && start && line < start);
    *count = strtoul(line + strlen("element vertex "), NULL, 10);
    return (const void *)(start + strlen("end_header\n"));
}

/* A superellipsoid, however near to a box or a star, is closed at the six points on the axes. */
static void expect_axes(const char *text)
{
    const struct pov_options options = {.folder = "/no/such/folder",
                                        .base = "t",
                                        .scene_folder = "",
                                        .from_output = "",
                                        .most_steps = 100000,
                                        .most_memory = (size_t)1 << 24};
    struct diagnostics *sink = diagnostics_create();
    struct written_scene scene;
    size_t count, found = 0;
    assert_int_equal(pov_convert("t.pov", text, strlen(text), &options, sink, &scene), PS_OK);
    const float *vertices = vertices_of(&scene, &count); /* x y z, nx ny nz, u v */
    for (int axis = 0; axis < 6; axis++) {
        double nearest = 1;
        for (size_t i = 0; i < count; i++) {
            double distance = 0;
            for (int k = 0; k < 3; k++) {
                float p;
                memcpy(&p, (const char *)(vertices + 8 * i + k), sizeof p);
                double wanted = k == axis / 2 ? (axis % 2 ? -1 : 1) : 0;
                distance = fmax(distance, fabs((double)p - wanted));
            }
            nearest = fmin(nearest, distance);
        }
        found += nearest < 1e-6;
    }
    if (found != 6)
        fail_msg("%s: %zu of 6", text, found);
    written_scene_release(&scene);
    diagnostics_destroy(sink);
}

static void test_superellipsoids_are_closed(void **state)
{
    (void)state;
    expect_axes("superellipsoid { <0.1, 0.1> }");
    expect_axes("superellipsoid { <0.3, 2> }");
    expect_axes("superellipsoid { <1, 1> }");
}

static void test_mirrors_unless_the_camera_does(void **state)
{
    (void)state;
    expect("camera { location -5*z look_at 0 } sphere { z, 1 }", "center: [0, 0, -1]");
    expect("camera { location -5*z right -4/3*x look_at 0 } sphere { z, 1 }", "center: [0, 0, 1]");
    expect("camera { location -5*z look_at 0 angle 40 right 2*x }", "angle: 40}");
    expect("camera { location -5*z look_at 0 angle 40 right 2*x }", "{width: 800, height: 400}");
    expect("camera { orthographic location -5*z look_at 0 right 3*x up 2*y }",
           "projection: orthographic, width: 3}");
    expect("camera { location <1, 2, -3> look_at <1, 2, 0> aperture 0.4 focal_point 0 }",
           "aperture: 0.2, focus: 3}");
    expect_error("camera { up 0 }", "of some length");
}

static void test_carries_lights(void **state)
{
    (void)state;
    expect("light_source { <1, 2, 3> rgb <1, 0.5, 0> fade_distance 2 fade_power 2 }",
           "point: {location: [1, 2, -3], intensity: [25.132742, 12.566371, 0]}");
    expect("light_source { 2*y 1 fade_distance 1 fade_power 2 spotlight radius 10 falloff 20 "
           "tightness 3 }",
           "point_at: [0, 0, 0], radius: 10, falloff: 20, tightness: 3, intensity:");
    expect("#declare L = light_source { y 1 fade_distance 1 fade_power 2 } light_source { L "
           "translate x }",
           "point: {location: [1, 1, 0]");
    expect("light_source { y 1 parallel point_at 0 }",
           "sun: {direction: [0, -1, 0], angle: 0, irradiance: 3.1415927}");
    expect("light_source { y 1 fade_distance 1 fade_power 2 area_light x, z, 4, 4 }",
           "sphere: {location");
    expect("camera { location -4*z look_at 0 } light_source { 2*y 1 }", "intensity: 12.566371");
    expect("background { rgb <0, 0, 1> }", "sky: {radiance: [0, 0, 1]}");
    expect("sky_sphere { pigment { gradient y color_map { [0 rgb 1] [1 rgb 0] } } }",
           "sky: {file: \"t-sky-0.exr\"}");
}

static void test_carries_textures(void **state)
{
    (void)state;
    static const char *const looks[][2] = {
        {"pigment { rgb 0.5 } finish { diffuse 1 }", "diffuse: 0.5}"},
        {"pigment { checker rgb 1, rgb 0 scale 2 } finish { diffuse 0.5 }",
         "checker: {colors: [0.5, 0], matrix: [2, 0, 0, 0, 0, 2, 0, 0, 0, 0, -2, 0]}"},
        {"pigment { gradient x color_map { [0 rgb 1] [1 rgb 0] } }",
         "gradient: {colors: [0.6, 0], axis: [1, 0, 0]"},
        /* More colours: the nearest two, of the same mean. */
        {"pigment { gradient y color_map { [0 rgb 1] [0.5 rgb 0] [1 rgb 1] } }",
         "gradient: {colors: [0.3, 0.3], axis"},
        {"pigment { gradient y color_map { [0 rgb 0] [0.5 rgb 0.5] [1 rgb 1] } }",
         "gradient: {colors: [0, 0.6], axis"},
        {"pigment { bozo color_map { [0 rgb 1] [1 rgb 0] } }",
         "noise: {colors: [0.45, 0.15], octaves: 1"},
        {"pigment { brick rgb 1, rgb 0 }", "diffuse: 0.12}"},
        {"pigment { rgb 1 } finish { emission 2 }", "emission: 2, emission_both: yes"},
        {"pigment { rgb 1 } finish { ambient 1 diffuse 0 }", "emission: 1"},
        {"pigment { rgb 1 } finish { phong 1 }",
         "glossy: {diffuse: 0.6, specular: 0.04, roughness:"},
        {"pigment { rgb 0 } finish { reflection 0.9 }", "mirror: 0.9}"},
        {"pigment { rgb 0.5 } finish { reflection 0.25 }",
         "mix: [{material: \"under-mirror\", weight: 0.74"},
        {"pigment { rgb 1 } finish { metallic specular 1 diffuse 0.2 }",
         "metal: {color: 1, roughness:"},
        {"pigment { rgbt 1 } interior { ior 1.5 }", "dielectric: {ior: 1.5, color: 1}"},
        {"pigment { rgbf <1, 0.5, 0, 1> }", "dielectric: {ior: 1, color: [1, 0.5, 0]}"},
        {"pigment { rgb 1 transmit 0.5 }", "mix: [{material: \"opaque\", weight: 0.49"},
        {"texture { pigment { rgb 0 } } texture { pigment { rgbt <1, 1, 1, 0.5> } }",
         "diffuse: 0.3}"},
    };
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        char text[512];
        snprintf(text, sizeof text, "sphere { 0, 1 %s }", looks[i][0]);
        expect(text, looks[i][1]);
        snprintf(text, sizeof text, "#declare S = sphere { 0, 1 } union { object { S } %s }",
                 looks[i][0]);
        if (i + 1 < sizeof looks / sizeof looks[0])
            expect(text, looks[i][1]);
    }
    expect("global_settings { assumed_gamma 2 } sphere { 0, 1 pigment { rgb 0.5 } finish { diffuse "
           "1 } }",
           "diffuse: 0.25}");
    expect("#default { finish { diffuse 1 } pigment { rgb 0.5 } } sphere { 0, 1 }",
           "diffuse: 0.5}");
    expect("sphere { 0, 1 pigment { srgb 1 } finish { diffuse 1 } }", "diffuse: 1}");
    expect("sphere { 0, 1 pigment { srgb 0.5 } finish { diffuse 1 } }", "diffuse: 0.21404");
    expect("global_settings { assumed_gamma 2.2 } sphere { 0, 1 pigment { srgb 0.5 } finish { "
           "diffuse 1 } }",
           "diffuse: 0.21404");
}

/* Ways to write that are rare, but POV-Ray's. */
static void test_reads_rare_forms(void **state)
{
    (void)state;
    static const char *const looks[][2] = {
        {"tiles { pigment { rgb 1 } tile2 pigment { rgb 0 } }", "diffuse: 0.3}"},
        {"object { box { 0, 1 } rgb 1, rgb 0 }", "diffuse: 0.3}"},
        {"object { Ball pigment { rgb 0 } pigment { rgb 1 } }", "diffuse: 0.3}"},
        {"slope { <0, 1, 0>, 0, 1 altitude <0, 1, 0>, 0, 2 }", "diffuse: 0.3}"},
        {"slope <0, 1, 0>, 0, 1 altitude <0, 1, 0>, 0, 2", "diffuse: 0.3}"},
        {"mandel 10 exterior 1, 2 interior 0, 1", "diffuse: 0.3}"},
        {"density_file df3 \"a.df3\" interpolate 1", "diffuse: 0.3}"},
        {"image_pattern { png \"a.png\" }", "diffuse: 0.3}"},
        {"checker Colors[0], Colors[1]", "colors: [0.6, 0]"},
        {"Pigments[0]", "diffuse: 0.6}"},
    };
    static const char start[] = "#declare Ball = sphere { 0, 1 } "
                                "#declare Colors = array[2] { rgb 1, rgb 0 } "
                                "#declare Pigments = array[1] { pigment { rgb 1 } } "
                                "#declare M = array[1] { material { texture { Pigments[0] } } }";
    char text[1024];
    for (size_t i = 0; i < sizeof looks / sizeof looks[0]; i++) {
        snprintf(text, sizeof text, "%s sphere { 0, 1 pigment { %s } }", start, looks[i][0]);
        expect(text, looks[i][1]);
    }
    snprintf(text, sizeof text, "%s sphere { 0, 1 material { M[0] } }", start);
    expect(text, "diffuse: 0.6}");
    expect("#declare S = \"a\"; #if (S != \"\" & S < \"b\") sphere { 0, 2 } #end", "radius: 2,");
    expect_error("#if (\"a\" + 1) #end", "a comparison of texts");
    expect("#declare S = sky_sphere { pigment { rgb <0, 0, 1> } } sky_sphere { S }",
           "sky: {radiance: [0, 0, 1]}");
    expect_warning("sphere { 0, 1 }\nbackground { rgb 1 }", "t.pov:2:1: warning: background",
                   "box");
}

/* --- solids
 * --------------------------------------------------------------------------------------- */

/* Of the triangles of a cube, with sides from -1 to 1, cut by x < 0. */
static void test_cuts_polygons(void **state)
{
    (void)state;
    const struct csg_vertex square[] = {{{-1, -1, 0}, {0, 0, 0}},
                                        {{1, -1, 0}, {0, 0, 0}},
                                        {{1, 1, 0}, {0, 0, 0}},
                                        {{-1, 1, 0}, {0, 0, 0}}};
    struct csg_plane planes[] = {{{1, 0, 0}, 0}, {{0, 1, 0}, 0.5}};
    const struct csg_convex convex = {planes, 2, {0, 0, 0}, INFINITY};
    struct csg_polygons all = {0}, inside = {0}, outside = {0};
    struct csg_budget budget = {.steps = 1000};
    assert_true(csg_polygons_add(&all, square, 4));
    assert_true(csg_cut(&all, &convex, 1e-9, &inside, &outside, &budget));
    double areas[2] = {0, 0};
    const struct csg_polygons *parts[] = {&inside, &outside};
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < parts[k]->count; i++) {
            const struct csg_vertex *v = parts[k]->vertices + parts[k]->list[i].start;
            for (size_t j = 1; j + 1 < parts[k]->list[i].count; j++)
                areas[k] += 0.5 * vector_cross(vector_subtract(v[j].point, v[0].point),
                                               vector_subtract(v[j + 1].point, v[0].point))
                                      .z;
        }
    assert_float_equal(areas[0], 1.5, 1e-9);
    assert_float_equal(areas[1], 2.5, 1e-9);
    csg_polygons_release(&all);
    csg_polygons_release(&inside);
    csg_polygons_release(&outside);
}

static void test_makes_solids(void **state)
{
    (void)state;
    expect("intersection { box { -1, 1 } plane { x, 0 } }", "triangles: {vertices: ");
    expect("difference { box { -1, 1 } box { 0, 2 } }", "triangles: {vertices: ");
    expect("difference { sphere { 0, 1 } torus { 2, 0.1 } }", "mesh: {file: ");
    /* Half a torus has no faces where it was cut; a plane with a groove has its own. */
    expect_warning("intersection { torus { 2, 0.5 } plane { y, 0 } }",
                   "the face by which plane ends a part that is not convex", "vertices");
    expect("difference { plane { y, 0 } torus { 2, 0.5 } }", "vertices");
    expect("intersection { plane { y, 0 } plane { x, 0 } sphere { 0, 1 } }", "vertices");
    expect_warning("union { intersection { sphere { 0, 1 } quadric { <1, 1, 1>, 0, 0, -1 } } }",
                   "quadric has no counterpart", "quadric");
    /* What a part that is left out would bound must not become sheets of planes. */
    expect_warning(
        "intersection { quadric { <1, 0, 1>, 0, 0, -1 } plane { y, 1 } plane { -y, 1 } }",
        "quadric has no counterpart", "vertices");
    expect("difference { plane { y, 1 } quadric { <1, 0, 1>, 0, 0, -1 } }", "vertices");
    expect_warning("light_source { 0, 1 looks_like { sphere { 0, 1 } } }", "looks_like",
                   "sphere: ");
    expect("sphere { 0, 1 clipped_by { plane { y, 0 } } }", "mesh: {file: ");
    char message[512];
    char *scene =
        convert("intersection { box { -1, 1 } box { 0, 2 } clipped_by { plane { y, 0.5 } } "
                "} global_settings { assumed_gamma 1 }",
                message);
    assert_non_null(scene);
    assert_non_null(strstr(scene, "0.5, 0]"));
    assert_string_equal(message, "");
    free(scene);
    expect_warning("union { box { 0, 1 } clipped_by { plane { y, 0 } } }",
                   "1:1: warning: clipped_by", "mesh");
    scene = convert("intersection { box { 0, 1 } box { 2, 3 } }", message);
    assert_non_null(scene);
    assert_null(strstr(scene, "objects:"));
    free(scene);
}

/* Copies of a solid are instances of its meshes, each with its own place and look. */
static void test_shares_solids(void **state)
{
    (void)state;
    static const char copies[] =
        "#declare D = difference { box { -1, 1 } sphere { 0, 1.2 } }"
        "object { D } object { D translate 3*x pigment { rgb <1, 0, 0> } }"
        "union { object { D rotate z*90 } scale 2 pigment { checker rgb 1, rgb 0 } }";
    expect_warning(copies, "", "t-mesh-2");
    expect(copies, "instance: {of: \"mesh-2\", material: \"texture-2\", matrix: [1, 0, 0, 3,");
    expect(copies, "matrix: [0, -2, 0, 0, 2, 0, 0, 0, 0, 0, -2, 0]}");
    /* The pattern moves with the instance: here it lies as in the world, which is turned back. */
    expect(copies,
           "checker: {colors: [0.6, 0], matrix: [0, 0.5, 0, 0, -0.5, 0, 0, 0, 0, 0, 0.5, 0]}");
}

static void test_leaves_out_whole_solids(void **state)
{
    (void)state;
    expect_warning("difference { box { -1, 1 } sphere { 0, 1.2 } sphere { 0.1, 1.2 } "
                   "sphere { 0.2, 1.2 } sphere { 0.3, 1.2 } sphere { 0.4, 1.2 } }",
                   "1:1: warning: an intersection or difference is left out: its parts", "mesh");
    const struct csg_vertex corners[3] = {{{0, 0, 0}, {0, 0, 0}}};
    struct csg_budget budget = {.bytes = 2000};
    struct csg_polygons list = {.budget = &budget};
    for (int i = 0; i < 100; i++)
        csg_polygons_add(&list, corners, 3);
    assert_true(budget.spent && list.count < 20);
    csg_polygons_release(&list);
}

/* assimp takes a line end behind the header for a part of it. */
static void test_begins_no_ply_file_with_a_line_end(void **state)
{
    (void)state;
    const uint32_t words[] = {0x3f80000a, 0x3f80000d, 0x3f800001};
    struct mesh mesh;
    assert_true(mesh_allocate(&mesh, 3, false, false, 1));
    for (size_t i = 0; i < 3; i++) {
        float x;
        size_t size;
        memcpy(&x, &words[i], sizeof x);
        mesh.points[0].x = (double)x;
        char *bytes = mesh_to_ply(&mesh, &size);
        assert_non_null(bytes);
        const char *data = (const char *)memmem(bytes, size, "end_header\n", 11) + 11;
        assert_int_equal(*data, i == 2 ? 1 : (int)(words[i] & 0xff) + 1);
        free(bytes);
    }
    mesh_release(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cuts_tokens),
        cmocka_unit_test(test_computes_numbers),
        cmocka_unit_test(test_draws_the_numbers_of_povray),
        cmocka_unit_test(test_executes_directives),
        cmocka_unit_test(test_calls_macros),
        cmocka_unit_test(test_ends_what_does_not_end),
        cmocka_unit_test(test_places_objects),
        cmocka_unit_test(test_superellipsoids_are_closed),
        cmocka_unit_test(test_mirrors_unless_the_camera_does),
        cmocka_unit_test(test_carries_lights),
        cmocka_unit_test(test_carries_textures),
        cmocka_unit_test(test_reads_rare_forms),
        cmocka_unit_test(test_cuts_polygons),
        cmocka_unit_test(test_makes_solids),
        cmocka_unit_test(test_shares_solids),
        cmocka_unit_test(test_leaves_out_whole_solids),
        cmocka_unit_test(test_begins_no_ply_file_with_a_line_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
