/* radiosity.c: light is exchanged between pieces of the surfaces, and looked at afterwards.
 *
 * Goral et al. 1984: B_i = rho_i (D_i + sum_j F_ij B_j). Here by a hierarchy of elements, so that
 * the work does not grow with the square of their number (radiosity/links.h); the picture takes the
 * light of the linked elements anew at each pixel (radiosity/local_pass.h).
 *
 * The solution knows diffuse surfaces alone. Mirrors, glass and gloss are black to it, but for
 * their diffuse part, and stand in the way: what they pass on to a surface that others see is lost.
 * What lamps send to the pixels by them alone, caustics, comes by photons, which are splatted
 * (shared/caustics.h), and what the camera sees in mirrors is lit like all else.
 *
 * All passes share one solution, made in the first of them: it goes by the seed alone.
 */
#include "radiosity/local_pass.h"
#include "shared/caustics.h"

#define OF_PROGRESS 0.3 /* the solution's part of the first pass */

enum reconstruction { GATHER, ELEMENTS };

struct state {
    double epsilon;
    int64_t samples;
    int64_t links;
    int32_t reconstruction;
    struct solution solution;
    bool is_solved;
};

static void describe(const ps_host *host, const struct solution *solution)
{
    host->count(host, "radiosity elements", (double)solution->elements.tree.count);
    host->count(host, "radiosity links", (double)solution->links.count);
    host->count(host, "radiosity rounds", (double)solution->rounds);
    host->count(host, "flux of direct light", solution->arrived);
    host->count(host, "flux absorbed", solution->absorbed);
    host->count(host, "flux escaped", solution->escaped);
    if (solution->links.cut_short)
        host->log(
            host, PS_LOG_WARNING,
            "the scene needs more links than `links` allows: light is coarser than epsilon says");
    if (solution->rounds > 0 && !solution->converged)
        host->log(host, PS_LOG_WARNING,
                  "light still changed after 1000 bounces: surfaces absorb next to nothing");
}

static ps_result solve(struct state *state, const ps_host *host, const ps_pass *pass)
{
    const struct links_setting setting = {
        .epsilon = state->epsilon,
        .most = (uint64_t)state->links,
    };
    ps_result result = solution_create(host, pass, &setting, OF_PROGRESS, &state->solution);
    host->progress_part(host, OF_PROGRESS, 1.0);
    if (result != PS_OK) {
        solution_release(&state->solution);
        return result;
    }
    state->is_solved = true;
    describe(host, &state->solution);
    return PS_OK;
}

static ps_result accumulate(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct state *state = opaque;
    const struct local_setting setting = {
        .pass = pass,
        .samples = (uint64_t)state->samples,
        .elements = state->reconstruction == ELEMENTS,
    };
    ps_result result = state->is_solved ? PS_OK : solve(state, host, pass);
    if (result == PS_OK && state->solution.elements.side_count > 0)
        result = local_pass(&state->solution, &setting);
    if (result == PS_OK && pass->specular)
        result = caustics_splat(host);
    return result;
}

static ps_result begin(void *opaque, const ps_host *host, const ps_pass *pass)
{
    struct state *state = opaque;
    (void)host;
    (void)pass;
    state->is_solved = false;
    return PS_OK;
}

static void end(void *opaque, const ps_host *host)
{
    struct state *state = opaque;
    (void)host;
    if (state->is_solved)
        solution_release(&state->solution);
    state->is_solved = false;
}

/* --- the strategy --- */

static const char *const reconstructions[] = {"gather", "elements", NULL};

static const ps_param params[] = {
    PS_NUMBER(struct state, epsilon, "2e-5", 1e-9, 1, 0, "",
              "most that one link may carry of all light that is reflected once"),
    PS_ROW(struct state, samples, PS_PARAM_INT, "32", 1, 1 << 16, PS_PARAM_QUALITY, NULL, "rays",
           "shadow rays for each pixel and pass, where something stands between elements"),
    PS_CHOICE(struct state, reconstruction, "gather", reconstructions,
              "how pixels take the light: over their links anew, or as their elements have it"),
    PS_ROW(struct state, links, PS_PARAM_INT, "20000000", 1000, 2000000000, PS_PARAM_EXPERT, NULL,
           "links", "most of them, of 48 bytes each while they are made"),
};

static const ps_estimator_vtable vtable = {
    .size = sizeof vtable,
    .flags = PS_ESTIMATOR_CROPS,
    .accumulate = accumulate,
    .begin = begin,
    .end = end,
};

static const ps_descriptor descriptor = {
    .size = sizeof descriptor,
    .kind = PS_ESTIMATOR,
    .name = "radiosity",
    .version = "1.0",
    .summary = "hierarchical radiosity, gathered anew at each pixel",
    .paper =
        "Hanrahan et al. 1991, A rapid hierarchical radiosity algorithm; Lischinski et al. 1993, "
        "Combining hierarchical radiosity and discontinuity meshing",
    .params = params,
    .param_count = sizeof params / sizeof params[0],
    .param_size = sizeof params[0],
    .state_size = sizeof(struct state),
    .vtable = &vtable,
};

PS_MODULE(estimator, radiosity, &descriptor)
