/* test_scene_message.c: a scene that one process has read reaches others whole, without the files
 * that it names. */
#include "job/scene_message.h"
#include "parser/psd.h"
#include "scene/scene.h"
#include "scene/scene_digest.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#define MOST_RANKS 7

/* --- processes with a pipe from each to each
 * ------------------------------------------------------- */

static int pipes[MOST_RANKS][MOST_RANKS][2];
static int own_rank;

static void send_by_pipe(int to, int tag, const void *bytes, size_t size)
{
    const char *rest = bytes;
    (void)tag;
    for (ssize_t done = 1; size > 0 && done > 0; size -= (size_t)done, rest += done)
        done = write(pipes[own_rank][to][1], rest, size);
}

static void receive_by_pipe(int from, int tag, void *bytes, size_t size)
{
    char *rest = bytes;
    (void)tag;
    for (ssize_t done = 1; size > 0; size -= (size_t)done, rest += done) {
        done = read(pipes[from][own_rank][0], rest, size);
        if (done <= 0)
            _exit(99);
    }
}

static struct transport transport_of(int rank, int size)
{
    own_rank = rank;
    return (struct transport){
        .rank = rank, .size = size, .send = send_by_pipe, .receive = receive_by_pipe};
}

typedef int (*rank_body)(const struct transport *transport, const void *expected);

/* Starts ranks 1 to size - 1, which end with the status that `body` gives. */
static void start_ranks(int size, rank_body body, const void *expected, pid_t children[])
{
    for (int from = 0; from < size; from++)
        for (int to = 0; to < size; to++)
            assert_int_equal(pipe(pipes[from][to]), 0);
    for (int rank = 1; rank < size; rank++) {
        children[rank] = fork();
        assert_true(children[rank] >= 0);
        if (children[rank] == 0) {
            struct transport transport = transport_of(rank, size);
            _exit(body(&transport, expected));
        }
    }
}

static void expect_success(int size, const pid_t children[])
{
    for (int rank = 1; rank < size; rank++) {
        int status;
        assert_int_equal(waitpid(children[rank], &status, 0), children[rank]);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 0);
    }
    for (int from = 0; from < size; from++)
        for (int to = 0; to < size; to++) {
            close(pipes[from][to][0]);
            close(pipes[from][to][1]);
        }
}

/* --- a scene of many blocks
 * ------------------------------------------------------------------------ */

static const char text[] =
    "psd: 1\n"
    "cameras: {front: {location: [0, 1, -5], look_at: [0, 1, 0]}, side: {location: [5, 1, 0], "
    "look_at: [0, 1, 0]}}\n"
    "render: {injection: {photon: {count: 1234}}, bounces: 3}\n"
    "materials:\n"
    "  wood: {diffuse: {image: {file: rgb8.png}}}\n"
    "  shiny: {metal: {color: [0.9, 0.8, 0.7], roughness: 0.2}}\n"
    "  both: {mix: [{material: wood, weight: 0.3}, {material: shiny, weight: 0.7}]}\n"
    "lights:\n"
    "  - sky: {file: baseline.jpg}\n"
    "  - rectangle: {corners: [[0, 2, 0], [0, 2, 1], [1, 2, 1], [1, 2, 0]], radiance: 5}\n"
    "groups:\n"
    "  pair: [box: {corners: [[0, 0, 0], [1, 1, 1]], material: both}, sphere: {center: [2, 0, 0], "
    "radius: 1, material: wood}]\n"
    "objects:\n"
    "  - mesh: {file: blender.glb}\n"
    "  - instance: {of: pair, translate: [4, 0, 0]}\n"
    "  - {for: i, from: 1, to: 800, do: [box: {corners: [[0, 0, 0], [1, =i, 1]], material: "
    "shiny}]}\n";

static void read_description(struct scene_description *description)
{
    struct diagnostics *sink = diagnostics_create();
    ps_result result = psd_read_text("scene.psd", text, strlen(text), sink, description);
    if (result != PS_OK)
        diagnostics_print(sink, stderr);
    assert_int_equal(result, PS_OK);
    diagnostics_destroy(sink);
}

static struct scene_digest digest_of(const struct scene_description *description)
{
    struct scene scene;
    struct origin where;
    struct error error;
    if (scene_create(description, &scene, &where, &error) != PS_OK) {
        fprintf(stderr, "%s\n", error.text);
        return (struct scene_digest){{0}};
    }
    struct scene_digest digest = scene_digest_of(description, &scene);
    scene_release(&scene);
    return digest;
}

static bool is_own_name(const struct scene_description *description, const char *name)
{
    for (size_t i = 0; i < description->file_count; i++)
        if (description->files[i] == name)
            return true;
    return false;
}

