/* test_mesh_cache.c: what was made of a mesh file comes from the cache while nothing that it
 * depends on has changed. */
#include "mesh_fixture.h"
#include "scratch.h"

#include <fcntl.h>

static const char model[] = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                            "usemtl m\nf 1/1 2/2 3/3\n";
static const char red[] = "newmtl m\nKd 0.5 0.1 0.1\nmap_Kd Picture.png\n";
static const char green[] = "newmtl m\nKd 0.1 0.5 0.1\nmap_Kd Picture.png\n";

static void write_text(void **state, const char *name, const char *text)
{
    scratch_store(scratch_path(state, name), text, strlen(text));
}

/* The entry, of which there is one at most; NULL: none. */
static const char *entry_path(void **state)
{
    const struct scratch *scratch = *state;
    const char *path = NULL;
    DIR *directory = opendir(scratch->directory);
    assert_non_null(directory);
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        if (strstr(entry->d_name, ".mesh")) {
            assert_null(path);
            path = scratch_path(state, entry->d_name);
        }
    closedir(directory);
    return path;
}

/* An entry that is written takes the place of the file that was there. */
static ino_t entry_number(void **state)
{
    const char *path = entry_path(state);
    struct stat status;
    assert_non_null(path);
    assert_int_equal(stat(path, &status), 0);
    return status.st_ino;
}

static struct imported import_by_cache(void **state, const char *name)
{
    struct scratch *scratch = *state;
    char path[512];
    snprintf(path, sizeof path, "%s", scratch_path(state, name));
    struct mesh_request request = request_all(path);
    request.cache = scratch->directory;
    return import_disk(&request);
}

static void expect_model(struct imported *imported, double r, double g, double b)
{
    expect_success(imported);
    assert_int_equal(imported->fragment.object_count, 1);
    assert_int_equal(mesh_of(imported, 0)->triangle_count, 1);
    expect_vector(mesh_of(imported, 0)->vertices[1], 1, 0, 0);
    expect_color(material_named(imported, "m")->color.colors[0], r, g, b);
    assert_string_equal(imported->fragment.objects[0].origin.file, "scene.psd");
    assert_int_equal(imported->fragment.materials[0].origin.line, 3);
}

static void write_model(void **state)
{
    write_text(state, "m.obj", model);
    write_text(state, "m.mtl", red);
}

/* Imports again; `as_before`: from the entry that there is. */
static void import_again(void **state, int as_before, double r, double g, double b,
                         const char *missing)
{
    ino_t before = entry_number(state);
    int holder = open(entry_path(state), O_RDONLY); /* so that its number is not given again */
    struct imported imported = import_by_cache(state, "m.obj");
    expect_model(&imported, r, g, b);
    assert_string_equal(imported.report.missing_names, missing);
    assert_int_equal(entry_number(state) == before, as_before);
    close(holder);
    release_imported(&imported);
}

static void import_first(void **state)
{
    write_model(state);
    struct imported imported = import_by_cache(state, "m.obj");
    expect_model(&imported, 0.5, 0.1, 0.1);
    release_imported(&imported);
}

static void comes_from_the_cache(void **state)
{
    import_first(state);
    import_again(state, 1, 0.5, 0.1, 0.1, "Picture.png");
    assert_int_equal(scratch_file_count(state), 3);
}

static void a_library_that_changed(void **state)
{
    import_first(state);
    write_text(state, "m.mtl", green);
    import_again(state, 0, 0.1, 0.5, 0.1, "Picture.png");
    import_again(state, 1, 0.1, 0.5, 0.1, "Picture.png");
}

/* Also by another letter case. */
static void a_texture_that_came(void **state)
{
    import_first(state);
    write_text(state, "picture.PNG", PNG_START);
    import_again(state, 0, 0.5, 0.1, 0.1, "");
    import_again(state, 1, 0.5, 0.1, 0.1, "");
    write_text(state, "picture.PNG", "nothing");
    import_again(state, 0, 0.5, 0.1, 0.1, "");
    remove(scratch_path(state, "picture.PNG"));
    import_again(state, 0, 0.5, 0.1, 0.1, "Picture.png");
}

static void a_library_that_came(void **state)
{
    write_text(state, "m.obj", model);
    struct imported imported = import_by_cache(state, "m.obj");
    expect_success(&imported);
    release_imported(&imported);
    write_text(state, "m.mtl", red);
    import_again(state, 0, 0.5, 0.1, 0.1, "Picture.png");
}

