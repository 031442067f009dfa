/* test_selection.c: a fixed number out of a stream, each thing as likely, in the stream's order. */
#include "debug/selection.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static void fill(struct selection *selection, size_t wanted, uint64_t stream)
{
    struct error error;
    assert_int_equal(selection_create(selection, wanted, sizeof stream, &error), PS_OK);
    for (uint64_t i = 0; i < stream; i++) {
        uint64_t item = 3 * i + 1; /* not its place, so that items and places can't be mistaken */
        selection_offer(selection, &item);
    }
    selection_finish(selection);
    assert_int_equal(selection->offered, stream);
}

static uint64_t item_of(const struct selection *selection, size_t index)
{
    return *(const uint64_t *)selection_item(selection, index);
}

static void test_short_streams_stay_whole(void **state)
{
    (void)state;
    for (uint64_t stream = 0; stream <= 20; stream++) {
        struct selection selection;
        fill(&selection, 20, stream);
        assert_int_equal(selection.count, stream);
        for (size_t i = 0; i < selection.count; i++)
            assert_int_equal(item_of(&selection, i), 3 * i + 1);
        selection_release(&selection);
    }
}

static void test_items_are_of_the_stream_in_order(void **state)
{
    (void)state;
    struct selection selection;
    fill(&selection, 500, 20000);
    assert_int_equal(selection.count, 500);
    for (size_t i = 0; i < selection.count; i++) {
        assert_int_equal(item_of(&selection, i) % 3, 1);
        assert_true(item_of(&selection, i) < 60000);
        assert_true(i == 0 || item_of(&selection, i) > item_of(&selection, i - 1));
    }
    selection_release(&selection);
}

/* Each tenth of the stream gives its share, within five standard deviations. */
static void test_all_of_the_stream_is_as_likely(void **state)
{
    (void)state;
    struct selection selection;
    size_t tenths[10] = {0};
    fill(&selection, 5000, 100000);
    for (size_t i = 0; i < selection.count; i++)
        tenths[item_of(&selection, i) / 30000]++;
    for (int i = 0; i < 10; i++)
        assert_true(fabs((double)tenths[i] - 500) < 5 * sqrt(500));
    selection_release(&selection);
}

static void test_larger_selections_hold_smaller_ones(void **state)
{
    (void)state;
    struct selection few, many;
    fill(&few, 10, 1000);
    fill(&many, 100, 1000);
    size_t found = 0;
    for (size_t i = 0; i < few.count; i++)
        for (size_t j = 0; j < many.count; j++)
            found += item_of(&few, i) == item_of(&many, j);
    assert_int_equal(found, 10);
    selection_release(&few);
    selection_release(&many);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_short_streams_stay_whole),
        cmocka_unit_test(test_items_are_of_the_stream_in_order),
        cmocka_unit_test(test_all_of_the_stream_is_as_likely),
        cmocka_unit_test(test_larger_selections_hold_smaller_ones),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
