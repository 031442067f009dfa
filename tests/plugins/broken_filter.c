/* broken_filter.c: a filter that is sound as it stands; each test breaks it in one place, by a
 * macro.
 */
#include <psplat/plugin.h>

#include <stdio.h>

#ifndef MAGIC
#define MAGIC PS_MODULE_MAGIC
#endif
#ifndef ABI_MAJOR
#define ABI_MAJOR PS_ABI_MAJOR
#endif
#ifndef ABI_MINOR
#define ABI_MINOR PS_ABI_MINOR
#endif
#ifndef FINGERPRINT
#define FINGERPRINT PS_LAYOUT_FINGERPRINT
#endif
#ifndef SYMBOL
#define SYMBOL psplat_module_v1
#endif
#ifndef MODULE_SIZE
#define MODULE_SIZE sizeof(ps_module)
#endif
#ifndef COUNT
#define COUNT 1
#endif
#ifndef DESCRIPTORS
#define DESCRIPTORS descriptors
#endif
#ifndef DESCRIPTOR
#define DESCRIPTOR &descriptor
#endif
#ifndef DESCRIPTOR_SIZE
#define DESCRIPTOR_SIZE sizeof(ps_descriptor)
#endif
#ifndef KIND
#define KIND PS_FILTER
#endif
#ifndef NAME
#define NAME "broken"
#endif
#ifndef PAPER
#define PAPER "none: a test"
#endif
#ifndef PARAMS
#define PARAMS params
#endif
#ifndef PARAM_SIZE
#define PARAM_SIZE sizeof(ps_param)
#endif
#ifndef PARAM_TYPE
#define PARAM_TYPE PS_PARAM_NUMBER
#endif
#ifndef PARAM_OFFSET
#define PARAM_OFFSET 0
#endif
#ifndef PARAM_DEFAULT
#define PARAM_DEFAULT "1"
#endif
#ifndef PARAM_CHOICES
#define PARAM_CHOICES NULL
#endif
#ifndef PARAM_HELP
#define PARAM_HELP "a factor that drops out"
#endif
#ifndef STATE_SIZE
#define STATE_SIZE sizeof(struct state)
#endif
#ifndef VTABLE
#define VTABLE &vtable
#endif
#ifndef VTABLE_SIZE
#define VTABLE_SIZE sizeof(ps_filter_vtable)
#endif
#ifndef WEIGH
#define WEIGH weigh
#endif
#ifndef WEIGHT
#define WEIGHT (1.0f - r2[i])
#endif
#ifndef INIT
#define INIT NULL
#endif

struct state {
    double factor;
};

#ifdef UNDEFINED
extern float missing_function(float r2);
#undef WEIGHT
#define WEIGHT missing_function(r2[i])
#endif

extern void weigh(const void *state, const float *r2, float *weights, size_t n);
void weigh(const void *state, const float *r2, float *weights, size_t n)
{
    (void)state;
    (void)r2;
    for (size_t i = 0; i < n; i++)
        weights[i] = WEIGHT;
}

extern ps_result refuse(void *state, const ps_host *host);
ps_result refuse(void *state, const ps_host *host)
{
    (void)state;
    return host->fail(host, PS_ERROR_INVALID, "the moon is in the wrong quarter");
}

extern ps_result refuse_silently(void *state, const ps_host *host);
ps_result refuse_silently(void *state, const ps_host *host)
{
    (void)state;
    (void)host;
    return PS_ERROR_INVALID;
}

#ifndef PARAM_MINIMUM
#define PARAM_MINIMUM 0
#endif
#ifndef PARAM_COUNT
#define PARAM_COUNT 1
#endif

#define FACTOR                                                                                     \
    {                                                                                              \
        .name = "factor", .type = PARAM_TYPE, .offset = PARAM_OFFSET,                              \
        .default_value = PARAM_DEFAULT, .minimum = PARAM_MINIMUM, .maximum = 2,                    \
        .choices = PARAM_CHOICES, .unit = "", .help = PARAM_HELP,                                  \
    }

extern const ps_param params[];
const ps_param params[] = {FACTOR, FACTOR};

extern const ps_filter_vtable vtable;
const ps_filter_vtable vtable = {.size = VTABLE_SIZE, .weigh = WEIGH};

extern const ps_descriptor descriptor;
const ps_descriptor descriptor = {
    .size = DESCRIPTOR_SIZE,
    .kind = KIND,
    .name = NAME,
    .version = "1.0",
    .summary = "a filter that is broken by the tests",
    .paper = PAPER,
    .params = PARAMS,
    .param_count = PARAM_COUNT,
    .param_size = PARAM_SIZE,
    .state_size = STATE_SIZE,
    .init = INIT,
    .vtable = VTABLE,
};

extern const ps_descriptor *const descriptors[];
const ps_descriptor *const descriptors[] = {DESCRIPTOR};

extern PS_EXPORT const ps_module SYMBOL;
PS_EXPORT const ps_module SYMBOL = {
    .magic = MAGIC,
    .abi_major = ABI_MAJOR,
    .abi_minor = ABI_MINOR,
    .fingerprint = FINGERPRINT,
    .size = MODULE_SIZE,
    .descriptor_count = COUNT,
    .descriptors = DESCRIPTORS,
};
