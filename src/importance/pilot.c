#include "importance/pilot.h"

#include "importance/importance.h"
#include "scene/scene.h"
#include <psplat/path.h>
#include <stdlib.h>
#include <string.h>

#define CHUNK 64
#define CHUNKS 64
#define MOST_SEGMENTS 8

/* Of PS_STREAM_EMISSION, far from those of light paths: points of the picture, then two for each
 * segment. */
#define FIRST_SET 0x200000u

/* Light of one light that a path found; 0: none. */
struct record {
    uint32_t light;
    float value; /* the sum of red, green and blue */
};

/* What a chunk found: of lamps that paths met, and of lights that surfaces sampled; and where it
 * met surfaces. */
struct findings {
    struct record met[MOST_SEGMENTS][CHUNK], sampled[MOST_SEGMENTS][CHUNK];
    size_t count;
    struct seen_surface surfaces[MOST_SEGMENTS * CHUNK];
    double root_irradiance; /* the sum of theirs */
};

struct pilot {
    const ps_host *host;
    const ps_pass *pass;
    const struct scene *scene;
    bool asks_first;           /* what the first surfaces get, by which lights have a threshold */
    struct findings *findings; /* of each chunk */
};

/* Those of a chunk that are under way. */
struct pilot_paths {
    size_t count;
    uint32_t places[CHUNK]; /* in the chunk */
    ps_ray rays[CHUNK];
    ps_rgb throughput[CHUNK];
    uint32_t bounces[CHUNK]; /* diffuse surfaces met */
    bool specular[CHUNK];    /* the last one scattered by another lobe */
    ps_hit hits[CHUNK];
    float numbers[CHUNK][4];
};

static void draw_numbers(const struct pilot *pilot, uint64_t chunk, uint32_t set,
                         struct pilot_paths *paths)
{
    uint64_t indices[CHUNK];
    for (size_t i = 0; i < paths->count; i++)
        indices[i] = chunk * CHUNK + paths->places[i];
    pilot->host->samples(pilot->host, PS_STREAM_EMISSION, FIRST_SET + set, indices, paths->count,
                         paths->numbers);
}

static void start(const struct pilot *pilot, uint64_t chunk, struct pilot_paths *paths)
{
    const struct scene *scene = pilot->scene;
    memset(paths, 0, sizeof *paths);
    paths->count = CHUNK;
    for (uint32_t i = 0; i < CHUNK; i++)
        paths->places[i] = i;
    draw_numbers(pilot, chunk, 0, paths);
    for (size_t i = 0; i < CHUNK; i++) {
        const float *numbers = paths->numbers[i];
        paths->rays[i] = camera_ray(&scene->camera, numbers[0] * (float)scene->width,
                                    numbers[1] * (float)scene->height, numbers + 2);
        paths->throughput[i] = (ps_rgb){1, 1, 1};
    }
}

static void move(struct pilot_paths *paths, size_t from, size_t to)
{
    paths->places[to] = paths->places[from];
    paths->rays[to] = paths->rays[from];
    paths->throughput[to] = paths->throughput[from];
    paths->bounces[to] = paths->bounces[from];
    paths->specular[to] = paths->specular[from];
    paths->hits[to] = paths->hits[from];
}

static float sum_of(ps_rgb a, ps_rgb b)
{
    ps_rgb product = ps_rgb_multiply(a, b);
    return product.r + product.g + product.b;
}

/* Records lamps that paths met after mirrors, glass or gloss, and drops paths that met nothing. */
static void record_emission(const struct pilot *pilot, struct pilot_paths *paths,
                            struct record *records)
{
    const float pdfs[CHUNK] = {0};
    ps_rgb radiance[CHUNK];
    size_t met = 0;
    pilot->host->emitted_radiance(pilot->host, paths->rays, paths->hits, pdfs, paths->count,
                                  radiance);
    for (size_t i = 0; i < paths->count; i++) {
        const ps_hit *hit = &paths->hits[i];
        if (!(hit->distance < INFINITY))
            continue;
        uint32_t light = pilot->scene->object_lights[hit->object];
        if (light != NO_LIGHT && paths->specular[i] && paths->bounces[i] > 0)
            records[paths->places[i]] =
                (struct record){light, sum_of(paths->throughput[i], radiance[i])};
        move(paths, i, met++);
    }
    paths->count = met;
}

