/* gbuffer.h: what each pixel of one pass sees, and what the pass has gathered there.
 *
 * Tiles of 16x16 pixels, each a structure of arrays (ps_tile), stored one after the other. A tile
 * is the unit of work: one thread owns it at a time, so nothing needs a lock.
 *
 * The tiles may be those of a window of the picture alone. They are stored by their index in the
 * window; their number in the picture, which random numbers go by, is another. Columns and rows are
 * always those of the picture.
 */
#ifndef FILM_GBUFFER_H
#define FILM_GBUFFER_H

#include "base/error.h"
#include "base/rectangle.h"
#include "trace/trace.h"
#include <psplat/math.h>
#include <stdbool.h>

/* Where lanes that see no surface lie: outside of any scene, yet its square is finite. */
#define GBUFFER_NOWHERE 1e18f

/* The surface that stands for a lane in denoisers, where its camera path met gloss or a partly
 * mirroring surface: the first such surface. What lies behind it differs from sample to sample;
 * this surface is what neighbouring pixels have in common. A path that met sharp mirrors only, and
 * no surface behind them, has its first mirror (`sharp`). */
struct glossy_tile {
    float reflectance_r[PS_TILE_PIXELS], reflectance_g[PS_TILE_PIXELS],
        reflectance_b[PS_TILE_PIXELS]; /* by all lobes, and of the way from there to the camera */
    float normal_x[PS_TILE_PIXELS], normal_y[PS_TILE_PIXELS], normal_z[PS_TILE_PIXELS];
    float position_x[PS_TILE_PIXELS], position_y[PS_TILE_PIXELS], position_z[PS_TILE_PIXELS];
    float gloss[PS_TILE_PIXELS]; /* share of the reflectance that is not diffuse */
    float depth[PS_TILE_PIXELS]; /* 0: met none */
    bool sharp[PS_TILE_PIXELS];  /* a mirror, with nothing behind: what it shows has no noise */
};

/* What decided where the path of a pixel's sample ends: nothing, or a matter of chance. */
enum path_choice { CHOSEN_BY_NOTHING, CHOSEN_BY_LENS_OR_GLOSS, CHOSEN_BY_GLASS };

struct gbuffer {
    size_t width, height;                          /* of the picture */
    uint32_t picture_across;                       /* tiles in a row of it */
    uint32_t first_column, first_row;              /* where the window begins, in tiles */
    uint32_t tiles_across, tiles_down, tile_count; /* of the window */
    ps_tile *tiles;                                /* 64-byte aligned, owned */
    /* Arrays with a value for each lane of each tile, owned. */
    ps_rgb *direct;  /* direct irradiance, W/m^2 */
    ps_rgb *emitted; /* radiance collected along the camera path, W/(m^2 sr) */
    uint8_t *choice; /* enum path_choice */
    /* The same, but NULL where they are not prepared. */
    ps_rgb *direct_half;      /* direct irradiance by the second half of the shadow rays */
    ps_rgb *hard, *hard_half; /* the part of both of lights that cast hard shadows */
    uint64_t *occlusion;      /* what shadow rays met, see gbuffer_occlusion_alike */
    ps_rgb *direct_scratch;   /* the discontinuity buffer writes here, and swaps it with `direct` */
    ps_vec3 *geometric_normals; /* where shading normals are smoothed or bent */
    struct glossy_tile *glossy; /* one for each tile */
    float *radiance;            /* ps_tile.radiance_r, _g and _b point into it; W/(m^2 sr) */
    /* Indirect irradiance of splats, where the tiles' irradiance is without it: red of a tile's
     * lanes, green and blue, W/m^2. */
    float *splatted;
};

/* Tiles of a picture of that size, and no memory for them. */
struct gbuffer gbuffer_layout(size_t width, size_t height);

/* The tiles of which a part of the picture needs any, so that its film is that of the whole
 * picture: its own and those that its means over neighbours look at. `smooth_edges`: pixels take
 * several samples at edges. */
