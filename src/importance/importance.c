#include "importance/importance.h"

#include "importance/pilot.h"
#include "importance/portal_search.h"
#include "scene/scene.h"
#include <math.h>
#include <stdlib.h>

/* Lights that lie together side by side; suns, skies and dark lights at the end. */
static void order_lights(const struct scene *scene, uint32_t *order, bool *listed)
{
    size_t count = light_bvh_list(scene->light_bvh, order);
    for (size_t i = 0; i < count; i++)
        listed[order[i]] = true;
    for (uint32_t i = 0; i < scene->light_count; i++)
        if (!listed[i])
            order[count++] = i;
}

/* What sharing needs of each light. */
struct sharing {
    struct found_light *found;
    uint32_t *order;
    float *powers, *shares;
    bool *listed;
};

static void release_sharing(struct sharing *sharing)
{
    free(sharing->found);
    free(sharing->order);
    free(sharing->powers);
    free(sharing->shares);
    free(sharing->listed);
}

/* The radius over the root mean square of the distances from the middle. Of a room that is seen all
 * around from within, 1.4 holds everything; but the light of an open place comes from farther than
 * what is seen of it. */
#define SPREADS 4.0

static void bound_seen(const struct scene *scene, const struct seen_places *seen,
                       struct importance *importance)
{
    double radius = SPREADS * seen->spread;
    if (!(radius > 0.0 && radius < (double)scene->radius))
        return;
    importance->center = seen->middle;
    importance->radius = (float)radius;
}

/* Lights that share the light paths. */
#define FEWEST_SHARED 2

/* Below, it costs little to ask all lights. */
#define FEWEST_LIGHTS 4

/* The threshold over the irradiance that the camera sees. A light that is drawn below it counts for
 * as much. */
#define THRESHOLD 0.02

bool importance_is_for_pixels(const struct scene *scene)
{
    return importance_has_threshold(scene) || scene_has_sky(scene);
}

bool importance_has_threshold(const struct scene *scene)
{
    size_t count = light_bvh_count(scene->light_bvh);
    return count >= FEWEST_LIGHTS &&
           (scene_chooses_lights(scene) ||
            (count <= MOST_LIGHT_CHOICES && !scene_has_delta_lamps(scene)));
}

/* A power of two, so that rounding, which differs between processors, hardly ever tells. */
static float threshold_of(double irradiance)
{
    return irradiance > 0.0 ? (float)exp2(floor(log2(THRESHOLD * irradiance))) : 0.0f;
}

static ps_result share_by_pilot(const ps_host *host, const ps_pass *pass, const struct scene *scene,
                                struct sharing *sharing, struct importance *importance,
                                struct error *error)
{
    struct seen_places seen;
    ps_result result = pilot_trace(host, pass, scene, sharing->found, &seen, error);
    if (result == PS_OK && scene_has_sky(scene))
        result = portal_search(host, pass, seen.surfaces, seen.count, &importance->portals, error);
    free(seen.surfaces);
    if (result != PS_OK || scene->light_count < FEWEST_SHARED)
        return result;
    bound_seen(scene, &seen, importance);
    if (importance_has_threshold(scene))
        importance->light_threshold = threshold_of(seen.irradiance);
    order_lights(scene, sharing->order, sharing->listed);
    for (size_t i = 0; i < scene->light_count; i++) {
        ps_rgb power = light_power(&scene->lights[i]);
        sharing->powers[i] = power.r + power.g + power.b;
    }
    light_shares(sharing->order, sharing->powers, sharing->found, scene->light_count,
                 sharing->shares);
    return distribution_create(sharing->shares, scene->light_count, &importance->lights, error);
}

ps_result importance_create(const ps_host *host, const ps_pass *pass, const struct scene *scene,
                            struct importance *importance, struct error *error)
{
    size_t count = scene->light_count;
    *importance = (struct importance){.radius = 0.0f};
    if (count < FEWEST_SHARED && !scene_has_sky(scene))
        return PS_OK;
    struct sharing sharing = {
        calloc(count, sizeof *sharing.found),  calloc(count, sizeof *sharing.order),
        calloc(count, sizeof *sharing.powers), calloc(count, sizeof *sharing.shares),
        calloc(count, sizeof *sharing.listed),
    };
    ps_result result =
        sharing.found && sharing.order && sharing.powers && sharing.shares && sharing.listed
            ? share_by_pilot(host, pass, scene, &sharing, importance, error)
            : error_memory(error, count * sizeof *sharing.found, "lights");
    release_sharing(&sharing);
    return result;
}

void importance_release(struct importance *importance)
{
    distribution_release(&importance->lights);
    free(importance->portals);
    *importance = (struct importance){.radius = 0.0f};
}
