/* light.c: lights, from glTF's JSON or from assimp's list.
 *
 * KHR_lights_punctual counts in candela and lux. 683 lm are taken as one watt, the rate of
 * Blender's exporter ("standard" lighting mode, its default): a light of P watts leaves Blender as
 * 683 P / (4 pi) cd and becomes P / (4 pi) W/sr here, P watts in all; a sun's W/m^2 come back as
 * they were. A spot has the intensity of the whole sphere's share, there as here.
 *
 * COLLADA, FBX and 3DS state no unit. Their numbers are taken for what Blender's exporters write: P
 * watts of a point or a spot, P / (4 pi) W/sr, and W/m^2 of a sun. What fades otherwise than by the
 * square is not asked for. FBX counts lengths in UnitScaleFactor centimetres, but not its lights.
 *
 * An intensity I lights a surface by I / d^2: where the request stretches all lengths by s, I grows
 * by s^2, and the picture stays the same. Scales of nodes do not count, as glTF says. A sun's
 * irradiance stays.
 */
#include "import/steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREES (180.0 / 3.14159265358979323846)
#define LUMENS_PER_WATT 683.0
#define PI 3.14159265358979323846

/* In the node's space; the angles are half ones, in radians. */
struct source_light {
    enum light_kind kind;
    ps_rgb amount;
    ps_vec3 location, direction, up;
    double inner, outer;
    float width, height;
};

static bool is_sound(const struct light_description *light)
{
    ps_vec3 amount = {light->amount.r, light->amount.g, light->amount.b};
    return mesh_is_finite(amount) && amount.x >= 0 && amount.y >= 0 && amount.z >= 0 &&
           ps_rgb_maximum(light->amount) > 0 && mesh_is_finite(light->location) &&
           mesh_is_finite(light->point_at) && mesh_is_finite(light->direction) &&
           (light->kind == LIGHT_POINT || ps_length(light->direction) > 0);
}

static void drop(struct mesh_job *job, const char *name, const char *why)
{
    if (job->report->dropped_lights++ == 0)
        mesh_note(job->report, "light %.100s %s", name, why);
}

static void set_cone(struct light_description *light, const struct source_light *source)
{
    light->falloff = fmin(fmax(source->outer * DEGREES, 0.01), 89.9);
    light->radius = fmin(fmax(source->inner * DEGREES, 0), light->falloff);
}

static void set_rectangle(struct light_description *light, const struct affine *map,
                          const struct source_light *source)
{
    ps_vec3 up = ps_scale(source->up, 0.5f * source->height);
    ps_vec3 right = ps_cross(source->direction, source->up);
    light->half_edges[0] = affine_direction(map, ps_scale(right, 0.5f * source->width));
    light->half_edges[1] = affine_direction(map, up);
    if (ps_dot(ps_cross(light->half_edges[0], light->half_edges[1]), light->direction) < 0)
        light->half_edges[0] = ps_scale(light->half_edges[0], -1);
    light->visible = true;
}

static struct light_description place(const struct mesh_job *job, const struct affine *map,
                                      const struct source_light *source)
{
    ps_vec3 direction = affine_direction(map, source->direction);
    float length = ps_length(direction);
    struct light_description light = {
        .kind = source->kind,
        .amount = source->amount,
        .unit = UNIT_INTENSITY,
        .location = affine_point(map, source->location),
        .direction = length > 0 ? ps_scale(direction, 1 / length) : (ps_vec3){0, 0, 0},
        .texture = NO_INDEX,
        .origin = job->request->origin,
    };
    light.point_at = ps_add_scaled(light.location, (float)job->scale, light.direction);
    if (source->kind == LIGHT_SUN)
        light.unit = UNIT_IRRADIANCE;
    else if (source->kind == LIGHT_RECTANGLE)
        light.unit = UNIT_RADIANCE;
    else
        light.amount = ps_rgb_scale(light.amount, (float)(job->scale * job->scale));
    if (source->kind == LIGHT_SPOT)
        set_cone(&light, source);
    if (source->kind == LIGHT_RECTANGLE)
        set_rectangle(&light, map, source);
    return light;
}

static ps_result add(struct mesh_job *job, const struct affine *map,
                     const struct source_light *source, const char *name)
{
    struct scene_description *fragment = job->fragment;
    struct light_description light = place(job, map, source);
    size_t bytes = (fragment->light_count + 1) * sizeof *fragment->lights;
    if (!is_sound(&light)) {
        drop(job, name, "gives no light");
        return PS_OK;
    }
    struct light_description *lights = realloc(fragment->lights, bytes);
    if (!lights)
        return mesh_out_of_memory(job, bytes);
    fragment->lights = lights;
    lights[fragment->light_count++] = light;
    return PS_OK;
}

/* --- glTF
 * ----------------------------------------------------------------------------------------- */

static ps_rgb read_amount(const struct json *light)
{
    const struct json *color = json_member(light, "color");
    float value[3] = {1, 1, 1};
    for (size_t i = 0; i < 3; i++) {
        const struct json *component = json_element(color, i);
        if (component && component->kind == JSON_NUMBER)
            value[i] = (float)component->number;
    }
    double watts = json_number(light, "intensity", 1) / LUMENS_PER_WATT;
    return ps_rgb_scale((ps_rgb){value[0], value[1], value[2]}, (float)watts);
}

static bool read_kind(const struct json *light, enum light_kind *kind)
{
    const struct json *type = json_member(light, "type");
    if (!type || type->kind != JSON_STRING)
        return false;
    if (json_is(&type->text, "point"))
        *kind = LIGHT_POINT;
    else if (json_is(&type->text, "spot"))
        *kind = LIGHT_SPOT;
    else if (json_is(&type->text, "directional"))
        *kind = LIGHT_SUN;
    else
        return false;
    return true;
}

