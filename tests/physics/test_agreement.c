/* test_agreement.c: the estimators against one another in the Cornell box, one bounce and several,
 * and in two other scenes.
 *
 * Path tracing is the truth; what each of the others may be off by is its own bias and noise at
 * these settings, in the mean of the indirect layer over the whole picture. The bias of bdpt is
 * none: it takes means over pixels, and the others the middles of these, which in one pass of this
 * size are 0.1 to 1.6 % apart; over passes see test_bdpt.c.
 */
#include "support/render_scene.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "support/run_tests.h"

#define WIDTH 96
#define HEIGHT 54

struct method {
    const char *name, *estimator, *injection, *visibility;
    double bias;
};

static double mean(const char *text, const char *bounces, const char *estimator,
                   const char *injection, const char *visibility)
{
    const char *choices[5] = {bounces, estimator};
    size_t count = 2;
    if (injection)
        choices[count++] = injection;
    if (visibility)
        choices[count++] = visibility;
    choices[count] = NULL;
    struct rendering rendering = render_text(text, 2, choices);
    double sum = mean_of_all(&rendering.image, "indirect.R") +
                 mean_of_all(&rendering.image, "indirect.G") +
                 mean_of_all(&rendering.image, "indirect.B");
    rendering_release(&rendering);
    return sum;
}

/* Frees the text. */
static void compare(char *text, const char *bounces, const char *reference,
                    const struct method *methods, size_t count)
{
    double truth = mean(text, bounces, reference, NULL, NULL);
    for (size_t i = 0; i < count; i++) {
        double ratio =
            mean(text, bounces, methods[i].estimator, methods[i].injection, methods[i].visibility) /
            truth;
        print_message("%-40s mean / path tracing %.4f, allowed %.1f %%\n", methods[i].name, ratio,
                      100 * methods[i].bias);
        assert_true(fabs(ratio - 1) < methods[i].bias);
    }
    free(text);
}

static void test_single_bounce(void **state)
{
    (void)state;
    static const struct method methods[] = {
        {"splat, step_back auto", "estimator=splat", "injection=photon:count=300000",
         "visibility=shadowmap:radius=10,resolution=8,step_back=auto", 0.02},
        {"splat, full beams", "estimator=splat", "injection=photon:count=300000",
         "visibility=shadowmap:radius=10,resolution=8,step_back=full", 0.025},
        {"photonmap", "estimator=photonmap:neighbours=60", "injection=photon:count=300000", NULL,
         0.025},
        {"photonmap, final gather", "estimator=photonmap:neighbours=60,gather=64",
         "injection=photon:count=300000", NULL, 0.02},
        {"sppm", "estimator=sppm", "injection=photon:count=300000", NULL, 0.025},
        {"final_gather", "estimator=final_gather:samples=64", "injection=photon:count=1000", NULL,
         0.01},
        {"vpl", "estimator=vpl:lights=2048", "injection=photon:count=2048", NULL, 0.01},
        {"vpl, shadow rays", "estimator=vpl:lights=2048,visibility=rays",
         "injection=photon:count=2048", NULL, 0.01},
        {"vpl, all light is compensation", "estimator=vpl:lights=1,clamp=1e5,compensation=64",
         "injection=photon:count=10", NULL, 0.01},
        {"lightcuts", "estimator=lightcuts:error=0.01", "injection=photon:count=20000", NULL, 0.01},
        {"gather", "estimator=gather:samples=64", "injection=photon:count=1000", NULL, 0.01},
        {"bdpt", "estimator=bdpt:samples=128", NULL, NULL, 0.01},
        {"irradiance_cache", "estimator=irradiance_cache:samples=4096", NULL, NULL, 0.01},
        {"voxel_cone", "estimator=voxel_cone:cones=64", NULL, NULL, 0.1},
        {"lpv", "estimator=lpv", NULL, NULL, 0.15},
        {"radiosity", "estimator=radiosity", NULL, NULL, 0.01},
    };
    compare(cornell_text(WIDTH, HEIGHT), "bounces=1", "estimator=pathtrace:samples=512", methods,
            sizeof methods / sizeof methods[0]);
}

