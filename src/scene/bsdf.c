/* bsdf.c: how a surface scatters: drawing directions, and evaluating and weighing those that were
 * drawn otherwise.
 *
 * Facets: Walter et al. 2007, Heitz 2018 (microfacet.h). Shading normals on light paths: Veach
 * 1997, section 5.3.
 */
#include "scene/bsdf_lobes.h"

#include "scene/fresnel.h"
#include "scene/heuristic.h"

/* --- lobes ----------------------------------------------------------------------------------- */

/* How many of the paths go by each lobe: whole numbers, about in proportion, and at least one. */
static void share_paths(const struct bsdf_lobe *lobes, size_t count, uint32_t paths,
                        uint32_t shares[BSDF_MOST_LOBES])
{
    uint32_t left = paths - (uint32_t)count;
    for (size_t i = 0; i < count; i++) {
        uint32_t more = (uint32_t)(lobes[i].probability * (float)paths);
        more = more > 0 ? more - 1 : 0;
        shares[i] = 1 + (more < left ? more : left);
        left -= shares[i] - 1;
    }
    for (size_t i = 0; left > 0; i = (i + 1) % count, left--)
        shares[i]++;
}

/* Chooses a lobe by *number, and rescales that so that it can be used again. Returns the lobe's
 * probability. Fewer paths than lobes do not share them out: each is alone. */
static float choose_lobe(const struct bsdf_lobe *lobes, size_t count, float *number,
                         struct stratum *stratum, const struct bsdf_lobe **lobe)
{
    uint32_t shares[BSDF_MOST_LOBES], paths = stratum ? stratum->paths : 1;
    bool shared = paths > 1 && paths >= count;
    float left = *number, chance;
    size_t i = 0;
    if (shared)
        share_paths(lobes, count, paths, shares);
    for (;; i++) {
        chance = shared ? (float)shares[i] / (float)paths : lobes[i].probability;
        if (i + 1 == count || left < chance)
            break;
        left -= chance;
    }
    *number = ps_min(left / chance, 0x1.fffffep-1f);
    if (stratum)
        *stratum = (struct stratum){*number, shared ? shares[i] : 1};
    *lobe = &lobes[i];
    return chance;
}

static ps_vec3 to_frame(const ps_vec3 frame[3], ps_vec3 w)
{
    return (ps_vec3){ps_dot(w, frame[0]), ps_dot(w, frame[1]), ps_dot(w, frame[2])};
}

static ps_vec3 from_frame(const ps_vec3 frame[3], ps_vec3 w)
{
    return ps_add_scaled(ps_add_scaled(ps_scale(frame[0], w.x), w.y, frame[1]), w.z, frame[2]);
}

static void shading_frame(const ps_hit *hit, ps_vec3 frame[3])
{
    frame[2] = hit->normal;
    ps_frame(frame[2], &frame[0], &frame[1]);
}

static ps_bsdf_sample mirror(const struct bsdf_lobe *lobe, const struct bsdf_view *view)
{
    const struct component *component = lobe->component;
    ps_vec3 n = view->hit->normal;
    ps_rgb reflected = bsdf_reflector_albedo(component, view, view->cosine);
    return (ps_bsdf_sample){
        .direction =
            ps_normalize(ps_add_scaled(ps_scale(view->out, -1.0f), 2.0f * ps_dot(view->out, n), n)),
        .weight = ps_rgb_scale(reflected, bsdf_share(component, view)),
        .lobe = PS_SPECULAR,
    };
}

static ps_bsdf_sample reflect_roughly(const struct bsdf_lobe *lobe, const struct bsdf_view *view,
                                      ps_direction direction, const float sample[4])
{
    const struct component *component = lobe->component;
    float roughness = bsdf_roughness(component, view->hit);
    ps_rgb f0 = bsdf_color(&component->specular, view->hit);
    ps_vec3 frame[3];
    shading_frame(view->hit, frame);
    ps_vec3 out = to_frame(frame, view->out);
    out.z = ps_max(out.z, BSDF_LEAST_COSINE);
    ps_vec3 in = microfacet_sample(roughness, out, sample[0], sample[1]);
    float eye = direction == PS_FROM_CAMERA ? out.z : in.z;
    ps_rgb weight = ps_rgb_multiply(microfacet_weight(roughness, f0, out, in),
                                    microfacet_compensation(view->table, f0, roughness, eye));
    return (ps_bsdf_sample){
        .direction = ps_normalize(from_frame(frame, in)),
        .weight = ps_rgb_scale(weight, bsdf_share(component, view)),
        .pdf = microfacet_pdf(roughness, out, in),
        .lobe = PS_GLOSSY,
    };
}

static ps_rgb diffuse_towards(const struct bsdf_view *view, float cosine)
{
    return cosine == view->cosine ? view->diffuse : bsdf_diffuse_albedo(view, cosine);
}

