/* types.h: the values that cross between psplat and its plugins.
 *
 * Units: lengths in scene units; directions have length 1; radiometry is linear Rec.709 RGB in
 * watts (power), W/m^2 (irradiance) and W/(m^2 sr) (radiance), where "metre" means the scene unit.
 * Coordinates are right-handed.
 *
 * Structs that cross in arrays never change within a major version of the interface: what is new
 * comes by new functions. The others begin with their size, and grow at their end; see module.h.
 */
#ifndef PSPLAT_TYPES_H
#define PSPLAT_TYPES_H

#include <psplat/result.h>
#include <stddef.h>
#include <stdint.h>

typedef struct ps_vec3 {
    float x, y, z;
} ps_vec3;

typedef struct ps_rgb {
    float r, g, b;
} ps_rgb;

typedef struct ps_ray {
    ps_vec3 origin;
    float tnear; /* >= 0 */
    ps_vec3 direction;
    float tfar; /* > tnear; may be INFINITY */
} ps_ray;

#define PS_NO_OBJECT UINT32_MAX

#define PS_HIT_BACK 1u     /* the ray met the back of the surface, or came from inside */
#define PS_HIT_SPECULAR 2u /* the surface has lobes that are not diffuse: host->sample_bsdf knows */
#define PS_HIT_EMISSIVE 4u /* it shines by itself */
#define PS_HIT_OWN 0xff000000u /* bits that are psplat's own */

/* Where a ray met a surface. `distance` is INFINITY, and `object` PS_NO_OBJECT, where it met none;
 * the other members are then unset. Both normals have length 1 and lie on the side that the ray
 * came from. */
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
    float roughness; /* of its smoothest lobe, 0..1: 0 mirrors or refracts, 1 is diffuse */
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

/* What a surface scatters from one direction into another; its mirrors and glass left out. */
typedef struct ps_bsdf_value {
    ps_rgb value;      /* BSDF times cosine, 1/sr */
    float pdf;         /* by which ps_bsdf_sample draws the direction, all lobes together, 1/sr */
    float reverse_pdf; /* the same where the light comes from there, and leaves along the ray */
} ps_bsdf_value;

/* Which way a path runs: refraction and smoothed normals tell the two apart (Veach 1997, ch. 5). */
typedef enum ps_direction { PS_FROM_CAMERA = 0, PS_FROM_LIGHT = 1 } ps_direction;

/* Sixteen rays, structure of arrays, aligned to 64 bytes. */
typedef struct ps_ray_packet {
    float origin_x[16], origin_y[16], origin_z[16], tnear[16];
    float direction_x[16], direction_y[16], direction_z[16], tfar[16];
} ps_ray_packet;

/* What a light path has met, so far, that did not scatter it diffusely. */
typedef enum ps_gloss {
    PS_NO_GLOSS = 0,
    PS_SHARP_GLOSS = 1, /* mirrors, glass, or gloss smoother than PS_ROUGH_GLOSS, among others */
    PS_ONLY_ROUGH_GLOSS = 2 /* since 1.15 */
} ps_gloss;

/* Roughness (ps_hit.roughness) from which on paths from the camera find what gloss reflects of
 * lamps. */
#define PS_ROUGH_GLOSS 0.2f

/* Light that leaves a surface: an indirect light source. It stands for a bundled light ray (Hoet
 * 2014, section 3.2) that carries `power` from `position` along `direction`. All strategies
 * exchange these. */
typedef struct ps_photon {
    ps_vec3 position;
    ps_vec3 normal; /* of the surface that it leaves */
    ps_vec3 direction;
    ps_rgb power; /* W */
    uint16_t
        bounce;   /* diffuse surfaces met so far, this one included: 1 = lit by a light directly */
    uint8_t lobe; /* ps_lobe by which the surface sent it out; not PS_DIFFUSE: a caustic */
    uint8_t specular; /* ps_gloss of the light's way, this surface included */
    float merged;     /* how many emitted photons this one stands for (1 when none were merged) */
    uint64_t path;    /* number of the light path, counted over all passes; keys random streams */
} ps_photon;

/* A straight border across a bundle, beyond which no ray starts: there a wall stands on the surface
 * that the bundle leaves. Beyond it lie the rays with u * normal_u + v * normal_v > distance, all
 * three in radii of the bundle. */
typedef struct ps_boundary {
    float normal_u, normal_v; /* length 1 */
    float distance;
} ps_boundary;

#define PS_MOST_BOUNDARIES 2

/* The parallel rays of a photon that was carried to the surface that it lights. A ray is named by
 * its place (u, v) across the bundle, and a point on it by its depth t along axis_w, all in scene
 * units from the centre: centre + u axis_u + v axis_v + t axis_w. |u| and |v| are at most the
 * radius. */
typedef struct ps_bundle {
    ps_vec3 centre;                 /* on the photon's own ray, where it meets its first surface */
    float radius;                   /* > 0 */
    ps_vec3 axis_u, axis_v, axis_w; /* orthonormal; axis_w is the direction of the light */
    /* Depth at which rays start, at the centre, and its change along u and v (a tilted start
     * plane). */
    float start_depth, start_slope_u, start_slope_v;
    float far_depth; /* nothing past it is lit; may be INFINITY */
    uint32_t boundary_count;
    ps_boundary boundaries[PS_MOST_BOUNDARIES];
} ps_bundle;

