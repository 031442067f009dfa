/* test_octree.c: the leaves of an octree that is a sorted list, against those of one that is split
 * as the definition says. */
#include "support/random.h"
#include "support/stratify.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

struct node {
    ps_vec3 low;
    double side;
    int64_t capacity, depth;
};

static bool inside(const struct node *node, ps_vec3 p)
{
    return p.x >= node->low.x && p.x < node->low.x + node->side && p.y >= node->low.y &&
           p.y < node->low.y + node->side && p.z >= node->low.z && p.z < node->low.z + node->side;
}

/* By the definition: how many leaves there are; each has one photon left, which stands for all. */
static size_t check_leaves(struct node node, const ps_photon *given, size_t n,
                           const ps_photon *left, size_t left_count)
{
    size_t count = 0, leaves = 0, kept = 0;
    for (size_t i = 0; i < n; i++)
        count += inside(&node, given[i].position);
    if (count > (size_t)node.capacity && node.depth > 0) {
        float half = (float)(node.side / 2);
        for (int child = 0; child < 8; child++) {
            ps_vec3 step = {(float)(child & 1) * half, (float)(child >> 1 & 1) * half,
                            (float)(child >> 2) * half};
            leaves += check_leaves(
                (struct node){ps_add(node.low, step), node.side / 2, node.capacity, node.depth - 1},
                given, n, left, left_count);
        }
        return leaves;
    }
    for (size_t i = 0; i < left_count; i++)
        if (inside(&node, left[i].position)) {
            assert_true(left[i].merged == (float)count);
            kept++;
        }
    assert_int_equal(kept, count > 0);
    return count > 0;
}

static void test_octree_by_definition(void **state)
{
    (void)state;
    enum { N = 400 };
    struct random random = {77};
    struct stage stage = stage_of(16);
    static ps_photon given[N], photons[N];
    for (size_t i = 0; i < N; i++) { /* denser towards a corner */
        float x = random_unit(&random), y = random_unit(&random), z = random_unit(&random);
        given[i] = stratify_photon((ps_vec3){16 * x * x, 16 * y * y - 8, 32 * z - 16}, 1, i);
    }
    for (int64_t capacity = 1; capacity < 200; capacity *= 3)
        for (int64_t depth = 0; depth < 8; depth++) {
            char choice[64];
            snprintf(choice, sizeof choice, "octree:capacity=%d,depth=%d", (int)capacity,
                     (int)depth);
            memcpy(photons, given, sizeof given);
            size_t left = stratify_photons(&stage, choice, photons, N);
            struct node root = {{-16, -16, -16}, 32, capacity, depth};
            assert_int_equal(check_leaves(root, given, N, photons, left), left);
        }
    stage_release(&stage);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_octree_by_definition),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
