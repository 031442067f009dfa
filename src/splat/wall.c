#include "splat/wall.h"

#include "splat/box.h"
#include <psplat/math.h>
#include <stdbool.h>

#define AZIMUTHS 16

/* How far walls are looked for, in half-widths: a pixel whose ray starts at the rim has half of its disc
 * beyond it. */
#define REACH 2.0f

/* Of the rays along a surface, so many are stopped near the ground where it is hollow, and get half as far
 * again or more where they run higher. */
#define MOST_AZIMUTHS 12
#define HIGHER_REACH 1.5f

/* Cosine and sine of an odd number of sixteenths of pi. */
#define C1 0.98078528f
#define C3 0.83146961f
#define C5 0.55557023f
#define C7 0.19509032f

static const float cosine[AZIMUTHS] = {C1,  C3,  C5,  C7,  -C7, -C5, -C3, -C1,
                                       -C1, -C3, -C5, -C7, C7,  C5,  C3,  C1};
static const float sine[AZIMUTHS] = {C7,  C5,  C3,  C1,  C1,  C3,  C5,  C7,
                                     -C7, -C5, -C3, -C1, -C1, -C3, -C5, -C7};

/* How far the rays got, in parts of the way to look; 1: all of it. */
struct free_way {
    float reach[AZIMUTHS];
};

/* A wall: points (u, v) with u a + v b = 1, so that 1 / reach = a cosine + b sine. */
struct wall {
    float a, b;
};

/* Along the surface, `height` above it. */
static struct free_way look_around(const ps_host *host, const ps_splat *splat,
                                   const ps_source *source, float height)
{
    _Alignas(64) ps_packet packet;
    struct free_way way;
    ps_vec3 origin = ps_add_scaled(source->position, height, source->normal);
    for (int i = 0; i < AZIMUTHS; i++) {
        float u = REACH * splat->half_width * cosine[i], v = REACH * splat->half_width * sine[i];
        ps_vec3 rim = ps_add(ps_scale(splat->axis_u, u), ps_scale(splat->axis_v, v));
        rim =
            ps_add_scaled(rim, u * splat->start_slope_u + v * splat->start_slope_v, splat->axis_w);
        ps_packet_set(&packet, (size_t)i, (ps_ray){origin, 0.0f, rim, 1.0f});
    }
    host->intersect_packets(host, &packet, 1, 0);
    for (int i = 0; i < AZIMUTHS; i++)
        way.reach[i] = fmaxf(packet.tfar[i], 1e-3f);
    return way;
}

/* How many rays get no farther than this part of the `other` ones' way. */
static int count_stopped(const struct free_way *way, const struct free_way *other, float part)
{
    int count = 0;
    for (int i = 0; i < AZIMUTHS; i++)
        count += way->reach[i] < 1.0f && way->reach[i] <= part * other->reach[i];
    return count;
}

static float reach_of(const struct wall *wall, int i)
{
    float inverse = wall->a * cosine[i] + wall->b * sine[i];
    return inverse > 1.0f ? 1.0f / inverse : 1.0f;
}

/* The wall through the hit of ray i and the nearer one of its neighbours'. */
static struct wall through(const struct free_way *way, int i)
{
    int left = (i + AZIMUTHS - 1) % AZIMUTHS, right = (i + 1) % AZIMUTHS;
    int j = way->reach[left] < way->reach[right] ? left : right;
    float at_i = 1.0f / way->reach[i], at_j = 1.0f / way->reach[j];
    if (!(way->reach[j] < 1.0f))
        return (struct wall){cosine[i] * at_i, sine[i] * at_i};
    float determinant = cosine[i] * sine[j] - cosine[j] * sine[i];
    return (struct wall){
        (at_i * sine[j] - at_j * sine[i]) / determinant,
        (at_j * cosine[i] - at_i * cosine[j]) / determinant,
    };
}

/* Whether the rays that a wall there would stop were stopped: a pole or a table's leg is none. Far out,
 * where a wall stops one ray or two, a pole counts as one; there it makes up for next to nothing. */
static bool stands(const struct wall *wall, const struct free_way *way)
{
    int expected = 0, met = 0;
    for (int i = 0; i < AZIMUTHS; i++) {
        float reach = reach_of(wall, i);
        expected += reach < 0.9f;
        met += reach < 0.9f && way->reach[i] < 1.1f * reach;
    }
    return 4 * met >= 3 * expected;
}

/* The ray that is stopped most clearly before the walls found so far; -1: none. */
static int nearest_unexplained(const struct free_way *way, const struct wall *walls, uint32_t n)
{
    int nearest = -1;
    for (int i = 0; i < AZIMUTHS; i++) {
        bool explained = way->reach[i] >= 1.0f;
        for (uint32_t k = 0; k < n; k++)
            explained |= way->reach[i] > 0.9f * reach_of(&walls[k], i);
        if (!explained && (nearest < 0 || way->reach[i] < way->reach[nearest]))
            nearest = i;
    }
    return nearest;
}

static void add_wall(const struct wall *wall, ps_splat *splat)
{
    float inverse = sqrtf(wall->a * wall->a + wall->b * wall->b);
    ps_wall *added = &splat->walls[splat->wall_count++];
    *added = (ps_wall){wall->a / inverse, wall->b / inverse, REACH / inverse};
}

static void find(const struct free_way *way, ps_splat *splat)
{
    struct wall walls[PS_MOST_WALLS];
    for (uint32_t n = 0; n < PS_MOST_WALLS; n++) {
        int nearest = nearest_unexplained(way, walls, n);
        if (nearest < 0)
            return;
        walls[n] = through(way, nearest);
        if (!stands(&walls[n], way))
            return;
        add_wall(&walls[n], splat);
    }
}

/* The way around a source, and where its beam starts. A hollow surface rises all around: its own walls
 * are no others, and its beam starts higher. */
static struct free_way look(const ps_host *host, float surface_offset, const ps_source *source,
                            ps_splat *splat)
{
    struct free_way low = look_around(host, splat, source, surface_offset);
    if (count_stopped(&low, &low, 1.0f) >= MOST_AZIMUTHS) {
        float clearance = box_clearance(surface_offset, splat->half_width, true);
        struct free_way high = look_around(host, splat, source, clearance);
        if (count_stopped(&low, &high, 1.0f / HIGHER_REACH) >= MOST_AZIMUTHS)
            return high;
    }
    box_start(source, box_clearance(surface_offset, splat->half_width, false), splat);
    return low;
}

void wall_find(const ps_host *host, float surface_offset, const ps_source *sources, size_t n,
               ps_splat *splats)
{
    for (size_t i = 0; i < n; i++) {
        if (!(splats[i].half_width > 0.0f))
            continue;
        struct free_way way = look(host, surface_offset, &sources[i], &splats[i]);
        find(&way, &splats[i]);
    }
}
