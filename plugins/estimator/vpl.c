/* vpl.c: instant radiosity: the photons as point lights over their hemispheres.
 *
 * Keller 1997. A photon of power Phi (its direction is ignored) on a diffuse surface has intensity
 * Phi / pi * cos(theta_photon); at distance d it gives
 *
 *     E(p) += Phi / pi * G * V,   G = cos(theta_photon) * cos(theta_receiver) / d^2
 *
 * G has no bound as d goes to 0: bright blotches near the photons. Clamping d removes them, and the
 * light that corners get from close by with them. Without visibility it is splatting indirect
 * illumination (Dachsbacher and Stamminger 2006), and the left half of figure 5 in Hoet 2014.
 *
 * Photons on mirrors and glass shine into one direction and can't be point lights: caustics are left
 * out. They are counted in the statistics.
 *
 * Cost is lights times pixels, so only `lights` photons, drawn at random from all, are used, with
 * the power of all.
 */
#include <psplat/plugin.h>

static const char *const clamp_choices[] = {"auto", NULL};

struct state {
    int64_t lights;
    int32_t visibility;
    ps_number_or_choice clamp;
};

struct work {
    const ps_host *host;
    const ps_pass *pass;
    const ps_photon *lights;
    size_t count;
    float nearest2; /* squared; distances below count as this */
    int visibility;
};

/* Irradiance of a point by a light, were nothing in between; the shadow ray goes from the point. */
static ps_rgb connect(const struct work *work, const ps_photon *light, ps_vec3 position,
                      ps_vec3 normal, ps_ray *ray)
{
    static const ps_rgb nothing = {0, 0, 0};
    float offset = work->pass->surface_offset;
    ps_vec3 from = ps_add_scaled(position, offset, normal);
    ps_vec3 to = ps_add_scaled(light->position, offset, light->normal);
    ps_vec3 between = ps_subtract(to, from);
    float distance2 = ps_dot(between, between), distance = sqrtf(distance2);
    ps_vec3 direction = ps_scale(between, 1.0f / distance);
    float receiver = ps_dot(normal, direction), photon = -ps_dot(light->normal, direction);
    if (!(receiver > 0.0f && photon > 0.0f))
        return nothing;
    *ray = (ps_ray){from, 0.0f, direction, distance};
    float geometry = receiver * photon / fmaxf(distance2, work->nearest2);
    return ps_rgb_scale(light->power, geometry / PS_PI);
}

/* Adds one light to all points of a tile. */
static void add_light(const struct work *work, const ps_photon *light, const ps_points *points,
                      ps_rgb *sums)
{
    ps_ray rays[PS_TILE_PIXELS];
    ps_rgb unshadowed[PS_TILE_PIXELS];
    size_t targets[PS_TILE_PIXELS];
    uint8_t blocked[PS_TILE_PIXELS] = {0};
    size_t count = 0;
    for (size_t i = 0; i < points->count; i++) {
        unshadowed[count] =
            connect(work, light, points->positions[i], points->normals[i], &rays[count]);
        targets[count] = i;
        count += ps_rgb_maximum(unshadowed[count]) > 0.0f;
    }
    if (work->visibility)
        work->host->occluded(work->host, rays, count, blocked);
    for (size_t i = 0; i < count; i++)
        if (!blocked[i])
            sums[targets[i]] = ps_rgb_add(sums[targets[i]], unshadowed[i]);
}

static void light_tile(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct work *work = user;
    ps_tile *tile = work->host->tile(work->host, (uint32_t)index);
    ps_points points;
    ps_rgb sums[PS_TILE_PIXELS] = {{0, 0, 0}};
    ps_collect_points(tile, &points);
    for (size_t i = 0; i < work->count; i++)
        add_light(work, &work->lights[i], &points, sums);
    for (size_t i = 0; i < points.count; i++)
        ps_add_irradiance(tile, points.lanes[i], sums[i]);
}