/* Records what surfaces get from a light each: how much that is near the camera, and past the first
 * diffuse surface whose it is. */
static void record_direct(const struct pilot *pilot, uint64_t chunk, uint32_t segment,
                          struct pilot_paths *paths, struct findings *findings)
{
    const ps_host *host = pilot->host;
    ps_vec3 places[CHUNK] = {{0, 0, 0}};
    ps_light_sample samples[CHUNK];
    ps_ray rays[CHUNK];
    uint8_t blocked[CHUNK];
    for (size_t i = 0; i < paths->count; i++)
        places[i] = ps_add_scaled(paths->hits[i].position, pilot->pass->surface_offset,
                                  paths->hits[i].geometric_normal);
    draw_numbers(pilot, chunk, 1 + 2 * segment, paths);
    host->sample_light(host, places, (const float(*)[4])paths->numbers, paths->count, samples);
    for (size_t i = 0; i < paths->count; i++) {
        float reach = ps_max(samples[i].distance - pilot->pass->surface_offset, 0.0f);
        rays[i] = (ps_ray){places[i], 0.0f, samples[i].direction, reach};
    }
    host->occluded(host, rays, paths->count, blocked);
    for (size_t i = 0; i < paths->count; i++) {
        float cosine = ps_dot(samples[i].direction, paths->hits[i].normal);
        ps_rgb reflected = ps_rgb_scale(paths->hits[i].albedo, ps_max(cosine, 0.0f) / PS_PI);
        ps_rgb beam = samples[i].irradiance; /* across */
        if (paths->bounces[i] <= 1 && !blocked[i] && cosine > 0.0f)
            findings->root_irradiance += sqrt((double)(cosine * (beam.r + beam.g + beam.b)));
        if (paths->bounces[i] > 0 && !blocked[i])
            findings->sampled[segment][paths->places[i]] = (struct record){
                samples[i].light, sum_of(ps_rgb_multiply(paths->throughput[i], reflected), beam)};
    }
}

/* Whether a path goes on. */
static bool goes_on(const struct pilot *pilot, const ps_bsdf_sample *scattered, float number,
                    struct pilot_paths *paths, size_t i)
{
    ps_rgb *throughput = &paths->throughput[i];
    *throughput = ps_rgb_multiply(*throughput, scattered->weight);
    float likelihood = ps_rgb_maximum(*throughput);
    if (!(likelihood > 0.0f))
        return false;
    paths->specular[i] = scattered->lobe != PS_DIFFUSE;
    if (paths->specular[i])
        return true;
    return paths->bounces[i]++ < pilot->pass->bounces &&
           (paths->bounces[i] == 1 || ps_russian_roulette(likelihood, number, throughput));
}

static void scatter(const struct pilot *pilot, uint64_t chunk, uint32_t set,
                    struct pilot_paths *paths)
{
    ps_bsdf_sample scattered[CHUNK];
    size_t alive = 0;
    draw_numbers(pilot, chunk, set, paths);
    pilot->host->sample_bsdf(pilot->host, PS_FROM_CAMERA, paths->rays, paths->hits,
                             (const float(*)[4])paths->numbers, paths->count, scattered);
    for (size_t i = 0; i < paths->count; i++) {
        if (!goes_on(pilot, &scattered[i], paths->numbers[i][2], paths, i))
            continue;
        paths->rays[i] = ps_leave_surface(paths->hits[i].position, scattered[i].normal,
                                          scattered[i].direction, pilot->pass->surface_offset);
        move(paths, i, alive++);
    }
    paths->count = alive;
}