struct gbuffer gbuffer_layout_around(struct rectangle part, bool smooth_edges, size_t width,
                                     size_t height);

/* The picture's pixels in the window. */
struct rectangle gbuffer_window(const struct gbuffer *gbuffer);

/* Memory for the tiles of a layout. */
ps_result gbuffer_create(struct gbuffer layout, struct gbuffer *gbuffer, struct error *error);
void gbuffer_release(struct gbuffer *gbuffer);

/* The optional arrays; those that are there stay as they are. PS_ERROR_MEMORY: release the buffer
 * all the same. */
ps_result gbuffer_prepare_discontinuity_buffer(struct gbuffer *gbuffer, struct error *error);
ps_result gbuffer_prepare_direct_half(struct gbuffer *gbuffer, struct error *error);
/* And half of it, if `direct_half` is there. */
ps_result gbuffer_prepare_hard(struct gbuffer *gbuffer, struct error *error);
ps_result gbuffer_prepare_glossy(struct gbuffer *gbuffer, struct error *error);
ps_result gbuffer_prepare_geometric_normals(struct gbuffer *gbuffer, struct error *error);
ps_result gbuffer_prepare_radiance(struct gbuffer *gbuffer, struct error *error);
ps_result gbuffer_prepare_splatted(struct gbuffer *gbuffer, struct error *error);

/* What a buffer has besides tiles, direct and emitted light, and `choice`. */
struct gbuffer_parts {
    bool discontinuity_buffer, direct_half, hard, glossy, geometric_normals, radiance, splatted;
};

/* Bytes that the tiles of a layout take with such parts, and that the buffer takes. */
size_t gbuffer_bytes_with(const struct gbuffer *layout, struct gbuffer_parts parts);
size_t gbuffer_bytes(const struct gbuffer *gbuffer);

/* A channel of what splats gave to a tile's lanes; NULL where the tile itself has it. */
static inline float *gbuffer_splatted(const struct gbuffer *gbuffer, uint32_t tile, int channel)
{
    size_t at = 3 * (size_t)tile + (size_t)channel;
    return gbuffer->splatted ? gbuffer->splatted + at * PS_TILE_PIXELS : NULL;
}

/* The number of a tile in the picture. */
static inline uint32_t gbuffer_number(const struct gbuffer *gbuffer, uint32_t tile)
{
    return (gbuffer->first_row + tile / gbuffer->tiles_across) * gbuffer->picture_across +
           gbuffer->first_column + tile % gbuffer->tiles_across;
}

/* How many tiles the picture has. */
static inline uint32_t gbuffer_picture_tiles(const struct gbuffer *gbuffer)
{
    return gbuffer->picture_across *
           (uint32_t)((gbuffer->height + PS_TILE_SIZE - 1) / PS_TILE_SIZE);
}

/* The tile of a number; false if it lies outside of the window. */
bool gbuffer_tile_numbered(const struct gbuffer *gbuffer, uint32_t number, uint32_t *tile);

/* Column and row of a lane; false if it lies outside of the picture. */
bool gbuffer_pixel(const struct gbuffer *gbuffer, uint32_t tile, uint32_t lane, uint32_t *x,
                   uint32_t *y);

/* The same for a tile of the picture, by its number. */
bool gbuffer_picture_pixel(const struct gbuffer *gbuffer, uint32_t number, uint32_t lane,
                           uint32_t *x, uint32_t *y);

/* The other way: tile and lane of a pixel of the window. */
uint32_t gbuffer_tile_of(const struct gbuffer *gbuffer, uint32_t x, uint32_t y, uint32_t *lane);

/* The same for a neighbour, which may lie outside of the window: false, and neither is set. */
bool gbuffer_find(const struct gbuffer *gbuffer, int64_t x, int64_t y, uint32_t *tile,
                  uint32_t *lane);

