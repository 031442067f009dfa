/* test_language.c: names, formulas, loops and conditions in scenes. */
#include "language_fixture.h"

#include "parser/language/arithmetic.h"
#include <math.h>

static const struct reading alone = {.files = NULL};

/* What follows HEAD is line 5 and on. */
#define SPHERE(center, radius) "{sphere: {center: " center ", radius: " radius ", material: white}}"

static struct scene_description expect_objects(const char *text, size_t count)
{
    struct scene_description d = expect_good(text, &alone);
    assert_int_equal(d.object_count, count);
    return d;
}

static void test_definitions(void **state)
{
    (void)state;
    struct scene_description d = expect_objects(
        HEAD "define:\n"
             "  n: 4\n"
             "  half_n: =n/2\n"
             "  at: [1, =half_n, 3]\n"
             "  name: white\n"
             "  base: {radius: =at.y + 0.5, material: =name}\n"
             "  all:\n"
             "    - sphere: {<<: =base, center: =at}\n"
             "    - sphere: {<<: [=base, {center: [=at.x, =at.g, =-at.b]}], radius: = n }\n"
             "objects: =all\n"
             "image: {width: =100*n}\n",
        2);
    assert_vector(d.objects[0].center, 1, 2, 3);
    assert_true(d.objects[0].radius == 2.5);
    assert_vector(d.objects[1].center, 1, 2, -3);
    assert_true(d.objects[1].radius == 4);
    assert_string_equal(d.materials[d.objects[1].material].name, "white");
    assert_int_equal(d.image.width, 400);
    assert_int_equal(d.objects[0].origin.line, 12);
    scene_description_release(&d);
}

static void test_bad_definitions(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "define: {height: 3}\nimage: {width: =100 * hieght}",
         "t:6:23: error: unknown name 'hieght' in arithmetic; did you mean 'height'?\n"},
        {HEAD "define: {a: =b, b: 3}",
         "t:5:14: error: 'b' is not defined yet; that follows in line 5\n"},
        {HEAD "define:\n  a: =a\n",
         "t:6:7: error: 'a' is not defined yet; that follows in line 6\n"},
        /* What follows from the first error is not reported. */
        {HEAD "define: {a: =1/0, b: =a+1, c: [=b, 1, 1]}\nimage: {width: =c.x, height: =a}",
         "t:5:15: error: division by zero\n"},
        {HEAD "define: {v: [1, 2, 3], s: text, m: {a: 1}, w: [1, x]}\n"
              "image: {width: =2*v, height: =v.w}\nrender: {passes: =1+s, seed: =m+1}",
         "t:6:19: error: 'v' is a list, which stands alone; in arithmetic use v.x, v.y and v.z\n"
         "t:6:33: error: expected x, y, z, r, g or b after the '.'\n"
         "t:7:21: error: 's' is text, which arithmetic can't use\n"
         "t:7:31: error: 'm' is a map, which arithmetic can't use\n"},
        {HEAD "define: {n: 1, w: [1, x]}\nimage: {width: =n.x, height: =w.y}\n"
              "render: {seed: =w.z}",
         "t:6:17: error: 'n' is a number and has no .x\n"
         "t:6:31: error: 'w' is a list whose .y is no number\n"
         "t:7:17: error: 'w' is a list whose .z is no number\n"},
        {HEAD "define: {2a: 1, sin: 2, pi: 3, a-b: 4, n: }",
         "t:5:10: error: a definition needs a name of letters, digits and '_' that begins with no "
         "digit, got 2a\n"
         "t:5:17: error: the name 'sin' is taken: arithmetic has a meaning for it\n"
         "t:5:25: error: the name 'pi' is taken: arithmetic has a meaning for it\n"
         "t:5:32: error: a definition needs a name of letters, digits and '_' that begins with no "
         "digit, got a-b\n"
         "t:5:40: error: 'n' is defined without a value\n"},
        {HEAD "define: {a: 1, a: 2}", "t:5:16: error: duplicate key 'a'; the first is on line 5\n"},
        {HEAD "define: [a]", "t:5:9: error: expected a map for define, got a list\n"},
        {HEAD "define: {a: [1]}\nobjects: [{sphere: {<<: =a}}]",
         "t:5:14: error: '<<' merges a map or a list of maps, not text\n"
         "t:6:12: error: missing key 'center' in sphere\n"
         "t:6:12: error: missing key 'radius' in sphere\n"
         "t:6:12: error: missing key 'material' in sphere\n"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect_bad(cases[i].text, &alone, cases[i].messages);
}

