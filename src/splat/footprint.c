#include "splat/footprint.h"

#include "base/sample.h"
#include <psplat/math.h>

/* Automatic size for FEW_PATHS, as a fraction of the scene's radius, and at most. With more paths splats shrink
 * less, since short-range light stays as near as it is there: little is left of what they would blur. */
#define FEW_PATHS 100000
#define AUTOMATIC_SIZE 0.138
#define LARGEST_AUTOMATIC_SIZE 0.25
#define POWER_OF_FEW (-0.25)
#define POWER_OF_MANY (-0.2)

/* How far gather rays reach, in sizes of that many paths. Farther, they are noisier, and lose more where a pool of
 * light begins at less than that distance and ends beyond: at 3 sizes `plate` has 2.0 % of error for 1.7. */
#define NEAR_IN_SIZES 2.5f

/* The same as a fraction of the spread of the light, and how much of what the scene's radius gives is left
 * where light lands in a point. */
#define SIZE_BY_SPREAD 0.5
#define LEAST_BY_SPREAD 0.4

/* A size that follows the distance stops at this fraction of `size`. Without a floor, light that
 * crosses a corner from very near makes splats so small and bright that they dominate the error: at a fifth,
 * a tenth of the Cornell box's pixels hold two thirds of its variance. What lights shine on has the sharp
 * edges of their shadows, which wide splats blur; what other surfaces light has none. Where light from close
 * by is not splatted, these blur less, and the size may stop at what it is at that distance. */
#define SMALLEST_LIT_BY_LAMPS 0.3f
#define SMALLEST_LIT_BY_SURFACES 0.6f

float footprint_automatic_size(float scene_radius, float light_spread, uint64_t paths,
                               uint32_t pass)
{
    double by_scene = AUTOMATIC_SIZE * (double)scene_radius;
    double by_light = light_spread > 0.0f ? SIZE_BY_SPREAD * (double)light_spread : INFINITY;
    double by_paths = pow((double)(paths > 0 ? paths : 1) / FEW_PATHS,
                          paths < FEW_PATHS ? POWER_OF_FEW : POWER_OF_MANY);
    double size = fmin(by_scene, fmax(by_light, LEAST_BY_SPREAD * by_scene)) * by_paths;
    return (float)(fmin(size, LARGEST_AUTOMATIC_SIZE * (double)scene_radius) *
                   pow(pass + 1.0, -1.0 / 6.0));
}

float footprint_automatic_near(float scene_radius, float light_spread, uint64_t paths)
{
    uint64_t few = paths < FEW_PATHS ? paths : FEW_PATHS;
    return NEAR_IN_SIZES * footprint_automatic_size(scene_radius, light_spread, few, 0);
}

/* The axes u, v turn by an angle of their own for each photon, so that texel borders don't line up.
 */
static void set_frame(const struct footprint_scene *scene, const ps_photon *photon,
                      struct splat *splat)
{
    ps_vec3 u, v;
    ps_frame(photon->direction, &u, &v);
    uint32_t key = sample_key(scene->seed, PS_STREAM_SPLAT, photon->bounce);
    float turn = (float)(sample_hash((uint64_t)key << 32 ^ photon->path) >> 8) * 0x1p-24f;
    float c = cosf(2.0f * PS_PI * turn), s = sinf(2.0f * PS_PI * turn);
    splat->bundle.axis_u = ps_add_scaled(ps_scale(u, c), s, v);
    splat->bundle.axis_v = ps_add_scaled(ps_scale(v, c), -s, u);
    splat->bundle.axis_w = photon->direction;
}

static float slope_of(float cosine)
{
    float c = ps_max(cosine, 1e-4f);
    return ps_min(sqrtf(ps_max(1.0f - c * c, 0.0f)) / c, FOOTPRINT_STEEPEST);
}

/* A full bundle starts this far above the photon's tangent plane, as a fraction of the half-width: surfaces
 * are not quite flat, and hollow ones rise above their tangent plane, by R^2 / 2r at the bundle's edge, and
 * must not block their own light. The bundle passes what lies lower, so that a room full of chairs comes
 * out 3 % too bright where all surfaces are taken for hollow. */
#define CLEARANCE 0.03125f
#define HOLLOW_CLEARANCE 0.125f