/* What the rays of a light have in common. */
typedef enum ps_light_kind {
    PS_LIGHT_POINT = 0,   /* they leave one point: a point light or a spotlight */
    PS_LIGHT_SUN = 1,     /* they come from infinity, out of one direction or a small cone */
    PS_LIGHT_SURFACE = 2, /* they leave a surface: an area light, an object that shines */
    PS_LIGHT_SKY = 3      /* they come from infinity, out of all directions */
} ps_light_kind;

/* Groups of lights, bits for ps_host.direct_radiance_of: those with shadows so soft that their
 * irradiance changes slowly from place to place, which are skies without a sun in their picture;
 * and all others. */
typedef enum ps_light_group {
    PS_LIGHTS_SOFT = 1,
    PS_LIGHTS_OTHERS = 2,
    PS_LIGHTS_ALL = PS_LIGHTS_SOFT | PS_LIGHTS_OTHERS
} ps_light_group;

typedef struct ps_light {
    uint32_t size;    /* set by the caller: sizeof(ps_light) as it knows it */
    uint32_t kind;    /* ps_light_kind */
    float cos_cone;   /* PS_LIGHT_POINT: cosine of the half angle of the cone around `axis` that it
                         shines into; -1: all around */
    ps_vec3 position; /* PS_LIGHT_POINT */
    ps_vec3 axis;     /* PS_LIGHT_POINT, PS_LIGHT_SUN: unit; where it shines to */
    ps_rgb power;     /* W; of sun and sky: what enters the sphere around the scene */
} ps_light;

/* A point of a light as it is seen from some place, if nothing is in between. */
typedef struct ps_light_sample {
    ps_vec3 position;  /* on the light; far outside of the scene: sun, sky */
    float distance;    /* INFINITY: sun, sky */
    ps_vec3 direction; /* from the place to the light */
    float pdf; /* of the direction by solid angle, given the light; 0: a point, or a sun without an
                          angle, which no other direction meets */
    ps_vec3 normal;    /* of the light's surface there; 0 where it has none */
    float probability; /* by which the light was chosen */
    /* Across the direction, W/m^2: what the sample stands for, both chances divided out (see
     * ps_host.sample_light). Times the receiver's cosine it is an estimate of the irradiance of all
     * lights. */
    ps_rgb irradiance;
    uint32_t light; /* its index */
} ps_light_sample;

#define PS_NO_LIGHT UINT32_MAX

/* How likely shadow rays and light paths go the same way between a point of a light and a place.
 * `direct`: the density by which host->sample_light, at the place, draws the direction to the
 * point, by solid angle, the choice of the light included; 0: a point, or a sun without an angle.
 * `arrival`: the density by which host->emit_points sends a ray from the point through an area
 * across it at the place (1/m^2), over that by which host->sample_light draws the point there. */
typedef struct ps_light_density {
    float direct, arrival;
} ps_light_density;

/* A triangle of the scene, in world space. */
typedef struct ps_triangle {
    ps_vec3 vertices[3]; /* counter-clockwise seen from the front */
    float area;
    ps_vec3 normal; /* of the front */
    uint32_t object, material;
} ps_triangle;

/* A point of one of the triangles of ps_triangle. */
typedef struct ps_surface_point {
    uint32_t object;
    uint32_t triangle; /* of those of the object, in their order, from 0 */
    float u, v;        /* weights of the triangle's second and third corner */
    uint32_t back;     /* 1: the back of it */
} ps_surface_point;

typedef enum ps_projection { PS_PERSPECTIVE = 0, PS_ORTHOGRAPHIC = 1 } ps_projection;

/* The camera. The point (x, y) of the picture, in pixels from its upper left corner, is seen from
 * `position` in the direction corner + x across + y down; by an orthographic camera, from
 * position + corner - forward + x across + y down in the direction `forward`. */
typedef struct ps_camera {
    uint32_t size;       /* set by the caller: sizeof(ps_camera) as it knows it */
    uint32_t projection; /* ps_projection */
    uint32_t width, height;
    ps_vec3 position, forward; /* forward: length 1 */
    ps_vec3 corner, across, down;
    float aperture; /* radius of the lens; 0: a pinhole */
    float focus;    /* distance along `forward` at which things are sharp */
} ps_camera;

#define PS_TILE_SIZE 16
#define PS_TILE_PIXELS 256

/* One 16x16 tile of the G-buffer and of the pass's accumulators, structure of arrays, 64-byte
 * aligned; it may grow at its end. Lane i is the pixel in column i % PS_TILE_SIZE and row i /
 * PS_TILE_SIZE of the tile. Lanes that are no pixel of the picture, or whose pixel sees nothing,
 * have depth INFINITY, object PS_NO_OBJECT, a normal of 0 and a position far outside of any
 * scene. */
typedef struct ps_tile {
    _Alignas(64) float position_x[PS_TILE_PIXELS], position_y[PS_TILE_PIXELS],
        position_z[PS_TILE_PIXELS];
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
    /* PS_TILE_PIXELS each: indirect radiance that leaves the surface towards the camera, W/(m^2
     * sr), besides albedo / pi * irradiance. NULL where the estimator's table does not ask for
     * it. */
    float *radiance_r, *radiance_g, *radiance_b;
    /* Since 1.17, what an estimator may set: the variance of the mean of the three channels of
     * irradiance / weight, (W/m^2)^2, where its samples tell that reliably; 0: it is not known. */
    float variance[PS_TILE_PIXELS];
} ps_tile;

#endif
