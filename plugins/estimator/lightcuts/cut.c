#include "cut.h"

/* The cut of a point: a heap, the largest bound first. */
struct cut {
    struct cut_entry *entries; /* borrowed */
    uint32_t count;
    float light; /* luminance of the irradiance found */
    uint8_t done;
};

/* --- heap --- */

static void exchange(struct cut_entry *a, struct cut_entry *b)
{
    struct cut_entry kept = *a;
    *a = *b;
    *b = kept;
}

static void sift_up(struct cut_entry *entries, uint32_t at)
{
    while (at > 0 && entries[at].bound > entries[(at - 1) / 2].bound) {
        exchange(&entries[at], &entries[(at - 1) / 2]);
        at = (at - 1) / 2;
    }
}

static void sift_down(struct cut_entry *entries, uint32_t count, uint32_t at)
{
    for (;;) {
        uint32_t child = 2 * at + 1;
        if (child >= count)
            return;
        child += child + 1 < count && entries[child + 1].bound > entries[child].bound;
        if (!(entries[child].bound > entries[at].bound))
            return;
        exchange(&entries[at], &entries[child]);
        at = child;
    }
}

/* --- light --- */

struct receiver {
    ps_vec3 position, normal; /* just above its surface */
};

/* What a light gives a receiver if nothing is in between, a unit of power; sets the ray that
 * tells. */
static float connect(const struct cut_setting *setting, const ps_photon *light,
                     const struct receiver *receiver, ps_ray *ray)
{
    ps_vec3 between = ps_subtract(virtual_light_origin(setting->pass, light), receiver->position);
    float distance2 = ps_dot(between, between), distance = sqrtf(distance2);
    ps_vec3 direction = ps_scale(between, 1.0f / distance);
    float cosines = ps_max(ps_dot(receiver->normal, direction), 0.0f) *
                    ps_max(-ps_dot(light->normal, direction), 0.0f);
    *ray = (ps_ray){receiver->position, 0.0f, direction, distance};
    float transfer = cosines / (PS_PI * ps_max(distance2, setting->clamp * setting->clamp));
    return cosines > 0.0f ? transfer : 0.0f;
}

static struct cut_entry entry_of(const struct cut_setting *setting, uint32_t place, float transfer,
                                 const struct receiver *receiver)
{
    const struct light_cluster *cluster = &setting->tree->clusters[place];
    float bound = 0.0f, power = ps_luminance(cluster->power);
    if (cluster->right && power > 0.0f)
        bound = power / PS_PI *
                light_cluster_bound(cluster, receiver->position, receiver->normal, setting->clamp);
    return (struct cut_entry){bound, place, transfer};
}

static ps_rgb light_of(const struct cut_setting *setting, const struct cut_entry *entry)
{
    return ps_rgb_scale(setting->tree->clusters[entry->cluster].power, entry->transfer);
}

/* --- steps --- */

/* Clusters with new representatives, one for each of some of a tile's points, and what these
 * give. */
struct step {
    size_t count; /* of rays */
    uint32_t targets[PS_TILE_PIXELS];
    ps_ray rays[PS_TILE_PIXELS];
    uint32_t clusters[PS_TILE_PIXELS]; /* by point, as what follows */
    float transfers[PS_TILE_PIXELS];
};

static void add_ray(const struct cut_setting *setting, uint32_t point, uint32_t cluster,
                    const struct receiver *receiver, struct step *step)
{
    const struct virtual_lights *lights = setting->tree->lights;
    uint32_t light = setting->tree->clusters[cluster].representative;
    step->targets[step->count] = point;
    step->clusters[point] = cluster;
    step->transfers[point] =
        connect(setting, &lights->lights[light], receiver, &step->rays[step->count]);
    step->count += step->transfers[point] > 0.0f;
}

static void trace(const struct cut_setting *setting, struct step *step)
{
    uint8_t blocked[PS_TILE_PIXELS];
    setting->host->occluded(setting->host, step->rays, step->count, blocked);
    for (size_t i = 0; i < step->count; i++)
        if (blocked[i])
            step->transfers[step->targets[i]] = 0.0f;
}

