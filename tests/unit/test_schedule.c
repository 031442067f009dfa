/* test_schedule.c: budgets of time and error, and what is due on the way, on a clock of the test's
 * own. */
#include "job/schedule.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static struct schedule started(struct schedule wishes)
{
    schedule_start(&wishes, 1000);
    return wishes;
}

#define NOTHING                                                                                    \
    .seconds = INFINITY, .write_every = INFINITY, .checkpoint_every = INFINITY, .error = 0

static void test_time_for_another_pass(void **state)
{
    (void)state;
    struct schedule schedule = started((struct schedule){NOTHING});
    schedule.seconds = 10;
    assert_true(schedule_has_time(&schedule, 1009.9)); /* no pass has told how long they take */
    schedule_begin_pass(&schedule, 1001);
    schedule_end_pass(&schedule, 1003);
    assert_true(schedule_has_time(&schedule, 1008));
    assert_false(schedule_has_time(&schedule, 1008.1));
    schedule.write_every = 1;
    schedule_note_picture(&schedule, 1003, 1004);
    assert_true(schedule_has_time(&schedule, 1007));
    assert_false(schedule_has_time(&schedule, 1007.1));
    schedule.seconds = INFINITY;
    assert_true(schedule_has_time(&schedule, 1e12));
}

static void test_pictures_on_the_way(void **state)
{
    (void)state;
    struct schedule schedule = started((struct schedule){NOTHING});
    assert_false(schedule_wants_picture(&schedule, 1e9));
    schedule.write_every = 30;
    assert_true(schedule_wants_picture(&schedule, 1000.1)); /* the first at once */
    schedule_note_picture(&schedule, 1001, 1002);
    assert_false(schedule_wants_picture(&schedule, 1031));
    assert_true(schedule_wants_picture(&schedule, 1032));
}

static void test_checkpoints(void **state)
{
    (void)state;
    struct schedule schedule = started((struct schedule){NOTHING});
    assert_false(schedule_wants_checkpoint(&schedule, 1e9));
    schedule.checkpoint_every = 60;
    assert_false(schedule_wants_checkpoint(&schedule, 1059));
    assert_true(schedule_wants_checkpoint(&schedule, 1060));
    schedule_note_checkpoint(&schedule, 1060, 1062);
    assert_false(schedule_wants_checkpoint(&schedule, 1121));
    assert_true(schedule_wants_checkpoint(&schedule, 1122));
    schedule.checkpoints_are_cheap = true; /* 2 seconds are a fiftieth of 100 */
    assert_false(schedule_wants_checkpoint(&schedule, 1161));
    assert_true(schedule_wants_checkpoint(&schedule, 1162));
}

/* Looked at after the first pass, and then when it may be met; at most twice as many passes
 * later. */
static void test_error(void **state)
{
    (void)state;
    struct schedule schedule = started((struct schedule){NOTHING});
    assert_false(schedule_wants_error(&schedule, 1));
    schedule.error = 0.02;
    assert_true(schedule_wants_error(&schedule, 1));
    schedule_note_error(&schedule, 1, -1, 0); /* not known */
    assert_false(schedule_is_good_enough(&schedule));
    assert_true(schedule_wants_error(&schedule, 2));
    schedule_note_error(&schedule, 10, 0.024, 0);
    assert_false(schedule_is_good_enough(&schedule));
    assert_false(schedule_wants_error(&schedule, 13));
    assert_true(schedule_wants_error(&schedule, 15)); /* 14.4 */
    schedule_note_error(&schedule, 10, 0.2, 0);
    assert_true(schedule_wants_error(&schedule, 20));
    schedule_note_error(&schedule, 20, 0.0201, 0);
    assert_true(schedule_wants_error(&schedule, 21));
    schedule_begin_pass(&schedule, 1000);
    schedule_end_pass(&schedule, 1001);
    schedule_note_error(&schedule, 21, 0.0201, 0.5); /* costs half a pass */
    assert_false(schedule_wants_error(&schedule, 23));
    assert_true(schedule_wants_error(&schedule, 24));
    schedule_note_error(&schedule, 24, 0.02, 0);
    assert_true(schedule_is_good_enough(&schedule));
}

static void test_fraction(void **state)
{
    (void)state;
    struct schedule schedule = started((struct schedule){NOTHING});
    assert_true(schedule_fraction(&schedule, 2000) == 0);
    schedule.seconds = 100;
    assert_true(fabs(schedule_fraction(&schedule, 1025) - 0.25) < 1e-9);
    schedule.error = 0.01;
    schedule_note_error(&schedule, 4, 0.0125, 0);
    assert_true(fabs(schedule_fraction(&schedule, 1025) - 0.64) < 1e-9);
    assert_true(schedule_fraction(&schedule, 1200) == 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_time_for_another_pass),
        cmocka_unit_test(test_pictures_on_the_way),
        cmocka_unit_test(test_checkpoints),
        cmocka_unit_test(test_error),
        cmocka_unit_test(test_fraction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
