/* module_check.c: judges a module by its data alone, before any of its functions is called. */
#include "plugin/strategy_type.h"

#include <stdlib.h>
#include <string.h>

static bool reject(struct error *error, const char *why)
{
    error_set(error, PS_ERROR_INVALID, "%s", why);
    return false;
}

/* What a struct ended with in the first version of the interface that has it: it may have grown
 * since, and a module's may not be shorter. */
#define FIRST_SIZE(type, last) (offsetof(type, last) + sizeof(((type *)NULL)->last))

/* What a kind's table has to hold: so many bytes, and these functions. */
struct table_rule {
    size_t first_size;
    size_t required[2]; /* offsets; 0: none */
};

static const struct table_rule table_rules[PS_KINDS] = {
    [PS_INJECTION] = {FIRST_SIZE(ps_injection_vtable, prepare),
                      {offsetof(ps_injection_vtable, path_count),
                       offsetof(ps_injection_vtable, emit)}},
    [PS_STRATIFICATION] = {FIRST_SIZE(ps_stratification_vtable, find_strata), {0, 0}},
    [PS_VISIBILITY] = {FIRST_SIZE(ps_visibility_vtable, visible), {0, 0}},
    [PS_FILTER] = {FIRST_SIZE(ps_filter_vtable, weigh), {offsetof(ps_filter_vtable, weigh), 0}},
    [PS_ESTIMATOR] = {FIRST_SIZE(ps_estimator_vtable, end),
                      {offsetof(ps_estimator_vtable, accumulate), 0}},
    [PS_NORMALIZATION] = {FIRST_SIZE(ps_normalization_vtable, resolve),
                          {offsetof(ps_normalization_vtable, resolve), 0}},
    [PS_DENOISER] = {FIRST_SIZE(ps_denoiser_vtable, filter), {0, 0}},
    [PS_BLOOM] = {FIRST_SIZE(ps_bloom_vtable, spread), {0, 0}},
    [PS_TONEMAP] = {FIRST_SIZE(ps_tonemap_vtable, map), {0, 0}},
};

static size_t member_size(uint32_t type)
{
    static const size_t sizes[] = {
        [PS_PARAM_BOOL] = sizeof(int32_t),
        [PS_PARAM_INT] = sizeof(int64_t),
        [PS_PARAM_NUMBER] = sizeof(double),
        [PS_PARAM_VEC3] = sizeof(ps_vec3),
        [PS_PARAM_COLOR] = sizeof(ps_rgb),
        [PS_PARAM_STRING] = sizeof(char *),
        [PS_PARAM_CHOICE] = sizeof(int32_t),
        [PS_PARAM_NUMBER_OR_CHOICE] = sizeof(ps_number_or_choice),
    };
    return type < sizeof sizes / sizeof sizes[0] ? sizes[type] : 0;
}

static bool check_table(const ps_descriptor *descriptor, struct error *error)
{
    const struct table_rule *rule = &table_rules[descriptor->kind];
    const uint32_t *leading_size = descriptor->vtable;
    if (!leading_size || *leading_size < rule->first_size)
        return reject(error, "its table of functions is too small");
    for (int i = 0; i < 2 && rule->required[i]; i++) {
        void (*function)(void);
        memcpy(&function, (const char *)descriptor->vtable + rule->required[i], sizeof function);
        if (!function)
            return reject(error, "its table of functions lacks one");
    }
    return true;
}

static bool check_param(const ps_param *row, uint64_t state_size, struct error *error)
{
    size_t size = member_size(row->type);
    if (!row->name || !row->help || !row->unit || size == 0)
        return reject(error, "a parameter has no name, help, unit or known type");
    if (row->offset > state_size || state_size - row->offset < size || row->offset % 4 != 0)
        return reject(error, "a parameter lies outside of its state");
    if (!(row->minimum <= row->maximum))
        return reject(error, "a parameter's range is empty");
    bool wants_choices = row->type == PS_PARAM_CHOICE || row->type == PS_PARAM_NUMBER_OR_CHOICE;
    if (wants_choices != (row->choices != NULL))
        return reject(error, "a parameter's choices do not fit its type");
    return true;
}

static const ps_param *row_at(const ps_descriptor *descriptor, uint32_t i)
{
    const char *row = (const char *)descriptor->params + (size_t)i * descriptor->param_size;
    return (const ps_param *)(const void *)row;
}

static bool check_params(const ps_descriptor *descriptor, struct error *error)
{
    for (uint32_t i = 0; i < descriptor->param_count; i++) {
        const ps_param *row = row_at(descriptor, i);
        if (!check_param(row, descriptor->state_size, error))
            return false;
        for (uint32_t j = 0; j < i; j++)
            if (strcmp(row->name, row_at(descriptor, j)->name) == 0)
                return reject(error, "two of its parameters have the same name");
    }
    return true;
}

static bool check_descriptor(const ps_descriptor *descriptor, struct error *error)
{
    if (!descriptor || descriptor->size < FIRST_SIZE(ps_descriptor, vtable))
        return reject(error, "its descriptor is too small");
    if (descriptor->kind >= PS_KINDS)
        return reject(error, "its descriptor is of an unknown kind");
    if (!descriptor->name || !descriptor->version || !descriptor->summary || !descriptor->paper)
        return reject(error, "its descriptor lacks a name, version, summary or paper");
    if (!check_table(descriptor, error))
        return false;
    if (descriptor->param_count && !descriptor->params)
        return reject(error, "its parameter table is missing");
    if (descriptor->param_count && descriptor->param_size < FIRST_SIZE(ps_param, help))
        return reject(error, "its parameter rows are too small");
    return check_params(descriptor, error);
}

bool module_check(const ps_module *module, struct error *error)
{
    if (module->magic != PS_MODULE_MAGIC)
        return reject(error, "psplat_module_v1 does not begin with the magic number");
    if (module->abi_major != PS_ABI_MAJOR || module->abi_minor > PS_ABI_MINOR) {
        error_set(error, PS_ERROR_INVALID,
                  "it was built for plugin interface %u.%u, this psplat has %u.%u",
                  (unsigned)module->abi_major, (unsigned)module->abi_minor, PS_ABI_MAJOR,
                  PS_ABI_MINOR);
        return false;
    }
    if (module->fingerprint != PS_LAYOUT_FINGERPRINT)
        return reject(error, "its structs are laid out otherwise (another compiler or flags?)");
    if (module->size < FIRST_SIZE(ps_module, descriptors) || module->descriptor_count == 0 ||
        !module->descriptors)
        return reject(error, "it describes no strategy");
    for (uint32_t i = 0; i < module->descriptor_count; i++)
        if (!check_descriptor(module->descriptors[i], error))
            return false;
    return true;
}
