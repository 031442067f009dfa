/* obj_mesh.c: the parts of an OBJ file as meshes.
 *
 * Corners that agree in all they have are one vertex. Normals are the file's, or those of its
 * smoothing groups: there a corner has the sum over the faces that share its vertex and group,
 * weighted by area; group 0 is flat.
 */
#include "import/geometry.h"

#include <stdlib.h>

/* The faces around a vertex of one smoothing group. */
struct smooth_sum {
    uint32_t group, next; /* the next of the same vertex, or OBJ_NONE */
    ps_vec3 area;         /* along the normal, twice the area */
};

/* A vertex of the part that is being filled. */
struct joint {
    uint32_t place, uv, normal; /* of the file, or OBJ_NONE; in smooth parts `normal` is a sum */
    uint32_t next;              /* an older one of the same place, or OBJ_NONE */
};

struct obj_filling {
    struct mesh_job *job;
    const struct obj *obj;
    struct joint *joints;
    size_t joint_count, joint_capacity;
    /* For each place its newest joint; it counts where that joint is of the place. */
    uint32_t *newest;
    struct smooth_sum *sums;
    size_t sum_count, sum_capacity;
    uint32_t *first_sums; /* for each place; NULL: there are no smoothing groups */
};

/* --- smoothing groups
 * ------------------------------------------------------------------------------ */

/* The group of a triangle; `run` is that of an earlier one, and moves on. */
static uint32_t group_of(const struct obj *obj, size_t triangle, size_t *run)
{
    while (*run + 1 < obj->run_count && obj->runs[*run + 1].first <= triangle)
        ++*run;
    return obj->runs[*run].group;
}

