/* test_choice.c: strategies as the command line writes them: parsing, and laying over. */
#include "render/settings.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static struct strategy_choice parse(const char *text)
{
    struct strategy_choice choice;
    struct error error = {""};
    if (settings_parse_choice(text, &choice, &error) != PS_OK)
        fail_msg("'%s': %s", text, error.text);
    return choice;
}

static void refuse(const char *text, const char *message)
{
    struct strategy_choice choice;
    struct error error = {""};
    assert_int_equal(settings_parse_choice(text, &choice, &error), PS_ERROR_INVALID);
    assert_string_equal(error.text, message);
    assert_null(choice.name); /* nothing is left for the caller to release */
    assert_null(choice.parameters);
}

static void expect_parameter(const struct strategy_choice *choice, size_t index, const char *key,
                             const char *value)
{
    assert_true(index < choice->parameter_count);
    assert_string_equal(choice->parameters[index].key, key);
    assert_string_equal(choice->parameters[index].value, value);
    assert_int_equal(choice->parameters[index].key_origin.line, 0);
}

static void test_name_alone(void **state)
{
    (void)state;
    struct strategy_choice choice = parse("gaussian");
    assert_string_equal(choice.name, "gaussian");
    assert_int_equal(choice.parameter_count, 0);
    strategy_choice_release(&choice);
    choice = parse("./folder/mine.so");
    assert_string_equal(choice.name, "./folder/mine.so");
    strategy_choice_release(&choice);
}

static void test_parameters(void **state)
{
    (void)state;
    struct strategy_choice choice = parse("photon:count=25000,bounces=2");
    assert_string_equal(choice.name, "photon");
    assert_int_equal(choice.parameter_count, 2);
    expect_parameter(&choice, 0, "count", "25000");
    expect_parameter(&choice, 1, "bounces", "2");
    strategy_choice_release(&choice);
}

static void test_brackets_hold_commas(void **state)
{
    (void)state;
    struct strategy_choice choice = parse("x:a=[1, 2, 3],b=[4,[5,6]],c=7");
    assert_int_equal(choice.parameter_count, 3);
    expect_parameter(&choice, 0, "a", "[1, 2, 3]");
    expect_parameter(&choice, 1, "b", "[4,[5,6]]");
    expect_parameter(&choice, 2, "c", "7");
    strategy_choice_release(&choice);
}

static void test_values_hold_anything_else(void **state)
{
    (void)state;
    struct strategy_choice choice = parse("x:a=,b=c=d,path=/tmp/a:b");
    assert_int_equal(choice.parameter_count, 3);
    expect_parameter(&choice, 0, "a", "");
    expect_parameter(&choice, 1, "b", "c=d");
    expect_parameter(&choice, 2, "path", "/tmp/a:b");
    strategy_choice_release(&choice);
}

static void test_refusals(void **state)
{
    (void)state;
    refuse("", "expected NAME[:KEY=VALUE,...], got ''");
    refuse(":a=1", "expected NAME[:KEY=VALUE,...], got ':a=1'");
    refuse("x:", "expected KEY=VALUE, got ''");
    refuse("x:a", "expected KEY=VALUE, got 'a'");
    refuse("x:=1", "expected KEY=VALUE, got '=1'");
    refuse("x:a=1,", "expected KEY=VALUE, got ''");
    refuse("x:a=1,,b=2", "expected KEY=VALUE, got ''");
    refuse("x:a=1,b", "expected KEY=VALUE, got 'b'");
    refuse("x:a=1,b=2,a=3", "parameter 'a' is given twice");
}

static void test_similar_keys_are_different(void **state)
{
    (void)state;
    struct strategy_choice choice = parse("x:size=1,siz=2,sizes=3");
    assert_int_equal(choice.parameter_count, 3);
    strategy_choice_release(&choice);
}

/* Lays `over` over `base`; the caller releases the result. */
static struct strategy_choice lay(const char *base_text, const char *over_text)
{
    struct strategy_choice base = {.name = NULL}, over = parse(over_text);
    struct error error;
    if (base_text)
        base = parse(base_text);
    assert_int_equal(settings_override(&base, &over, &error), PS_OK);
    assert_null(over.name); /* taken over */
    assert_null(over.parameters);
    assert_int_equal(over.parameter_count, 0);
    return base;
}

static void test_lays_over_nothing(void **state)
{
    (void)state;
    struct strategy_choice choice = lay(NULL, "photon:count=5");
    assert_string_equal(choice.name, "photon");
    expect_parameter(&choice, 0, "count", "5");
    strategy_choice_release(&choice);
}

static void test_the_same_strategy_keeps_its_parameters(void **state)
{
    (void)state;
    struct strategy_choice choice = lay("photon:count=5,bounces=3", "photon:roulette=4,count=6");
    assert_string_equal(choice.name, "photon");
    assert_int_equal(choice.parameter_count, 3);
    expect_parameter(&choice, 0, "count", "6");
    expect_parameter(&choice, 1, "bounces", "3");
    expect_parameter(&choice, 2, "roulette", "4");
    strategy_choice_release(&choice);
    choice = lay("photon:count=5", "photon");
    assert_int_equal(choice.parameter_count, 1);
    expect_parameter(&choice, 0, "count", "5");
    strategy_choice_release(&choice);
}

static void test_another_strategy_forgets_them(void **state)
{
    (void)state;
    struct strategy_choice choice = lay("photon:count=5,bounces=3", "rsm:bounces=1");
    assert_string_equal(choice.name, "rsm");
    assert_int_equal(choice.parameter_count, 1);
    expect_parameter(&choice, 0, "bounces", "1");
    strategy_choice_release(&choice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_name_alone),
        cmocka_unit_test(test_parameters),
        cmocka_unit_test(test_brackets_hold_commas),
        cmocka_unit_test(test_values_hold_anything_else),
        cmocka_unit_test(test_refusals),
        cmocka_unit_test(test_similar_keys_are_different),
        cmocka_unit_test(test_lays_over_nothing),
        cmocka_unit_test(test_the_same_strategy_keeps_its_parameters),
        cmocka_unit_test(test_another_strategy_forgets_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
