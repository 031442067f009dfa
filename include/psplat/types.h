/* types.h: the values that cross between psplat and its plugins.
 *
 * Units: lengths in scene units; directions have length 1; radiometry is linear Rec.709 RGB in
 * watts (power), W/m^2 (irradiance) and W/(m^2 sr) (radiance), where "metre" means the scene unit.
 * Coordinates are right-handed.
 */
#ifndef PSPLAT_TYPES_H
#define PSPLAT_TYPES_H

#include <stddef.h>
#include <stdint.h>

typedef struct ps_vec3 {
    float x, y, z;
} ps_vec3;

typedef struct ps_rgb {
    float r, g, b;
} ps_rgb;

/* What a function that can fail returns; 0 is success. */
typedef enum ps_result {
    PS_OK = 0,
    PS_ERROR_MEMORY = 1,
    PS_ERROR_INVALID = 2, /* a setting or input that makes no sense */
    PS_ERROR_IO = 3,
    PS_CANCELLED = 4
} ps_result;

typedef struct ps_ray {
    ps_vec3 origin;
    float tnear; /* >= 0 */
    ps_vec3 direction;
    float tfar; /* > tnear; may be INFINITY */
} ps_ray;

#define PS_NO_OBJECT UINT32_MAX

#define PS_HIT_BACK 1u     /* the ray met the back of the surface, or came from inside */
#define PS_HIT_SPECULAR 2u /* the surface also mirrors or refracts: host->scatter knows how */
#define PS_HIT_EMISSIVE 4u /* it shines by itself */

/* Where a ray met a surface. `distance` is INFINITY, and `object` PS_NO_OBJECT, where it met none;
 * the other members are then unset. Both normals have length 1 and lie on the side that the ray came
 * from. */
typedef struct ps_hit {
    ps_vec3 position;
    float distance;
    ps_vec3 normal; /* for shading: smoothed, bent by bumps */
    uint32_t object;
    ps_rgb albedo; /* diffuse reflectance towards the ray's origin, 0..1 */
    uint32_t material;
    ps_vec3 geometric_normal; /* of the surface itself: the side that rays leave to */
    uint32_t flags;           /* PS_HIT_... */
    ps_vec3 texture_point;    /* where its textures are looked up */
    float uv[2];
} ps_hit;

/* How light went on at a surface. */
typedef enum ps_lobe {
    PS_DIFFUSE = 0,
    PS_GLOSSY = 1,  /* into directions around the mirrored one */
    PS_SPECULAR = 2 /* mirrored or refracted: one direction alone */
} ps_lobe;

/* One direction in which a surface scatters, drawn by the surface's own distribution. */
typedef struct ps_bsdf_sample {
    ps_vec3 direction;
    ps_vec3 normal;    /* of the surface, on the side that the direction leaves to */
    ps_rgb weight;     /* what is carried is multiplied by this; black: absorbed */
    float probability; /* by which the lobe was chosen among the surface's lobes; it is in weight */
    float pdf;         /* of the direction by solid angle, with probability; 0: PS_SPECULAR */
    uint32_t lobe;     /* ps_lobe */
} ps_bsdf_sample;

/* Which way a path runs: refraction and smoothed normals tell the two apart (Veach 1997, ch. 5). */
typedef enum ps_direction { PS_FROM_CAMERA = 0, PS_FROM_LIGHT = 1 } ps_direction;

/* Sixteen rays, structure of arrays, laid out as the ray tracer wants them. The caller fills
 * origin, direction, tnear and tfar; tracing shortens tfar to the first hit, or leaves it. `tail`
 * is the tracer's. Must be aligned to 64 bytes. */
typedef struct ps_packet {
    float origin_x[16], origin_y[16], origin_z[16], tnear[16];
    float direction_x[16], direction_y[16], direction_z[16], time[16];
    float tfar[16];
    uint32_t mask[16], id[16], flags[16];
    uint32_t tail[9 * 16];
} ps_packet;

/* An indirect light source: one bundled light ray (Hoet 2014, section 3.2). All strategies exchange
 * these. `power` is what the bundle carries away from `position` along `direction`. */
typedef struct ps_photon {
    ps_vec3 position;
    ps_vec3 normal; /* of the surface that the photon lies on */
    ps_vec3 direction;
    ps_rgb power; /* W */
    uint16_t
        bounce;   /* diffuse surfaces met so far, this one included: 1 = lit by a light directly */
    uint8_t lobe; /* ps_lobe by which the surface sent it out; not PS_DIFFUSE: a caustic */
    uint8_t specular; /* 1: some surface on the light's way, this one included, did not scatter it
                         diffusely */
    float merged;     /* how many emitted photons this one stands for (1 when none were merged) */
    uint64_t path;    /* number of the light path, counted over all passes; keys random streams */
} ps_photon;

/* A wall beside a photon, behind which part of its bundle would start: the ray at (u, v), in
 * half-widths, starts distance - u * normal_u - v * normal_v in front of it. */
