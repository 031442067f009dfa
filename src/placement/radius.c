/* radius.c: the radius of a footprint: by paths and passes, by merging, by distance. */
#include "placement/radius.h"

#include <psplat/math.h>

/* The automatic radius for FEW_PATHS, as a fraction of the scene's radius, and at most. With more
 * paths it shrinks less, since short-range light stays as near as it is there: little is left of
 * what splats would blur. */
#define FEW_PATHS 100000
#define BY_SCENE 0.138
#define LARGEST_BY_SCENE 0.25
#define POWER_OF_FEW (-0.25)
#define POWER_OF_MANY (-0.2)

/* The same as a fraction of the spread of the light, and how much of what the scene's radius gives
 * is left where light lands in a point. */
#define BY_SPREAD 0.5
#define LEAST_BY_SPREAD 0.4

/* How far gather rays reach, in radii of that many paths. Farther, they are noisier, and lose more
 * where a pool of light begins at less than that distance and ends beyond. */
#define GATHER_RADII 2.5f

/* A radius that follows the distance stops at this fraction of the largest. Without a floor, light
 * that crosses a corner from very near makes splats so small and bright that they dominate the
 * error. What lights shine on has the sharp edges of their shadows, which large splats blur; what
 * other surfaces light has none. Where light from close by is not splatted, these blur less, and
 * the radius may stop at what it is at that distance. */
#define SMALLEST_LIT_BY_LIGHTS 0.3f
#define SMALLEST_LIT_BY_SURFACES 0.6f

float radius_automatic(float scene_radius, float light_spread, uint64_t paths, uint32_t pass)
{
    double by_scene = BY_SCENE * (double)scene_radius;
    double by_light = light_spread > 0.0f ? BY_SPREAD * (double)light_spread : INFINITY;
    double by_paths = pow((double)(paths > 0 ? paths : 1) / FEW_PATHS,
                          paths < FEW_PATHS ? POWER_OF_FEW : POWER_OF_MANY);
    double radius = fmin(by_scene, fmax(by_light, LEAST_BY_SPREAD * by_scene)) * by_paths;
    return (float)(fmin(radius, LARGEST_BY_SCENE * (double)scene_radius) *
                   pow(pass + 1.0, -1.0 / 6.0));
}

float radius_automatic_gather_distance(float scene_radius, float light_spread, uint64_t paths)
{
    uint64_t few = paths < FEW_PATHS ? paths : FEW_PATHS;
    return GATHER_RADII * radius_automatic(scene_radius, light_spread, few, 0);
}

float radius_gather_distance(const struct placement_scene *scene,
                             const struct footprint_params *settings, uint64_t paths)
{
    if (settings->step_back.choice != STEP_BACK_FULL || !(settings->bandwidth_scale > 0))
        return 0.0f;
    if (!(settings->radius.number > 0))
        return scene->automatic_gather_distance;
    double larger = pow(fmax((double)paths / FEW_PATHS, 1), -POWER_OF_MANY);
    return radius_bounded(scene, (double)GATHER_RADII * larger * settings->radius.number);
}

/* All the way, where shadow rays would not find the light that it sends on: caustics, and what
 * other surfaces lit. */
float radius_blend_distance(const struct placement_scene *scene, const ps_photon *photon)
{
    return photon->bounce == 1 && !photon->specular ? scene->gather_distance : 0.0f;
}

/* A merged photon has the light of many: over as many times the area, a splat is no brighter than
 * theirs, and as many splats overlap as without merging. But larger splats lose light at edges and
 * creases, so there is a limit. */
static float merge_scale(const struct footprint_params *settings, const ps_photon *photon)
{
    if (!(settings->max_merge_scale > 1.0 && photon->merged > 1.0f))
        return 1.0f;
    return ps_min(sqrtf(photon->merged), (float)fmin(settings->max_merge_scale, 1e9));
}

/* Across n pixels, of which every n-th is lit. */
static float size_of_pixels(const struct placement_scene *scene, const ps_photon *photon,
                            float distance)
{
    ps_vec3 lit =
        ps_add_scaled(photon->position, ps_min(distance, 4.0f * scene->radius), photon->direction);
    return (float)scene->interleave * camera_pixel_size(scene->camera, lit);
}

float radius_largest(const struct placement_scene *scene, const struct footprint_params *settings,
                     const ps_photon *photon, const ps_hit *hit)
{
    bool automatic = !(settings->radius.number > 0);
    double single =
        automatic ? scene->automatic_radius : radius_bounded(scene, settings->radius.number);
    float radius = radius_bounded(scene, single * (double)merge_scale(settings, photon));
    if (!automatic || !scene->caustics || photon->bounce > 0 || !(hit->distance < INFINITY))
        return radius;
    float least = size_of_pixels(scene, photon, hit->distance);
    return ps_min(radius, ps_max(least, caustics_radius(scene->caustics, hit->position)));
}

/* Smaller ones than n pixels are noise that averaging them takes back in part. */
float radius_smallest(const struct placement_scene *scene, const ps_photon *photon, float distance,
                      float largest)
{
    float pixels = size_of_pixels(scene, photon, distance);
    bool is_wide = photon->bounce > 1 || radius_blend_distance(scene, photon) > 0.0f;
    float part = is_wide ? SMALLEST_LIT_BY_SURFACES : SMALLEST_LIT_BY_LIGHTS;
    return ps_max(part * largest, ps_min(pixels, largest));
}

float radius_at(const struct placement_scene *scene, const struct footprint_params *settings,
                const ps_photon *photon, float largest, float distance)
{
    if (!(settings->bandwidth_scale > 0))
        return largest;
    return ps_max(ps_min(largest, (float)fmin(settings->bandwidth_scale, 1e9) * distance),
                  radius_smallest(scene, photon, distance, largest));
}
