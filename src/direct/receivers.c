#include "direct/receivers.h"

#include "scene/heuristic.h"
#include "scene/light_bvh.h"
#include <psplat/math.h>
#include <string.h>

/* Receivers connected with points of lights, and what each connection is multiplied by. */
struct connections {
    size_t count;
    uint32_t receivers[RECEIVERS_MOST];
    uint32_t lights[RECEIVERS_MOST];
    float weights[RECEIVERS_MOST];
    struct light_sample samples[RECEIVERS_MOST];
};

/* Two of a point's four numbers, or these moved by Roberts's sequence for many lights. */
static void numbers_for_light(const float numbers[4], size_t light, float pair[2])
{
    size_t first = light % 2 * 2, turn = light / 2;
    if (turn == 0) { /* as below, without two calls; few scenes have more lights */
        memcpy(pair, numbers + first, 2 * sizeof *pair);
        return;
    }
    float turns = (float)turn;
    float a = numbers[first] + 0.7548777f * turns, b = numbers[first + 1] + 0.5698403f * turns;
    pair[0] = ps_min(a - floorf(a), 0x1.fffffep-1f);
    pair[1] = ps_min(b - floorf(b), 0x1.fffffep-1f);
}

/* What the receiver makes of irradiance 1 across a beam from `direction`. */
static ps_rgb response(const struct receivers *to, size_t i, ps_vec3 direction, float light_pdf)
{
    float cosine = ps_max(ps_dot(direction, to->normals[i]), 0.0f);
    if (!to->hits)
        return (ps_rgb){cosine, cosine, cosine};
    const ps_hit *hit = &to->hits[i];
    if (!(ps_dot(direction, hit->geometric_normal) > 0.0f))
        return (ps_rgb){0, 0, 0};
    ps_rgb reflected = ps_rgb_scale(hit->albedo, cosine / PS_PI);
    if (!(hit->flags & PS_HIT_SPECULAR))
        return reflected;
    return ps_rgb_add(reflected, material_gloss(&to->lighting->scene->materials[hit->material],
                                                to->lighting->scene->microfacets, &to->rays[i], hit,
                                                direction, light_pdf));
}

/* Whether the densities of a receiver's samples matter. */
static bool is_glossy(const struct receivers *to, size_t i)
{
    return to->hits && (to->hits[i].flags & PS_HIT_SPECULAR);
}

/* The normal of a receiver to which light counts by the cosine alone; 0 for others. */
static ps_vec3 normal_of_diffuse(const struct receivers *to, size_t i)
{
    return is_glossy(to, i) ? (ps_vec3){0, 0, 0} : to->normals[i];
}

/* Where a receiver's shadow rays begin. */
static ps_vec3 origin_of(const struct receivers *to, size_t i)
{
    ps_vec3 away = to->hits ? to->hits[i].geometric_normal : to->normals[i];
    return ps_add_scaled(to->positions[i], to->lighting->scene->surface_offset, away);
}

/* --- shadow rays --- */

/* The shadow ray from a receiver to a point of a light, and what arrives where nothing is in the
 * way. */
static ps_rgb connect(const struct receivers *to, size_t i, const struct light_sample *sample,
                      ps_ray *ray)
{
    if (!(ps_rgb_maximum(sample->weight) > 0.0f &&
          ps_dot(sample->direction, to->normals[i]) > 0.0f))
        return (ps_rgb){0, 0, 0};
    /* A light may lie on a surface, which must not shadow it. */
    float radius = ps_max(sample->distance - to->lighting->scene->surface_offset, 0.0f);
    *ray = (ps_ray){origin_of(to, i), 0.0f, sample->direction, radius};
    return ps_rgb_multiply(sample->weight, response(to, i, sample->direction, sample->pdf));
}

