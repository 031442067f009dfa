#include "virtual_lights.h"

#include "photons.h"

static bool can_be_light(const struct virtual_lights *chosen, const ps_photon *photon)
{
    return photon->lobe == PS_DIFFUSE ||
           (chosen->with_gloss && photon->specular == PS_ONLY_ROUGH_GLOSS);
}

/* Whether the next of `seen` photons enters the sample, and in whose place: every one ends up in it
 * with the same probability, whatever their number (reservoir sampling, Vitter 1985). */
static size_t place_in_sample(const struct virtual_lights *chosen, uint64_t seen)
{
    const ps_host *host = chosen->host;
    float numbers[1][4];
    uint64_t index = (uint64_t)chosen->pass->number << 40 | seen;
    if (seen < chosen->most)
        return (size_t)seen;
    host->samples(host, PS_STREAM_ESTIMATOR, 0, &index, 1, numbers);
    double place = ((double)numbers[0][0] + (double)numbers[0][1] * 0x1p-24) * (double)(seen + 1);
    return place < (double)chosen->most ? (size_t)place : chosen->most;
}

ps_result virtual_lights_begin(const ps_host *host, const ps_pass *pass, size_t most,
                               bool with_gloss, struct virtual_lights *chosen)
{
    *chosen = (struct virtual_lights){
        .host = host,
        .pass = pass,
        .lights = host->allocate(host, most * sizeof *chosen->lights, "virtual lights"),
        .most = most,
        .with_gloss = with_gloss,
    };
    return chosen->lights ? PS_OK : PS_ERROR_MEMORY;
}

void virtual_lights_take(struct virtual_lights *chosen, const ps_photon *photons, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (!can_be_light(chosen, &photons[i])) {
            chosen->left_out++;
            continue;
        }
        size_t place = place_in_sample(chosen, chosen->seen++);
        if (place < chosen->most)
            chosen->lights[place] = photons[i];
        chosen->power += ps_luminance(photons[i].power);
    }
}

void virtual_lights_end(struct virtual_lights *chosen)
{
    double share = 0;
    chosen->count = chosen->seen < chosen->most ? (size_t)chosen->seen : chosen->most;
    for (size_t i = 0; i < chosen->count; i++)
        share += ps_luminance(chosen->lights[i].power);
    for (size_t i = 0; i < chosen->count && share > 0; i++)
        chosen->lights[i].power =
            ps_rgb_scale(chosen->lights[i].power, (float)(chosen->power / share));
}

/* A photons_take. */
static ps_result take_batch(void *chosen, const ps_photon *photons, size_t n)
{
    virtual_lights_take(chosen, photons, n);
    return PS_OK;
}

ps_result virtual_lights_choose(const ps_host *host, const ps_pass *pass, size_t most,
                                struct virtual_lights *chosen)
{
    ps_result result = virtual_lights_begin(host, pass, most, false, chosen);
    if (result == PS_OK)
        result = photons_for_each_batch(host, take_batch, chosen);
    virtual_lights_end(chosen);
    host->count(host, "photons left out", (double)chosen->left_out);
    host->count(host, "virtual lights", (double)chosen->count);
    return result;
}

void virtual_lights_release(struct virtual_lights *chosen)
{
    chosen->host->release(chosen->host, chosen->lights);
    *chosen = (struct virtual_lights){.host = chosen->host};
}

float virtual_lights_clamp(const ps_host *host, ps_number_or_choice clamp)
{
    ps_vec3 center;
    float radius;
    host->scene_bounds(host, &center, &radius);
    return clamp.choice >= 0 ? 0.05f * radius : (float)clamp.number;
}
