/* test_importance.c: light paths go where the camera looks: in a building of many rooms, of which
 * it sees one, splats are nearly as good as in that room alone, and have the same mean as path
 * tracing.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define WIDTH 32
#define HEIGHT 18

/* Of the building of scenes/rooms.psd with so many rooms along each side. */
static struct rendering render_rooms(char rooms, const char *const choices[])
{
    static const char words[] = "rooms: {default: ";
    char *text = scene_file_text("rooms", WIDTH, HEIGHT);
    char *place = strstr(text, words);
    assert_non_null(place);
    place[strlen(words)] = rooms;
    struct rendering rendering = render_text(text, 2, choices);
    free(text);
    return rendering;
}

/* The error of splats against path tracing, and their mean over that of path tracing. */
struct comparison {
    double error, mean;
};

static struct comparison compare_with_paths(char rooms)
{
    static const char *const by_splats[] = {"estimator=splat", "injection=photon:count=20000",
                                            "bounces=all", NULL};
    static const char *const by_paths[] = {"estimator=pathtrace:samples=512", "bounces=all", NULL};
    struct rendering splats = render_rooms(rooms, by_splats);
    struct rendering paths = render_rooms(rooms, by_paths);
    const float *tested = image_channel(&splats.image, "indirect.G");
    const float *reference = image_channel(&paths.image, "indirect.G");
    double squares = 0.0, sum = 0.0, tested_sum = 0.0;
    for (size_t i = 0; i < WIDTH * HEIGHT; i++) {
        double difference = (double)tested[i] - (double)reference[i];
        squares += difference * difference;
        sum += (double)reference[i];
        tested_sum += (double)tested[i];
    }
    rendering_release(&splats);
    rendering_release(&paths);
    return (struct comparison){sqrt(squares * WIDTH * HEIGHT) / sum, tested_sum / sum};
}

/* Shared by power, 64 rooms have seven times the error of one. */
static void test_rooms_that_are_not_seen(void **state)
{
    (void)state;
    struct comparison one = compare_with_paths('1'), many = compare_with_paths('8');
    print_message("error %.3f in one room, %.3f of 64; mean %.3f, %.3f\n", one.error, many.error,
                  one.mean, many.mean);
    assert_true(many.error < 1.5 * one.error);
    assert_true(fabs(many.mean - 1.0) < 0.06);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_rooms_that_are_not_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
