/* test_surfel_table.c: what lies around a ray's end, by cubes of surfels
 * (plugins/estimator/gather/surfel_table.h). */
#include "plugins/estimator/gather/surfel_table.h"

#include "support/one_strategy.h"
#include "support/random.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#define COUNT 16384
#define LENGTH 8.0f /* of the rays that found the surfels: cubes of a quarter and wider know them */

static const ps_vec3 up = {0, 0, 1};

static int compare(const void *a, const void *b)
{
    const ps_key_entry *first = a, *second = b;
    if (first->key != second->key)
        return first->key < second->key ? -1 : 1;
    return first->index < second->index ? -1 : first->index > second->index;
}

static ps_key_entry *sort(ps_key_entry *entries, ps_key_entry *spare, size_t n)
{
    (void)spare;
    qsort(entries, n, sizeof *entries, compare);
    return entries;
}

static const ps_cells cells = {.size = sizeof cells, .sort = sort};

static float light_at(ps_vec3 position)
{
    return 1.0f + position.x;
}

/* Every fourth surfel is on things of another material, which stand in the dark. */
#define DARK_MATERIAL 7

/* A floor of 4x4, lit more and more along x. */
struct floor {
    struct bare_host bare;
    ps_vec3 positions[COUNT], normals[COUNT];
    uint32_t materials[COUNT];
    float lengths[COUNT];
    ps_rgb irradiance[COUNT], sky[COUNT];
    struct surfels surfels;
};

static int make_floor(void **state)
{
    struct floor *floor = calloc(1, sizeof *floor);
    struct random random = {17};
    if (!floor)
        return -1;
    bare_host_create(&floor->bare, 1);
    for (size_t i = 0; i < COUNT; i++) {
        ps_vec3 position = {4 * random_unit(&random), 4 * random_unit(&random), 0};
        floor->positions[i] = position;
        floor->normals[i] = up;
        floor->lengths[i] = LENGTH;
        floor->materials[i] = i % 4 == 0 ? DARK_MATERIAL : 0;
        floor->irradiance[i] = i % 4 == 0 ? (ps_rgb){0, 0, 0} : (ps_rgb){light_at(position), 2, 0};
        floor->sky[i] = (ps_rgb){0, 0, light_at(position)};
    }
    floor->surfels = (struct surfels){
        .host = &floor->bare.host,
        .extension = &cells,
        .count = COUNT,
        .positions = floor->positions,
        .normals = floor->normals,
        .materials = floor->materials,
        .lengths = floor->lengths,
        .irradiance = floor->irradiance,
        .sky = floor->sky,
        .origin = {-0.3f, -0.4f, -1.1f},
        .largest = 1,
    };
    *state = floor;
    return surfel_table_build(&floor->surfels) == PS_OK ? 0 : -1;
}

static int free_floor(void **state)
{
    struct floor *floor = *state;
    const ps_host *host = &floor->bare.host;
    host->release(host, floor->surfels.cells);
    int leaks = floor->bare.live_allocations;
    bare_host_release(&floor->bare);
    free(floor);
    return leaks;
}

static struct gather_landing landing_at(ps_vec3 position, ps_vec3 normal, float length,
                                        struct random *random)
{
    return (struct gather_landing){
        .position = position,
        .normal = normal,
        .length = length,
        .numbers = {random_unit(random), random_unit(random)},
    };
}

/* On average over the random numbers, what lies around a point is what is there, where light is
 * linear. */
static void test_finds_the_light_of_a_place(void **state)
{
    const struct floor *floor = *state;
    struct random random = {19};
    const ps_vec3 position = {1.7f, 2.2f, 0};
    double indirect = 0, even = 0, sky = 0;
    enum { LOOKUPS = 40 * PS_TILE_PIXELS };
    for (int batch = 0; batch < LOOKUPS / PS_TILE_PIXELS; batch++) {
        struct gather_landing landings[PS_TILE_PIXELS];
        struct cached_irradiance known[PS_TILE_PIXELS];
        bool is_known[PS_TILE_PIXELS] = {false};
        for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
            landings[i] = landing_at(position, up, LENGTH, &random);
            landings[i].path = i;
        }
        surfel_table_lookup(&floor->surfels, landings, PS_TILE_PIXELS, known, is_known);
        for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
            assert_true(is_known[i]);
            indirect += (double)known[i].indirect.r / LOOKUPS;
            even += (double)known[i].indirect.g / LOOKUPS;
            sky += (double)known[i].sky.b / LOOKUPS;
        }
    }
    assert_float_equal(indirect, light_at(position), 0.02 * (double)light_at(position));
    assert_float_equal(even, 2.0, 1e-4);
    assert_float_equal(sky, indirect, 1e-4);
}