/* Whether light gets along each of n shadow rays: 0 or 1. */
static void trace_lit(const struct lighting *lighting, const ps_ray *rays, size_t n, float *lit)
{
    uint8_t blocked[RECEIVERS_MOST];
    if (n == 0)
        return;
    trace_occluded(lighting->trace, rays, n, blocked);
    for (size_t i = 0; i < n; i++)
        lit[i] = blocked[i] ? 0.0f : 1.0f;
}

/* The share of the light that gets along each connection, by rays, or by the maps of lights that
 * have them. */
static void find_lit(const struct receivers *to, const struct connections *open, const ps_ray *rays,
                     float *lit)
{
    const struct lighting *lighting = to->lighting;
    size_t places[RECEIVERS_MOST], count = 0;
    ps_ray without_map[RECEIVERS_MOST];
    float traced[RECEIVERS_MOST];
    if (!lighting->maps) {
        trace_lit(lighting, rays, open->count, lit);
        return;
    }
    for (size_t i = 0; i < open->count; i++) {
        if (shadow_maps_hold(lighting->maps, open->lights[i])) {
            ps_vec3 normal = to->normals[open->receivers[i]];
            lit[i] = shadow_maps_lit(lighting->maps, open->lights[i], rays[i].origin, normal);
        } else {
            without_map[count] = rays[i];
            places[count++] = i;
        }
    }
    trace_lit(lighting, without_map, count, traced);
    for (size_t i = 0; i < count; i++)
        lit[places[i]] = traced[i];
}

/* Traces the connections, adds what they bring and forgets them. Those that bring nothing have no
 * shadow ray. */
static void trace_connections(const struct receivers *to, struct connections *connections,
                              ps_rgb *sums)
{
    ps_ray rays[RECEIVERS_MOST];
    ps_rgb unshadowed[RECEIVERS_MOST];
    float lit[RECEIVERS_MOST];
    size_t open = 0;
    for (size_t i = 0; i < connections->count; i++) {
        uint32_t receiver = connections->receivers[i];
        ps_rgb whole = connect(to, receiver, &connections->samples[i], &rays[open]);
        unshadowed[open] = ps_rgb_scale(whole, connections->weights[i]);
        connections->receivers[open] = receiver;
        connections->lights[open] = connections->lights[i];
        open += ps_rgb_maximum(whole) > 0.0f;
    }
    connections->count = open;
    find_lit(to, connections, rays, lit);
    for (size_t i = 0; i < open; i++) {
        uint32_t receiver = connections->receivers[i];
        ps_rgb light = ps_rgb_scale(unshadowed[i], lit[i]);
        sums[receiver] = ps_rgb_add(sums[receiver], light);
        if (to->hard && scene_light_casts_hard_shadows(to->lighting->scene, connections->lights[i]))
            to->hard[receiver] = ps_rgb_add(to->hard[receiver], light);
        if (to->occlusion)
            to->occlusion[receiver] |= gbuffer_occlusion(connections->lights[i], lit[i]);
    }
    connections->count = 0;
}

/* --- connections --- */

static void pair_of(const struct receivers *to, size_t i, size_t number, float pair[2])
{
    pair[0] = pair[1] = 0.0f;
    if (to->numbers)
        numbers_for_light(to->numbers[i], number, pair);
}

/* Some receivers of a batch. */
struct chosen {
    size_t count;
    uint32_t receivers[RECEIVERS_MOST];
};

/* Samples a light from points: the sky through the portals, where there are any. */
static void look_at_light(const struct receivers *to, size_t index, const ps_vec3 *origins,
                          const ps_vec3 *normals, const float (*pairs)[2], size_t n,
                          struct light_sample *samples)
{
    const struct lighting *lighting = to->lighting;
    const struct light *light = &lighting->scene->lights[index];
    if (lighting->portals && light->emitter == EMITTER_SKY)
        portals_sample(lighting->portals, light, origins, normals, pairs, n, samples);
    else
        light_sample(light, origins, normals, pairs, n, samples);
}

