/* abusive.c: strategies that do what they must not. ABUSE says what; the estimator otherwise adds
 * one unit of irradiance, the injection makes no photons. */
#include <psplat/plugin.h>
#include <string.h>

#ifndef ABUSE
#define ABUSE ""
#endif

static int does(const char *what)
{
    return strcmp(ABUSE, what) == 0;
}

static const ps_photon lamp = {
    .position = {278, 200, 279},
    .normal = {0, -1, 0},
    .direction = {0, -1, 0},
    .power = {1e6f, 1e6f, 1e6f},
    .bounce = 1,
    .merged = 1,
};

static ps_result init(void *state, const ps_host *host)
{
    const ps_photon *photons;
    size_t n;
    double progress;
    uint32_t x, y;
    uint64_t paths;
    ps_rgb power = {0, 0, 0};
    float written = power.r;
    (void)state;
    if (does("init:tile")) {
        host->tile(host, 0)->irradiance_r[0] = 1;
        host->tile(host, 4000000000u)->radiance_r[255] = 1;
        written = host->tile(host, 0)->depth[0];
    }
    if (does("init:pixel"))
        host->pixel(host, 0, 0, &x, &y);
    if (does("init:tile_of"))
        host->tile_of(host, 0, 0, &x, &y);
    if (does("init:tile_hits")) {
        static ps_ray rays[PS_TILE_PIXELS];
        static ps_hit hits[PS_TILE_PIXELS];
        host->tile_hits(host, 0, rays, hits);
    }
    if (does("init:next_photons"))
        host->next_photons(host, &photons, &n, &progress);
    if (does("init:path_count"))
        host->path_count(host, &paths);
    if (does("init:begin_splats"))
        host->begin_splats(host, 1);
    if (does("init:splat"))
        host->splat(host, &lamp, 1);
    if (does("init:gather_short_range"))
        host->gather_short_range(host, 4);
#if PS_ABI_MINOR >= 2
    if (does("init:begin_points"))
        host->begin_points(host, &lamp.position, &lamp.normal, 1);
    if (does("init:splat_points"))
        host->splat_points(host, &lamp, 1);
    if (does("init:end_points"))
        host->end_points(host, &power);
#endif
#if PS_ABI_MINOR >= 7
    ps_tile seen;
    if (does("init:for_each_picture_tile"))
        host->for_each_picture_tile(host, NULL, NULL);
    if (does("init:tile_surfaces"))
        host->tile_surfaces(host, 0, sizeof seen, &seen);
#endif
    if (does("init:for_each_tile"))
        host->for_each_tile(host, NULL, NULL);
    if (does("init:fail"))
        return host->fail(host, PS_OK, "it does not want to");
    return written < 0 ? PS_ERROR_INVALID : PS_OK;
}

static void nothing(void *user, uint64_t index, uint32_t worker)
{
    (void)user;
    (void)index;
    (void)worker;
}

static void nested(void *user, uint64_t index, uint32_t worker)
{
    const ps_host *host = user;
    (void)index;
    (void)worker;
    host->parallel_for(host, 4, nothing, NULL);
}

static void bad_rays(const ps_host *host)
{
    const ps_ray rays[3] = {{{NAN, 0, 0}, 0, {0, 0, 1}, INFINITY},
                            {{278, 273, -100}, 0, {0, 0, 1}, INFINITY},
                            {{0, 0, 0}, 0, {0, INFINITY, 1}, INFINITY}};
    ps_hit hits[3];
    uint8_t blocked[3];
    _Alignas(64) ps_ray_packet packet;
    host->intersect(host, rays, 3, hits);
#if PS_ABI_MINOR >= 16
    ps_hit mirrors[3];
    host->intersect_specular(host, rays, 3, mirrors);
    for (int i = 0; i < 3; i++)
        if (mirrors[i].distance < INFINITY)
            host->fail(host, PS_ERROR_INVALID, "a mirror where none is");
#endif
    host->occluded(host, rays, 3, blocked);
    for (size_t lane = 0; lane < 16; lane++)
        ps_packet_set(&packet, lane, rays[lane == 7 ? 0 : 1]);
    host->intersect_packets(host, &packet, 1, 1);
    if (hits[0].distance < INFINITY || !(hits[1].distance < INFINITY) ||
        hits[2].distance < INFINITY || blocked[0] || !blocked[1] || blocked[2])
        host->fail(host, PS_ERROR_INVALID, "bad rays met something, or a good one nothing");
}

