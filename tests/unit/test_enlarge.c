/* test_enlarge.c: pictures scaled up, and the camera of one whose pixels are larger. */
#include "image/enlarge.h"
#include "scene/camera.h"
#include "support/workers.h"

#include <math.h>
#include <string.h>

enum { WIDTH = 7, HEIGHT = 5 };

static bool keeps_all(const char *channel)
{
    (void)channel;
    return true;
}

static bool keeps_ramp(const char *channel)
{
    return strcmp(channel, "ramp") == 0;
}

/* Where a pixel's centre lies, in pixels of a picture that is scaled up by `step`. */
static float centre(size_t index, float step)
{
    return ((float)index + 0.5f) * step;
}

/* A plane over the picture, and a constant. */
static struct image picture(float step)
{
    struct image image = {.width = WIDTH, .height = HEIGHT};
    float *ramp = image_add_channel(&image, "ramp");
    float *constant = image_add_channel(&image, "constant");
    assert_non_null(ramp);
    assert_non_null(constant);
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        ramp[i] = 2.0f * centre(i % WIDTH, step) - 3.0f * centre(i / WIDTH, step) + 1.0f;
        constant[i] = 0.25f;
    }
    return image;
}

/* Beyond the outermost centres there is nothing to go by. */
static float within(float place, size_t count, float step)
{
    return fminf(fmaxf(place, centre(0, step)), centre(count - 1, step));
}

static void check_ramp(double step, size_t width, size_t height)
{
    struct workers *workers = start_workers(2);
    struct image image = picture((float)step), large;
    struct error error;
    const struct enlargement to = {step, width, height};
    assert_int_equal(image_enlarge(&image, to, keeps_all, workers, &large, &error), PS_OK);
    assert_int_equal(large.width, width);
    assert_int_equal(large.height, height);
    const float *ramp = image_channel(&large, "ramp"),
                *constant = image_channel(&large, "constant");
    for (size_t i = 0; i < width * height; i++) {
        float x = within(centre(i % width, 1.0f), WIDTH, (float)step);
        float y = within(centre(i / width, 1.0f), HEIGHT, (float)step);
        assert_float_equal(ramp[i], 2.0f * x - 3.0f * y + 1.0f, 1e-3f);
        assert_float_equal(constant[i], 0.25f, 1e-6f);
    }
    image_release(&large);
    image_release(&image);
    workers_destroy(workers);
}

/* Between centres it is linear, by whatever factor, also where the last pixels are cut. */
static void test_linear(void **state)
{
    (void)state;
    check_ramp(1.0, WIDTH, HEIGHT);
    check_ramp(2.0, 2 * WIDTH, 2 * HEIGHT);
    check_ramp(3.0, 3 * WIDTH - 2, 3 * HEIGHT - 1);
    check_ramp(2.5, 17, 12);
}

/* What is infinite does not reach pixels that lie on the centres of others. */
static void test_infinite(void **state)
{
    (void)state;
    struct workers *workers = start_workers(1);
    struct image image = picture(1.0f), large;
    struct error error;
    const struct enlargement to = {3.0, 3 * WIDTH, 3 * HEIGHT};
    image.channels[0].samples[WIDTH + 2] = INFINITY;
    assert_int_equal(image_enlarge(&image, to, keeps_ramp, workers, &large, &error), PS_OK);
    assert_int_equal(large.channel_count, 1);
    const float *ramp = image_channel(&large, "ramp");
    assert_true(isinf(ramp[(3 + 1) * to.width + 6 + 1]));
    assert_float_equal(ramp[(3 + 1) * to.width + 3 + 1], image.channels[0].samples[WIDTH + 1], 0.0);
    for (size_t i = 0; i < to.width * to.height; i++)
        assert_false(isnan(ramp[i]));
    image_release(&large);
    image_release(&image);
    workers_destroy(workers);
}

/* Its rays are those of the whole picture's points. */
static void check_camera(enum camera_kind kind)
{
    const struct camera_description description = {
        .kind = kind,
        .location = {1, 2, 3},
        .look_at = {4, 1, -2},
        .up = {0, 1, 0},
        .angle = 50,
        .width = 3,
        .aperture = 0.1,
    };
    const float left = 30, top = 7, step = 6.5f, lens[2] = {0.3f, 0.8f};
    struct camera camera = camera_from_description(&description, 160, 90);
    struct camera part = camera_of_part(&camera, left, top, step);
    for (size_t i = 0; i < 40; i++) {
        float x = 0.5f * (float)(i % 8), y = (float)i / 8.0f;
        ps_ray expected = camera_ray(&camera, left + step * x, top + step * y, lens);
        ps_ray found = camera_ray(&part, x, y, lens);
        assert_float_equal(found.origin.x, expected.origin.x, 1e-5f);
        assert_float_equal(found.origin.y, expected.origin.y, 1e-5f);
        assert_float_equal(found.direction.x, expected.direction.x, 1e-5f);
        assert_float_equal(found.direction.y, expected.direction.y, 1e-5f);
        assert_float_equal(found.direction.z, expected.direction.z, 1e-5f);
    }
}

static void test_camera(void **state)
{
    (void)state;
    check_camera(CAMERA_PERSPECTIVE);
    check_camera(CAMERA_ORTHOGRAPHIC);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_linear),
        cmocka_unit_test(test_infinite),
        cmocka_unit_test(test_camera),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