float footprint_clearance(float surface_offset, float half_width, bool hollow)
{
    return ps_max(surface_offset, (hollow ? HOLLOW_CLEARANCE : CLEARANCE) * half_width);
}

#define GRAZING_COSINE 0.015625f

float footprint_cosine(const ps_photon *photon)
{
    return ps_max(ps_dot(photon->normal, photon->direction), GRAZING_COSINE);
}

void footprint_start(const ps_photon *photon, float clearance, struct splat *splat)
{
    float cosine = footprint_cosine(photon);
    splat->bundle.start_depth =
        splat->photon_depth + ps_min(clearance / cosine, -0.5f * splat->photon_depth);
}

static float step_back(const struct footprint_params *settings, float half_width, float distance,
                       float slope)
{
    float wanted = settings->step_back.choice < 0 ? (float)fmin(settings->step_back.number, 1e9)
                                                  : half_width * slope + 0.5f * half_width;
    return ps_min(wanted, distance);
}

/* A length from the settings as a float that the ray tracer can bear: past the scene is nothing. */
static float bounded(const struct footprint_scene *scene, double length)
{
    return (float)fmin(length, 4.0 * (double)scene->radius);
}

/* A merged photon has the light of many: over as many times the area, a splat is no brighter than
 * theirs, and as many splats overlap as without merging. But larger splats lose light at edges and
 * creases, so there is a limit. */
static float growth(const struct footprint_params *settings, const ps_photon *photon)
{
    if (!(settings->max_merge_scale > 1.0 && photon->merged > 1.0f))
        return 1.0f;
    return ps_min(sqrtf(photon->merged), (float)fmin(settings->max_merge_scale, 1e9));
}

/* From which distance on a splat gives all of its light. All the way, where shadow rays would not find the light
 * that it sends on: caustics, and what other surfaces lit. */
static float blend_distance(const struct footprint_scene *scene, const ps_photon *photon)
{
    return photon->bounce == 1 && !photon->specular ? scene->gather_distance : 0.0f;
}

/* What a size that follows the distance may not fall below. Smaller ones than n pixels, of which every
 * n-th is lit, are noise that averaging them takes back in part. */
static float smallest(const struct footprint_scene *scene, const ps_photon *photon, float distance,
                      float size)
{
    ps_vec3 lit =
        ps_add_scaled(photon->position, ps_min(distance, 4.0f * scene->radius), photon->direction);
    float pixels = (float)scene->interleave * camera_pixel_size(scene->camera, lit);
    bool wide = photon->bounce > 1 || blend_distance(scene, photon) > 0.0f;
    float part = wide ? SMALLEST_LIT_BY_SURFACES : SMALLEST_LIT_BY_LAMPS;
    return ps_max(part * size, ps_min(pixels, size));
}

/* Half-width where nothing was merged and no distance is followed. */
static float footprint_size(const struct footprint_scene *scene,
                            const struct footprint_params *settings)
{
    return settings->radius.number > 0 ? bounded(scene, settings->radius.number)
                                       : scene->automatic_size;
}

float footprint_widest(const struct footprint_scene *scene, const struct footprint_params *settings,
                       const ps_photon *photon)
{
    double size = footprint_size(scene, settings);
    return bounded(scene, size * (double)growth(settings, photon));
}

float footprint_gather_distance(const struct footprint_scene *scene,
                                const struct footprint_params *settings, uint64_t paths)
{
    if (settings->step_back.choice != STEP_BACK_FULL || !(settings->bandwidth_scale > 0))
        return 0.0f;
    if (!(settings->radius.number > 0))
        return scene->automatic_near;
    double wider = pow(fmax((double)paths / FEW_PATHS, 1), -POWER_OF_MANY);
    return bounded(scene, (double)NEAR_IN_SIZES * wider * settings->radius.number);
}

float footprint_half_width(const struct footprint_scene *scene,
                           const struct footprint_params *settings, const ps_photon *photon,
                           float distance)
{
    float size = footprint_widest(scene, settings, photon);
    if (!(settings->bandwidth_scale > 0))
        return size;
    return ps_max(ps_min(size, (float)fmin(settings->bandwidth_scale, 1e9) * distance),
                  smallest(scene, photon, distance, size));
}

