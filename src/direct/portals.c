#include "direct/portals.h"

#include <assert.h>
#include <math.h>
#include <psplat/math.h>
#include <string.h>

/* The more of a hemisphere the portals take up, the more rays go by the sky: all of them from 1 /
 * WIDE_OPEN on. */
#define WIDE_OPEN 2.0f
#define BY_SKY 0.25f        /* share of the rays */
#define BY_SKY_PICTURE 0.5f /* where the sky is uneven, so that portals miss what is bright in it */

static float coordinate(ps_vec3 v, uint32_t axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* --- the box --- */

void portals_begin(struct portals *portals, ps_vec3 low, ps_vec3 high)
{
    memset(portals, 0, sizeof *portals);
    portals->low = low;
    portals->high = high;
}

bool portals_know(const struct portals *portals, ps_vec3 position)
{
    const ps_vec3 *low = &portals->low, *high = &portals->high;
    return position.x > low->x && position.x < high->x && position.y > low->y &&
           position.y < high->y && position.z > low->z && position.z < high->z;
}

/* From 0 to 1 through the box. */
static float place_along(const struct portals *portals, ps_vec3 position, uint32_t axis)
{
    float low = coordinate(portals->low, axis), high = coordinate(portals->high, axis);
    return (coordinate(position, axis) - low) / (high - low);
}

static uint32_t part_of(float place, uint32_t count)
{
    float part = place * (float)count;
    uint32_t index = part > 0.0f ? (uint32_t)part : 0;
    return index < count ? index : count - 1;
}

size_t portals_cell(const struct portals *portals, ps_vec3 position)
{
    size_t cell = 0;
    for (uint32_t axis = 0; axis < 3; axis++)
        cell = cell * PORTAL_CELLS + part_of(place_along(portals, position, axis), PORTAL_CELLS);
    return cell;
}

struct portal_exit portals_exit(const struct portals *portals, ps_vec3 position, ps_vec3 direction)
{
    struct portal_exit exit = {.distance = INFINITY};
    for (uint32_t axis = 0; axis < 3; axis++) {
        float along = coordinate(direction, axis);
        bool high = along > 0.0f;
        float face = coordinate(high ? portals->high : portals->low, axis);
        float distance = (face - coordinate(position, axis)) / along;
        if (along != 0.0f && distance < exit.distance) {
            exit.distance = distance;
            exit.face = (struct portal_face){axis, high};
            exit.cosine = fabsf(along);
        }
    }
    ps_vec3 point = ps_add_scaled(position, exit.distance, direction);
    for (uint32_t k = 0; k < 2; k++)
        exit.bin[k] =
            part_of(place_along(portals, point, (exit.face.axis + 1 + k) % 3), PORTAL_BINS);
    return exit;
}

/* --- portals --- */

static float between(float low, float high, float share)
{
    return low + (high - low) * share;
}

/* A point of a portal, both shares from 0 to 1. */
static ps_vec3 point_of(const struct portals *portals, const struct portal_bins *bins,
                        const float shares[2])
{
    float at[3];
    uint32_t axis = bins->face.axis;
    at[axis] = coordinate(bins->face.high ? portals->high : portals->low, axis);
    for (uint32_t k = 0; k < 2; k++) {
        uint32_t along = (axis + 1 + k) % 3;
        float place = between((float)bins->first[k], (float)bins->end[k], shares[k]);
        at[along] = between(coordinate(portals->low, along), coordinate(portals->high, along),
                            place / PORTAL_BINS);
    }
    return (ps_vec3){at[0], at[1], at[2]};
}

void portals_add(struct portals *portals, const struct portal_bins *bins)
{
    assert(portals->count < PORTALS_MOST);
    size_t portal = portals->count++;
    uint32_t axis = bins->face.axis;
    ps_vec3 corner = point_of(portals, bins, (const float[2]){0, 0});
    ps_vec3 opposite = point_of(portals, bins, (const float[2]){1, 1});
    ps_vec3 across = ps_subtract(opposite, corner);
    portals->bins[portal] = *bins;
    for (uint32_t k = 0; k < 3; k++) {
        portals->middle[k][portal] = 0.5f * (coordinate(corner, k) + coordinate(opposite, k));
        portals->normal[k][portal] = k == axis ? 1.0f : 0.0f;
    }
    portals->area[portal] = coordinate(across, (axis + 1) % 3) * coordinate(across, (axis + 2) % 3);
    portals->radius[portal] = 0.5f * sqrtf(ps_dot(across, across));
    for (uint32_t row = bins->first[1]; row < bins->end[1]; row++)
        for (uint32_t column = bins->first[0]; column < bins->end[0]; column++)
            portals->portal_of[axis][bins->face.high][row][column] = (uint8_t)(portal + 1);
    for (size_t cell = 0; cell < PORTAL_CELL_COUNT; cell++)
        portals->visibility[cell][portal] = 1.0f;
}

/* About the light through each portal: area times the cosines at both ends over the square of the
 * distance, none of which is less than parts of the portal may have, so that only portals behind a
 * surface have 0. The sum. */
static float weigh(const struct portals *portals, ps_vec3 position, ps_vec3 normal,
                   float weights[PORTALS_MOST])
{
    const float *visibility = portals->visibility[portals_cell(portals, position)];
    bool faces = ps_dot(normal, normal) > 0.0f;
    float sum = 0.0f;
    for (size_t i = 0; i < portals->count; i++) {
        float x = portals->middle[0][i] - position.x, y = portals->middle[1][i] - position.y;
        float z = portals->middle[2][i] - position.z, radius = portals->radius[i];
        float across = fabsf(x * portals->normal[0][i] + y * portals->normal[1][i] +
                             z * portals->normal[2][i]);
        float square = x * x + y * y + z * z, distance = sqrtf(square);
        float facing = x * normal.x + y * normal.y + z * normal.z + radius;
        float size = square + portals->area[i] * (1.0f / PS_PI);
        float cosine = faces ? ps_max(facing, 0.0f) / (distance + radius) : 1.0f;
        weights[i] = visibility[i] * portals->area[i] * (across + 0.1f * radius) * cosine /
                     (size * sqrtf(size));
    }
    for (size_t i = 0; i < portals->count; i++)
        sum += weights[i];
    return sum;
}

/* The pdf of a direction in which a point of a portal lies, chosen evenly over its area. */
static float pdf_over_area(float area, float distance, float cosine)
{
    return distance * distance / (area * cosine);
}

/* How a point sees the portals. */
struct choice {
    float weights[PORTALS_MOST], sum;
};

static ps_vec3 choose(const struct portals *portals, const struct choice *choice, ps_vec3 position,
                      const float numbers[2])
{
    float at = numbers[0] * choice->sum;
    size_t i = 0;
    while (i + 1 < portals->count && at >= choice->weights[i])
        at -= choice->weights[i++];
    const float shares[2] = {ps_min(at / ps_max(choice->weights[i], 1e-30f), 1.0f), numbers[1]};
    return ps_normalize(ps_subtract(point_of(portals, &portals->bins[i], shares), position));
}

bool portals_choose(const struct portals *portals, ps_vec3 position, ps_vec3 normal,
                    const float numbers[2], ps_vec3 *direction)
{
    struct choice choice;
    choice.sum = weigh(portals, position, normal, choice.weights);
    if (!(choice.sum > 0.0f))
        return false;
    *direction = choose(portals, &choice, position, numbers);
    return true;
}

uint32_t portals_at(const struct portals *portals, const struct portal_exit *exit)
{
    return portals->portal_of[exit->face.axis][exit->face.high][exit->bin[1]][exit->bin[0]];
}

/* The pdf of a direction by portals alone. */
static float portal_pdf(const struct portals *portals, const struct choice *choice,
                        ps_vec3 position, ps_vec3 direction)
{
    struct portal_exit exit = portals_exit(portals, position, direction);
    uint32_t portal = portals_at(portals, &exit);
    if (portal == 0)
        return 0.0f;
    float pdf = pdf_over_area(portals->area[portal - 1], exit.distance, exit.cosine);
    return pdf < INFINITY ? choice->weights[portal - 1] / choice->sum * pdf : 0.0f;
}

/* --- the sky --- */

static float by_sky(const struct light *sky, const struct choice *choice, ps_vec3 normal)
{
    float least = sky->sky.picture.rgb ? BY_SKY_PICTURE : BY_SKY;
    float all = ps_dot(normal, normal) > 0.0f ? PS_PI : 4.0f * PS_PI;
    return least + (1.0f - least) * ps_min(WIDE_OPEN * choice->sum / all, 1.0f);
}

/* The first number tells whether a ray goes by the sky, too, as the share `share` does. */
static ps_vec3 direction_of(const struct portals *portals, const struct light *sky,
                            const struct choice *choice, float share, ps_vec3 position,
                            ps_vec3 normal, const float numbers[2])
{
    float rest[1][2] = {{numbers[0] / share, numbers[1]}};
    if (numbers[0] < share) {
        struct light_sample sample;
        light_sample(sky, &position, &normal, (const float(*)[2])rest, 1, &sample);
        return sample.direction;
    }
    rest[0][0] = (numbers[0] - share) / (1.0f - share);
    return choose(portals, choice, position, rest[0]);
}

static void sample_one(const struct portals *portals, const struct light *sky, ps_vec3 position,
                       ps_vec3 normal, const float numbers[1][2], struct light_sample *sample)
{
    struct choice choice = {.sum = 0.0f};
    if (portals_know(portals, position))
        choice.sum = weigh(portals, position, normal, choice.weights);
    if (!(choice.sum > 0.0f)) {
        light_sample(sky, &position, &normal, numbers, 1, sample);
        return;
    }
    float share = by_sky(sky, &choice, normal);
    ps_vec3 direction = direction_of(portals, sky, &choice, share, position, normal, numbers[0]);
    float pdf = share * light_pdf_by_normal(sky, normal, direction) +
                (1.0f - share) * portal_pdf(portals, &choice, position, direction);
    *sample = (struct light_sample){.direction = direction, .distance = INFINITY, .pdf = pdf};
    if (pdf > 0.0f)
        sample->weight = ps_rgb_scale(light_radiance_from(sky, direction), 1.0f / pdf);
}

void portals_sample(const struct portals *portals, const struct light *sky,
                    const ps_vec3 *positions, const ps_vec3 *normals, const float (*numbers)[2],
                    size_t n, struct light_sample *samples)
{
    for (size_t i = 0; i < n; i++)
        sample_one(portals, sky, positions[i], normals[i], numbers + i, &samples[i]);
}

float portals_pdf(const struct portals *portals, const struct light *sky, ps_vec3 position,
                  ps_vec3 direction)
{
    static const ps_vec3 unknown = {0, 0, 0};
    float pdf = light_pdf_by_normal(sky, unknown, direction);
    struct choice choice = {.sum = 0.0f};
    if (portals_know(portals, position))
        choice.sum = weigh(portals, position, unknown, choice.weights);
    if (!(choice.sum > 0.0f))
        return pdf;
    float share = by_sky(sky, &choice, unknown);
    return share * pdf + (1.0f - share) * portal_pdf(portals, &choice, position, direction);
}
