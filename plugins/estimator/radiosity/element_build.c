/* element_build.c: the tree over the scene's triangles. */
#include "element.h"

#include <assert.h>

#define READ 256u         /* triangles of the host at a time */
#define LEAST_AREA 1e-30f /* in squares of the scene's radius */
#define NORMAL_WEIGHT                                                                              \
    0.25f /* a difference of normals, in radii of the scene, when clusters are parted */

/* --- the triangles of the scene --- */

/* What the tree is built of: a place and a direction of each side. */
struct point {
    float coordinates[6];
    uint32_t side;
};

struct building {
    struct elements *elements;
    struct point *points;
    ps_triangle *triangles;
};

static void sides_of(const struct elements *elements, const ps_triangle *triangle, uint32_t number,
                     struct side *sides, struct point *points)
{
    ps_vec3 sum =
        ps_add(ps_add(triangle->vertices[0], triangle->vertices[1]), triangle->vertices[2]);
    ps_vec3 centre = elements_place(elements, ps_scale(sum, 1.0f / 3.0f));
    for (uint32_t back = 0; back < 2; back++) {
        ps_vec3 normal = ps_scale(triangle->normal, back ? -NORMAL_WEIGHT : NORMAL_WEIGHT);
        sides[back] = (struct side){triangle->object, number, back, ELEMENT_NONE};
        points[back] =
            (struct point){{centre.x, centre.y, centre.z, normal.x, normal.y, normal.z}, 0};
    }
}

/* Instances and spheres may be so small that their triangles have no area left, nor a normal. */
static bool has_area(const struct elements *elements, const ps_triangle *triangle)
{
    ps_vec3 n = triangle->normal;
    return triangle->area / elements->unit / elements->unit > LEAST_AREA &&
           isfinite(n.x + n.y + n.z);
}

static ps_result read_triangles(struct building *building)
{
    struct elements *elements = building->elements;
    const ps_host *host = elements->host;
    uint64_t count = host->triangle_count(host);
    if (count > UINT32_MAX / 8) {
        host->fail(host, PS_ERROR_INVALID, "the scene has more triangles than it can take");
        return PS_ERROR_INVALID;
    }
    elements->sides =
        host->allocate(host, (size_t)count * 2 * sizeof *elements->sides, "radiosity elements");
    building->points =
        host->allocate(host, (size_t)count * 2 * sizeof(struct point), "radiosity elements");
    building->triangles =
        host->allocate(host, (size_t)count * sizeof(ps_triangle), "radiosity elements");
    if (!elements->sides || !building->points || !building->triangles)
        return PS_ERROR_MEMORY;
    uint32_t number = 0, object = PS_NO_OBJECT;
    for (uint64_t first = 0; first < count; first += READ)
        host->triangles(host, first, READ < count - first ? READ : (size_t)(count - first),
                        building->triangles + first);
    size_t side = 0;
    for (size_t i = 0; i < count; i++, number++) {
        const ps_triangle triangle = building->triangles[i];
        if (triangle.object != object)
            number = 0;
        object = triangle.object;
        if (!has_area(elements, &triangle))
            continue;
        building->triangles[side / 2] = triangle;
        sides_of(elements, &triangle, number, &elements->sides[side], &building->points[side]);
        building->points[side].side = (uint32_t)side;
        building->points[side + 1].side = (uint32_t)(side + 1);
        side += 2;
    }
    elements->side_count = side;
    return PS_OK;
}

/* --- triangles as elements --- */

static void make_triangle(struct building *building, uint32_t index, uint32_t side)
{
    struct elements *elements = building->elements;
    const ps_triangle *triangle = &building->triangles[side / 2];
    struct element *element = elements_at(elements, index);
    bool back = side % 2;
    float unit = elements->unit;
    static const float places[3][2] = {{0, 0}, {1, 0}, {0, 1}};
    element->side = side;
    for (int i = 0; i < 3; i++) {
        int corner = back ? 2 - i : i;
        element->corners[i] = elements_place(elements, triangle->vertices[corner]);
        element->places[i][0] = places[corner][0];
        element->places[i][1] = places[corner][1];
    }
    element->normal = back ? ps_scale(triangle->normal, -1.0f) : triangle->normal;
    element->area = triangle->area / unit / unit;
    element->cone = 1.0f;
    element_measure(element);
    elements->sides[side].element = index;
}

/* How far the surface is from the middle and a corner of a triangle. */
static void measure_slack(void *user, uint64_t index, uint32_t worker)
{
    (void)worker;
    const struct elements *elements = user;
    const ps_host *host = elements->host;
    const struct side *side = &elements->sides[index];
    struct element *element = elements_at(elements, side->element);
    static const float weights[2][2] = {{1.0f / 3.0f, 1.0f / 3.0f}, {0.0f, 0.0f}};
    ps_ray ray;
    ps_hit hit;
    element->slack = 0.0f;
    for (int i = 0; i < 2; i++) {
        const float *at = weights[i];
        ps_surface_point point = {side->object, side->triangle, at[0], at[1], side->back};
        host->surface_points(host, &point, 1, &ray, &hit);
        ps_vec3 place = i == 0 ? element->centre : element->corners[side->back ? 2 : 0];
        float distance =
            ps_length(ps_subtract(elements_place(elements, ray.origin), place)) - elements->offset;
        element->slack = ps_max(element->slack, distance);
    }
    /* A sphere is farthest from the middle of the circle around a triangle. Of meshes it is
     * rounding. */
    element->slack = element->slack > 1e-3f * element->radius ? 1.25f * element->slack : 0.0f;
}

/* --- clusters --- */

static struct element no_element(uint32_t parent)
{
    return (struct element){.parent = parent, .side = ELEMENT_NONE};
}

