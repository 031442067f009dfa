/* lights.c: what plugins ask of lights; see ps_host.
 *
 * Where there are few, light_sample draws them by power; of many, as the points of pixels and paths
 * do, by the light BVH.
 */
#include "host/host.h"

#include "scene/light_bvh.h"
#include <psplat/math.h>
#include <stdio.h>
#include <string.h>

static const ps_ray nowhere = {{0, 0, 0}, 0, {0, 0, 1}, 0};

/* A ray of a light, moved off what the light may lie on; and where it starts. */
static ps_rgb emit_from(const struct scene *scene, size_t light, const float numbers[4],
                        ps_ray *ray, ps_light_sample *point)
{
    const struct light *from = &scene->lights[light];
    ps_rgb flux = light_emit(from, numbers, ray, &point->normal);
    point->position = ray->origin;
    point->distance = light_is_afar(from) ? INFINITY : 0;
    point->light = (uint32_t)light;
    if (light_is_delta(from))
        ray->tnear = scene->surface_offset; /* a light may lie on a surface */
    ray->origin = ps_add_scaled(ray->origin, scene->surface_offset, point->normal);
    return flux;
}

/* By which light paths choose their lights. */
static const struct distribution *emission_of(const struct render *render)
{
    return render->importance.lights.count > 0 ? &render->importance.lights
                                               : &render->scene->light_choice;
}

/* A ray of one of the lights; black where there is none. */
static ps_rgb emit(const struct render *render, const float numbers[4], ps_ray *ray,
                   ps_light_sample *point)
{
    const struct scene *scene = render->scene;
    const struct distribution *lights = emission_of(render);
    *ray = nowhere;
    *point = (ps_light_sample){.distance = 0};
    if (scene->light_count == 0)
        return (ps_rgb){0, 0, 0};
    float left[4] = {numbers[0], numbers[1], numbers[2], numbers[3]};
    size_t light = distribution_choose(lights, left[2], &left[2]);
    point->probability = distribution_probability(lights, light);
    ps_rgb flux = emit_from(scene, light, left, ray, point);
    return point->probability > 0.0f ? ps_rgb_scale(flux, 1.0f / point->probability)
                                     : (ps_rgb){0, 0, 0};
}

static void host_emit_light(const ps_host *host, const float (*samples)[4], size_t n, ps_ray *rays,
                            ps_rgb *power)
{
    ps_light_sample point;
    for (size_t i = 0; i < n; i++)
        power[i] = emit(render_of(host), samples[i], &rays[i], &point);
}

static void host_emit_points(const ps_host *host, const float (*samples)[4], size_t n, ps_ray *rays,
                             ps_rgb *power, ps_light_sample *points)
{
    for (size_t i = 0; i < n; i++)
        power[i] = emit(render_of(host), samples[i], &rays[i], &points[i]);
}

static uint32_t host_light_count(const ps_host *host)
{
    return (uint32_t)render_of(host)->scene->light_count;
}

/* Whether there is a light of that index. */
static bool has_light(const ps_host *host, uint32_t index, const char *service)
{
    size_t count = render_of(host)->scene->light_count;
    if (index < count)
        return true;
    host_refuse_index(host, service, index, count);
    return false;
}

static void host_light(const ps_host *host, uint32_t index, ps_light *described)
{
    ps_light light = {.kind = PS_LIGHT_POINT, .axis = {0, 0, 1}};
    if (has_light(host, index, "light"))
        light = light_describe(&render_of(host)->scene->lights[index]);
    host_hand_over(host, "light", described, &light, sizeof light);
}

static void host_light_intensity(const ps_host *host, uint32_t index, const ps_vec3 *directions,
                                 size_t n, ps_rgb *intensity)
{
    bool there = has_light(host, index, "light_intensity");
    const struct light *light = there ? &render_of(host)->scene->lights[index] : NULL;
    for (size_t i = 0; i < n; i++)
        intensity[i] = light ? light_intensity(light, directions[i]) : (ps_rgb){0, 0, 0};
}

static void host_emit_from(const ps_host *host, uint32_t index, const float (*samples)[4], size_t n,
                           ps_ray *rays, ps_rgb *power)
{
    bool there = has_light(host, index, "emit_from");
    ps_light_sample point;
    for (size_t i = 0; i < n; i++) {
        rays[i] = nowhere;
        power[i] = there ? emit_from(render_of(host)->scene, index, samples[i], &rays[i], &point)
                         : (ps_rgb){0, 0, 0};
    }
}

/* A light that a place draws, or one of its triangles; the chance of the light, for weights; and
 * what to multiply the light's answer with. */
struct drawn_light {
    struct light_choice choice;
    float probability;
};

static float power_share(const struct scene *scene, size_t light)
{
    return distribution_probability(&scene->light_choice, light);
}

/* Suns and skies together. */
static float afar_share(const struct scene *scene)
{
    float share = 0.0f;
    for (size_t i = 0; i < scene->afar_count; i++)
        share += power_share(scene, scene->afar[i]);
    return share;
}

static const struct light_draws one_draw = {.most = 1};

/* The chance of a light at a place: its share of the power; of many lights that of its draws from
 * the light BVH, suns and skies aside. */
static float light_probability(const struct scene *scene, size_t light, ps_vec3 place)
{
    if (!scene_chooses_lights(scene) || light_is_afar(&scene->lights[light]))
        return power_share(scene, light);
    return (1.0f - afar_share(scene)) *
           light_bvh_expected(scene->light_bvh, light, place, &one_draw);
}

/* Draws by power. */
static void draw_of_few(const struct scene *scene, float u, struct drawn_light *drawn)
{
    size_t light = scene_choose_light(scene, &u, &drawn->probability);
    drawn->choice = (struct light_choice){(uint32_t)light, WHOLE_LIGHT, 1.0f / drawn->probability};
}