static ps_result accumulate(void *state, const ps_host *host, const ps_pass *pass)
{
    const ps_photon *photons;
    ps_light light = {.size = sizeof light}, unsized = {.size = 0};
    size_t n;
    double progress;
    ps_ray ray;
    ps_rgb power;
    static const float numbers[1][4] = {{0.5f, 0.5f, 0.5f, 0.5f}};
    (void)state;
    for (uint32_t i = 0; i < pass->tile_count; i++)
        for (uint32_t lane = 0; lane < PS_TILE_PIXELS; lane++)
            ps_add_irradiance(host->tile(host, i), lane, (ps_rgb){1, 1, 1});
    if (does("tile"))
        host->tile(host, pass->tile_count)->irradiance_g[0] = 1;
    if (does("light"))
        host->light(host, 99, &light);
    if (does("size"))
        host->light(host, 0, &unsized);
    if (does("emit_from"))
        host->emit_from(host, 99, numbers, 1, &ray, &power);
#if PS_ABI_MINOR >= 5
    if (does("light_of_object"))
        host->light_of_object(host, 9999);
    if (does("is_shown"))
        host->is_shown(host, 9999);
#endif
#if PS_ABI_MINOR >= 7
    ps_tile seen;
    if (does("tile_surfaces"))
        host->tile_surfaces(host, pass->tile_count, sizeof seen, &seen);
#endif
#if PS_ABI_MINOR >= 6
    static const ps_surface_point no_object = {.object = 9999}, no_triangle = {.triangle = 9999};
    ps_hit hit;
    if (does("surface_points"))
        host->surface_points(host, &no_object, 1, &ray, &hit);
    if (does("surface_triangle"))
        host->surface_points(host, &no_triangle, 1, &ray, &hit);
#endif
    if (does("splat"))
        return host->splat(host, &lamp, 1);
    if (does("gather_short_range"))
        return host->gather_short_range(host, 1);
#if PS_ABI_MINOR >= 2
    if (does("splat_points"))
        return host->splat_points(host, &lamp, 1);
    if (does("end_points"))
        return host->end_points(host, &power);
    if (does("no_points"))
        return host->begin_points(host, &lamp.position, &lamp.normal, 0);
    if (does("begin_twice") || does("points_left"))
        host->begin_points(host, &lamp.position, &lamp.normal, 1);
    if (does("begin_twice"))
        return host->begin_points(host, &lamp.position, &lamp.normal, 1);
#endif
    if (does("nested"))
        host->parallel_for(host, 8, nested, (void *)(uintptr_t)host);
    if (does("keep") &&
        host->allocate(host, 100, "denoiser") == host->allocate(host, 100, "denoiser"))
        return PS_ERROR_MEMORY;
    if (does("rays"))
        bad_rays(host);
    if (does("nan"))
        host->tile(host, 0)->irradiance_b[3] = NAN;
    if (does("negative"))
        host->tile(host, 0)->weight[2] = host->tile(host, 0)->irradiance_r[2] = -1;
    if (does("infinite"))
        host->tile(host, 0)->irradiance_r[2] = INFINITY;
    if (does("fail"))
        return host->fail(host, PS_ERROR_INVALID, "the estimator is out of sorts");
    if (does("fail and go on"))
        host->fail(host, PS_OK, "the estimator is out of sorts");
    if (does("photons"))
        return host->next_photons(host, &photons, &n, &progress);
    return PS_OK;
}

static uint64_t path_count(const void *state)
{
    (void)state;
    return 1000;
}

