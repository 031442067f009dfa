/* test_pass_set.c: sets of passes, as text and as numbers. */
#include "film/pass_set.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static struct pass_set set_of(const char *text)
{
    struct pass_set set = {NULL, 0, 0};
    struct error error;
    assert_int_equal(pass_set_parse(text, &set, &error), PS_OK);
    return set;
}

static void expect_text(const struct pass_set *set, const char *expected)
{
    char *text = pass_set_format(set);
    assert_string_equal(text, expected);
    free(text);
}

static void add(struct pass_set *set, uint32_t first, uint32_t end)
{
    struct error error;
    assert_int_equal(pass_set_add(set, first, end, &error), PS_OK);
}

static void test_runs_join(void **state)
{
    (void)state;
    struct pass_set set = {NULL, 0, 0};
    add(&set, 8, 12);
    add(&set, 0, 2);
    expect_text(&set, "0:2,8:12");
    add(&set, 4, 5);
    expect_text(&set, "0:2,4:5,8:12");
    add(&set, 2, 4);
    expect_text(&set, "0:5,8:12");
    add(&set, 5, 8);
    expect_text(&set, "0:12");
    add(&set, 12, 12); /* nothing */
    expect_text(&set, "0:12");
    pass_set_release(&set);
    expect_text(&set, "");
}

static void test_what_is_in_it(void **state)
{
    (void)state;
    struct pass_set set = set_of("1:4,6:7,9:10");
    assert_int_equal(pass_set_size(&set), 5);
    assert_int_equal(pass_set_odd_size(&set), 3); /* 1, 3, 9 */
    for (uint32_t i = 0; i < 12; i++)
        assert_int_equal(pass_set_has(&set, i), (i >= 1 && i < 4) || i == 6 || i == 9);
    assert_int_equal(pass_set_next_missing(&set, 0), 0);
    assert_int_equal(pass_set_next_missing(&set, 2), 4);
    assert_int_equal(pass_set_next_missing(&set, 9), 10);
    pass_set_release(&set);
}

static void expect_meeting(const char *a, const char *b, int expected)
{
    struct pass_set x = set_of(a), y = set_of(b);
    uint32_t number;
    bool meets = pass_set_meets(&x, &y, &number);
    assert_int_equal(meets ? (int)number : -1, expected);
    pass_set_release(&x);
    pass_set_release(&y);
}

static void test_meeting(void **state)
{
    (void)state;
    expect_meeting("0:4", "4:8", -1);
    expect_meeting("0:4", "3:8", 3);
    expect_meeting("3:8", "0:4", 3);
    expect_meeting("0:1,2:3,8:9", "1:2,3:8", -1);
    expect_meeting("0:1,2:3,8:9", "1:2,3:9", 8);
    expect_meeting("0:100", "50:51", 50);
    expect_meeting("", "0:1", -1);
}

static void test_sets_add_up(void **state)
{
    (void)state;
    struct pass_set a = set_of("0:2,6:8"), b = set_of("2:4,9:10");
    struct error error;
    assert_int_equal(pass_set_add_all(&a, &b, &error), PS_OK);
    expect_text(&a, "0:4,6:8,9:10");
    pass_set_release(&a);
    pass_set_release(&b);
}

static void test_what_is_no_set(void **state)
{
    (void)state;
    static const char *const wrong[] = {"0",       "0:",      ":1",          "1:1",  "2:1",
                                        "0:2,1:3", "0:2,",    ",0:2",        "0:2 ", "a:b",
                                        "-1:2",    "4:6,0:2", "0:4294967296"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct pass_set set = {NULL, 0, 0};
        struct error error;
        if (pass_set_parse(wrong[i], &set, &error) != PS_ERROR_INVALID)
            fail_msg("'%s' was taken", wrong[i]);
        pass_set_release(&set);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_runs_join),      cmocka_unit_test(test_what_is_in_it),
        cmocka_unit_test(test_meeting),        cmocka_unit_test(test_sets_add_up),
        cmocka_unit_test(test_what_is_no_set),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