static void note_surfaces(const struct pilot_paths *paths, struct findings *findings)
{
    for (size_t i = 0; i < paths->count; i++)
        findings->surfaces[findings->count++] = (struct seen_surface){
            .position = paths->hits[i].position,
            .normal = paths->hits[i].geometric_normal,
            .is_near = paths->bounces[i] <= 1,
        };
}

static void trace_chunk(void *user, uint64_t chunk, uint32_t worker)
{
    (void)worker;
    const struct pilot *pilot = user;
    struct findings *findings = &pilot->findings[chunk];
    struct pilot_paths paths;
    start(pilot, chunk, &paths);
    for (uint32_t segment = 0; segment < MOST_SEGMENTS && paths.count > 0; segment++) {
        pilot->host->intersect(pilot->host, paths.rays, paths.count, paths.hits);
        record_emission(pilot, &paths, findings->met[segment]);
        note_surfaces(&paths, findings);
        if (segment > 0 || pilot->asks_first)
            record_direct(pilot, chunk, segment, &paths, findings);
        scatter(pilot, chunk, 2 + 2 * segment, &paths);
    }
}

/* --- sums, in the order of the paths --- */

static void add_records(const struct record *records, size_t count, struct found_light *found)
{
    for (size_t i = 0; i < count; i++) {
        if (!(records[i].value > 0.0f && records[i].value < INFINITY))
            continue;
        found[records[i].light].sum += (double)records[i].value;
        found[records[i].light].times += 1.0;
    }
}

/* `roots`: the sum of the roots of their irradiance. */
static void measure(struct seen_places *seen, double roots)
{
    double count = 0.0, x = 0.0, y = 0.0, z = 0.0, squares = 0.0;
    for (size_t i = 0; i < seen->count; i++) {
        ps_vec3 place = seen->surfaces[i].position;
        if (!seen->surfaces[i].is_near)
            continue;
        count += 1.0;
        x += (double)place.x;
        y += (double)place.y;
        z += (double)place.z;
        squares += (double)ps_dot(place, place);
    }
    if (!(count > 0.0))
        return;
    x /= count;
    y /= count;
    z /= count;
    double variance = squares / count - x * x - y * y - z * z;
    seen->middle = (ps_vec3){(float)x, (float)y, (float)z};
    seen->spread = sqrt(fmax(variance, 0.0));
    seen->irradiance = roots * roots / (count * count);
}

static ps_result collect(const struct findings *findings, struct seen_places *seen,
                         struct error *error)
{
    size_t bytes = (size_t)CHUNKS * MOST_SEGMENTS * CHUNK * sizeof *seen->surfaces;
    double roots = 0.0;
    seen->surfaces = malloc(bytes);
    if (!seen->surfaces)
        return error_memory(error, bytes, "camera paths");
    for (size_t chunk = 0; chunk < CHUNKS; chunk++) {
        const struct findings *from = &findings[chunk];
        memcpy(seen->surfaces + seen->count, from->surfaces, from->count * sizeof *from->surfaces);
        seen->count += from->count;
        roots += from->root_irradiance;
    }
    measure(seen, roots);
    return PS_OK;
}

ps_result pilot_trace(const ps_host *host, const ps_pass *pass, const struct scene *scene,
                      struct found_light *found, struct seen_places *seen, struct error *error)
{
    struct pilot pilot = {host, pass, scene, importance_has_threshold(scene),
                          calloc(CHUNKS, sizeof *pilot.findings)};
    *seen = (struct seen_places){.surfaces = NULL};
    if (!pilot.findings)
        return error_memory(error, CHUNKS * sizeof *pilot.findings, "camera paths");
    host->parallel_for(host, CHUNKS, trace_chunk, &pilot);
    for (size_t chunk = 0; chunk < CHUNKS; chunk++) {
        const struct findings *findings = &pilot.findings[chunk];
        add_records(findings->met[0], MOST_SEGMENTS * CHUNK, found);
        add_records(findings->sampled[0], MOST_SEGMENTS * CHUNK, found);
    }
    ps_result result = collect(pilot.findings, seen, error);
    free(pilot.findings);
    return result;
}