static bool names_are_own(const struct scene_description *description)
{
    bool own =
        is_own_name(description, description->image.origin.file) || !description->image.origin.file;
    for (size_t i = 0; i < description->light_count; i++)
        own &= is_own_name(description, description->lights[i].origin.file);
    for (size_t i = 0; i < description->object_count; i++)
        own &= is_own_name(description, description->objects[i].origin.file);
    for (size_t i = 0; i < description->groups[0].object_count; i++)
        own &= is_own_name(description, description->groups[0].objects[i].origin.file);
    for (size_t i = 0; i < description->mesh_count; i++)
        own &=
            !description->meshes[i].file || is_own_name(description, description->meshes[i].file);
    return own;
}

/* Elsewhere, where none of the scene's files are. */
static int receive_and_compare(const struct transport *transport, const void *expected)
{
    struct scene_description description;
    struct error error;
    if (chdir("/") != 0)
        return 1;
    if (scene_message_receive(transport, &description, &error) != PS_OK)
        return 2;
    const struct scene_digest digest = digest_of(&description);
    const struct strategy_choice *injection = &description.render.strategies[PS_INJECTION];
    int status = memcmp(&digest, expected, sizeof digest) != 0 ? 3
                 : !names_are_own(&description)                ? 4
                 : strcmp(description.cameras[1].name, "side") != 0 ||
                         strcmp(injection->parameters[0].value, "1234") != 0
                     ? 5
                     : 0;
    scene_description_release(&description);
    return status;
}

static void test_every_rank_has_the_scene(void **state)
{
    (void)state;
    struct scene_description description;
    read_description(&description);
    const struct scene_digest expected = digest_of(&description);
    assert_int_not_equal(expected.parts[SCENE_TEXTURES], 0);
    for (int size = 1; size <= MOST_RANKS; size++) {
        pid_t children[MOST_RANKS];
        start_ranks(size, receive_and_compare, &expected, children);
        struct transport transport = transport_of(0, size);
        scene_message_send(&transport, &description);
        expect_success(size, children);
        const struct scene_digest after = digest_of(&description);
        assert_memory_equal(&after, &expected, sizeof after);
    }
    scene_description_release(&description);
}

/* --- without a scene
 * ------------------------------------------------------------------------------- */

static int receive_none(const struct transport *transport, const void *expected)
{
    (void)expected;
    struct scene_description description;
    struct error error;
    ps_result result = scene_message_receive(transport, &description, &error);
    scene_description_release(&description);
    return result == PS_ERROR_INVALID ? 0 : 1;
}

static void test_no_scene(void **state)
{
    (void)state;
    pid_t children[MOST_RANKS];
    start_ranks(MOST_RANKS, receive_none, NULL, children);
    struct transport transport = transport_of(0, MOST_RANKS);
    scene_message_send(&transport, NULL);
    expect_success(MOST_RANKS, children);
}

static int skip_in_some(const struct transport *transport, const void *expected)
{
    if (transport->rank % 2 == 0)
        scene_message_skip(transport);
    else
        return receive_and_compare(transport, expected);
    return 0;
}

/* A rank that has no use for it hands it on all the same: 6 has it from 4. */
static void test_skipped(void **state)
{
    (void)state;
    struct scene_description description;
    pid_t children[MOST_RANKS];
    read_description(&description);
    const struct scene_digest expected = digest_of(&description);
    start_ranks(MOST_RANKS, skip_in_some, &expected, children);
    struct transport transport = transport_of(0, MOST_RANKS);
    scene_message_send(&transport, &description);
    expect_success(MOST_RANKS, children);
    scene_description_release(&description);
}

/* Rank 0 has a picture that it cannot read: so have the others. */
static int expect_no_picture(const struct transport *transport, const void *expected)
{
    (void)expected;
    struct scene_description description;
    struct error error;
    if (scene_message_receive(transport, &description, &error) != PS_OK)
        return 1;
    bool is_there = description.textures[0].bytes != NULL;
    scene_description_release(&description);
    return is_there;
}

static void test_missing_picture(void **state)
{
    (void)state;
    struct scene_description description;
    pid_t children[MOST_RANKS];
    read_description(&description);
    strcpy(description.textures[0].path, "absent");
    start_ranks(2, expect_no_picture, NULL, children);
    struct transport transport = transport_of(0, 2);
    scene_message_send(&transport, &description);
    expect_success(2, children);
    scene_description_release(&description);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_every_rank_has_the_scene),
        cmocka_unit_test(test_no_scene),
        cmocka_unit_test(test_skipped),
        cmocka_unit_test(test_missing_picture),
    };
    char folder[4096];
    snprintf(folder, sizeof folder, "%s/tests/data", getenv("PSPLAT_SOURCE"));
    if (chdir(folder) != 0)
        return 1;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
