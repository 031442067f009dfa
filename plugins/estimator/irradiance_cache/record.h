/* record.h: irradiance at a point, and how it changes around it: an entry of the cache. */
#ifndef PSPLAT_ESTIMATOR_IRRADIANCE_RECORD_H
#define PSPLAT_ESTIMATOR_IRRADIANCE_RECORD_H

#include "../shared/paths.h"

/* Cosine of the angle between normals at which a record ends. */
#define RECORD_FACING 0.9f

struct record {
    /* Given by the caller. */
    ps_vec3 position, normal;
    float footprint; /* size of a pixel there */
    /* What record_make() finds. Axes lie in the plane of the surface: those of the second
     * derivatives of irradiance. */
    ps_vec3 axes[2];
    float radii[2];       /* how far along them the record reaches */
    ps_rgb irradiance;    /* W/m^2 */
    ps_rgb gradients[2];  /* of irradiance, along the axes */
    ps_vec3 rotations[3]; /* gradients of its red, green and blue by the normal */
};

/* How records are made. */
struct record_setting {
    struct paths_setting paths;
    uint32_t rings, sectors; /* of the strata of its rays */
    float unit; /* of length, about as large as the scene, by which hits are measured */
    /* Radii, in pixels; where irradiance E has the second derivative c, the square is scale *
     * sqrt(E / c). */
    float scale, least, most;
};

/* Room for the rays of one record, for each worker. */
struct record_room {
    ps_rgb *radiance;           /* rings * sectors, as all */
    ps_vec3 *directions, *hits; /* hits: in the record's frame, in units */
};

/* Memory of rooms for all workers; NULL when out of memory. */
struct record_room *record_rooms_create(const struct record_setting *setting);
void record_rooms_release(const ps_host *host, struct record_room *rooms);

/* Makes a record whose place is given; its rays draw the random numbers from `first_sample` on. Any
 * thread. */
void record_make(const struct record_setting *setting, const struct record_room *room,
                 uint64_t first_sample, struct record *record);

/* How far above and below its surface a record tells anything. */
float record_thickness(const struct record *record);

/* Square of the distance of a point from the record, 1 where the record ends. */
float record_distance(const struct record *record, ps_vec3 position, ps_vec3 normal);

/* Irradiance that the record tells of at a point, not below 0. */
ps_rgb record_extrapolate(const struct record *record, ps_vec3 position, ps_vec3 normal);

#endif
