#include "contact.h"

void contact_tell_variance(const ps_host *host, const ps_points *points, const float *nearest,
                           const float *variance, ps_tile *tile)
{
    ps_camera camera = {.size = sizeof camera};
    float mean = 0.0f;
    host->camera(host, &camera);
    for (size_t i = 0; i < points->count; i++)
        mean += variance[i] / (float)points->count;
    for (size_t i = 0; i < points->count; i++) {
        uint32_t lane = points->lanes[i];
        if (nearest[i] < ps_pixel_size(&camera, tile->depth[lane]))
            tile->variance[lane] = ps_max(variance[i], mean);
    }
}
