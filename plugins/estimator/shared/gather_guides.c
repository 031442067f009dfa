#include "gather_guides.h"

#define SAME_FACING 0.8f /* cosine of two normals that share a guide */

static uint8_t choose_guide(struct gather *gather, ps_vec3 normal)
{
    uint32_t best = 0;
    float most = -2.0f;
    for (uint32_t i = 0; i < gather->guide_count; i++) {
        float cosine = ps_dot(gather->guides[i].normal, normal);
        if (cosine > most) {
            most = cosine;
            best = i;
        }
    }
    if (most >= SAME_FACING || gather->guide_count == GATHER_GUIDES)
        return (uint8_t)best;
    guide_begin(&gather->guides[gather->guide_count], normal);
    return (uint8_t)gather->guide_count++;
}

/* Turns guides to the mean of the normals that share them: of a bent surface, the horizon of one
 * point would hide the light of another, which rays by the cosine alone would find. */
static void face_mean_normals(struct gather *gather)
{
    ps_vec3 sums[GATHER_GUIDES] = {{0, 0, 0}};
    for (size_t i = 0; i < gather->points.count; i++) {
        uint8_t which = gather->guide_of[i];
        ps_vec3 normal = gather->points.normals[i], first = gather->guides[which].normal;
        if (ps_dot(normal, first) < SAME_FACING)
            continue;
        sums[which] = ps_add(sums[which], normal);
        gather->is_bent[which] |= !ps_same(normal, first);
    }
    for (uint32_t i = 0; i < gather->guide_count; i++)
        if (gather->is_bent[i])
            guide_begin(&gather->guides[i], ps_normalize(sums[i]));
}

/* Turns guides of bent surfaces as those points face which get most of the light: or at the edge of
 * a ball's shade it would come from below the horizon of the mean. */
static void face_lit_points(struct gather *gather, const struct photon_guide_draws *drawn)
{
    ps_vec3 sums[GATHER_GUIDES] = {{0, 0, 0}};
    for (size_t k = 0; k < drawn->count; k++) {
        size_t i = drawn->points[k];
        ps_vec3 normal = gather->points.normals[i];
        uint8_t which = gather->guide_of[i];
        if (ps_dot(normal, gather->guides[which].normal) >= SAME_FACING)
            sums[which] = ps_add_scaled(sums[which], drawn->light[k], normal);
    }
    for (uint32_t i = 0; i < gather->guide_count; i++)
        if (gather->is_bent[i] && ps_length(sums[i]) > 0.0f)
            guide_begin(&gather->guides[i], ps_normalize(sums[i]));
}

void gather_choose_guides(struct gather *gather)
{
    gather->guide_count = 0;
    for (size_t i = 0; i < gather->points.count; i++)
        gather->guide_of[i] = choose_guide(gather, gather->points.normals[i]);
    face_mean_normals(gather);
}

void gather_guide_first(struct gather *gather)
{
    const struct gather_setting *setting = gather->setting;
    if (!setting->photons)
        return;
    struct photon_guide_draws drawn;
    photon_guide_draw(setting->photons, setting->paths.pass, &gather->points, gather->index,
                      &drawn);
    face_lit_points(gather, &drawn);
    for (uint32_t i = 0; i < gather->guide_count; i++)
        guide_begin(&gather->first_guides[i], gather->guides[i].normal);
    for (size_t k = 0; k < drawn.count; k++) {
        size_t i = drawn.points[k];
        struct guide *guide = &gather->first_guides[gather->guide_of[i]];
        guide_add(guide, drawn.halves[k],
                  guide_bin_of(guide, gather->points.normals[i], drawn.rays[k].direction),
                  drawn.light[k]);
    }
    for (uint32_t i = 0; i < gather->guide_count; i++) {
        guide_update_coarse(&gather->first_guides[i]);
        gather->first.is_guided |= gather->first_guides[i].scale > 0.0f;
    }
}