static int can_be_light(const ps_photon *photon)
{
    return photon->lobe == PS_DIFFUSE;
}

/* Of the photons that can be point lights; the others are counted. */
static double total_power(const ps_photon *photons, size_t n, uint64_t *left_out)
{
    double total = 0;
    for (size_t i = 0; i < n; i++) {
        if (can_be_light(&photons[i]))
            total += ps_luminance(photons[i].power);
        else
            ++*left_out;
    }
    return total;
}

/* Whether the next of `seen` photons enters the sample, and in whose place: every one ends up in it
 * with the same probability, whatever their number (reservoir sampling, Vitter 1985). */
static size_t place_in_sample(const ps_host *host, const ps_pass *pass, uint64_t seen, size_t room)
{
    float numbers[1][4];
    uint64_t index = (uint64_t)pass->number << 40 | seen;
    if (seen < room)
        return (size_t)seen;
    host->samples(host, PS_STREAM_ESTIMATOR, 0, &index, 1, numbers);
    double place = ((double)numbers[0][0] + (double)numbers[0][1] * 0x1p-24) * (double)(seen + 1);
    return place < (double)room ? (size_t)place : room;
}

/* Draws photons from all of the pass, and gives them the power of all. */
static ps_result choose_lights(const struct state *state, const ps_host *host, const ps_pass *pass,
                               ps_photon *lights, size_t *count)
{
    const ps_photon *photons;
    size_t n, room = (size_t)state->lights;
    uint64_t seen = 0, left_out = 0;
    double progress, power = 0;
    ps_result result;
    do {
        result = host->next_photons(host, &photons, &n, &progress);
        for (size_t i = 0; result == PS_OK && i < n; i++) {
            if (!can_be_light(&photons[i]))
                continue;
            size_t place = place_in_sample(host, pass, seen++, room);
            if (place < room)
                lights[place] = photons[i];
        }
        power += result == PS_OK ? total_power(photons, n, &left_out) : 0;
    } while (result == PS_OK && n > 0);
    size_t taken = seen < room ? (size_t)seen : room;
    double share = total_power(lights, taken, &left_out);
    for (size_t i = 0; i < taken && share > 0; i++)
        lights[i].power = ps_rgb_scale(lights[i].power, (float)(power / share));
    host->count(host, "photons left out", (double)left_out);
    *count = taken;
    return result;
}

static float nearest_distance(const struct state *state, const ps_host *host)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    return state->clamp.choice >= 0 ? 0.05f * radius : (float)state->clamp.number;
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    const struct state *state = opaque;
    ps_photon *lights =
        host->allocate(host, (size_t)state->lights * sizeof *lights, "virtual lights");
    if (!lights)
        return PS_ERROR_MEMORY;
    float nearest = nearest_distance(state, host);
    struct work work = {host, pass, lights, 0, nearest * nearest, state->visibility};
    ps_result result = choose_lights(state, host, pass, lights, &work.count);
    if (result == PS_OK)
        result = host->for_each_tile(host, light_tile, &work);
    host->count(host, "virtual lights", (double)work.count);
    host->release(host, lights);
    return result;
}

static const ps_param params[] = {
    PS_INT(struct state, lights, "256", 1, 10000000, "lights",
           "photons used as point lights; they are drawn from all and get the power of all"),
    PS_BOOL(struct state, visibility, "yes", "whether shadow rays decide what a light reaches"),
    PS_NUMBER_OR(struct state, clamp, "auto", 0, INFINITY, 0, clamp_choices, "scene units",
                 "shorter distances count as this; auto: 5 % of the scene's radius; 0: none"),
};

static const ps_estimator_vtable vtable = {.size = sizeof vtable, .accumulate = accumulate};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "vpl",
    .version = "1.0",
    .summary = "instant radiosity: photons as point lights over the hemisphere",
    .paper = "Keller 1997, Instant radiosity",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, vpl, &descriptor)
