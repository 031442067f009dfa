#include "subpath.h"

static ps_rgb without(ps_rgb a, ps_rgb b)
{
    return (ps_rgb){ps_max(a.r - b.r, 0.0f), ps_max(a.g - b.g, 0.0f), ps_max(a.b - b.b, 0.0f)};
}

struct scattering bdpt_scattering(const ps_hit *hit, ps_vec3 direction, const ps_bsdf_value *value)
{
    float cosine = ps_max(ps_dot(direction, hit->normal), 0.0f);
    if (!(hit->flags & PS_HIT_SPECULAR))
        return (struct scattering){value->value, value->value};
    return (struct scattering){value->value, ps_rgb_scale(hit->albedo, cosine / PS_PI)};
}

ps_rgb bdpt_scattered(uint32_t room, const struct scattering *a, const struct scattering *b)
{
    if (room == 0)
        return ps_rgb_multiply(without(a->all, a->diffuse), without(b->all, b->diffuse));
    ps_rgb all = ps_rgb_multiply(a->all, b->all);
    return room == 1 ? without(all, ps_rgb_multiply(a->diffuse, b->diffuse)) : all;
}

ps_bsdf_value bdpt_evaluate_diffuse(ps_direction direction, const ps_ray *ray, const ps_hit *hit,
                                    ps_vec3 away)
{
    float shading = ps_max(ps_dot(away, hit->normal), 0.0f) / PS_PI;
    float geometric = ps_dot(away, hit->geometric_normal) / PS_PI;
    float back_shading = ps_max(-ps_dot(ray->direction, hit->normal), 0.0f) / PS_PI;
    float back_geometric = -ps_dot(ray->direction, hit->geometric_normal) / PS_PI;
    if (!(geometric > 0.0f))
        return (ps_bsdf_value){{0, 0, 0}, 0, 0};
    if (direction == PS_FROM_CAMERA)
        return (ps_bsdf_value){ps_rgb_scale(hit->albedo, shading), shading, back_geometric};
    float arrived =
        ps_same(hit->normal, hit->geometric_normal) ? 1.0f : back_shading / back_geometric;
    return (ps_bsdf_value){ps_rgb_scale(hit->albedo, geometric * arrived), geometric, back_shading};
}

void bdpt_evaluate(const struct bdpt *bdpt, ps_direction direction, const ps_ray *rays,
                   const ps_hit *hits, const ps_vec3 *directions, size_t n, ps_bsdf_value *values)
{
    uint32_t flags = 0;
    for (size_t i = 0; i < n; i++)
        flags |= hits[i].flags;
    if (flags & PS_HIT_SPECULAR) {
        bdpt->host->evaluate_bsdf(bdpt->host, direction, rays, hits, directions, n, values);
        return;
    }
    for (size_t i = 0; i < n; i++)
        values[i] = bdpt_evaluate_diffuse(direction, &rays[i], &hits[i], directions[i]);
}

/* That of a surface with other lobes depends on the direction: a short ray from there meets it
 * again. */
ps_rgb bdpt_albedo_towards(const struct bdpt *bdpt, const ps_hit *hit, ps_vec3 direction)
{
    if (!(hit->flags & PS_HIT_SPECULAR))
        return hit->albedo;
    float distance = 4.0f * bdpt->pass->surface_offset;
    ps_ray ray = {ps_add_scaled(hit->position, distance, direction), 0.0f,
                  ps_scale(direction, -1.0f), 2.0f * distance};
    ps_hit again;
    bdpt->host->intersect(bdpt->host, &ray, 1, &again);
    return again.distance < INFINITY && again.object == hit->object ? again.albedo
                                                                    : (ps_rgb){0, 0, 0};
}

void subpath_leave(struct subpath *end, float cosine, float pdf, float reverse_pdf)
{
    if (pdf > 0.0f) {
        end->vc = bdpt_square(cosine / pdf) * (end->vc * bdpt_square(reverse_pdf) + end->vcm);
        end->vcm = bdpt_square(1.0f / pdf);
    } else {
        end->vc *= bdpt_square(cosine);
        end->vcm = 0.0f;
    }
}