/* Parts points[first, end) at the mean of the coordinate that they differ most in; returns
 * where. */
static size_t part(struct point *points, size_t first, size_t end)
{
    assert(points && first < end);
    int widest = 0;
    float width = -1.0f;
    double mean = 0.0;
    for (int k = 0; k < 6; k++) {
        float low = INFINITY, high = -INFINITY;
        double sum = 0.0;
        for (size_t i = first; i < end; i++) {
            low = ps_min(low, points[i].coordinates[k]);
            high = ps_max(high, points[i].coordinates[k]);
            sum += (double)points[i].coordinates[k];
        }
        if (high - low > width) {
            width = high - low;
            widest = k;
            mean = sum / (double)(end - first);
        }
    }
    size_t middle = first;
    for (size_t i = first; i < end; i++) {
        if ((double)points[i].coordinates[widest] >= mean)
            continue;
        struct point lower = points[i];
        points[i] = points[middle];
        points[middle++] = lower;
    }
    return middle > first && middle < end ? middle : first + (end - first) / 2;
}

/* Of clusters without children yet: which points they hold. */
struct range {
    uint32_t element;
    size_t first, end;
};

/* The tree has room for all of it: one element less than two for each side. */
static ps_result build_tree(struct building *building)
{
    struct elements *elements = building->elements;
    const ps_host *host = elements->host;
    size_t sides = elements->side_count, waiting = 1;
    struct range *ranges = host->allocate(host, sides * sizeof *ranges, "radiosity elements");
    if (!ranges || !elements->tree.items) {
        host->release(host, ranges);
        return PS_ERROR_MEMORY;
    }
    assert(sides > 0 && building->points);
    *elements_at(elements, elements->tree.count++) = no_element(ELEMENT_NONE);
    ranges[0] = (struct range){0, 0, sides};
    while (waiting > 0) {
        struct range range = ranges[--waiting];
        if (range.end - range.first == 1) {
            make_triangle(building, range.element, building->points[range.first].side);
            continue;
        }
        size_t middle = part(building->points, range.first, range.end);
        uint32_t child = (uint32_t)elements->tree.count;
        struct element *cluster = elements_at(elements, range.element);
        cluster->child = child;
        cluster->child_count = 2;
        for (int i = 0; i < 2; i++)
            *elements_at(elements, elements->tree.count++) = no_element(range.element);
        ranges[waiting++] = (struct range){child, range.first, middle};
        ranges[waiting++] = (struct range){child + 1, middle, range.end};
    }
    host->release(host, ranges);
    return PS_OK;
}

static void grow_box(ps_vec3 box[2], const ps_vec3 *points, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        ps_vec3 p = points[i];
        box[0] = (ps_vec3){ps_min(box[0].x, p.x), ps_min(box[0].y, p.y), ps_min(box[0].z, p.z)};
        box[1] = (ps_vec3){ps_max(box[1].x, p.x), ps_max(box[1].y, p.y), ps_max(box[1].z, p.z)};
    }
}

/* The cone that holds those of the children. */
static float cone_around(ps_vec3 normal, const struct element *children)
{
    float widest = 0.0f;
    for (int i = 0; i < 2; i++) {
        float cosine = ps_max(-1.0f, ps_min(1.0f, ps_dot(normal, children[i].normal)));
        widest = ps_max(widest, acosf(cosine) + acosf(children[i].cone));
    }
    return widest < PS_PI ? cosf(widest) : -1.0f;
}

static void measure_cluster(const struct elements *elements, struct element *cluster)
{
    const struct element *children = elements_at(elements, cluster->child);
    ps_vec3 sum = {0, 0, 0}, *box = cluster->corners;
    box[0] = (ps_vec3){INFINITY, INFINITY, INFINITY};
    box[1] = ps_scale(box[0], -1.0f);
    cluster->slack = 0.0f;
    for (int i = 0; i < 2; i++) {
        grow_box(box, children[i].corners, element_is_cluster(&children[i]) ? 2 : 3);
        cluster->area += children[i].area;
        cluster->slack = ps_max(cluster->slack, children[i].slack);
        sum = ps_add_scaled(sum, children[i].area, children[i].normal);
    }
    float length = ps_length(sum);
    cluster->centre = ps_scale(ps_add(box[0], box[1]), 0.5f);
    cluster->radius = 0.5f * ps_length(ps_subtract(box[1], box[0]));
    bool faces = length > 1e-3f * cluster->area;
    cluster->normal = faces ? ps_scale(sum, 1.0f / length) : (ps_vec3){0, 0, 1};
    cluster->cone = faces ? cone_around(cluster->normal, children) : -1.0f;
}

ps_result elements_create(const ps_host *host, const ps_pass *pass, struct elements *elements)
{
    *elements = (struct elements){.host = host};
    struct building building = {.elements = elements};
    host->scene_bounds(host, &elements->origin, &elements->unit);
    if (!(elements->unit > 0.0f))
        return PS_OK;
    elements->offset = pass->surface_offset / elements->unit;
    ps_result result = read_triangles(&building);
    if (result == PS_OK && elements->side_count > 0)
        result = array_reserve(host, &elements->tree, 2 * elements->side_count - 1,
                               sizeof(struct element), "radiosity elements")
                     ? build_tree(&building)
                     : PS_ERROR_MEMORY;
    if (result == PS_OK) {
        host->parallel_for(host, elements->side_count, measure_slack, elements);
        for (size_t i = elements->tree.count; i-- > 0;)
            if (element_is_cluster(elements_at(elements, i)))
                measure_cluster(elements, elements_at(elements, i));
    }
    host->release(host, building.points);
    host->release(host, building.triangles);
    return result;
}