static void test_materials_have_light_of_their_own(void **state)
{
    const struct floor *floor = *state;
    struct random random = {37};
    struct gather_landing landing = landing_at((ps_vec3){1.7f, 2.2f, 0}, up, LENGTH, &random);
    struct cached_irradiance known;
    bool is_known = false;
    landing.material = DARK_MATERIAL;
    surfel_table_lookup(&floor->surfels, &landing, 1, &known, &is_known);
    assert_true(is_known);
    assert_true(known.indirect.r == 0.0f && known.indirect.g == 0.0f);
    is_known = false;
    landing.material = DARK_MATERIAL + 1;
    surfel_table_lookup(&floor->surfels, &landing, 1, &known, &is_known);
    assert_false(is_known);
}

static bool is_known_at(const struct floor *floor, ps_vec3 position, ps_vec3 normal, float length)
{
    struct random random = {23};
    struct gather_landing landing = landing_at(position, normal, length, &random);
    struct cached_irradiance known;
    bool is_known = false;
    surfel_table_lookup(&floor->surfels, &landing, 1, &known, &is_known);
    return is_known;
}

static void test_knows_nothing_elsewhere(void **state)
{
    const struct floor *floor = *state;
    const ps_vec3 inside = {1.7f, 2.2f, 0}, above = {1.7f, 2.2f, 1.6f}, far = {-1e6f, 1e9f, 0};
    assert_true(is_known_at(floor, inside, up, LENGTH));
    assert_false(is_known_at(floor, inside, ps_scale(up, -1.0f), LENGTH));
    assert_false(is_known_at(floor, inside, (ps_vec3){1, 0, 0}, LENGTH));
    assert_false(is_known_at(floor, above, up, LENGTH));
    assert_false(is_known_at(floor, far, up, LENGTH));
}

/* A cube of more than 0.6 lengths says nothing of a ray's end; smaller ones hold no surfels of such
 * long rays. */
static void test_leaves_short_rays_to_paths(void **state)
{
    const struct floor *floor = *state;
    const ps_vec3 inside = {1.7f, 2.2f, 0};
    assert_true(is_known_at(floor, inside, up, 0.25f / 0.6f * 1.01f));
    assert_false(is_known_at(floor, inside, up, 0.25f / 0.6f * 0.99f));
    assert_false(is_known_at(floor, inside, up, 0.001f));
    assert_false(is_known_at(floor, inside, up, 0.0f));
}

/* How far from the place of a landing there is light that it may get. */
static float reach(const struct floor *floor, bool is_focused)
{
    struct random random = {31};
    const ps_vec3 position = {1.7f, 2.2f, 0};
    float most = 0.0f;
    for (int i = 0; i < 1000; i++) {
        struct gather_landing landing = landing_at(position, up, 2.0f * LENGTH, &random);
        struct cached_irradiance known;
        bool is_known = false;
        landing.is_focused = is_focused;
        surfel_table_lookup(&floor->surfels, &landing, 1, &known, &is_known);
        assert_true(is_known);
        most = ps_max(most, fabsf(known.indirect.r - light_at(position)));
    }
    return most;
}

static void test_focused_light_stays_narrow(void **state)
{
    const struct floor *floor = *state;
    assert_true(reach(floor, true) < 0.5f * reach(floor, false));
}

/* Each landing has its own answer, in whatever company, by its own path. */
static void test_answers_each_by_itself(void **state)
{
    const struct floor *floor = *state;
    struct random random = {29};
    struct gather_landing landings[PS_TILE_PIXELS];
    struct cached_irradiance known[PS_TILE_PIXELS], alone;
    bool is_known[PS_TILE_PIXELS] = {false};
    size_t answered = 0;
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        ps_vec3 position = {5 * random_unit(&random), 5 * random_unit(&random), 0};
        landings[i] = landing_at(position, up, LENGTH * random_unit(&random), &random);
        landings[i].path = PS_TILE_PIXELS - 1 - i;
    }
    surfel_table_lookup(&floor->surfels, landings, PS_TILE_PIXELS, known, is_known);
    for (uint32_t i = 0; i < PS_TILE_PIXELS; i++) {
        struct gather_landing landing = landings[i];
        bool is_known_alone = false;
        uint32_t path = landing.path;
        landing.path = 0;
        surfel_table_lookup(&floor->surfels, &landing, 1, &alone, &is_known_alone);
        assert_int_equal(is_known[path], is_known_alone);
        answered += is_known_alone;
        if (is_known_alone)
            assert_memory_equal(&known[path], &alone, sizeof alone);
    }
    assert_in_range(answered, PS_TILE_PIXELS / 4, PS_TILE_PIXELS - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_finds_the_light_of_a_place),
        cmocka_unit_test(test_materials_have_light_of_their_own),
        cmocka_unit_test(test_knows_nothing_elsewhere),
        cmocka_unit_test(test_leaves_short_rays_to_paths),
        cmocka_unit_test(test_focused_light_stays_narrow),
        cmocka_unit_test(test_answers_each_by_itself),
    };
    return cmocka_run_group_tests(tests, make_floor, free_floor);
}