void walk_move(struct walk *walk, size_t from, size_t to)
{
    walk->ends[to] = walk->ends[from];
    walk->rays[to] = walk->rays[from];
    walk->hits[to] = walk->hits[from];
}

void walk_drop_lost(struct walk *walk)
{
    size_t met = 0;
    for (size_t i = 0; i < walk->count; i++)
        if (walk->hits[i].distance < INFINITY)
            walk_move(walk, i, met++);
    walk->count = met;
}

void walk_arrive(const struct bdpt *bdpt, struct walk *walk)
{
    for (size_t i = 0; i < walk->count; i++) {
        const ps_hit *hit = &walk->hits[i];
        float cosine = -ps_dot(walk->rays[i].direction, hit->geometric_normal);
        float distance2 = hit->distance * hit->distance / bdpt->area;
        walk->ends[i].vcm *= bdpt_square(distance2 / cosine);
        walk->ends[i].vc *= bdpt_square(1.0f / cosine);
    }
}

/* Whether a subpath goes on by that lobe. */
static int goes_on(const struct bdpt *bdpt, uint32_t lobe, float number, struct subpath *end)
{
    float likelihood = ps_rgb_maximum(end->throughput) / end->start;
    if (!(likelihood > 0.0f))
        return 0;
    if (lobe != PS_DIFFUSE)
        return ++end->chain <= PS_LONGEST_CHAIN;
    if (end->bounces >= bdpt->pass->bounces)
        return 0;
    end->chain = 0;
    end->bounces++;
    return end->bounces < bdpt->roulette ||
           ps_russian_roulette(likelihood, number, &end->throughput);
}

/* Sends a subpath on; false where it ends. */
static int scatter(const struct bdpt *bdpt, const ps_bsdf_sample *to, const ps_bsdf_value *value,
                   float number, struct walk *walk, size_t i)
{
    struct subpath *end = &walk->ends[i];
    const ps_hit *hit = &walk->hits[i];
    int is_specular = to->lobe == PS_SPECULAR;
    if (!is_specular && !(value->pdf > 0.0f))
        return 0;
    end->throughput = ps_rgb_multiply(end->throughput, to->weight);
    if (!goes_on(bdpt, to->lobe, number, end))
        return 0;
    subpath_leave(end, ps_dot(to->direction, to->normal), is_specular ? 0.0f : value->pdf,
                  value->reverse_pdf);
    walk->rays[i] =
        ps_leave_surface(hit->position, to->normal, to->direction, bdpt->pass->surface_offset);
    return 1;
}

void walk_scatter(const struct bdpt *bdpt, ps_direction direction, uint32_t stream, uint32_t set,
                  const uint64_t *samples, struct walk *walk)
{
    const ps_host *host = bdpt->host;
    uint64_t indices[PS_TILE_PIXELS];
    float numbers[PS_TILE_PIXELS][4];
    ps_bsdf_sample to[PS_TILE_PIXELS];
    ps_bsdf_value values[PS_TILE_PIXELS];
    ps_vec3 directions[PS_TILE_PIXELS];
    size_t alive = 0;
    for (size_t i = 0; i < walk->count; i++)
        indices[i] = samples[walk->ends[i].lane];
    host->samples(host, stream, set, indices, walk->count, numbers);
    host->sample_bsdf(host, direction, walk->rays, walk->hits, (const float(*)[4])numbers,
                      walk->count, to);
    for (size_t i = 0; i < walk->count; i++)
        directions[i] = to[i].direction;
    bdpt_evaluate(bdpt, direction, walk->rays, walk->hits, directions, walk->count, values);
    for (size_t i = 0; i < walk->count; i++)
        if (scatter(bdpt, &to[i], &values[i], numbers[i][2], walk, i))
            walk_move(walk, i, alive++);
    walk->count = alive;
}