static ps_result add_gltf_light(struct mesh_job *job, size_t node, const struct json *light)
{
    struct affine map = mesh_node_placement(job, &job->nodes[node]);
    const char *name = job->nodes[node].node->mName.data;
    const struct json *spot = json_member(light, "spot");
    struct source_light source = {
        .amount = read_amount(light),
        .direction = {0, 0, -1},
        .inner = json_number(spot, "innerConeAngle", 0),
        .outer = json_number(spot, "outerConeAngle", 45 / DEGREES),
    };
    if (!read_kind(light, &source.kind)) {
        drop(job, name, "is of an unknown kind");
        return PS_OK;
    }
    return add(job, &map, &source, name);
}

static const struct json *extension_of(const struct json *object)
{
    return json_member(json_member(object, "extensions"), "KHR_lights_punctual");
}

static ps_result read_gltf_lights(struct mesh_job *job)
{
    const struct json *lights = json_member(extension_of(job->gltf.root), "lights");
    ps_result result = PS_OK;
    for (size_t i = 0; result == PS_OK && i < job->node_count; i++) {
        const struct json *reference = extension_of(mesh_gltf_node(job, i));
        size_t index;
        if (!json_member(reference, "light") || !json_size(reference, "light", 0, &index))
            continue;
        const struct json *light = json_element(lights, index);
        if (light)
            result = add_gltf_light(job, i, light);
    }
    return result;
}

/* --- other formats
 * -------------------------------------------------------------------------------- */

static bool kind_of(enum aiLightSourceType type, enum light_kind *kind)
{
    switch (type) {
    case aiLightSource_POINT:
        *kind = LIGHT_POINT;
        return true;
    case aiLightSource_SPOT:
        *kind = LIGHT_SPOT;
        return true;
    case aiLightSource_DIRECTIONAL:
        *kind = LIGHT_SUN;
        return true;
    case aiLightSource_AREA:
        *kind = LIGHT_RECTANGLE;
        return true;
    default:
        return false;
    }
}

/* Units of an FBX file in a metre; of others, what assimp hands out is in metres. */
static double units_per_metre(const struct mesh_job *job)
{
    const struct aiMetadata *data = job->scene->mMetaData;
    for (unsigned i = 0; job->format == FORMAT_FBX && data && i < data->mNumProperties; i++) {
        float centimetres = 0;
        if (data->mValues[i].mType == AI_FLOAT &&
            strcmp(data->mKeys[i].data, "UnitScaleFactor") == 0)
            memcpy(&centimetres, data->mValues[i].mData, sizeof centimetres);
        if (centimetres > 0 && isfinite(centimetres))
            return 100.0 / (double)centimetres;
    }
    return 1;
}

/* W/sr, or a sun's W/m^2, of what the file states. */
static ps_rgb assimp_amount(const struct mesh_job *job, const struct aiLight *light,
                            enum light_kind kind)
{
    ps_rgb stated = {light->mColorDiffuse.r, light->mColorDiffuse.g, light->mColorDiffuse.b};
    double unit = units_per_metre(job);
    bool fades = kind == LIGHT_POINT || kind == LIGHT_SPOT;
    return fades ? ps_rgb_scale(stated, (float)(unit * unit / (4 * PI))) : stated;
}

/* COLLADA's spots end at falloff_angle. Blender writes its blend, 0 to 1, as falloff_exponent, of
 * which assimp makes a rim of at least acos 0.1 around the cone. */
static double outer_cone(const struct mesh_job *job, const struct aiLight *light)
{
    double inner = light->mAngleInnerCone, outer = light->mAngleOuterCone;
    bool is_exponent = outer - inner > 84 / DEGREES;
    return job->format == FORMAT_COLLADA && is_exponent ? inner : outer;
}

static ps_result add_assimp_light(struct mesh_job *job, unsigned index)
{
    const struct aiLight *light = job->scene->mLights[index];
    size_t before = 0;
    for (unsigned i = 0; i < index; i++)
        before += strcmp(job->scene->mLights[i]->mName.data, light->mName.data) == 0;
    const struct mesh_node *node = mesh_node_named(job, light->mName.data, before);
    struct affine map = node ? mesh_node_placement(job, node) : job->to_scene;
    struct source_light source = {
        .location = mesh_vector(light->mPosition),
        .direction = mesh_vector(light->mDirection),
        .up = mesh_vector(light->mUp),
        .inner = 0.5 * light->mAngleInnerCone,
        .outer = 0.5 * outer_cone(job, light),
        .width = light->mSize.x,
        .height = light->mSize.y,
    };
    if (!kind_of(light->mType, &source.kind)) {
        drop(job, light->mName.data, "is of a kind that psplat lacks");
        return PS_OK;
    }
    if (source.kind == LIGHT_RECTANGLE && !(source.width > 0 && source.height > 0)) {
        drop(job, light->mName.data, "is an area without a size");
        return PS_OK;
    }
    source.amount = assimp_amount(job, light, source.kind);
    return add(job, &map, &source, light->mName.data);
}

ps_result mesh_read_lights(struct mesh_job *job)
{
    if (job->gltf.root)
        return read_gltf_lights(job);
    ps_result result = PS_OK;
    for (unsigned i = 0; result == PS_OK && i < job->scene->mNumLights; i++)
        result = add_assimp_light(job, i);
    return result;
}
