/* shape_height_field.c: a picture's brightness as heights.
 *
 * As in POV-Ray: x and z go from 0 to 1 over the picture, whose lower left pixel is at x = 0, z =
 * 0; a vertex for each pixel, so that w pixels make w - 1 squares. Each square is cut from its
 * corner of least x and z to that of greatest. The front is +y.
 */
#include "scene/shape_build.h"

static void set_vertices(const struct height_samples *heights, struct shape *shape)
{
    size_t across = heights->width, along = heights->height;
    for (size_t j = 0; j < along; j++) {
        const float *row = heights->samples + (along - 1 - j) * across;
        float z = (float)j / (float)(along - 1);
        for (size_t i = 0; i < across; i++) {
            float x = (float)i / (float)(across - 1);
            shape->vertices[j * across + i] = (ps_vec3){x, row[i], z};
            shape->uv[j * across + i][0] = x;
            shape->uv[j * across + i][1] = z;
        }
    }
}

static void set_triangles(size_t across, size_t along, struct shape *shape)
{
    uint32_t(*next)[3] = shape->triangles;
    for (size_t j = 0; j + 1 < along; j++)
        for (size_t i = 0; i + 1 < across; i++) {
            uint32_t near = (uint32_t)(j * across + i), far = near + (uint32_t)across;
            const uint32_t square[2][3] = {{near, far, far + 1}, {near, far + 1, near + 1}};
            for (int t = 0; t < 2; t++, next++)
                for (int k = 0; k < 3; k++)
                    (*next)[k] = square[t][k];
        }
}

/* Smooth normals are left at zero: shape_place fills in the mean of the faces around. */
static const char *check_heights(const struct height_samples *heights)
{
    if (!heights || !heights->samples)
        return "it has no picture";
    if (heights->width < 2 || heights->height < 2)
        return "its picture must be of 2 pixels or more each way";
    if (heights->width > SHAPE_HEIGHT_SAMPLES_MAX / heights->height)
        return "its picture has more than 2^27 pixels";
    for (size_t i = 0; i < heights->width * heights->height; i++)
        if (!isfinite(heights->samples[i]))
            return "its picture holds a value that is no number";
    return NULL;
}

ps_result shape_height_field(const struct object_description *object,
                             const struct shape_surroundings *surroundings, struct shape *shape,
                             struct error *error)
{
    const char *wrong = check_heights(surroundings->heights);
    if (wrong)
        return shape_invalid(object, error, wrong);
    const struct height_samples *heights = surroundings->heights;
    size_t across = heights->width, along = heights->height;
    unsigned parts = MESH_UV | (object->smooth ? MESH_NORMALS : 0u);
    ps_result result =
        shape_allocate(shape, across * along, 2 * (across - 1) * (along - 1), parts, error);
    if (result != PS_OK)
        return result;
    set_vertices(heights, shape);
    set_triangles(across, along, shape);
    return PS_OK;
}
