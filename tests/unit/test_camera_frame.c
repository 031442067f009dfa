/* test_camera_frame.c: cameras that find their place, and what they count as worth a look. */
#include "scene/camera_frame.h"

#include "parser_fixture.h"
#include "scene/scene_box.h"

/* Of the picture's half width and half height, how far the corners of the box reach from its
 * middle. */
struct reach {
    double left, right, up, down;
};

static struct reach reach_of(const struct camera_description *description, const struct box *box,
                             size_t width, size_t height)
{
    struct camera camera = camera_from_description(description, width, height);
    struct reach reach = {0, 0, 0, 0};
    for (unsigned i = 0; i < 8; i++) {
        float x, y;
        assert_true(camera_project(&camera, box_corner(box, i), &x, &y));
        double across = 2.0 * (double)x / (double)width - 1.0;
        double down = 2.0 * (double)y / (double)height - 1.0;
        reach.left = fmax(reach.left, -across);
        reach.right = fmax(reach.right, across);
        reach.up = fmax(reach.up, -down);
        reach.down = fmax(reach.down, down);
    }
    return reach;
}

static double largest(struct reach reach)
{
    return fmax(fmax(reach.left, reach.right), fmax(reach.up, reach.down));
}

static struct camera_description automatic(void)
{
    return (struct camera_description){
        .up = {0, 1, 0}, .finds_location = true, .finds_look_at = true};
}

static void frame(struct camera_description *camera, const struct box *box, size_t width,
                  size_t height)
{
    struct error error;
    assert_int_equal(camera_frame(camera, box, width, height, &error), PS_OK);
}

static const struct box boxes[] = {
    {{-1, -1, -1}, {1, 1, 1}},
    {{0, 0, 0}, {0.2F, 30, 0.2F}},
    {{-5, 0, -5}, {5, 0, 5}},
    {{0, 0, 0}, {0, 2, 3}},
    {{1000, 50, -700}, {1001, 52, -699}},
    {{-2e-3F, 0, 0}, {1e-3F, 1e-3F, 2e-3F}},
    {{-4e4F, 0, -2e4F}, {4e4F, 9e3F, 5e4F}},
};

static const size_t sizes[][2] = {{800, 450}, {100, 100}, {90, 700}, {2000, 50}, {1, 1}};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/* More than a right angle in width or height. */
static bool is_wide(const struct camera_description *camera, const size_t size[2])
{
    double aspect = (double)size[0] / (double)size[1];
    double half = tan(fmax(camera->angle, camera->vertical_angle) * PS_PI / 360);
    return half > 1 || half * (camera->vertical_angle > 0 ? aspect : 1 / aspect) > 1;
}

/* The box is in the picture, and fills its width or its height up to the margin, alike on both
 * sides. */
static void expect_framed(const struct camera_description *camera, const struct box *box,
                          const size_t size[2])
{
    struct reach reach = reach_of(camera, box, size[0], size[1]);
    assert_true(largest(reach) < 0.9);
    if (is_wide(camera, size))
        return; /* keeps away from the nearest corner */
    assert_true(fmin(reach.left, reach.right) > 0.85 || fmin(reach.up, reach.down) > 0.85);
    assert_true(fabs(reach.left - reach.right) < 0.01 || fabs(reach.up - reach.down) < 0.01);
}