static void test_all_bounces(void **state)
{
    (void)state;
    static const struct method methods[] = {
        {"splat, step_back auto", "estimator=splat", "injection=photon:count=300000",
         "visibility=shadowmap:radius=10,resolution=8,step_back=auto", 0.025},
        {"photonmap", "estimator=photonmap:neighbours=60", "injection=photon:count=300000", NULL,
         0.03},
        {"photonmap, final gather", "estimator=photonmap:neighbours=60,gather=64",
         "injection=photon:count=300000", NULL, 0.02},
        {"sppm", "estimator=sppm", "injection=photon:count=300000", NULL, 0.03},
        {"final_gather", "estimator=final_gather:samples=64", "injection=photon:count=50000", NULL,
         0.015},
        {"vpl", "estimator=vpl:lights=8192", "injection=photon:count=20000", NULL, 0.01},
        {"vpl, shadow rays", "estimator=vpl:lights=8192,visibility=rays",
         "injection=photon:count=20000", NULL, 0.01},
        {"vpl, all light is compensation", "estimator=vpl:lights=1,clamp=1e5,compensation=64",
         "injection=photon:count=10", NULL, 0.01},
        {"lightcuts", "estimator=lightcuts:error=0.01", "injection=photon:count=20000", NULL, 0.01},
        {"gather", "estimator=gather:samples=64", "injection=photon:count=50000", NULL, 0.01},
        {"gather, surfels by photons alone", "estimator=gather:samples=64,paths=0",
         "injection=photon:count=50000", NULL, 0.025},
        {"bdpt", "estimator=bdpt:samples=128", NULL, NULL, 0.01},
        {"irradiance_cache", "estimator=irradiance_cache:samples=4096", NULL, NULL, 0.01},
        {"voxel_cone", "estimator=voxel_cone:cones=64", NULL, NULL, 0.1},
        {"lpv", "estimator=lpv", NULL, NULL, 0.15},
        {"radiosity", "estimator=radiosity", NULL, NULL, 0.01},
    };
    compare(cornell_text(WIDTH, HEIGHT), "bounces=all", "estimator=pathtrace:samples=512", methods,
            sizeof methods / sizeof methods[0]);
}

/* Behind a corner, and in the open among columns. */
static void test_other_scenes(void **state)
{
    (void)state;
    static const struct method methods[] = {
        {"splat", "estimator=splat", "injection=photon:count=200000", NULL, 0.03},
        {"photonmap", "estimator=photonmap:neighbours=60", "injection=photon:count=200000", NULL,
         0.08},
        {"final_gather", "estimator=final_gather:samples=64", "injection=photon:count=200000", NULL,
         0.02},
        {"gather", "estimator=gather:samples=64", "injection=photon:count=50000", NULL, 0.02},
        {"gather, surfels by photons alone", "estimator=gather:samples=64,paths=0",
         "injection=photon:count=50000", NULL, 0.06},
        {"vpl", "estimator=vpl:lights=8192", "injection=photon:count=100000", NULL, 0.02},
        {"lightcuts", "estimator=lightcuts", "injection=photon:count=100000", NULL, 0.02},
        {"bdpt", "estimator=bdpt:samples=256", NULL, NULL, 0.02},
        {"irradiance_cache", "estimator=irradiance_cache:samples=4096", NULL, NULL, 0.02},
        {"voxel_cone", "estimator=voxel_cone:cones=64", NULL, NULL, 0.1},
        {"radiosity", "estimator=radiosity:epsilon=1e-5", NULL, NULL, 0.02},
    };
    static const char *const scenes[] = {"corridor", "columns"};
    for (size_t i = 0; i < sizeof scenes / sizeof scenes[0]; i++) {
        print_message("%s:\n", scenes[i]);
        compare(scene_file_text(scenes[i], WIDTH, HEIGHT), "bounces=all",
                "estimator=pathtrace:samples=2048", methods, sizeof methods / sizeof methods[0]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_single_bounce),
        SLOW_TEST(test_all_bounces),
        SLOW_TEST(test_other_scenes),
    };
    return RUN_TESTS(tests);
}
