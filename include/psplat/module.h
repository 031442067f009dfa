/* module.h: what a plugin exports.
 *
 * A module is a shared object with one data symbol, `psplat_module_v1`, a ps_module. The loader
 * judges magic, version and layout before it calls any of the module's functions. A module holds
 * one or more descriptors; psplat's own modules hold one each: one strategy, one file, one shared
 * object.
 *
 *     #include <psplat/plugin.h>
 *     struct state { double sharpness; };
 *     static void weigh(const void *state, const float *r2, float *w, size_t n) { ... }
 *     static const ps_param params[] = {
 *         PS_NUMBER(struct state, sharpness, "1", 0, 10, 0, "", "..."),
 *     };
 *     static const ps_filter_vtable vtable = {.size = sizeof vtable, .weigh = weigh};
 *     static const ps_descriptor descriptor = { ... };
 *     PS_MODULE(filter, mine, &descriptor)
 *
 * Versions. A psplat loads modules that were built for its own major version and for no later minor
 * one. Within a major version:
 *   - structs that begin with their size grow at their end alone. psplat takes a smaller one of a
 *     module's as if the members that it lacks were 0; a module finds at the front of psplat's what
 *     it knows of.
 *   - structs that cross in arrays (those of the fingerprint below, and what they hold) do not
 *     change.
 *   - no member changes its meaning, and none is taken away.
 */
#ifndef PSPLAT_MODULE_H
#define PSPLAT_MODULE_H

#include <psplat/host.h>
#include <psplat/param.h>
#include <psplat/types.h>

#define PS_MODULE_MAGIC UINT64_C(0x3154414c50535030) /* "0PSPLAT1" */
#define PS_ABI_MAJOR 1u
#define PS_ABI_MINOR 17u

/* Kinds of strategy, in pipeline order. */
typedef enum ps_kind {
    PS_INJECTION = 0,
    PS_STRATIFICATION = 1,
    PS_VISIBILITY = 2,
    PS_FILTER = 3,
    PS_ESTIMATOR = 4,
    PS_NORMALIZATION = 5,
    PS_DENOISER = 6,
    PS_BLOOM = 7,   /* since 1.5 */
    PS_TONEMAP = 8, /* since 1.5 */
    PS_KINDS = 9
} ps_kind;

/* A checksum of the sizes of what crosses in arrays; it differs where a compiler or a flag laid out
 * the structs otherwise. */
#define PS_LAYOUT_FINGERPRINT                                                                      \
    ((uint64_t)sizeof(void *) | (uint64_t)sizeof(ps_photon) << 8 |                                 \
     (uint64_t)sizeof(ps_hit) << 16 | (uint64_t)sizeof(ps_ray) << 24 |                             \
     (uint64_t)sizeof(ps_bundle) << 32 | (uint64_t)sizeof(ps_bsdf_sample) << 40 |                  \
     (uint64_t)sizeof(ps_light_sample) << 48 | (uint64_t)sizeof(ps_triangle) << 56)

typedef struct ps_descriptor {
    uint32_t size;    /* sizeof(ps_descriptor) as the plugin was built */
    uint32_t kind;    /* ps_kind */
    const char *name; /* lower case, what --plugin and scene files say */
    const char *version;
    const char *summary; /* one line */
    const char *paper;   /* the publication the method comes from */
    const ps_param *params;
    uint32_t param_count;
    uint32_t param_size; /* sizeof(ps_param) as the plugin was built */
    /* Bytes of state that the core allocates, zeroed, and fills from `params`. */
    uint64_t state_size;

    /* Checks what no table can, and prepares what follows from the parameters. Main thread,
     * once, before any other callback and before the first pass: the host's ray queries,
     * samples, lights, bounds, camera and memory are there, its tiles, photons, splats and
     * progress not yet. The state is const afterwards, except to an injection's prepare and to
     * an estimator. May be NULL. */
    ps_result (*init)(void *state, const ps_host *host);

    /* Frees what init took. Main thread, once, only after a successful init. May be NULL. */
    void (*destroy)(void *state, const ps_host *host);

    const void *vtable; /* of the kind: ps_injection_vtable, ... */
} ps_descriptor;

typedef struct ps_module {
    uint64_t magic;
    uint32_t abi_major; /* must be equal */
    uint32_t abi_minor; /* at most the host's */
    uint64_t fingerprint;
    uint32_t size; /* sizeof(ps_module) as the plugin was built */
    uint32_t descriptor_count;
    const ps_descriptor *const *descriptors;
} ps_module;

#if defined(_WIN32)
#define PS_EXPORT __declspec(dllexport)
#elif defined(__GNUC__)
#define PS_EXPORT __attribute__((visibility("default")))
#else
#define PS_EXPORT
#endif

/* With PS_STATIC_MODULES each module gets a name of its own, so that all can be linked into one
 * program (for sanitizers and fuzzing). */
#ifdef PS_STATIC_MODULES
#define PS_MODULE_SYMBOL(kind_name, module_name) psplat_module_v1_##kind_name##_##module_name
#else
#define PS_MODULE_SYMBOL(kind_name, module_name) psplat_module_v1
#endif

#define PS_MODULE(kind_name, module_name, descriptor_pointer)                                      \
    extern PS_EXPORT const ps_module PS_MODULE_SYMBOL(kind_name, module_name);                     \
    static const ps_descriptor *const ps_module_descriptors[] = {descriptor_pointer};              \
    PS_EXPORT const ps_module PS_MODULE_SYMBOL(kind_name, module_name) = {                         \
        .magic = PS_MODULE_MAGIC,                                                                  \
        .abi_major = PS_ABI_MAJOR,                                                                 \
        .abi_minor = PS_ABI_MINOR,                                                                 \
        .fingerprint = PS_LAYOUT_FINGERPRINT,                                                      \
        .size = sizeof(ps_module),                                                                 \
        .descriptor_count = 1,                                                                     \
        .descriptors = ps_module_descriptors,                                                      \
    };

#endif
