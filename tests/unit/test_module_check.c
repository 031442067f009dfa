/* test_module_check.c: a good module is taken; each defect is refused with its own message. */
#include "plugin/loader.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#define ABI_MESSAGE "it was built for plugin interface "

/* A module with one filter of two parameters, to be spoiled. */
struct specimen {
    ps_param params[2];
    ps_filter_vtable vtable;
    ps_descriptor descriptor;
    const ps_descriptor *descriptors[1];
    ps_module module;
};

struct values {
    double sharpness;
    int32_t mode;
};

static const char *const modes[] = {"fast", "slow", NULL};

static void weigh(const void *state, const float *r2, float *weights, size_t n)
{
    (void)state;
    (void)r2;
    memset(weights, 0, n * sizeof *weights);
}

static struct specimen *make(void)
{
    static struct specimen it;
    it.params[0] = (ps_param)PS_NUMBER(struct values, sharpness, "1", 0, 10, 0, "", "how sharp");
    it.params[1] = (ps_param)PS_CHOICE(struct values, mode, "fast", modes, "how fast");
    it.vtable = (ps_filter_vtable){.size = sizeof it.vtable, .weigh = weigh};
    it.descriptor = (ps_descriptor){
        .size = sizeof it.descriptor,
        .kind = PS_FILTER,
        .name = "mine",
        .version = "1.0",
        .summary = "a test's",
        .paper = "none",
        .params = it.params,
        .param_count = 2,
        .param_size = sizeof it.params[0],
        .state_size = sizeof(struct values),
        .vtable = &it.vtable,
    };
    it.descriptors[0] = &it.descriptor;
    it.module = (ps_module){
        .magic = PS_MODULE_MAGIC,
        .abi_major = PS_ABI_MAJOR,
        .abi_minor = PS_ABI_MINOR,
        .fingerprint = PS_LAYOUT_FINGERPRINT,
        .size = sizeof(ps_module),
        .descriptor_count = 1,
        .descriptors = it.descriptors,
    };
    return &it;
}

static void accept(const struct specimen *it)
{
    struct error error = {""};
    if (!module_check(&it->module, &error))
        fail_msg("refused: %s", error.text);
}

static void refuse(const struct specimen *it, const char *message)
{
    struct error error = {""};
    assert_false(module_check(&it->module, &error));
    assert_non_null(strstr(error.text, message));
}

static void test_good_modules(void **state)
{
    (void)state;
    struct specimen *it = make();
    accept(it);
    it->descriptor.param_count = 0; /* no parameters: no rows, no size of rows, no state */
    it->descriptor.params = NULL;
    it->descriptor.param_size = 0;
    it->descriptor.state_size = 0;
    accept(it);
}

/* A later minor version may have appended members. */
static void test_larger_structs_are_good(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->module.size += 8;
    it->descriptor.size += 16;
    it->vtable.size += 8;
    accept(it);
}

/* The bytes of a struct up to the end of its last member in the first version that has it. */
#define FIRST_SIZE(type, last) (offsetof(type, last) + sizeof(((type *)NULL)->last))

static const struct {
    ps_kind kind;
    size_t first_size;
} tables[] = {
    {PS_INJECTION, FIRST_SIZE(ps_injection_vtable, prepare)},
    {PS_STRATIFICATION, FIRST_SIZE(ps_stratification_vtable, find_strata)},
    {PS_VISIBILITY, FIRST_SIZE(ps_visibility_vtable, visible)},
    {PS_FILTER, FIRST_SIZE(ps_filter_vtable, weigh)},
    {PS_ESTIMATOR, FIRST_SIZE(ps_estimator_vtable, end)},
    {PS_NORMALIZATION, FIRST_SIZE(ps_normalization_vtable, resolve)},
    {PS_DENOISER, FIRST_SIZE(ps_denoiser_vtable, filter)},
    {PS_BLOOM, FIRST_SIZE(ps_bloom_vtable, spread)},
    {PS_TONEMAP, FIRST_SIZE(ps_tonemap_vtable, map)},
};