static size_t run_before(const struct obj *obj, size_t triangle)
{
    size_t low = 0, high = obj->run_count;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (obj->runs[middle].first <= triangle)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static uint32_t find_sum(const struct obj_filling *filling, uint32_t place, uint32_t group)
{
    uint32_t sum = filling->first_sums[place];
    while (sum != OBJ_NONE && filling->sums[sum].group != group)
        sum = filling->sums[sum].next;
    return sum;
}

static bool reserve_sum(struct obj_filling *filling)
{
    size_t capacity = 2 * filling->sum_capacity;
    if (filling->sum_count < filling->sum_capacity)
        return true;
    struct smooth_sum *sums = realloc(filling->sums, capacity * sizeof *sums);
    if (!sums)
        return false;
    filling->sums = sums;
    filling->sum_capacity = capacity;
    return true;
}

static bool add_to_sum(struct obj_filling *filling, uint32_t place, uint32_t group, ps_vec3 area)
{
    uint32_t sum = find_sum(filling, place, group);
    if (sum == OBJ_NONE) {
        if (!reserve_sum(filling))
            return false;
        sum = (uint32_t)filling->sum_count++;
        filling->sums[sum] = (struct smooth_sum){group, filling->first_sums[place], {0, 0, 0}};
        filling->first_sums[place] = sum;
    }
    filling->sums[sum].area = ps_add(filling->sums[sum].area, area);
    return true;
}

static ps_vec3 area_vector(const struct obj_text *text, size_t triangle)
{
    const uint32_t *corners = text->triangles[triangle];
    ps_vec3 a = text->places[corners[0]];
    return ps_cross(ps_subtract(text->places[corners[1]], a),
                    ps_subtract(text->places[corners[2]], a));
}

static bool add_sums(struct obj_filling *filling)
{
    const struct obj_text *text = &filling->obj->text;
    size_t run = 0;
    for (size_t i = 0; i < text->triangle_count; i++) {
        uint32_t group = group_of(filling->obj, i, &run);
        ps_vec3 area = area_vector(text, i);
        if (group == 0 || !mesh_is_finite(area))
            continue;
        for (int k = 0; k < 3; k++)
            if (!add_to_sum(filling, text->triangles[i][k], group, area))
                return false;
    }
    return true;
}

static bool has_groups(const struct obj *obj)
{
    for (size_t i = 0; i < obj->run_count; i++)
        if (obj->runs[i].group != 0)
            return true;
    return false;
}

/* --- what a part has
 * ------------------------------------------------------------------------------- */

static bool some_corner_has(const struct obj_part *part, const uint32_t (*indices)[3])
{
    for (size_t i = part->first; indices && i < part->first + part->count; i++)
        for (int k = 0; k < 3; k++)
            if (indices[i][k] != OBJ_NONE)
                return true;
    return false;
}

static bool is_smooth(const struct obj *obj, const struct obj_part *part)
{
    for (size_t i = run_before(obj, part->first);
         i < obj->run_count && obj->runs[i].first < part->first + part->count; i++)
        if (obj->runs[i].group != 0)
            return true;
    return false;
}

bool obj_has_colors(const struct mesh_job *job, const struct obj_part *part)
{
    const struct obj_text *text = &job->obj.text;
    if (!text->colors || text->partly_colored)
        return false;
    for (size_t i = part->first; i < part->first + part->count; i++)
        for (int k = 0; k < 3; k++) {
            const float *color = text->colors[text->triangles[i][k]];
            if (color[0] != 1.0f || color[1] != 1.0f || color[2] != 1.0f)
                return true;
        }
    return false;
}

/* --- vertices
 * -------------------------------------------------------------------------------------- */

enum normals { NORMALS_NONE, NORMALS_OF_FILE, NORMALS_OF_GROUPS };

static bool is_usable(ps_vec3 normal)
{
    float square = ps_dot(normal, normal);
    return isfinite(square) && square > 0;
}

/* A corner without a normal, which will get that of its triangle, shares its vertex with no
 * other. */
static bool is_shared(const struct obj_filling *filling, const struct joint *corner,
                      enum normals normals)
{
    const struct obj_text *text = &filling->obj->text;
    return normals == NORMALS_NONE ||
           (corner->normal != OBJ_NONE &&
            (normals == NORMALS_OF_GROUPS || is_usable(text->normals[corner->normal])));
}

static bool reserve_joint(struct obj_filling *filling)
{
    size_t capacity = 2 * filling->joint_capacity + 1024;
    if (filling->joints && filling->joint_count < filling->joint_capacity)
        return true;
    struct joint *joints = realloc(filling->joints, capacity * sizeof *joints);
    if (!joints)
        return false;
    filling->joints = joints;
    filling->joint_capacity = capacity;
    return true;
}

/* The number of the corner's vertex; OBJ_NONE: out of memory. */
static uint32_t vertex_of(struct obj_filling *filling, const struct joint *corner, bool shared)
{
    if (!reserve_joint(filling))
        return OBJ_NONE;
    uint32_t newest = filling->newest[corner->place];
    if (newest >= filling->joint_count || filling->joints[newest].place != corner->place)
        newest = OBJ_NONE;
    for (uint32_t i = newest; shared && i != OBJ_NONE; i = filling->joints[i].next)
        if (filling->joints[i].uv == corner->uv && filling->joints[i].normal == corner->normal)
            return i;
    filling->joints[filling->joint_count] =
        (struct joint){corner->place, corner->uv, corner->normal, newest};
    filling->newest[corner->place] = (uint32_t)filling->joint_count;
    return (uint32_t)filling->joint_count++;
}

static struct joint corner_of(const struct obj_filling *filling, size_t triangle, int k,
                              enum normals normals, uint32_t group)
{
    const struct obj_text *text = &filling->obj->text;
    struct joint corner = {
        .place = text->triangles[triangle][k],
        .uv = text->triangle_uv ? text->triangle_uv[triangle][k] : OBJ_NONE,
        .normal = OBJ_NONE,
    };
    if (normals == NORMALS_OF_FILE)
        corner.normal = text->triangle_normals[triangle][k];
    else if (normals == NORMALS_OF_GROUPS && group != 0)
        corner.normal = find_sum(filling, corner.place, group);
    return corner;
}

static bool is_good_triangle(const struct obj_text *text, const uint32_t corners[3])
{
    return mesh_has_area(text->places[corners[0]], text->places[corners[1]],
                         text->places[corners[2]]);
}

/* Triangles that have an area, in their order; the others are counted. */
static ps_result join_corners(struct obj_filling *filling, const struct obj_part *part,
                              enum normals normals, struct mesh_description *mesh, size_t *dropped)
{
    const struct obj_text *text = &filling->obj->text;
    size_t run = run_before(filling->obj, part->first);
    filling->joint_count = 0;
    for (size_t i = part->first; i < part->first + part->count; i++) {
        if (!is_good_triangle(text, text->triangles[i])) {
            ++*dropped;
            continue;
        }
        uint32_t group = group_of(filling->obj, i, &run);
        uint32_t *triangle = mesh->triangles[mesh->triangle_count++];
        for (int k = 0; k < 3; k++) {
            const struct joint corner = corner_of(filling, i, k, normals, group);
            triangle[k] = vertex_of(filling, &corner, is_shared(filling, &corner, normals));
            if (triangle[k] == OBJ_NONE)
                return mesh_out_of_memory(filling->job, filling->joint_capacity * sizeof corner);
        }
    }
    return PS_OK;
}

static ps_vec3 normal_of(const struct obj_filling *filling, const struct joint *joint,
                         enum normals normals)
{
    if (joint->normal == OBJ_NONE)
        return (ps_vec3){0, 0, 0};
    if (normals == NORMALS_OF_FILE)
        return filling->obj->text.normals[joint->normal];
    ps_vec3 area = filling->sums[joint->normal].area;
    float length = ps_length(area);
    return length > 0 && isfinite(length) ? ps_scale(area, 1.0f / length) : (ps_vec3){0, 0, 0};
}

static void fill_vertex(const struct obj_filling *filling, size_t index, enum normals normals,
                        struct mesh_description *mesh)
{
    const struct obj_text *text = &filling->obj->text;
    const struct joint *joint = &filling->joints[index];
    mesh->vertices[index] = text->places[joint->place];
    if (mesh->normals)
        mesh->normals[index] = normal_of(filling, joint, normals);
    for (int i = 0; mesh->uv && i < 2; i++) {
        float value = joint->uv == OBJ_NONE ? 0.0f : text->uv[joint->uv][i];
        mesh->uv[index][i] = isfinite(value) ? value : 0.0f;
    }
    if (mesh->colors)
        mesh_fill_color(filling->job, text->colors[joint->place], mesh->colors[index]);
}

/* --- filling
 * --------------------------------------------------------------------------------------- */

static ps_result fill(struct obj_filling *filling, const struct obj_part *part, bool colors,
                      struct mesh_description *mesh, size_t *dropped)
{
    const struct obj_text *text = &filling->obj->text;
    enum normals normals = some_corner_has(part, (const uint32_t(*)[3])text->triangle_normals)
                               ? NORMALS_OF_FILE
                           : is_smooth(filling->obj, part) ? NORMALS_OF_GROUPS
                                                           : NORMALS_NONE;
    const struct mesh_parts parts = {
        .normals = normals != NORMALS_NONE,
        .uv = some_corner_has(part, (const uint32_t(*)[3])text->triangle_uv),
        .colors = colors,
    };
    ps_result result = join_corners(filling, part, normals, mesh, dropped);
    if (result == PS_OK && mesh->triangle_count > 0)
        result = mesh_allocate_vertices(filling->job, mesh, filling->joint_count, &parts);
    if (result != PS_OK || mesh->triangle_count == 0)
        return result;
    for (size_t i = 0; i < filling->joint_count; i++)
        fill_vertex(filling, i, normals, mesh);
    return mesh_settle_normals(filling->job, mesh);
}

ps_result obj_fill(struct obj_filling *filling, const struct obj_part *part, bool colors,
                   struct mesh_description *mesh, size_t *dropped)
{
    *dropped = 0;
    mesh->triangles = malloc((part->count + 1) * sizeof *mesh->triangles);
    if (!mesh->triangles)
        return mesh_out_of_memory(filling->job, part->count * sizeof *mesh->triangles);
    return fill(filling, part, colors, mesh, dropped);
}

static uint32_t *no_indices(size_t count)
{
    uint32_t *indices = malloc((count + 1) * sizeof *indices);
    for (size_t i = 0; indices && i < count; i++)
        indices[i] = OBJ_NONE;
    return indices;
}

struct obj_filling *obj_filling_create(struct mesh_job *job)
{
    struct obj_filling *filling = calloc(1, sizeof *filling);
    size_t places = job->obj.text.place_count;
    if (!filling)
        return NULL;
    filling->job = job;
    filling->obj = &job->obj;
    filling->newest = no_indices(places);
    bool good = filling->newest != NULL;
    if (good && has_groups(filling->obj)) {
        filling->sum_capacity = 1024;
        filling->sums = calloc(filling->sum_capacity, sizeof *filling->sums);
        filling->first_sums = no_indices(places);
        good = filling->sums && filling->first_sums && add_sums(filling);
    }
    if (good)
        return filling;
    obj_filling_destroy(filling);
    return NULL;
}

void obj_filling_destroy(struct obj_filling *filling)
{
    if (!filling)
        return;
    free(filling->joints);
    free(filling->newest);
    free(filling->sums);
    free(filling->first_sums);
    free(filling);
}