typedef struct ps_boundary {
    float normal_u, normal_v; /* length 1 */
    float distance;
} ps_boundary;

#define PS_MOST_BOUNDARIES 2

/* A photon carried to the surface that it lights: an orthographic box around the first hit, or around a
 * point of the axis beside which something is met.
 * A point p lies at depth t = (p - centre).axis_w, and is inside where
 * |(p - centre).axis_u|, |(p - centre).axis_v| <= half_width and near_depth <= t <= far_depth. */
typedef struct ps_splat {
    ps_vec3 centre;
    float half_width;               /* > 0; a splat with half_width 0 lights nothing */
    ps_vec3 axis_u, axis_v, axis_w; /* orthonormal; axis_w is the direction of the light */
    float near_depth, far_depth; /* relative to the centre; near <= 0 <= far until cut to a map */
    /* Depth at which rays of the bundle start (what lies before stays dark, but see below), at the
     * centre, and its change along u and v (a tilted start plane). */
    float start_depth, start_slope_u, start_slope_v;
    /* Of full bundles: where the photon's tangent plane, parallel to the start plane, crosses the axis. At
     * distance t from it a pixel takes the part of the disc around its own ray of half-width follow * t /
     * (1 + follow * s), s the change of t across the bundle over its surface, between `narrowest` > 0
     * and `widest`; and where that is less than the box's, the bundle starts as much nearer to the
     * photon's plane. follow 0: all pixels take all of it, and photon_depth says nothing. */
    float photon_depth, follow, narrowest, widest;
    /* Of full bundles that follow the distance: what lies this far from the photon's plane, or farther, gets all
     * of the light; what lies nearer, the less of it, the nearer. The rest is gathered otherwise
     * (host->gather_short_range). 0: all gets all. */
    float blend_distance;
    /* Lit where t <= map + constant + slope * tan(theta), slope >= 0, theta between the light and the
     * receiver's normal. */
    float bias_constant, bias_slope;
    ps_rgb power;  /* W */
    float merged;  /* photons that it stands for: how often its weight counts; 0 is as 1 */
    uint64_t path; /* of its photon */
    uint32_t boundary_count;
    ps_boundary boundaries[PS_MOST_BOUNDARIES];
} ps_splat;

/* What the rays of a light have in common. */
typedef enum ps_light_kind {
    PS_LIGHT_POINT = 0,   /* they leave one point: a point light or a spotlight */
    PS_LIGHT_SUN = 1,     /* they come from infinity, out of one direction or a small cone */
    PS_LIGHT_SURFACE = 2, /* they leave a surface: an area light, an object that shines */
    PS_LIGHT_SKY = 3      /* they come from infinity, out of all directions */
} ps_light_kind;

typedef struct ps_light {
    uint32_t kind;    /* ps_light_kind */
    float cos_cone;   /* PS_LIGHT_POINT: cosine of the half angle of the cone around `axis` that it
                         shines into; -1: all around */
    ps_vec3 position; /* PS_LIGHT_POINT */
    ps_vec3 axis;     /* PS_LIGHT_POINT, PS_LIGHT_SUN: unit; where it shines to */
    ps_rgb power;     /* W; of sun and sky: what enters the sphere around the scene */
} ps_light;

#define PS_TILE_SIZE 16
#define PS_TILE_PIXELS 256

/* One 16x16 tile of the G-buffer and of the pass's accumulators, structure of arrays, 64-byte
 * aligned. Lanes that are no pixel of the picture, or whose pixel sees nothing, have depth
 * INFINITY, object PS_NO_OBJECT, a normal of 0 and a position far outside of any scene. */
typedef struct ps_tile {
    float position_x[PS_TILE_PIXELS], position_y[PS_TILE_PIXELS], position_z[PS_TILE_PIXELS];
    float normal_x[PS_TILE_PIXELS], normal_y[PS_TILE_PIXELS], normal_z[PS_TILE_PIXELS];
    float albedo_r[PS_TILE_PIXELS], albedo_g[PS_TILE_PIXELS], albedo_b[PS_TILE_PIXELS];
    float depth[PS_TILE_PIXELS]; /* distance from the camera, along the way that light takes */
    uint32_t object[PS_TILE_PIXELS], material[PS_TILE_PIXELS];
    /* What mirrors and glass on the way leave of the light from here to the camera: radiance in the
     * picture is throughput * albedo / pi * irradiance. */
    float throughput_r[PS_TILE_PIXELS], throughput_g[PS_TILE_PIXELS], throughput_b[PS_TILE_PIXELS];
    /* What an estimator adds to: indirect irradiance (W/m^2), and the weight of what was added, 0
     * where the pixel learned nothing. */
    float irradiance_r[PS_TILE_PIXELS], irradiance_g[PS_TILE_PIXELS], irradiance_b[PS_TILE_PIXELS];
    float weight[PS_TILE_PIXELS];
} ps_tile;

#endif
