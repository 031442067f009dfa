/* room.c: rays from the middle of the model tell whether it is a room.
 *
 * What such a ray meets last is the outermost surface. Of a thing that surface turns its front away
 * from the middle, of a room towards it. Where many rays leave without meeting anything, the room
 * is open, as a stage is; level rays tell its walls from ground, which turns its front up and which
 * many rays from above it meet. A closed room with nothing in it is more often a thing whose faces
 * are wound the wrong way round, and is taken for that.
 */
#include "model/room.h"

#include "model/probe.h"
#include "scene/camera_frame.h"
#include <psplat/math.h>

#define DIRECTIONS 96
#define WALL_SHARE 0.4f  /* of the directions, that meet a wall's front */
#define FRONT_SHARE 0.8f /* of those that meet anything */
#define LEVEL_DIRECTIONS 32
#define AROUND 0.53f     /* of these, that meet a wall's front; two walls take half */
#define ALL_AROUND 0.8f  /* where the top or the bottom is open */
#define OPEN_SHARE 0.08f /* that meet nothing, of a room that is looked into from outside */
#define ABOVE 0.7f       /* y of the direction of an opening above or below */
#define FULL_SHARE 0.05f /* that meet things before a wall, of a closed room */
#define BEFORE 0.98f     /* of the way to the wall */

#define STAGE_ANGLE 40.0
#define STAGE_ASPECT (16.0 / 9.0)

#define CORNERS 4
#define GLANCES 9 /* from each corner, to find the one with the widest view */
#define ROOM_ANGLE 78.0
#define TO_CORNER 0.78f  /* of the way from the middle */
#define EYE_HEIGHT 0.55f /* of the room's */
#define TARGET_HEIGHT 0.42f
#define LAMP_HEIGHT 0.75f
#define LAMP_RADIUS 0.04f /* of the room's shortest side */

/* Even over the sphere: a spiral by the golden angle (Vogel 1979). */
static ps_vec3 spiral(size_t i, size_t count)
{
    float y = 1.0f - (2.0f * (float)i + 1.0f) / (float)count;
    float radius = sqrtf(ps_max(1.0f - y * y, 0.0f));
    float phi = (float)i * PS_PI * (3.0f - sqrtf(5.0f));
    return (ps_vec3){radius * cosf(phi), y, radius * sinf(phi)};
}

static ps_vec3 level_direction(size_t i)
{
    float phi = 2.0f * PS_PI * ((float)i + 0.5f) / LEVEL_DIRECTIONS;
    return (ps_vec3){cosf(phi), 0.0f, sinf(phi)};
}

static ps_vec3 inside(const struct box *box, ps_vec3 share)
{
    ps_vec3 size = ps_subtract(box->high, box->low);
    return ps_add(box->low, (ps_vec3){size.x * share.x, size.y * share.y, size.z * share.z});
}

/* --- the camera
 * ----------------------------------------------------------------------------------- */

/* Before the open side, or above it. */
static void look_in(struct room *room, const struct box *box, ps_vec3 opening)
{
    struct camera_description camera = {.up = {0, 1, 0}, .angle = STAGE_ANGLE};
    ps_vec3 away;
    if (fabsf(opening.y) > ABOVE)
        away = (ps_vec3){opening.x, opening.y, opening.z + copysignf(0.7f, opening.z)};
    else if (fabsf(opening.x) > fabsf(opening.z))
        away = (ps_vec3){copysignf(1.0f, opening.x), 0, 0};
    else
        away = (ps_vec3){0, 0, copysignf(1.0f, opening.z)};
    camera_frame_from(&camera, box, away, STAGE_ASPECT);
    room->location = camera.location;
    room->look_at = camera.look_at;
    room->angle = camera.angle;
}

/* How far one sees from there, in directions about that of view; 0 where it is in a wall or
 * thing. */
static float openness(const struct probe glances[GLANCES])
{
    float sum = 0.0f;
    for (int i = 0; i < GLANCES; i++)
        sum +=
            glances[i].nearest < INFINITY && glances[i].nearest_faces ? glances[i].nearest : 0.0f;
    return sum;
}

static void aim(struct probe glances[GLANCES], ps_vec3 from, ps_vec3 to)
{
    ps_vec3 forward = ps_normalize(ps_subtract(to, from)), u, v;
    ps_frame(forward, &u, &v);
    for (int i = 0; i < GLANCES; i++) {
        int row = i / 3;
        float across = 0.4f * (float)(i % 3 - 1), along = 0.4f * (float)(row - 1);
        ps_vec3 direction = ps_add_scaled(ps_add_scaled(forward, across, u), along, v);
        glances[i] = (struct probe){.origin = from, .direction = ps_normalize(direction)};
    }
}

