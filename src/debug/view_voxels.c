/* view_voxels.c: the cells of a grid over the scene, each in a colour of its own (Hoet 2014, figure
 * 9). The grid is that of stratification=grid with its `cell` and `centre` left alone: cubes, as many
 * across as asked for, over the sphere around the scene.
 */
#include "debug/debug.h"
#include "debug/id_colour.h"
#include <psplat/cell.h>
#include <psplat/math.h>

#define USUAL_RESOLUTION 16u

static ps_lattice lattice_of(const struct scene *scene, uint32_t resolution)
{
    ps_vec3 corner =
        ps_subtract(scene->center, (ps_vec3){scene->radius, scene->radius, scene->radius});
    double side = 2.0 * (double)scene->radius / (double)resolution;
    return ps_lattice_over(corner, side, scene->center, scene->radius);
}

static ps_result draw(struct render *render, const struct debug_options *options, int part,
                      struct canvas *canvas, struct error *error)
{
    (void)part;
    const struct film *film = &render->film;
    uint32_t resolution = options->resolution ? options->resolution : USUAL_RESOLUTION;
    ps_lattice lattice = lattice_of(render->scene, resolution);
    ps_result result = canvas_create(canvas, film->width, film->height, error);
    for (size_t i = 0; i < film->width * film->height && result == PS_OK; i++) {
        if (!(film->planes[FILM_COVERAGE][i] > 0.0f))
            continue;
        ps_vec3 position = {film->planes[FILM_POSITION_X][i], film->planes[FILM_POSITION_Y][i],
                            film->planes[FILM_POSITION_Z][i]};
        canvas_set(canvas, (long)(i % film->width), (long)(i / film->width),
                   id_colour(ps_cell_key(&lattice, 0, position)));
    }
    return result;
}

const struct debug_view debug_voxels = {.name = "voxels", .draw = draw};