static void test_the_whole_box_is_in_the_picture(void **state)
{
    static const double angles[] = {0, 1, 20, 67.38, 120, 170};
    static const ps_vec3 ups[] = {{0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {3, 1, -2}};
    (void)state;
    for (size_t b = 0; b < COUNT(boxes); b++)
        for (size_t s = 0; s < COUNT(sizes); s++)
            for (size_t a = 0; a < COUNT(angles); a++)
                for (size_t u = 0; u < COUNT(ups); u++) {
                    struct camera_description camera = automatic();
                    camera.up = ups[u];
                    *(u & 1 ? &camera.vertical_angle : &camera.angle) = angles[a];
                    frame(&camera, &boxes[b], sizes[s][0], sizes[s][1]);
                    expect_framed(&camera, &boxes[b], sizes[s]);
                }
}

static void test_orthographic_width_is_found(void **state)
{
    (void)state;
    for (size_t b = 0; b < COUNT(boxes); b++)
        for (size_t s = 0; s < COUNT(sizes); s++) {
            struct camera_description camera = automatic();
            camera.kind = CAMERA_ORTHOGRAPHIC;
            frame(&camera, &boxes[b], sizes[s][0], sizes[s][1]);
            expect_framed(&camera, &boxes[b], sizes[s]);
        }
}

/* From the front, the right and above, whichever way up is. */
static void test_three_quarter_view(void **state)
{
    (void)state;
    struct camera_description camera = automatic();
    frame(&camera, &boxes[0], 100, 100);
    assert_true(camera.location.z > camera.location.x && camera.location.x > 0);
    assert_true(camera.location.y > 0 && camera.location.y < camera.location.z);
    camera = automatic();
    camera.up = (ps_vec3){0, 0, 1};
    frame(&camera, &boxes[0], 100, 100);
    assert_true(-camera.location.y > camera.location.x && camera.location.x > 0);
    assert_true(camera.location.z > 0);
}

/* What the scene says of location or look_at stays. */
static void test_given_points_stay(void **state)
{
    (void)state;
    struct camera_description camera = automatic();
    camera.finds_look_at = false;
    camera.look_at = (ps_vec3){0.9F, -0.5F, 3};
    frame(&camera, &boxes[0], 160, 90);
    float x, y;
    struct camera made = camera_from_description(&camera, 160, 90);
    assert_true(camera_project(&made, camera.look_at, &x, &y));
    assert_float_equal(x, 80, 0.01);
    assert_float_equal(y, 45, 0.01);
    assert_true(fabs(largest(reach_of(&camera, &boxes[0], 160, 90)) - 0.88) < 0.01);

    camera = automatic();
    camera.finds_location = false;
    camera.location = (ps_vec3){7, 8, 9};
    camera.angle = 30;
    frame(&camera, &boxes[1], 160, 90);
    assert_true(camera.look_at.y == 15 && camera.location.x == 7 && camera.angle == 30);
}

static void test_no_direction_of_view(void **state)
{
    (void)state;
    struct error error;
    struct camera_description camera = automatic();
    camera.finds_location = false;
    assert_int_equal(camera_frame(&camera, &boxes[0], 4, 4, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "look_at: auto is the camera's location"));
    camera.location = (ps_vec3){0, 5, 0};
    assert_int_equal(camera_frame(&camera, &boxes[0], 4, 4, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "up is along"));
    camera = automatic();
    struct box nothing = BOX_EMPTY;
    assert_int_equal(camera_frame(&camera, &nothing, 4, 4, &error), PS_OK);
}

/* --- what is worth a look
 * ------------------------------------------------------------------------- */

static void expect_box_of(const char *objects, const char *expected)
{
    char text[4096], found[256];
    struct scene scene;
    struct error error;
    snprintf(text, sizeof text, "psd: 1\ncamera: auto\n" LIGHTS MATERIALS "%s", objects);
    struct scene_description d = parse_good(text);
    assert_int_equal(scene_create(&d, &scene, NULL, &error), PS_OK);
    struct box box = scene_box_to_frame(&d, &scene, (ps_vec3){0, 1, 0});
    snprintf(found, sizeof found, "%g %g %g, %g %g %g", (double)box.low.x, (double)box.low.y,
             (double)box.low.z, (double)box.high.x, (double)box.high.y, (double)box.high.z);
    assert_string_equal(found, expected);
    scene_release(&scene);
    scene_description_release(&d);
}

#define BALL "  - sphere: {center: [0, 1, 0], radius: 1, material: white}\n"
#define BALL_BOX "-1 0 -1, 1 2 1"
#define LEVEL(y)                                                                                   \
    "  - quad: {corners: [[-9, " y ", -9], [-9, " y ", 9], [9, " y ", 9], [9, " y                  \
    ", -9]], material: white}\n"

static void test_what_is_left_out(void **state)
{
    (void)state;
    expect_box_of("objects:\n" BALL, BALL_BOX);
    expect_box_of("objects:\n" BALL LEVEL("0"), BALL_BOX);
    expect_box_of("objects:\n" LEVEL("-0.5") BALL, BALL_BOX);
    expect_box_of("objects:\n" BALL "  - plane: {normal: [0, 1, 0], material: white}\n"
                  "  - plane: {normal: [1, 0, 1], extent: 5, material: white}\n",
                  BALL_BOX);
    expect_box_of("objects:\n" BALL "  - disc: {center: [0, -1, 0], normal: [0, 1, 0], radius: 9, "
                  "material: white}\n",
                  BALL_BOX);
    expect_box_of("objects:\n" BALL
                  "  - sphere: {center: [9, 1, 0], radius: 1, material: white, camera: no}\n",
                  BALL_BOX);
    expect_box_of("objects:\n" BALL LEVEL("0.5"), "-9 0 -9, 9 2 9");             /* a table */
    expect_box_of("objects:\n" BALL LEVEL("0") LEVEL("-0.5"), "-9 0 -9, 9 2 9"); /* above a floor */
    expect_box_of("objects:\n" BALL "  - box: {corners: [[-3, -1, -3], [3, 0, 3]], "
                  "material: white}\n",
                  "-3 -1 -3, 3 2 3");
}

static void test_floors_alone_are_framed(void **state)
{
    (void)state;
    expect_box_of("objects:\n" LEVEL("2"), "-9 2 -9, 9 2 9");
    expect_box_of("objects: [plane: {normal: [0, 1, 0], extent: 3, material: white}]\n",
                  "-3 0 -3, 3 0 3");
}

static void test_instances_are_framed_without_planes(void **state)
{
    (void)state;
    expect_box_of("groups:\n  g:\n" BALL
                  "  - plane: {normal: [0, 1, 0], extent: 50, material: white}\n"
                  "objects: [instance: {of: g, translate: [10, 0, 0]}]\n",
                  "9 0 -1, 11 2 1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_whole_box_is_in_the_picture),
        cmocka_unit_test(test_orthographic_width_is_found),
        cmocka_unit_test(test_three_quarter_view),
        cmocka_unit_test(test_given_points_stay),
        cmocka_unit_test(test_no_direction_of_view),
        cmocka_unit_test(test_what_is_left_out),
        cmocka_unit_test(test_floors_alone_are_framed),
        cmocka_unit_test(test_instances_are_framed_without_planes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