/* In the corner with the widest view. */
static void stand_inside(struct room *room, const struct scene_description *fragment,
                         const struct box *box)
{
    struct probe glances[CORNERS * GLANCES];
    ps_vec3 corners[CORNERS];
    float widest = -1.0f;
    room->look_at = inside(box, (ps_vec3){0.5f, TARGET_HEIGHT, 0.5f});
    room->angle = ROOM_ANGLE;
    for (int i = 0; i < CORNERS; i++) {
        float x = i & 1 ? -TO_CORNER : TO_CORNER, z = i & 2 ? -TO_CORNER : TO_CORNER;
        corners[i] = inside(box, (ps_vec3){0.5f + 0.5f * x, EYE_HEIGHT, 0.5f + 0.5f * z});
        aim(glances + i * GLANCES, corners[i], room->look_at);
    }
    probe_all(fragment, glances, sizeof glances / sizeof glances[0]);
    for (int i = 0; i < CORNERS; i++) {
        float view = openness(glances + i * GLANCES);
        if (view > widest * 1.001f)
            room->location = corners[i];
        widest = fmaxf(widest, view);
    }
}

/* Shares of the directions in which the middle sees a wall, nothing at all, and things before what
 * is outermost. */
struct shares {
    float walls, open, full;
    float level;     /* of the level directions those that meet a wall */
    ps_vec3 opening; /* where it sees nothing */
};

/* What the ray meets last is a wall's front. */
static bool meets_wall(const struct probe *probe)
{
    return probe->nearest < INFINITY && probe->farthest_faces;
}

static struct shares look_around(const struct scene_description *fragment, const struct box *box)
{
    struct probe probes[DIRECTIONS + LEVEL_DIRECTIONS];
    const struct probe *level = probes + DIRECTIONS;
    struct shares shares = {0, 0, 0, 0, {0, 0, 0}};
    for (size_t i = 0; i < DIRECTIONS + LEVEL_DIRECTIONS; i++)
        probes[i] = (struct probe){.origin = box_center(box),
                                   .direction = i < DIRECTIONS ? spiral(i, DIRECTIONS)
                                                               : level_direction(i - DIRECTIONS)};
    probe_all(fragment, probes, DIRECTIONS + LEVEL_DIRECTIONS);
    for (size_t i = 0; i < LEVEL_DIRECTIONS; i++)
        shares.level += meets_wall(&level[i]) ? 1.0f / LEVEL_DIRECTIONS : 0.0f;
    for (size_t i = 0; i < DIRECTIONS; i++) {
        const struct probe *probe = &probes[i];
        bool leaves = !(probe->nearest < INFINITY);
        shares.walls += meets_wall(probe) ? 1.0f / DIRECTIONS : 0.0f;
        shares.full += probe->nearest < BEFORE * probe->farthest ? 1.0f / DIRECTIONS : 0.0f;
        shares.open += leaves ? 1.0f / DIRECTIONS : 0.0f;
        if (leaves)
            shares.opening = ps_add(shares.opening, probe->direction);
    }
    return shares;
}

static bool has_walls(const struct shares *shares, bool is_open)
{
    bool is_open_above = is_open && fabsf(ps_normalize(shares->opening).y) > ABOVE;
    return shares->walls >= WALL_SHARE && shares->walls >= FRONT_SHARE * (1.0f - shares->open) &&
           shares->level >= (is_open_above ? ALL_AROUND : AROUND);
}

struct room room_find(const struct scene_description *fragment, const struct box *box)
{
    struct room room = {.is_room = false};
    ps_vec3 size = ps_subtract(box->high, box->low);
    struct shares shares = look_around(fragment, box);
    bool is_open = shares.open > OPEN_SHARE && ps_length(shares.opening) > 0.0f;
    if (!has_walls(&shares, is_open) || (!is_open && shares.full < FULL_SHARE))
        return room;
    room.is_room = true;
    room.lamp = inside(box, (ps_vec3){0.5f, LAMP_HEIGHT, 0.5f});
    room.lamp_radius = (double)(LAMP_RADIUS * fminf(size.x, fminf(size.y, size.z)));
    if (is_open)
        look_in(&room, box, ps_normalize(shares.opening));
    else
        stand_inside(&room, fragment, box);
    return room;
}
