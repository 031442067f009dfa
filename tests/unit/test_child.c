/* test_child.c: what ends in a child process, and what it leaves. */
#include "import/child.h"
#include "import/transfer.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cmocka.h>

#include <signal.h>

static const struct child_limits usual = {1e9, 20};

static void leave_a_number(void *context)
{
    *(int *)context = 7;
}

static void return_at_once(void *context)
{
    (void)context;
}

static void crash(void *context)
{
    (void)context;
    raise(SIGKILL); /* which a sanitizer does not report */
}

static void end_early(void *context)
{
    (void)context;
    _exit(3);
}

static void wait_for_ever(void *context)
{
    for (volatile int *never = context; *never == 0;)
        continue;
}

static void expect_end(void (*work)(void *context), void *context, const char *words)
{
    const struct child_limits limits = {1e9, 1};
    struct error error;
    assert_int_equal(child_run(work, context, &limits, &error), PS_ERROR_INVALID);
    assert_string_equal(error.text, words);
}

static void what_ends_the_child_is_told(void **state)
{
    (void)state;
    int never = 0;
    struct error error;
    assert_int_equal(child_run(return_at_once, NULL, &usual, &error), PS_OK);
    expect_end(crash, NULL, "crashed (Killed)");
    expect_end(end_early, NULL, "crashed (status 3)");
    expect_end(wait_for_ever, &never, "took too long");
}

/* Its memory is a copy, but for what is shared. */
static void the_parent_keeps_its_memory(void **state)
{
    (void)state;
    int own = 1;
    struct error error;
    int *shared =
        mmap(NULL, sizeof *shared, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(shared != MAP_FAILED);
    assert_int_equal(child_run(leave_a_number, &own, &usual, &error), PS_OK);
    assert_int_equal(own, 1);
    assert_int_equal(child_run(leave_a_number, shared, &usual, &error), PS_OK);
    assert_int_equal(*shared, 7);
    munmap(shared, sizeof *shared);
}

static void fill_memory(void *context)
{
    void *volatile taken = malloc((size_t)1 << 34);
    *(bool *)context = taken == NULL;
    free(taken);
}

static void memory_is_limited(void **state)
{
    (void)state;
    struct error error;
    bool *refused =
        mmap(NULL, sizeof *refused, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(refused != MAP_FAILED);
    assert_int_equal(child_run(fill_memory, refused, &usual, &error), PS_OK);
    bool limited = *refused;
    munmap(refused, sizeof *refused);
    if (child_has_memory_limit())
        assert_true(limited);
    else
        skip();
}

static void take_a_little(void *context)
{
    void *volatile taken = malloc((size_t)1 << 28);
    *(bool *)context = taken != NULL;
    free(taken);
}

/* What the caller has mapped, more than the limit here, is not counted. */
static void memory_is_the_child_s_own(void **state)
{
    (void)state;
    struct error error;
    size_t size = (size_t)1 << 31;
    int flags = MAP_ANONYMOUS | MAP_NORESERVE;
    void *of_caller = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | flags, -1, 0);
    bool *got = mmap(NULL, sizeof *got, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    assert_true(of_caller != MAP_FAILED && got != MAP_FAILED);
    assert_int_equal(child_run(take_a_little, got, &usual, &error), PS_OK);
    assert_true(*got);
    *got = false;
    if (child_has_memory_limit()) {
        assert_int_equal(child_run(fill_memory, got, &usual, &error), PS_OK);
        assert_true(*got);
    }
    munmap(got, sizeof *got);
    munmap(of_caller, size);
}

/* --- the transfer
 * ------------------------------------------------------------------------------- */

static struct mesh_outcome *outcome_of_a_mesh(void)
{
    struct mesh_outcome *outcome = calloc(1, sizeof *outcome);
    struct scene_description *fragment = &outcome->fragment;
    fragment->meshes = calloc(1, sizeof *fragment->meshes);
    fragment->mesh_count = 1;
    fragment->meshes[0].vertices = calloc(3, sizeof(ps_vec3));
    fragment->meshes[0].vertices[2] = (ps_vec3){1, 2, 3};
    fragment->meshes[0].vertex_count = 3;
    fragment->materials = calloc(2, sizeof *fragment->materials);
    fragment->material_count = 2;
    fragment->materials[1].name = strdup("brass");
    fragment->materials[1].weights = calloc(2, sizeof(double));
    fragment->materials[1].weights[1] = 0.25;
    fragment->materials[1].component_count = 2;
    return outcome;
}

static void destroy(struct mesh_outcome *outcome)
{
    mesh_outcome_release(outcome);
    free(outcome);
}

static void what_is_sent_is_received(void **state)
{
    (void)state;
    struct mesh_outcome *sent = outcome_of_a_mesh(), *received = calloc(1, sizeof *received);
    int file = mesh_transfer_open();
    assert_true(file >= 0);
    assert_true(mesh_outcome_send(sent, file));
    destroy(sent);
    assert_int_equal(lseek(file, 0, SEEK_SET), 0);
    assert_true(mesh_outcome_receive(received, file));
    const struct scene_description *fragment = &received->fragment;
    assert_true(fragment->meshes[0].vertices[2].z == 3);
    assert_null(fragment->meshes[0].normals);
    assert_null(fragment->materials[0].name);
    assert_string_equal(fragment->materials[1].name, "brass");
    assert_true(fragment->materials[1].weights[1] == 0.25);
    destroy(received);
    close(file);
}

/* Cut anywhere, it is nothing, and nothing is lost. */
static void what_is_cut_is_nothing(void **state)
{
    (void)state;
    struct mesh_outcome *sent = outcome_of_a_mesh(), *received = calloc(1, sizeof *received);
    int file = mesh_transfer_open();
    assert_true(file >= 0);
    assert_true(mesh_outcome_send(sent, file));
    off_t whole = lseek(file, 0, SEEK_CUR);
    for (off_t length = whole - 1; length >= 0; length--) {
        assert_int_equal(ftruncate(file, length), 0);
        assert_int_equal(lseek(file, 0, SEEK_SET), 0);
        assert_false(mesh_outcome_receive(received, file));
        assert_null(received->fragment.meshes);
        assert_null(received->fragment.materials);
    }
    destroy(received);
    destroy(sent);
    close(file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_ends_the_child_is_told),
        cmocka_unit_test(the_parent_keeps_its_memory),
        cmocka_unit_test(memory_is_limited),
        cmocka_unit_test(memory_is_the_child_s_own),
        cmocka_unit_test(what_is_sent_is_received),
        cmocka_unit_test(what_is_cut_is_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
