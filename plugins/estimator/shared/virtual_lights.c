#include "virtual_lights.h"

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

static ps_result draw(const ps_host *host, const ps_pass *pass, size_t room,
                      struct virtual_lights *chosen)
{
    const ps_photon *photons;
    size_t n;
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
                chosen->lights[place] = photons[i];
        }
        power += result == PS_OK ? total_power(photons, n, &left_out) : 0;
    } while (result == PS_OK && n > 0);
    chosen->count = seen < room ? (size_t)seen : room;
    double share = total_power(chosen->lights, chosen->count, &left_out);
    for (size_t i = 0; i < chosen->count && share > 0; i++)
        chosen->lights[i].power = ps_rgb_scale(chosen->lights[i].power, (float)(power / share));
    host->count(host, "photons left out", (double)left_out);
    host->count(host, "virtual lights", (double)chosen->count);
    return result;
}

ps_result virtual_lights_choose(const ps_host *host, const ps_pass *pass, size_t most,
                                struct virtual_lights *chosen)
{
    *chosen = (struct virtual_lights){
        .host = host,
        .lights = host->allocate(host, most * sizeof *chosen->lights, "virtual lights"),
    };
    return chosen->lights ? draw(host, pass, most, chosen) : PS_ERROR_MEMORY;
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
