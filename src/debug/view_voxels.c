/* view_voxels.c: the cells that a stratification sorts photons into, each in a colour of its own
 * (Hoet 2014, figure 9). An octree's leaves, and the cells of a grid that merge with their
 * neighbours, follow from the photons of the pass. Where a number of cells is asked for, and where
 * the stratification has no cells, they are those of a grid by itself: cubes, that many across the
 * sphere around the scene.
 */
#include "debug/debug.h"
#include "debug/id_colour.h"
#include "stratify/cells.h"
#include "stratify/stratify.h"
#include <psplat/math.h>
#include <stdlib.h>

#define USUAL_RESOLUTION 16u

/* Places in the picture, and the cells that they lie in. */
struct places {
    size_t count;
    size_t *pixels;
    ps_vec3 *points;
    uint64_t *cells;
};

static void places_release(struct places *places)
{
    free(places->pixels);
    free(places->points);
    free(places->cells);
}

/* To be released in any case. */
static ps_result places_create(const struct film *film, struct places *places, struct error *error)
{
    size_t pixels = film->width * film->height;
    *places = (struct places){
        .pixels = calloc(pixels, sizeof *places->pixels),
        .points = calloc(pixels, sizeof *places->points),
        .cells = calloc(pixels, sizeof *places->cells),
    };
    if (!places->pixels || !places->points || !places->cells)
        return error_memory(error, pixels * sizeof *places->points, "the cells");
    for (size_t i = 0; i < pixels; i++) {
        if (!(film->planes[FILM_COVERAGE][i] > 0.0f))
            continue;
        places->points[places->count] =
            (ps_vec3){film->planes[FILM_POSITION_X][i], film->planes[FILM_POSITION_Y][i],
                      film->planes[FILM_POSITION_Z][i]};
        places->pixels[places->count++] = i;
    }
    return PS_OK;
}

static ps_lattice lattice_of(const struct scene *scene, uint32_t resolution)
{
    ps_vec3 corner =
        ps_subtract(scene->center, (ps_vec3){scene->radius, scene->radius, scene->radius});
    double side = 2.0 * (double)scene->radius / (double)resolution;
    return cells_lattice(corner, side, scene->center, scene->radius);
}

static void find_in_lattice(const struct scene *scene, uint32_t resolution, struct places *places)
{
    ps_lattice lattice = lattice_of(scene, resolution);
    for (size_t i = 0; i < places->count; i++)
        places->cells[i] = cells_key(&lattice, 0, places->points[i]);
}

/* By the render's own stratification, which has cells. */
static ps_result find_in_strata(struct render *render, struct places *places, struct error *error)
{
    const struct strategy *strategy = strategy_in(render, PS_STRATIFICATION);
    ps_photon *photons;
    size_t n;
    ps_result result = photon_stream_injected(&render->photons, &photons, &n, error);
    if (result != PS_OK)
        return result;
    result = stratify_numbers(strategy, strategy->host, &render->pass, photons, n, places->points,
                              places->count, places->cells);
    return render_judge(render, PS_STRATIFICATION, result, error);
}

static ps_result find_cells(struct render *render, uint32_t resolution, struct places *places,
                            struct error *error)
{
    const ps_stratification_vtable *table =
        &strategy_in(render, PS_STRATIFICATION)->type->table.stratification;
    if (table->stratify && table->find_strata && resolution == 0)
        return find_in_strata(render, places, error);
    find_in_lattice(render->scene, resolution ? resolution : USUAL_RESOLUTION, places);
    return PS_OK;
}

static ps_result draw(struct render *render, const struct debug_options *options, int part,
                      struct canvas *canvas, struct error *error)
{
    (void)part;
    const struct film *film = &render->film;
    struct places places;
    ps_result result = places_create(film, &places, error);
    if (result == PS_OK)
        result = find_cells(render, options->resolution, &places, error);
    if (result == PS_OK)
        result = canvas_create(canvas, film->width, film->height, error);
    for (size_t i = 0; i < places.count && result == PS_OK; i++)
        if (places.cells[i] != PS_NO_STRATUM)
            canvas_set(canvas, (long)(places.pixels[i] % film->width),
                       (long)(places.pixels[i] / film->width), id_colour(places.cells[i]));
    places_release(&places);
    return result;
}

const struct debug_view debug_voxels = {.name = "voxels", .draw = draw};