static ps_result emit(const void *state, const ps_host *host, const ps_pass *pass, uint64_t first,
                      size_t n, const ps_photon_sink *sink)
{
    (void)state;
    (void)pass;
    if (does("emit:fail"))
        return host->fail(host, PS_ERROR_INVALID, "the lamps are out");
    for (size_t i = 0; i < n; i++) {
        ps_photon photon = lamp;
        photon.path = first + i;
        if (does("emit:nan") && i == 7)
            photon.position.x = NAN;
        if (does("emit:direction") && i == 7)
            photon.direction = (ps_vec3){0, 0, 0};
        if (does("emit:negative") && i == 7)
            photon.power.g = -1;
        if (does("emit:infinite") && i == 7)
            photon.power.g = INFINITY;
        ps_result result = sink->append(sink->core, &photon, 1);
        if (result != PS_OK)
            return result;
    }
    return PS_OK;
}

static ps_result stratify(const void *state, const ps_host *host, const ps_pass *pass,
                          ps_photon *photons, size_t n, ps_strata *strata)
{
    (void)state;
    (void)host;
    (void)pass;
    if (does("strata:index"))
        ps_strata_add(strata, n, 0);
    if (does("strata:count"))
        strata->count = n + 1;
    if (does("strata:starts")) {
        ps_strata_add(strata, 0, 0);
        ps_strata_end_at(strata, 5);
    }
    if (does("strata:nan"))
        photons[0].power.r = NAN;
    return PS_OK;
}

static ps_result resolve(const void *state, const ps_host *host, const ps_film_view *film,
                         float *out_r, float *out_g, float *out_b)
{
    (void)state;
    for (uint64_t i = 0; i < film->pixel_count; i++)
        out_r[i] = out_g[i] = out_b[i] = does("resolve:nan") && i % 100 == 0 ? NAN : 0.5f;
    return does("resolve:fail") ? host->fail(host, PS_ERROR_INVALID, "it is not normal") : PS_OK;
}

static ps_result filter(const void *state, const ps_host *host, const ps_image_view *image)
{
    (void)state;
    (void)host;
    if (does("filter:negative"))
        image->g[5] = -1;
    if (does("filter:nan"))
        image->g[5] = NAN;
    return PS_OK;
}

static const ps_estimator_vtable estimator = {
    .size = sizeof estimator, .flags = PS_ESTIMATOR_RADIANCE, .accumulate = accumulate};
static const ps_injection_vtable injection = {
    .size = sizeof injection, .path_count = path_count, .emit = emit};
static const ps_stratification_vtable stratification = {.size = sizeof stratification,
                                                        .stratify = stratify};
static const ps_normalization_vtable normalization = {.size = sizeof normalization,
                                                      .resolve = resolve};
static const ps_denoiser_vtable denoiser = {.size = sizeof denoiser, .filter = filter};

#define DESCRIPTOR(KIND, TABLE, INIT)                                                              \
    {                                                                                              \
        .size = sizeof(ps_descriptor), .kind = KIND, .name = "abusive", .version = "1.0",          \
        .summary = "does what it must not", .paper = "none: a test", .init = INIT,                 \
        .vtable = &TABLE                                                                           \
    }

static const ps_descriptor descriptors[] = {
    DESCRIPTOR(PS_ESTIMATOR, estimator, init), DESCRIPTOR(PS_INJECTION, injection, NULL),
    DESCRIPTOR(PS_STRATIFICATION, stratification, NULL),
    DESCRIPTOR(PS_NORMALIZATION, normalization, NULL), DESCRIPTOR(PS_DENOISER, denoiser, NULL)};
static const ps_descriptor *const list[] = {&descriptors[0], &descriptors[1], &descriptors[2],
                                            &descriptors[3], &descriptors[4]};

extern PS_EXPORT const ps_module psplat_module_v1;
PS_EXPORT const ps_module psplat_module_v1 = {
    .magic = PS_MODULE_MAGIC,
    .abi_major = PS_ABI_MAJOR,
    .abi_minor = PS_ABI_MINOR,
    .fingerprint = PS_LAYOUT_FINGERPRINT,
    .size = sizeof(ps_module),
    .descriptor_count = 5,
    .descriptors = list,
};