/* Each of these samples a light once. */
static void sample_light(const struct receivers *to, const struct chosen *by, size_t light,
                         ps_rgb *sums)
{
    struct connections connections;
    ps_vec3 normals[RECEIVERS_MOST], origins[RECEIVERS_MOST];
    float pairs[RECEIVERS_MOST][2];
    for (size_t k = 0; k < by->count; k++) {
        uint32_t i = by->receivers[k];
        origins[k] = origin_of(to, i);
        normals[k] = normal_of_diffuse(to, i);
        pair_of(to, i, light, pairs[k]);
        connections.receivers[k] = i;
        connections.lights[k] = (uint32_t)light;
        connections.weights[k] = 1.0f;
    }
    connections.count = by->count;
    look_at_light(to, light, origins, normals, (const float(*)[2])pairs, by->count,
                  connections.samples);
    trace_connections(to, &connections, sums);
}

/* A receiver samples a light that it drew, number `number` of those. `expected`: how often it draws
 * it in the mean. */
static void add_connection(const struct receivers *to, size_t i, size_t number,
                           const struct light_choice *choice, float expected,
                           struct connections *connections, ps_rgb *sums)
{
    const struct light *light = &to->lighting->scene->lights[choice->light];
    struct light_sample *sample = &connections->samples[connections->count];
    ps_vec3 origin = origin_of(to, i);
    float pair[1][2];
    pair_of(to, i, number, pair[0]);
    if (choice->triangle == WHOLE_LIGHT)
        light_sample(light, &origin, NULL, (const float(*)[2])pair, 1, sample);
    else
        light_sample_triangle(light, choice->triangle, origin, pair[0], sample);
    sample->pdf *= expected;
    connections->receivers[connections->count] = (uint32_t)i;
    connections->lights[connections->count] = choice->light;
    connections->weights[connections->count++] = choice->weight;
    if (connections->count == RECEIVERS_MOST)
        trace_connections(to, connections, sums);
}

/* Of a light that is split each of these samples one triangle. */
static void sample_triangles(const struct receivers *to, const struct chosen *by, size_t light,
                             ps_rgb *sums)
{
    const struct scene *scene = to->lighting->scene;
    struct connections connections = {.count = 0};
    for (size_t k = 0; k < by->count; k++) {
        struct light_choice choice;
        uint32_t i = by->receivers[k];
        double turned = to->choices[i] + 0.6180339887498949 * (double)light;
        if (light_bvh_choose_triangle(scene->light_bvh, light, to->positions[i], to->normals[i],
                                      turned - floor(turned), &choice))
            add_connection(to, i, light, &choice, 1.0f, &connections, sums);
    }
    trace_connections(to, &connections, sums);
}

_Static_assert(RECEIVERS_MOST >= MOST_LIGHT_CHOICES, "room for what one receiver draws");

/* What some receivers have drawn. */
struct drawn_lights {
    struct light_choice choices[RECEIVERS_MOST];
    size_t counts[RECEIVERS_MOST];
};

static bool asks_all(const struct lighting *lighting)
{
    return !light_bvh_is_chosen_from(lighting->scene->light_bvh, lighting->choices);
}

static struct light_draws draws_of(const struct lighting *lighting)
{
    bool all = asks_all(lighting);
    size_t count = light_bvh_count(lighting->scene->light_bvh);
    uint32_t most = all ? (uint32_t)count : lighting->choices;
    return (struct light_draws){most, all, lighting->light_threshold};
}

/* Traces what receivers `first` to before `end` have drawn: of each the first one, then of each the
 * second one, and so on. Draws come in the order of the tree, so these shadow rays go much the same
 * way. */