static void test_loops(void **state)
{
    (void)state;
    struct scene_description d = expect_objects(
        HEAD
        "objects:\n"
        "  - " SPHERE(
            "[9, 9, 9]",
            "9") "\n"
                 "  - for: i\n    from: 1\n    to: 3\n    do: " SPHERE(
                     "[=i, 0, 0]",
                     "=i/2") "\n"
                             "  - for: i\n    from: 0\n    to: 1\n    step: 0.5\n    do:\n"
                             "      - for: j\n        in: [5, 7]\n        do:\n"
                             "          - " SPHERE(
                                 "[=i, =j, 1]",
                                 "1") "\n"
                                      "          - " SPHERE(
                                          "[=i, =j, 2]",
                                          "1") "\n"
                                               "  - {for: i, from: 3, to: 1, step: -2, do: " SPHERE(
                                                   "[=i, 0, 0]",
                                                   "1") "}\n"
                                                        "  - {for: i, from: 3, to: 1, do: " SPHERE(
                                                            "[=i, 0, 0]",
                                                            "1") "}\n"
                                                                 "  - {for: i, in: [], do: " SPHERE(
                                                                     "[=i, 0, 0]", "1") "}\n",
        1 + 3 + 12 + 2);
    assert_vector(d.objects[0].center, 9, 9, 9);
    assert_vector(d.objects[3].center, 3, 0, 0);
    assert_true(d.objects[3].radius == 1.5);
    assert_vector(d.objects[4].center, 0, 5, 1);
    assert_vector(d.objects[5].center, 0, 5, 2);
    assert_vector(d.objects[6].center, 0, 7, 1);
    assert_vector(d.objects[8].center, 0.5, 5, 1);
    assert_vector(d.objects[15].center, 1, 7, 2);
    assert_vector(d.objects[16].center, 3, 0, 0);
    assert_vector(d.objects[17].center, 1, 0, 0);
    scene_description_release(&d);
    /* Ends that rounding misses; an index that hides a definition; lists of other things. */
    d = expect_objects(
        HEAD "define: {i: 5, names: [white, white]}\nobjects:\n"
             "  - {for: i, from: 0, to: 0.3, step: 0.1, do: " SPHERE(
                 "[=i, 0, 0]",
                 "1") "}\n"
                      "  - triangles: {material: white, triangles: [[0, 1, =i-3]],\n"
                      "      vertices: [{for: k, from: 1, to: 3, do: [[=k, =k^2, =k^3]]}]}\n"
                      "  - {for: m, in: =names, do: {sphere: {center: [0,0,0], radius: 1, "
                      "material: =m}}}\n",
        7);
    assert_vector(d.objects[3].center, 0.3, 0, 0);
    assert_int_equal(d.objects[4].triangles[0][2], 2);
    assert_vector(d.objects[4].vertices[2], 3, 9, 27);
    scene_description_release(&d);
}