/* Structs of 1.0 are good for ever, whatever lies behind them; a byte less is not. */
static void test_the_first_sizes_are_good(void **state)
{
    (void)state;
    static union {
        uint32_t size;
        void (*members[32])(void);
    } table;
    for (int i = 0; i < PS_KINDS; i++) {
        struct specimen *it = make();
        for (int k = 0; k < 32; k++)
            table.members[k] = (void (*)(void))weigh;
        it->module.size = FIRST_SIZE(ps_module, descriptors);
        it->descriptor.size = FIRST_SIZE(ps_descriptor, vtable);
        it->descriptor.kind = tables[i].kind;
        it->descriptor.vtable = &table;
        table.members[0] = NULL;
        table.size = (uint32_t)tables[i].first_size;
        accept(it);
        table.size--;
        refuse(it, "table of functions is too small");
    }
}

/* What a module does not know is 0 to the core, not what happens to lie behind its structs. */
static void test_unknown_members_are_zero(void **state)
{
    (void)state;
    struct specimen *it = make();
    struct strategy_type *type;
    struct error error;
    it->vtable.size = offsetof(ps_filter_vtable, weigh);
    assert_int_equal(strategy_type_create(&it->descriptor, NULL, &type, &error), PS_OK);
    assert_null(type->table.filter.weigh);
    assert_int_equal(type->row_count, 2);
    strategy_type_destroy(type);
}

/* Parameters that psplat gives to a kind come first, and their names are taken. */
static void test_shared_parameters(void **state)
{
    (void)state;
    struct specimen *it = make();
    struct strategy_type *type;
    struct error error;
    static const ps_visibility_vtable visibility = {.size = sizeof visibility};
    it->descriptor.kind = PS_VISIBILITY;
    it->descriptor.vtable = &visibility;
    accept(it);
    assert_int_equal(strategy_type_create(&it->descriptor, NULL, &type, &error), PS_OK);
    assert_int_equal(type->row_count, 6 + 2);
    assert_string_equal(type->rows[0].name, "radius");
    assert_string_equal(type->rows[6].name, "sharpness");
    assert_true(type->rows[0].offset >= type->shared_offset);
    assert_true(type->shared_offset >= sizeof(struct values));
    strategy_type_destroy(type);
    it->params[0].name = "radius";
    assert_int_equal(strategy_type_create(&it->descriptor, NULL, &type, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "its parameter 'radius' is one that psplat gives to every"));
    it->params[0].name = "sharpness";
    it->params[0].default_value = "11";
    assert_int_equal(strategy_type_create(&it->descriptor, NULL, &type, &error), PS_ERROR_INVALID);
    assert_non_null(strstr(error.text, "it has a bad default: expected number 0..10, got '11'"));
}

static void test_header(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->module.magic ^= 1;
    refuse(it, "does not begin with the magic number");
    it = make();
    it->module.abi_major++;
    refuse(it, ABI_MESSAGE);
    it = make();
    it->module.abi_major--;
    refuse(it, ABI_MESSAGE);
    it = make();
    it->module.abi_minor = PS_ABI_MINOR + 1;
    refuse(it, ABI_MESSAGE);
    it = make();
    it->module.fingerprint += 1 << 8;
    refuse(it, "laid out otherwise");
}

/* The version decides before the layout does: it is the better explanation. */
static void test_first_defect_counts(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->module.abi_major++;
    it->module.fingerprint = 0;
    it->module.descriptors = NULL;
    refuse(it, ABI_MESSAGE);
    it->module.magic = 0;
    refuse(it, "magic");
}

static void test_no_strategy(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->module.size = sizeof(ps_module) - 1;
    refuse(it, "describes no strategy");
    it = make();
    it->module.descriptor_count = 0;
    refuse(it, "describes no strategy");
    it = make();
    it->module.descriptors = NULL;
    refuse(it, "describes no strategy");
}