/* Draws suns and skies by power, and the others by the BVH. False: none of those gives anything. */
static bool draw_of_many(const struct scene *scene, ps_vec3 place, float u,
                         struct drawn_light *drawn)
{
    static const ps_vec3 no_normal = {0, 0, 0};
    float share = afar_share(scene), below = 0.0f;
    for (size_t i = 0; i < scene->afar_count; i++) {
        drawn->probability = power_share(scene, scene->afar[i]);
        below += drawn->probability;
        drawn->choice =
            (struct light_choice){scene->afar[i], WHOLE_LIGHT, 1.0f / drawn->probability};
        if (u < below)
            return true;
    }
    double rest = ((double)u - (double)share) / (1.0 - (double)share);
    if (light_bvh_choose(scene->light_bvh, place, no_normal, &one_draw, rest, &drawn->choice) != 1)
        return false;
    drawn->choice.weight /= 1.0f - share;
    drawn->probability = light_probability(scene, drawn->choice.light, place);
    return true;
}

/* False: no light gives anything. */
static bool draw_light(const struct scene *scene, ps_vec3 place, float u, struct drawn_light *drawn)
{
    if (scene_chooses_lights(scene))
        return draw_of_many(scene, place, u, drawn);
    draw_of_few(scene, u, drawn);
    return drawn->probability > 0.0f;
}

/* What a place sees of what it drew, and the normal there. */
static struct light_sample look_at_drawn(const struct scene *scene, const struct drawn_light *drawn,
                                         ps_vec3 place, const float numbers[2], ps_vec3 *normal)
{
    const struct light *light = &scene->lights[drawn->choice.light];
    struct light_sample sample;
    const float pair[1][2] = {{numbers[0], numbers[1]}};
    if (drawn->choice.triangle == WHOLE_LIGHT) {
        light_sample(light, &place, NULL, pair, 1, &sample);
        *normal = light_sample_normal(light, place, numbers, &sample);
        return sample;
    }
    light_sample_triangle(light, drawn->choice.triangle, place, numbers, &sample);
    *normal = light->surface.normals[drawn->choice.triangle];
    if (ps_dot(*normal, sample.direction) > 0.0f)
        *normal = ps_scale(*normal, -1.0f);
    return sample;
}

/* One place's. */
static ps_light_sample sample_light(const struct scene *scene, ps_vec3 place,
                                    const float numbers[4])
{
    ps_light_sample sampled = {.distance = INFINITY};
    struct drawn_light drawn;
    if (scene->light_count == 0 || !draw_light(scene, place, numbers[2], &drawn))
        return sampled;
    struct light_sample sample = look_at_drawn(scene, &drawn, place, numbers, &sampled.normal);
    float far = 4.0f * scene->radius;
    sampled.light = drawn.choice.light;
    sampled.probability = drawn.probability;
    sampled.distance = sample.distance;
    sampled.direction = sample.direction;
    sampled.pdf = sample.pdf;
    sampled.position =
        ps_add_scaled(place, sample.distance < INFINITY ? sample.distance : far, sample.direction);
    sampled.irradiance = ps_rgb_scale(sample.weight, drawn.choice.weight);
    return sampled;
}

static void host_sample_light(const ps_host *host, const ps_vec3 *places, const float (*samples)[4],
                              size_t n, ps_light_sample *sampled)
{
    for (size_t i = 0; i < n; i++)
        sampled[i] = sample_light(render_of(host)->scene, places[i], samples[i]);
}

static ps_light_density density_of(const struct render *render, uint32_t light, ps_vec3 place,
                                   const ps_light_sample *point)
{
    const struct scene *scene = render->scene;
    const struct light *from = &scene->lights[light];
    ps_vec3 front = light_front(from, place, point->normal);
    float probability = light_probability(scene, light, place);
    float emitted = distribution_probability(emission_of(render), light);
    if (!(probability > 0.0f))
        return (ps_light_density){0, 0};
    return (ps_light_density){
        probability * light_pdf(from, place, point->direction, point->distance, front),
        light_arrival(from, place, point->direction, point->distance, front) *
            (emitted / probability),
    };
}

/* Of all that shines from a direction, but suns without an angle. Their rays fill the same disc. */
static ps_light_density density_from_afar(const struct render *render, ps_vec3 place,
                                          const ps_light_sample *point)
{
    const struct scene *scene = render->scene;
    ps_light_density sum = {0, 0};
    for (size_t i = 0; i < scene->afar_count; i++) {
        ps_light_density own = density_of(render, scene->afar[i], place, point);
        sum.direct += own.direct;
        sum.arrival = own.arrival;
    }
    return sum;
}

static void host_light_densities(const ps_host *host, const ps_vec3 *places,
                                 const ps_light_sample *points, size_t n,
                                 ps_light_density *densities)
{
    const struct render *render = render_of(host);
    const struct scene *scene = render->scene;
    for (size_t i = 0; i < n; i++) {
        bool there = points[i].light < scene->light_count;
        bool afar = !(points[i].distance < INFINITY);
        densities[i] = (ps_light_density){0, 0};
        if (afar && !(there && light_is_delta(&scene->lights[points[i].light])))
            densities[i] = density_from_afar(render, places[i], &points[i]);
        else if (there)
            densities[i] = density_of(render, points[i].light, places[i], &points[i]);
    }
}

void host_add_lights(ps_host *host)
{
    host->emit_light = host_emit_light;
    host->emit_points = host_emit_points;
    host->emit_from = host_emit_from;
    host->light_count = host_light_count;
    host->light = host_light;
    host->light_intensity = host_light_intensity;
    host->sample_light = host_sample_light;
    host->light_densities = host_light_densities;
}