void footprint_stand_in(const ps_photon *photon, float distance, ps_hit *hit)
{
    hit->distance = distance;
    hit->position = ps_add_scaled(photon->position, distance, photon->direction);
    hit->normal = (ps_vec3){0, 0, 0};
}

/* Around a bundle that starts at its photon. Pixels with narrow parts of its disc take it from below the
 * start plane (kernel.h), so the box begins at the photon's plane itself. */
static void place_full(const struct footprint_scene *scene, const struct footprint_params *settings,
                       const ps_photon *photon, float distance, struct splat *splat)
{
    float cosine = footprint_cosine(photon);
    splat->bundle.start_slope_u = -ps_dot(photon->normal, splat->bundle.axis_u) / cosine;
    splat->bundle.start_slope_v = -ps_dot(photon->normal, splat->bundle.axis_v) / cosine;
    splat->photon_depth = -distance;
    footprint_start(photon, footprint_clearance(scene->surface_offset, splat->bundle.radius, true),
                    splat);
    float slope = sqrtf(splat->bundle.start_slope_u * splat->bundle.start_slope_u +
                        splat->bundle.start_slope_v * splat->bundle.start_slope_v);
    splat->near_depth = ps_min(splat->photon_depth - slope * splat->bundle.radius, 0.0f);
    splat->follow = (float)fmin(settings->bandwidth_scale, 1e9);
    splat->blend_distance = blend_distance(scene, photon);
    splat->widest = footprint_widest(scene, settings, photon);
    splat->narrowest = smallest(scene, photon, distance, splat->widest);
}

static struct splat place_one(const struct footprint_scene *scene,
                              const struct footprint_params *settings, const ps_photon *photon,
                              const ps_hit *hit, float size)
{
    struct splat splat = {.power = photon->power, .merged = photon->merged, .path = photon->path};
    if (!(size > 0.0f && hit->distance < INFINITY))
        return splat;
    float slope = slope_of(-ps_dot(photon->direction, hit->normal));
    set_frame(scene, photon, &splat);
    splat.bundle.centre = hit->position;
    splat.bundle.radius = size;
    splat.bundle.far_depth =
        settings->depth.number > 0 ? bounded(scene, settings->depth.number) : size * slope + size;
    if (settings->step_back.choice == STEP_BACK_FULL) {
        place_full(scene, settings, photon, hit->distance, &splat);
    } else {
        splat.near_depth = -step_back(settings, size, hit->distance, slope);
        splat.bundle.start_depth = splat.near_depth;
    }
    return splat;
}

void footprint_place(const struct footprint_scene *scene, const struct footprint_params *settings,
                     const ps_photon *photons, const ps_hit *hits, const float *half_widths,
                     size_t n, struct splat *splats)
{
    for (size_t i = 0; i < n; i++)
        splats[i] = place_one(scene, settings, &photons[i], &hits[i], half_widths[i]);
}

void footprint_cut(struct splat *splat, const float *depths, uint32_t resolution)
{
    float farthest = -INFINITY;
    for (uint32_t i = 0; i < resolution * resolution; i++)
        farthest = ps_max(depths[i], farthest);
    float tolerance = splat->bias_constant + splat->bias_slope * FOOTPRINT_STEEPEST;
    splat->bundle.far_depth = ps_min(farthest + tolerance, splat->bundle.far_depth);
}

void footprint_open(const struct footprint_params *settings, struct splat *splats, size_t n)
{
    if (settings->step_back.choice != STEP_BACK_FULL || settings->depth.number > 0)
        return;
    for (size_t i = 0; i < n; i++)
        splats[i].bundle.far_depth = INFINITY;
}

void footprint_set_bias(const struct footprint_params *settings, struct splat *splats, size_t n)
{
    static const float slope_texels = 0.75f;
    static const float flat_texels = 0.1f; /* where the light arrives at a right angle */
    for (size_t i = 0; i < n; i++) {
        float texel = 2.0f * splats[i].bundle.radius / (float)settings->resolution;
        bool by_slope = settings->bias.choice >= 0;
        splats[i].bias_constant =
            by_slope ? flat_texels * texel : (float)fmin(settings->bias.number, 1e9);
        splats[i].bias_slope = by_slope ? slope_texels * texel : 0.0f;
    }
}