static void test_descriptor(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->descriptors[0] = NULL;
    refuse(it, "descriptor is too small");
    it = make();
    it->descriptor.size = FIRST_SIZE(ps_descriptor, vtable) - 1;
    refuse(it, "descriptor is too small");
    it = make();
    it->descriptor.kind = PS_KINDS;
    refuse(it, "unknown kind");
    it = make();
    it->descriptor.kind = UINT32_MAX;
    refuse(it, "unknown kind");
}

static void test_names(void **state)
{
    (void)state;
    for (int member = 0; member < 4; member++) {
        struct specimen *it = make();
        const char **members[] = {&it->descriptor.name, &it->descriptor.version,
                                  &it->descriptor.summary, &it->descriptor.paper};
        *members[member] = NULL;
        refuse(it, "lacks a name, version, summary or paper");
    }
}

static void test_functions(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->descriptor.vtable = NULL;
    refuse(it, "table of functions is too small");
    it = make();
    it->vtable.weigh = NULL;
    refuse(it, "table of functions lacks one");
    it = make();
    it->descriptor.kind = PS_VISIBILITY; /* whose table is larger than a filter's */
    refuse(it, "table of functions is too small");
}

static void test_parameter_rows(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->descriptor.param_size = FIRST_SIZE(ps_param, help) - 1;
    refuse(it, "rows are too small");
    it = make();
    it->params[0].name = NULL;
    refuse(it, "no name, help, unit or known type");
    it = make();
    it->params[1].help = NULL;
    refuse(it, "no name, help, unit or known type");
    it = make();
    it->params[1].unit = NULL;
    refuse(it, "no name, help, unit or known type");
    it = make();
    it->params[1].type = PS_PARAM_NUMBER_OR_CHOICE + 1;
    refuse(it, "no name, help, unit or known type");
}

static void test_missing_rows(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->descriptor.params = NULL;
    struct error error = {""};
    assert_false(module_check(&it->module, &error));
    assert_true(error.text[0] != '\0');
}

static void test_parameters_stay_inside_their_state(void **state)
{
    (void)state;
    const char *message = "outside of its state";
    struct specimen *it = make();
    it->params[0].offset = sizeof(struct values) - sizeof(double);
    accept(it);
    it->params[0].offset++;
    refuse(it, message);
    it->params[0].offset = UINT64_MAX - 3; /* its end would wrap around */
    refuse(it, message);
    it = make();
    it->descriptor.state_size = 0;
    refuse(it, message);
    it = make();
    it->params[1].type = PS_PARAM_NUMBER_OR_CHOICE; /* 16 bytes where 8 are left */
    refuse(it, message);
}

static void test_choices(void **state)
{
    (void)state;
    struct specimen *it = make();
    it->params[1].choices = NULL;
    refuse(it, "choices do not fit");
    it = make();
    it->params[0].choices = modes;
    refuse(it, "choices do not fit");
}

static void test_every_descriptor_is_checked(void **state)
{
    (void)state;
    struct specimen *it = make();
    ps_descriptor second = it->descriptor;
    const ps_descriptor *both[2] = {&it->descriptor, &second};
    it->module.descriptors = both;
    it->module.descriptor_count = 2;
    accept(it);
    second.kind = PS_KINDS;
    refuse(it, "unknown kind");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_good_modules),
        cmocka_unit_test(test_larger_structs_are_good),
        cmocka_unit_test(test_the_first_sizes_are_good),
        cmocka_unit_test(test_unknown_members_are_zero),
        cmocka_unit_test(test_shared_parameters),
        cmocka_unit_test(test_header),
        cmocka_unit_test(test_first_defect_counts),
        cmocka_unit_test(test_no_strategy),
        cmocka_unit_test(test_descriptor),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_functions),
        cmocka_unit_test(test_parameter_rows),
        cmocka_unit_test(test_parameters_stay_inside_their_state),
        cmocka_unit_test(test_choices),
        cmocka_unit_test(test_every_descriptor_is_checked),
        cmocka_unit_test(test_missing_rows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
