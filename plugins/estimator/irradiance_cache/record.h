/* record.h: irradiance at a point, and how it changes around it: an entry of the cache. */
#ifndef PSPLAT_ESTIMATOR_IRRADIANCE_RECORD_H
#define PSPLAT_ESTIMATOR_IRRADIANCE_RECORD_H

#include "../shared/paths.h"

/* Cosine of the angle between normals at which a record ends. */
#define RECORD_FACING 0.9f

struct record {
    ps_vec3 position, normal; /* the caller's, as is the footprint */
    float footprint;          /* size of a pixel there */
    ps_vec3 axes[2];          /* in the plane of the surface: of most and of least curvature */
    float radii[2];           /* along them: farther away the record tells nothing */
    ps_rgb irradiance;        /* W/m^2 */
    ps_vec3
        rotation[3]; /* of red, green and blue: times a change of the normal that of irradiance */
    ps_rgb gradients[2]; /* of irradiance along the axes */
};

/* How records are made. */
struct record_setting {
    struct paths_setting paths;
    uint32_t rings, sectors; /* of the strata of its rays */
    float far;               /* where rays that meet nothing are taken to end */
    /* Radii, in pixels. Where irradiance E changes with a curvature of c, the square of the radius is that of the scale
     * times the length sqrt(E / c). */
    float scale, least, most;
};

/* Room for the rays of one record, for each worker. */
struct record_room {
    ps_rgb *radiance; /* rings * sectors, as all */
    ps_vec3 *directions, *hits;
};

/* Memory of rooms for all workers; NULL when out of memory. */
struct record_room *record_rooms_create(const struct record_setting *setting);
void record_rooms_release(const ps_host *host, struct record_room *rooms);

/* Finds out all about a record whose place is given; its rays draw the random numbers from `first_sample` on. Any thread. */
void record_make(const struct record_setting *setting, const struct record_room *room,
                 uint64_t first_sample, struct record *record);

/* How far above and below its surface a record tells anything. */
float record_thickness(const struct record *record);

/* Square of the distance of a point from the record, 1 where the record ends. */
float record_distance(const struct record *record, ps_vec3 position, ps_vec3 normal);

/* Irradiance that the record tells of at a point, not below 0. */
ps_rgb record_extrapolate(const struct record *record, ps_vec3 position, ps_vec3 normal);

#endif