static int is_fine(const struct cut_setting *setting, const struct cut *cut)
{
    float bound = cut->entries[0].bound;
    return cut->count == setting->most || !(bound > 0.0f && bound > setting->error * cut->light);
}

/* The child of a cluster that has another representative. */
static uint32_t new_child(const struct light_tree *tree, uint32_t place)
{
    const struct light_cluster *cluster = &tree->clusters[place];
    int is_left = tree->clusters[place + 1].representative == cluster->representative;
    return is_left ? cluster->right : place + 1;
}

/* Replaces the cluster with the largest bound by its children, of which `child` has a transfer of
 * its own. */
static void refine(const struct cut_setting *setting, const struct receiver *receiver,
                   uint32_t child, float transfer, struct cut *cut)
{
    struct cut_entry parent = cut->entries[0];
    uint32_t left = parent.cluster + 1, right = setting->tree->clusters[parent.cluster].right;
    uint32_t other = child == left ? right : left;
    struct cut_entry first = entry_of(setting, other, parent.transfer, receiver);
    struct cut_entry second = entry_of(setting, child, transfer, receiver);
    cut->light += ps_luminance(light_of(setting, &first)) +
                  ps_luminance(light_of(setting, &second)) -
                  ps_luminance(light_of(setting, &parent));
    cut->entries[0] = first;
    sift_down(cut->entries, cut->count, 0);
    cut->entries[cut->count] = second;
    sift_up(cut->entries, cut->count++);
}

/* One step of all points whose cuts are too coarse; how many there are. */
static size_t take_step(const struct cut_setting *setting, const struct receiver *receivers,
                        size_t count, struct step *step, struct cut *cuts)
{
    size_t open = 0;
    step->count = 0;
    for (uint32_t i = 0; i < count; i++) {
        cuts[i].done = cuts[i].done || is_fine(setting, &cuts[i]);
        if (cuts[i].done)
            continue;
        add_ray(setting, i, new_child(setting->tree, cuts[i].entries[0].cluster), &receivers[i],
                step);
        open++;
    }
    trace(setting, step);
    for (uint32_t i = 0; i < count; i++)
        if (!cuts[i].done)
            refine(setting, &receivers[i], step->clusters[i], step->transfers[i], &cuts[i]);
    return open;
}

static void begin(const struct cut_setting *setting, const struct receiver *receivers, size_t count,
                  struct cut_entry *room, struct step *step, struct cut *cuts)
{
    step->count = 0;
    for (uint32_t i = 0; i < count; i++)
        add_ray(setting, i, 0, &receivers[i], step);
    trace(setting, step);
    for (uint32_t i = 0; i < count; i++) {
        cuts[i] = (struct cut){room + (size_t)i * setting->most, 1, 0.0f, 0};
        cuts[i].entries[0] = entry_of(setting, 0, step->transfers[i], &receivers[i]);
        cuts[i].light = ps_luminance(light_of(setting, &cuts[i].entries[0]));
    }
}

uint64_t cut_light_points(const struct cut_setting *setting, const ps_points *points,
                          struct cut_entry *room, ps_rgb *irradiance)
{
    struct receiver receivers[PS_TILE_PIXELS];
    struct cut cuts[PS_TILE_PIXELS];
    struct step step = {.count = 0};
    uint64_t clusters = 0;
    for (size_t i = 0; i < points->count; i++)
        receivers[i] = (struct receiver){
            ps_add_scaled(points->positions[i], setting->pass->surface_offset, points->normals[i]),
            points->normals[i]};
    begin(setting, receivers, points->count, room, &step, cuts);
    while (take_step(setting, receivers, points->count, &step, cuts) > 0)
        continue;
    for (size_t i = 0; i < points->count; i++) {
        irradiance[i] = (ps_rgb){0, 0, 0};
        for (uint32_t k = 0; k < cuts[i].count; k++)
            irradiance[i] = ps_rgb_add(irradiance[i], light_of(setting, &cuts[i].entries[k]));
        clusters += cuts[i].count;
    }
    return clusters;
}
