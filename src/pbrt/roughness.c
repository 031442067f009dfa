/* roughness.c: see roughness.h. */
#include "pbrt/roughness.h"

#include <math.h>
#include <stdio.h>

double roughness_from(double value, bool remap, int version)
{
    double alpha = fmax(value, 0.0);
    if (remap && version == 4) {
        alpha = sqrt(alpha);
    } else if (remap) {
        double x = log(fmax(value, 1e-3));
        alpha = 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
    }
    /* Below this pbrt-v4 takes a surface for smooth. */
    return alpha < 1e-3 ? 0.0 : fmin(sqrt(alpha), 1.0);
}

/* One of the three; false: it is absent. */
static bool read_one(struct importer *importer, const struct statement *statement,
                     const char *prefix, const char *name, const struct pattern *otherwise,
                     struct pattern *pattern)
{
    char whole[64];
    snprintf(whole, sizeof whole, "%s%s", prefix, name);
    bool found = texture_parameter(importer, statement, whole, otherwise->colors[0], pattern);
    if (!found)
        *pattern = *otherwise;
    return found;
}

struct pattern roughness_read(struct importer *importer, const struct statement *statement,
                              const char *prefix, double otherwise)
{
    struct pattern both = pattern_constant((const double[3]){otherwise, otherwise, otherwise}), u,
                   v;
    bool remap = statement_bool(importer, statement, "remaproughness", true);
    read_one(importer, statement, prefix, "roughness", &both, &both);
    read_one(importer, statement, prefix, "uroughness", &both, &u);
    read_one(importer, statement, prefix, "vroughness", &both, &v);
    if (!pattern_is_constant(&u)) {
        importer_warn(importer, &statement->origin, statement->width,
                      "a texture of roughness is taken for the square root of alpha as it is");
        pattern_clamp(importer, &(struct place){&statement->origin, statement->width}, "roughness",
                      1.0, &u);
        return u;
    }
    double along = u.colors[0][0], across = pattern_is_constant(&v) ? v.colors[0][0] : along;
    if (along != across)
        importer_warn(importer, &statement->origin, statement->width,
                      "a roughness that differs along u and v is taken for its geometric mean");
    double value = along == across ? along : sqrt(fmax(along, 0.0) * fmax(across, 0.0));
    value = roughness_from(value, remap, importer->version);
    return pattern_constant((const double[3]){value, value, value});
}