static void trace_drawn(const struct receivers *to, size_t first, size_t end,
                        const struct light_draws *draws, const struct drawn_lights *drawn,
                        ps_rgb *sums)
{
    const struct light_bvh *bvh = to->lighting->scene->light_bvh;
    struct connections connections = {.count = 0};
    for (size_t k = 0; k < draws->most; k++)
        for (size_t i = first; i < end; i++) {
            if (k >= drawn->counts[i - first])
                continue;
            const struct light_choice *choice = &drawn->choices[(i - first) * draws->most + k];
            float expected = is_glossy(to, i)
                                 ? light_bvh_expected(bvh, choice->light, origin_of(to, i), draws)
                                 : 1.0f;
            add_connection(to, i, k, choice, expected, &connections, sums);
        }
    trace_connections(to, &connections, sums);
}

static bool asks_for(const struct receivers *to, size_t i, ps_light_group group)
{
    return !to->groups || to->groups[i] & group;
}

/* All receivers sample lights that they draw; lists those that ask all lights instead. */
static void sample_some(const struct receivers *to, struct chosen *ask, ps_rgb *sums)
{
    const struct light_bvh *bvh = to->lighting->scene->light_bvh;
    struct light_draws draws = draws_of(to->lighting);
    struct drawn_lights drawn;
    size_t together = RECEIVERS_MOST / draws.most, end;
    for (size_t first = 0; first < to->n; first = end) {
        end = first + together < to->n ? first + together : to->n;
        for (size_t i = first; i < end; i++) {
            size_t *count = &drawn.counts[i - first];
            *count = 0;
            if (!asks_for(to, i, PS_LIGHTS_OTHERS))
                continue;
            *count = light_bvh_choose(bvh, to->positions[i], to->normals[i], &draws, to->choices[i],
                                      drawn.choices + (i - first) * draws.most);
            if (*count == LIGHT_BVH_ALL) {
                ask->receivers[ask->count++] = (uint32_t)i;
                *count = 0;
            }
        }
        trace_drawn(to, first, end, &draws, &drawn, sums);
    }
}

static struct chosen all_that_ask_for(const struct receivers *to, ps_light_group group)
{
    struct chosen all = {.count = 0};
    for (uint32_t i = 0; i < to->n; i++)
        if (asks_for(to, i, group))
            all.receivers[all.count++] = i;
    return all;
}

/* Whether some points draw lights. */
static bool draws_some(const struct lighting *lighting)
{
    return !asks_all(lighting) || lighting->light_threshold > 0.0f;
}

bool receivers_need_choices(const struct lighting *lighting)
{
    return lighting->scene->has_split_lights || draws_some(lighting);
}

void receivers_add_lights(const struct receivers *to, ps_rgb *sums)
{
    const struct scene *scene = to->lighting->scene;
    struct chosen of_soft = all_that_ask_for(to, PS_LIGHTS_SOFT);
    struct chosen of_others = all_that_ask_for(to, PS_LIGHTS_OTHERS), some = {.count = 0};
    const struct chosen *ask = &of_others;
    if (draws_some(to->lighting)) {
        sample_some(to, &some, sums);
        ask = &some;
    }
    bool all_lights = ask->count > 0; /* else suns and skies alone: there may be a million others */
    size_t count = all_lights ? scene->light_count : scene->afar_count;
    for (size_t i = 0; i < count; i++) {
        size_t light = all_lights ? i : scene->afar[i];
        const struct chosen *by = light_is_soft(&scene->lights[light])   ? &of_soft
                                  : light_is_afar(&scene->lights[light]) ? &of_others
                                                                         : ask;
        if (light_bvh_is_split(scene->light_bvh, light))
            sample_triangles(to, by, light, sums);
        else
            sample_light(to, by, light, sums);
    }
}

float receivers_light_pdf(const struct lighting *lighting, size_t light, ps_vec3 origin,
                          ps_vec3 direction, float distance, ps_vec3 normal)
{
    const struct scene *scene = lighting->scene;
    float pdf = light_pdf(&scene->lights[light], origin, direction, distance, normal);
    struct light_draws draws = draws_of(lighting);
    return draws_some(lighting) && !light_is_afar(&scene->lights[light])
               ? pdf * light_bvh_expected(scene->light_bvh, light, origin, &draws)
               : pdf;
}