static ps_bsdf_sample scatter_diffusely(const struct bsdf_view *view, ps_direction direction,
                                        const float sample[4])
{
    ps_vec3 n = view->hit->normal;
    ps_vec3 w = ps_cosine_direction(n, sample[0], sample[1]);
    float cosine = ps_dot(w, n);
    return (ps_bsdf_sample){
        .direction = w,
        .weight = diffuse_towards(view, direction == PS_FROM_CAMERA ? view->cosine : cosine),
        .pdf = cosine / PS_PI,
        .lobe = PS_DIFFUSE,
    };
}

static ps_rgb transmittance(ps_rgb absorption, float distance)
{
    return (ps_rgb){expf(-absorption.r * distance), expf(-absorption.g * distance),
                    expf(-absorption.b * distance)};
}

/* Chance by which glass mirrors, of the share that it does. Of camera paths of a pixel a whole
 * number goes either way, at least one, so that what is rare is seen in all pixels, and as often; a
 * path alone goes the rarer way one time in eight. Photons keep their power. */
static float chance_to_mirror(float reflectance, ps_direction direction, uint32_t paths)
{
    float parts = paths > 1 ? (float)paths : 8.0f;
    if (direction == PS_FROM_LIGHT || reflectance <= 0.0f || reflectance >= 1.0f)
        return reflectance;
    float part = paths > 1 ? ceilf(parts * reflectance) : parts * reflectance;
    return ps_min(ps_max(part, 1.0f), parts - 1.0f) / parts;
}

/* Whether glass mirrors. */
static bool choose_to_mirror(float chance, float number, struct stratum *stratum)
{
    bool mirrors = number < chance;
    if (!stratum || stratum->paths <= 1)
        return mirrors;
    float within = mirrors ? number : number - chance, share = mirrors ? chance : 1.0f - chance;
    stratum->number = ps_min(within / share, 0x1.fffffep-1f);
    stratum->paths = (uint32_t)(share * (float)stratum->paths + 0.5f);
    return mirrors;
}

/* Mirrors or refracts, by chance. Radiance is squeezed into a smaller solid angle on the denser
 * side; power is not. */
static ps_bsdf_sample pass_surface(const struct bsdf_lobe *lobe, const struct bsdf_view *view,
                                   ps_direction direction, float number, struct stratum *stratum)
{
    const struct component *component = lobe->component;
    bool inside = view->hit->flags & PS_HIT_BACK;
    float eta = inside ? 1.0f / component->ior : component->ior;
    float far_cosine, reflectance = fresnel_dielectric(view->cosine, eta, &far_cosine);
    ps_vec3 n = view->hit->normal;
    ps_rgb weight = {component->share, component->share, component->share};
    if (inside)
        weight = ps_rgb_multiply(weight, transmittance(component->absorption, view->hit->distance));
    ps_bsdf_sample scattered = {.lobe = PS_SPECULAR, .weight = weight};
    float chance = chance_to_mirror(reflectance, direction, stratum ? stratum->paths : 1);
    if (choose_to_mirror(chance, number, stratum)) {
        scattered.weight = ps_rgb_scale(weight, reflectance / chance);
        scattered.direction =
            ps_add_scaled(ps_scale(view->out, -1.0f), 2.0f * ps_dot(view->out, n), n);
    } else {
        weight = ps_rgb_scale(weight, (1.0f - reflectance) / (1.0f - chance));
        ps_vec3 along = ps_scale(view->out, -1.0f / eta);
        scattered.direction = ps_add_scaled(along, view->cosine / eta - far_cosine, n);
        scattered.weight = ps_rgb_multiply(weight, bsdf_color(&component->specular, view->hit));
        if (direction == PS_FROM_CAMERA)
            scattered.weight = ps_rgb_scale(scattered.weight, 1.0f / (eta * eta));
    }
    scattered.direction = ps_normalize(scattered.direction);
    return scattered;
}

static ps_bsdf_sample follow_lobe(const struct bsdf_lobe *lobe, const struct bsdf_view *view,
                                  ps_direction direction, const float sample[4], float number,
                                  struct stratum *stratum)
{
    const struct component *component = lobe->component;
    if (!component)
        return scatter_diffusely(view, direction, sample);
    if (component->kind == COMPONENT_DIELECTRIC)
        return pass_surface(lobe, view, direction, number, stratum);
    if (component->constant || bsdf_is_smooth(bsdf_roughness(component, view->hit)))
        return mirror(lobe, view);
    return reflect_roughly(lobe, view, direction, sample);
}

/* What light paths lose or gain at smoothed and bent normals (Veach 1997, section 5.3): where they
 * arrive, along view->out, and where they leave along w. */