/* Cut off anywhere, or with one byte that is another: made anew. */
static void a_broken_entry(void **state)
{
    import_first(state);
    size_t size;
    char path[512];
    snprintf(path, sizeof path, "%s", entry_path(state));
    unsigned char *bytes = scratch_load(path, &size);
    for (size_t at = 0; at < size; at += at < 64 ? 7 : 997) {
        scratch_store(path, bytes, at);
        import_again(state, 0, 0.5, 0.1, 0.1, "Picture.png");
        bytes[at] ^= 4;
        scratch_store(path, bytes, size);
        bytes[at] ^= 4;
        import_again(state, 0, 0.5, 0.1, 0.1, "Picture.png");
    }
    free(bytes);
    import_again(state, 1, 0.5, 0.1, 0.1, "Picture.png");
}

/* A file of the same name with other bytes, the same bytes under another name, and another request
 * have entries of their own. */
static void other_entries(void **state)
{
    struct scratch *scratch = *state;
    import_first(state);
    write_text(state, "n.obj", model);
    struct imported imported = import_by_cache(state, "n.obj");
    expect_model(&imported, 0.5, 0.1, 0.1);
    release_imported(&imported);
    assert_int_equal(scratch_file_count(state), 5);
    char path[512];
    snprintf(path, sizeof path, "%s", scratch_path(state, "m.obj"));
    struct mesh_request request = request_all(path);
    request.cache = scratch->directory;
    request.unit = 2;
    imported = import_disk(&request);
    expect_success(&imported);
    assert_int_equal(scratch_file_count(state), 6);
    release_imported(&imported);
}

static void what_fails_leaves_no_entry(void **state)
{
    write_text(state, "m.obj", "f 1 2 3\n");
    struct imported imported = import_by_cache(state, "m.obj");
    expect_failure(&imported, PS_ERROR_INVALID, "m.obj:1: ");
    imported = import_by_cache(state, "gone.obj");
    expect_failure(&imported, PS_ERROR_IO, "gone.obj: cannot open");
    assert_int_equal(scratch_file_count(state), 1);
}

static void a_cache_that_is_not_there(void **state)
{
    char path[512], cache[512];
    write_model(state);
    snprintf(path, sizeof path, "%s", scratch_path(state, "m.obj"));
    snprintf(cache, sizeof cache, "%s", scratch_path(state, "nowhere"));
    struct mesh_request request = request_all(path);
    request.cache = cache;
    struct imported imported = import_disk(&request);
    expect_model(&imported, 0.5, 0.1, 0.1);
    if (!strstr(imported.report.notes, "it is not kept in the cache: "))
        fail_msg("notes: %s", imported.report.notes);
    release_imported(&imported);
}

/* Each member that says what is read, and how, makes another digest; those that do not make
 * none. */
static void digests_of_requests(void **state)
{
    (void)state;
    const struct mesh_request plain = {.path = "m.obj", .placement = AFFINE_IDENTITY, .unit = 1};
    struct mesh_request others[9], same = plain;
    const size_t count = sizeof others / sizeof others[0];
    for (size_t i = 0; i < count; i++)
        others[i] = plain;
    others[0].path = "n.obj";
    others[1].folder = "m.obj";
    others[2].unit = 2;
    others[3].up = 2;
    others[4].diffuse_only = true;
    others[5].srgb_colors = true;
    others[6].bump_scale = 1;
    others[7].smooth_angle = 1;
    others[8].placement.translation.y = 1;
    for (size_t i = 0; i < count; i++) {
        assert_true(mesh_request_digest(&others[i]) != mesh_request_digest(&plain));
        for (size_t k = 0; k < i; k++)
            assert_true(mesh_request_digest(&others[i]) != mesh_request_digest(&others[k]));
    }
    same.geometry = same.lights = true;
    same.cache = "cache";
    same.memory_limit = 1e9;
    same.origin.line = 7;
    assert_true(mesh_request_digest(&same) == mesh_request_digest(&plain));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(comes_from_the_cache),
        cmocka_unit_test(digests_of_requests),
        SCRATCH_TEST(a_library_that_changed),
        SCRATCH_TEST(a_texture_that_came),
        SCRATCH_TEST(a_library_that_came),
        SCRATCH_TEST(a_broken_entry),
        SCRATCH_TEST(other_entries),
        SCRATCH_TEST(what_fails_leaves_no_entry),
        SCRATCH_TEST(a_cache_that_is_not_there),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