static void test_bad_loops(void **state)
{
    (void)state;
    static const struct bad cases[] = {
        {HEAD "objects: [{for: i, from: 0, stpe: 3, to: 1, do: []}]",
         "t:5:29: error: unknown key 'stpe' in for; did you mean 'step'?\n"},
        {HEAD "objects: [{for: i, from: 0, do: []}]", "t:5:12: error: missing key 'to' in for\n"},
        {HEAD "objects: [{for: i, to: 0, do: []}]", "t:5:12: error: missing key 'from' in for\n"},
        {HEAD "objects: [{for: i, do: []}]", "t:5:12: error: for needs from and to, or in\n"},
        {HEAD "objects: [{for: i, in: [], to: 3, do: []}]",
         "t:5:32: error: for has both in and a range; give one of them\n"},
        {HEAD "objects: [{for: i, in: 3, do: []}]",
         "t:5:24: error: expected a list for in, got text\n"},
        {HEAD "objects: [{for: i, from: 0, to: 1}]", "t:5:12: error: missing key 'do' in for\n"},
        {HEAD "objects: [{for: i, from: 0, to: 1, step: =1-1, do: []}]",
         "t:5:42: error: step in for: expected a number that is not 0\n"},
        {HEAD "objects: [{for: i, from: a, to: [1], do: []}]",
         "t:5:26: error: from in for: expected number, got 'a'\n"
         "t:5:33: error: to in for: expected number, got a list\n"},
        {HEAD "objects: [{for: 3, from: 0, to: 1, do: []}]",
         "t:5:17: error: the index of a loop needs a name of letters, digits and '_' that begins "
         "with no digit, got 3\n"},
        {HEAD "objects: [{for: i, from: 0, to: 1, do: {for: i, in: [1], do: []}}]",
         "t:5:46: error: 'i' is the index of the loop around this one, in line 5\n"},
        {HEAD "objects: [{for: i, from: 0, to: =n, do: []}, {for: j, in: [=i], do: []}]",
         "t:5:34: error: unknown name 'n' in arithmetic\n"
         "t:5:61: error: unknown name 'i' in arithmetic\n"},
        /* The same in every turn, and said once. */
        {HEAD "objects: [{for: i, from: -3, to: 3, do: " SPHERE("[0, 0, 0]", "=1/(i+3)") "}]",
         "t:5:80: error: division by zero\n"},
        {HEAD "objects: [{for: i, from: 1, to: 1e5, do: [=1/0]}]\nimage: {width: x}",
         "t:5:45: error: division by zero\n"
         "t:6:16: error: width in image: expected integer 1..65536, got 'x'\n"},
        {HEAD "objects: [{for: i, from: 1, to: 1e18, do: []}]",
         "t:5:33: error: this loop has 1e+18 turns; a scene has at most 4000000 values\n"},
        {HEAD "objects: {for: i, from: 0, to: 1, do: []}",
         "t:5:10: error: expected a list for objects, got a map\n"},
        {HEAD "objects: [{if: maybe, do: []}]",
         "t:5:16: error: if in if: expected yes | no, got 'maybe'\n"},
        {HEAD "objects: [{if: [1], than: 3}]",
         "t:5:16: error: if in if: expected yes | no, got a list\n"
         "t:5:21: error: unknown key 'than' in if\n"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        expect_bad(cases[i].text, &alone, cases[i].messages);
}

static void test_conditions(void **state)
{
    (void)state;
    struct scene_description d = expect_objects(
        HEAD
        "define: {night: no}\nobjects:\n"
        "  - for: i\n    from: 0\n    to: 3\n    do:\n"
        "      - if: =mod(i, 2) == 1\n"
        "        do: " SPHERE(
            "[=i, 1, 0]", "1") "\n"
                               "        else: [" SPHERE("[=i, 0, 0]", "1") ", " SPHERE(
                                   "[=i, 0, 1]",
                                   "1") "]\n"
                                        "  - {if: =night, do: " SPHERE(
                                            "[7, 7, 7]", "1") "}\n"
                                                              "  - {if: yes, else: " SPHERE(
                                                                  "[7, 7, 7]",
                                                                  "1") "}\n"
                                                                       "  - {if: -2.5, do: " SPHERE(
                                                                           "[8, 8, 8]", "1") "}\n",
        7);
    assert_vector(d.objects[0].center, 0, 0, 0);
    assert_vector(d.objects[1].center, 0, 0, 1);
    assert_vector(d.objects[2].center, 1, 1, 0);
    assert_vector(d.objects[3].center, 2, 0, 0);
    assert_vector(d.objects[5].center, 3, 1, 0);
    assert_vector(d.objects[6].center, 8, 8, 8);
    scene_description_release(&d);
}

/* What loops and names make can be taken up by anchors and merge keys, and the other way round. */
static void test_anchors_in_loops(void **state)
{
    (void)state;
    struct scene_description d = expect_objects(
        HEAD "objects:\n"
             "  - {for: i, from: 1, to: 2, do: &body [{sphere: &s {center: [=i, 0, 0], radius: 1,\n"
             "     material: white}}]}\n"
             "  - {for: i, from: 3, to: 4, do: *body}\n"
             "  - {for: i, in: [5], do: {sphere: {<<: *s, radius: =i}}}\n",
        5);
    assert_vector(d.objects[3].center, 4, 0, 0);
    assert_vector(d.objects[4].center, 5, 0, 0);
    assert_true(d.objects[4].radius == 5);
    scene_description_release(&d);
}

static double value_of(const char *text)
{
    struct error error;
    size_t position;
    double value = NAN;
    assert_int_equal(arithmetic_evaluate(text, NULL, &value, &position, &error), PS_OK);
    return value;
}

static void test_functions(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
    } cases[] = {{"floor(-1.5)*10+ceil(1.2)", -18},
                 {"round(2.5)+round(-0.4)", 3},
                 {"mod(7, 3)", 1},
                 {"mod(-1, 3)", 2},
                 {"mod(1, -3)", -2},
                 {"pow(2, 10)", 1024},
                 {"clamp(5, 0, 1)", 1},
                 {"clamp(-5, 0, 1)", 0},
                 {"clamp(0.5, 0, 1)", 0.5},
                 {"min(3, 1, 2)", 1},
                 {"max(3, 1, 2, 5)", 5},
                 {"degrees(atan2(1, 1))", 45},
                 {"asin(1)+acos(1)-atan(0)", 1.5707963267948966},
                 {"ln(exp(2))", 2},
                 {"1 < 2", 1},
                 {"2 <= 1", 0},
                 {"1+1 == 2", 1},
                 {"(1 != 1) + (2 > 1)*2 + (1 >= 1)*4", 6}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++)
        assert_true(fabs(value_of(cases[i].text) - cases[i].value) <= 1e-12);
}

/* The numbers are part of the language: a scene must look the same ever after. */
static void test_noise(void **state)
{
    (void)state;
    double sum = 0, squares = 0, product = 0, before = value_of("rand(-1)");
    for (int i = 0; i < 10000; i++) {
        char text[32];
        snprintf(text, sizeof text, "rand(%d)", i);
        double value = value_of(text);
        assert_true(value >= 0 && value < 1);
        sum += value;
        squares += value * value;
        product += value * before;
        before = value;
    }
    assert_true(fabs(sum / 10000 - 0.5) < 0.015); /* 5 standard deviations */
    assert_true(fabs(squares / 10000 - 1.0 / 3) < 0.015);
    assert_true(fabs(product / 10000 - 0.25) < 0.015);
    assert_true(value_of("rand(3)") == value_of("rand(1+2)"));
    assert_true(value_of("rand(0)") == value_of("rand(-0)"));
    assert_true(value_of("rand(1, 2)") != value_of("rand(2, 1)"));
    assert_true(value_of("rand(1)") != value_of("rand(1, 0)"));
    assert_true(fabs(value_of("rand(0)") - 0.43152799690142274) < 1e-15);
    assert_true(fabs(value_of("rand(1)") - 0.96890303562395275) < 1e-15);
    assert_true(fabs(value_of("rand(1, 2)") - 0.85262733488343656) < 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_definitions), cmocka_unit_test(test_bad_definitions),
        cmocka_unit_test(test_loops),       cmocka_unit_test(test_bad_loops),
        cmocka_unit_test(test_conditions),  cmocka_unit_test(test_anchors_in_loops),
        cmocka_unit_test(test_functions),   cmocka_unit_test(test_noise),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