static float arrival_correction(const struct bsdf_view *view)
{
    ps_vec3 shading = view->hit->normal, true_normal = view->hit->geometric_normal;
    if (ps_same(shading, true_normal))
        return 1.0f;
    float in =
        ps_dot(view->out, shading) / ps_max(ps_dot(view->out, true_normal), BSDF_LEAST_COSINE);
    return ps_max(in, 0.0f);
}

static float shading_correction(const struct bsdf_view *view, ps_vec3 w)
{
    ps_vec3 shading = view->hit->normal, true_normal = view->hit->geometric_normal;
    if (ps_same(shading, true_normal))
        return 1.0f;
    float away =
        fabsf(ps_dot(w, true_normal)) / ps_max(fabsf(ps_dot(w, shading)), BSDF_LEAST_COSINE);
    return arrival_correction(view) * away;
}

/* --- surfaces that are diffuse alone
 * ---------------------------------------------------------------
 *
 * What arrives counts by the shading normal, and what leaves goes to all directions of the surface
 * itself, whichever side of its shading normal they are on. So camera paths draw by the shading
 * normal, and light paths by the geometric one. */

static ps_bsdf_sample scatter_light_diffusely(const struct bsdf_view *view, const float sample[4])
{
    ps_vec3 n = view->hit->geometric_normal;
    ps_vec3 w = ps_cosine_direction(n, sample[0], sample[1]);
    return (ps_bsdf_sample){
        .direction = w,
        .normal = n,
        .weight = ps_rgb_scale(view->diffuse, arrival_correction(view)),
        .probability = 1.0f,
        .pdf = ps_dot(w, n) / PS_PI,
        .lobe = PS_DIFFUSE,
    };
}

static ps_bsdf_value evaluate_diffuse(const struct bsdf_view *view, ps_direction direction,
                                      ps_vec3 away)
{
    const ps_hit *hit = view->hit;
    float shading = ps_max(ps_dot(away, hit->normal), 0.0f) / PS_PI;
    float geometric = ps_dot(away, hit->geometric_normal) / PS_PI;
    float back_shading = ps_max(ps_dot(view->out, hit->normal), 0.0f) / PS_PI;
    float back_geometric = ps_dot(view->out, hit->geometric_normal) / PS_PI;
    if (!(geometric > 0.0f))
        return (ps_bsdf_value){.pdf = 0.0f};
    if (direction == PS_FROM_CAMERA)
        return (ps_bsdf_value){ps_rgb_scale(view->diffuse, shading), shading, back_geometric};
    return (ps_bsdf_value){ps_rgb_scale(view->diffuse, geometric * arrival_correction(view)),
                           geometric, back_shading};
}

/* --- any surface
 * ------------------------------------------------------------------------------- */

ps_bsdf_sample material_scatter(const struct material *material,
                                const struct microfacet_table *table, ps_direction direction,
                                const ps_ray *ray, const ps_hit *hit, const float sample[4],
                                struct stratum *stratum)
{
    struct bsdf_lobe lobes[BSDF_MOST_LOBES];
    struct bsdf_view view = bsdf_view_of(material, table, hit, ray->direction);
    if (!material->specular && direction == PS_FROM_LIGHT)
        return scatter_light_diffusely(&view, sample);
    size_t count = bsdf_list_lobes(&view, lobes);
    if (count == 0)
        return (ps_bsdf_sample){
            .direction = hit->normal, .normal = hit->normal, .probability = 1.0f};
    float number = stratum && stratum->paths > 1 ? stratum->number : sample[3];
    const struct bsdf_lobe *lobe;
    float chance = choose_lobe(lobes, count, &number, stratum, &lobe);
    ps_bsdf_sample scattered = follow_lobe(lobe, &view, direction, sample, number, stratum);
    scattered.probability = chance;
    scattered.pdf *= lobe->probability;
    float factor = 1.0f / chance;
    float side = ps_dot(scattered.direction, hit->geometric_normal);
    bool crosses = ps_dot(scattered.direction, hit->normal) < 0.0f;
    scattered.normal = crosses ? ps_scale(hit->geometric_normal, -1.0f) : hit->geometric_normal;
    if (crosses != (side < 0.0f)) /* a bent normal would send it through the surface */
        factor = 0.0f;
    else if (direction == PS_FROM_LIGHT)
        factor *= shading_correction(&view, scattered.direction);
    scattered.weight = ps_rgb_scale(scattered.weight, factor);
    return scattered;
}

/* The lobe's part of the value, with light that comes from `in` and leaves to `out`, or the other
 * way round; `eye`: the cosine of where it leaves to. Directions in the shading frame; `pdf`
 * becomes the density by which material_scatter draws `in`, given `out`. */
