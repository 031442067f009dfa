#include "import/import.h"

#include <string.h>
#include <xxhash.h>

static uint64_t add(uint64_t digest, const void *bytes, size_t size)
{
    return XXH3_64bits_withSeed(bytes, size, digest);
}

static uint64_t add_text(uint64_t digest, const char *text)
{
    unsigned char is_there = text != NULL;
    digest = add(digest, &is_there, 1);
    return text ? add(digest, text, strlen(text) + 1) : digest;
}

uint64_t mesh_request_digest(const struct mesh_request *request)
{
    const struct affine *to = &request->placement;
    const unsigned char flags[] = {request->diffuse_only, request->srgb_colors};
    const double numbers[] = {request->unit, request->up, request->bump_scale,
                              request->smooth_angle};
    const ps_vec3 columns[] = {to->x, to->y, to->z, to->translation};
    uint64_t digest = add_text(add_text(0, request->path), request->folder);
    digest = add(digest, flags, sizeof flags);
    digest = add(digest, numbers, sizeof numbers);
    return add(digest, columns, sizeof columns);
}
