/* injection.c: an example: photons where light from the lights lands first, one for each light
 * path. */
#include <psplat/plugin.h>

struct state {
    int64_t count;
};

static uint64_t path_count(const void *opaque)
{
    const struct state *state = opaque;
    return (uint64_t)state->count;
}

static ps_result emit(const void *opaque, const ps_host *host, const ps_pass *pass, uint64_t first,
                      size_t n, const ps_photon_sink *sink)
{
    const struct state *state = opaque;
    uint64_t indices[PS_PATH_CHUNK] = {0};
    float numbers[PS_PATH_CHUNK][4];
    ps_ray rays[PS_PATH_CHUNK];
    ps_rgb power[PS_PATH_CHUNK];
    ps_hit hits[PS_PATH_CHUNK];
    ps_photon photons[PS_PATH_CHUNK];
    size_t count = 0;
    for (size_t i = 0; i < n; i++)
        indices[i] = pass->number * (uint64_t)state->count + first + i;
    host->samples(host, PS_STREAM_EMISSION, 0, indices, n, numbers);
    host->emit_light(host, (const float(*)[4])numbers, n, rays, power);
    host->intersect(host, rays, n, hits);
    host->samples(host, PS_STREAM_BOUNCE, 0, indices, n, numbers);
    for (size_t i = 0; i < n; i++) {
        if (!(hits[i].distance < INFINITY) || !(ps_rgb_maximum(hits[i].albedo) > 0.0f))
            continue;
        ps_rgb reflected = ps_rgb_multiply(power[i], hits[i].albedo);
        photons[count++] = (ps_photon){
            .position = hits[i].position,
            .normal = hits[i].geometric_normal,
            .direction =
                ps_cosine_direction(hits[i].geometric_normal, numbers[i][0], numbers[i][1]),
            .power = ps_rgb_scale(reflected, 1.0f / (float)state->count),
            .bounce = 1,
            .lobe = PS_DIFFUSE,
            .merged = 1.0f,
            .path = indices[i],
        };
    }
    return sink->append(sink->core, photons, count);
}

static const ps_param params[] = {
    PS_INT(struct state, count, "100000", 1, 2000000000, "paths", "light paths in each pass"),
};

static const ps_injection_vtable vtable = {
    .size = sizeof vtable,
    .path_count = path_count,
    .emit = emit,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_INJECTION,
    .name = "first",
    .version = "1.0",
    .summary = "photons where light lands first",
    .paper = "none: an example",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(injection, first, &descriptor)