static ps_rgb evaluate_lobe(const struct bsdf_lobe *lobe, const struct bsdf_view *view, ps_vec3 out,
                            ps_vec3 in, float eye, float *pdf)
{
    const struct component *component = lobe->component;
    *pdf = 0.0f;
    if (!component) {
        *pdf = lobe->probability * in.z / PS_PI;
        return ps_rgb_scale(diffuse_towards(view, eye), in.z / PS_PI);
    }
    float roughness =
        component->kind == COMPONENT_DIELECTRIC ? 0.0f : bsdf_roughness(component, view->hit);
    if (component->constant || bsdf_is_smooth(roughness))
        return (ps_rgb){0, 0, 0};
    ps_rgb f0 = bsdf_color(&component->specular, view->hit);
    *pdf = lobe->probability * microfacet_pdf(roughness, out, in);
    return ps_rgb_scale(ps_rgb_multiply(microfacet_reflect(roughness, f0, out, in),
                                        microfacet_compensation(view->table, f0, roughness, eye)),
                        bsdf_share(component, view));
}

/* All lobes; the ray leaves them along view->out, or comes from there. */
static ps_rgb evaluate_lobes(const struct bsdf_view *view, ps_direction direction, ps_vec3 out,
                             ps_vec3 in, float *pdf)
{
    struct bsdf_lobe lobes[BSDF_MOST_LOBES];
    size_t count = bsdf_list_lobes(view, lobes);
    ps_rgb sum = {0, 0, 0};
    *pdf = 0.0f;
    for (size_t i = 0; i < count; i++) {
        float own;
        float eye = direction == PS_FROM_CAMERA ? view->cosine : in.z;
        sum = ps_rgb_add(sum, evaluate_lobe(&lobes[i], view, out, in, eye, &own));
        *pdf += own;
    }
    return sum;
}

ps_bsdf_value material_evaluate(const struct material *material,
                                const struct microfacet_table *table, ps_direction direction,
                                const ps_ray *ray, const ps_hit *hit, ps_vec3 away)
{
    struct bsdf_view view = bsdf_view_of(material, table, hit, ray->direction);
    if (!material->specular)
        return evaluate_diffuse(&view, direction, away);
    struct bsdf_view reverse = bsdf_view_of(material, table, hit, ps_scale(away, -1.0f));
    reverse.diffuse = bsdf_diffuse_albedo(&reverse, reverse.cosine);
    ps_bsdf_value value = {.pdf = 0.0f};
    ps_vec3 frame[3];
    shading_frame(hit, frame);
    ps_vec3 out = to_frame(frame, view.out), in = to_frame(frame, away);
    if (!(in.z > 0.0f && ps_dot(away, hit->geometric_normal) > 0.0f))
        return value;
    out.z = ps_max(out.z, BSDF_LEAST_COSINE);
    value.value = evaluate_lobes(&view, direction, out, in, &value.pdf);
    evaluate_lobes(&reverse, direction, in, out, &value.reverse_pdf);
    if (direction == PS_FROM_LIGHT)
        value.value = ps_rgb_scale(value.value, shading_correction(&view, away));
    return value;
}

ps_rgb material_gloss(const struct material *material, const struct microfacet_table *table,
                      const ps_ray *ray, const ps_hit *hit, ps_vec3 in, float light_pdf)
{
    struct bsdf_lobe lobes[BSDF_MOST_LOBES];
    struct bsdf_view view = bsdf_view_of(material, table, hit, ray->direction);
    view.diffuse =
        bsdf_diffuse_albedo(&view, view.cosine); /* hit->albedo may be what is to count */
    size_t count = bsdf_list_lobes(&view, lobes);
    ps_vec3 frame[3];
    shading_frame(hit, frame);
    ps_vec3 to_eye = to_frame(frame, view.out), to_light = to_frame(frame, in);
    to_eye.z = ps_max(to_eye.z, BSDF_LEAST_COSINE);
    ps_rgb sum = {0, 0, 0};
    if (!(to_light.z > 0.0f && ps_dot(in, hit->geometric_normal) > 0.0f))
        return sum;
    for (size_t i = 0; i < count; i++) {
        const struct component *component = lobes[i].component;
        if (!component || component->kind == COMPONENT_DIELECTRIC || component->constant)
            continue;
        float roughness = bsdf_roughness(component, hit);
        if (bsdf_is_smooth(roughness))
            continue;
        ps_rgb f0 = bsdf_color(&component->specular, hit);
        ps_rgb reflected = ps_rgb_multiply(microfacet_reflect(roughness, f0, to_eye, to_light),
                                           microfacet_compensation(table, f0, roughness, to_eye.z));
        float own = lobes[i].probability * microfacet_pdf(roughness, to_eye, to_light);
        float share = power_heuristic(light_pdf, own);
        sum = ps_rgb_add(sum, ps_rgb_scale(reflected, bsdf_share(component, &view) * share));
    }
    return sum;
}