/* Makes all lanes of a tile see nothing, meet no glossy surface, and zeroes its accumulators,
 * emitted radiance and choice. */
void gbuffer_clear_tile(struct gbuffer *gbuffer, uint32_t tile);

/* Lets a lane see what was hit, at the end of a way of length `travelled` that leaves `throughput`
 * of its light. */
void gbuffer_store(ps_tile *tile, uint32_t lane, const ps_hit *hit, ps_rgb throughput,
                   float travelled);

/* Notes the geometric normal of what a lane sees, where there is room. */
void gbuffer_store_geometric_normal(struct gbuffer *gbuffer, uint32_t tile, uint32_t lane,
                                    const ps_hit *hit);

/* Notes a glossy surface of a lane that met none before, what it reflects with the way to the
 * camera, and the share of that which is gloss. */
void gbuffer_store_glossy(struct glossy_tile *glossy, uint32_t lane, const ps_hit *hit,
                          ps_rgb reflectance, float gloss, float travelled);

/* Notes a mirror of a lane that met no such surface before, likewise. A glossy surface behind it
 * replaces it; a path that ends at a surface forgets it (below). */
void gbuffer_store_mirror(struct glossy_tile *glossy, uint32_t lane, const ps_hit *hit,
                          ps_rgb reflectance, float travelled);

/* Forgets the mirror of a lane whose path ends at a surface. */
void gbuffer_forget_mirror(struct glossy_tile *glossy, uint32_t lane);

/* Whether no lane of a tile sees anything. */
bool gbuffer_sees_nothing(const ps_tile *tile);

/* Lane of number i when a tile is walked in 4x4 blocks. */
uint32_t gbuffer_block_lane(uint32_t i);

/* Whether two points may be taken for points of one surface: normals no farther apart than 25
 * degrees, and the second, which lies `way` from the first, no farther off its plane than a tenth
 * of their distance. For loops of vectors. */
static inline int gbuffer_same_surface(ps_vec3 normal, ps_vec3 other_normal, ps_vec3 way)
{
    float off_plane = ps_dot(normal, way);
    int faces_alike = ps_dot(normal, other_normal) > 0.9f;
    int in_plane = off_plane * off_plane <= 0.01f * ps_dot(way, way);
    return faces_alike & in_plane;
}

/* What a point counts for another that lies `way` from it: inverse distance weighting (Shepard
 * 1968, "A two-dimensional interpolation function for irregularly-spaced data"). One in the same
 * place counts, too. For loops of vectors. */
static inline float gbuffer_nearness(ps_vec3 way)
{
    return 1.0f / (ps_dot(way, way) + 1e-20f);
}

/* Which lanes of a tile may show the surface of an object at that place: 1 or 0. Returns how
 * many. */
float gbuffer_alike(const ps_tile *tile, ps_vec3 position, ps_vec3 normal, uint32_t object,
                    float alike[PS_TILE_PIXELS]);

/* What a ray to light `light` met, of which the share `lit` came through: light i of 32 has bits 2
 * i, some light came through, and 2 i + 1, some was stopped. Further lights share them. */
static inline uint64_t gbuffer_occlusion(size_t light, float lit)
{
    uint64_t bits = (uint64_t)(lit > 0.0f) | (uint64_t)(lit < 1.0f) << 1;
    return bits << 2 * (light % 32);
}

static inline uint64_t gbuffer_either_bit(uint64_t mask)
{
    return (mask | mask >> 1) & UINT64_C(0x5555555555555555);
}

/* Whether two points see the lights alike: none that shines on one of them whole is hidden from the
 * other, nor out of its reach. So the edge of a hard shadow lies between them, or nothing does. */
static inline bool gbuffer_occlusion_alike(uint64_t a, uint64_t b)
{
    return gbuffer_either_bit(a & b) == gbuffer_either_bit(a | b);
}

/* Forgets the indirect light of an unfinished pass. */
void gbuffer_clear_indirect(struct gbuffer *gbuffer);

#endif
