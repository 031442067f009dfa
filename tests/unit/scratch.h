/* scratch.h: a directory of its own for each test, removed with all that is in it. */
#ifndef TESTS_SCRATCH_H
#define TESTS_SCRATCH_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SCRATCH_PATHS 4

struct scratch {
    char *directory;
    char paths[SCRATCH_PATHS][512];
    unsigned next_path;
};

#define SCRATCH_TEST(function)                                                                     \
    cmocka_unit_test_setup_teardown(function, scratch_open, scratch_close)

static inline int scratch_open(void **state)
{
    struct scratch *scratch = calloc(1, sizeof *scratch);
    const char *parent = getenv("TMPDIR") ? getenv("TMPDIR") : "/tmp";
    size_t size = strlen(parent) + sizeof "/psplat-test-XXXXXX";
    assert_non_null(scratch);
    scratch->directory = malloc(size);
    assert_non_null(scratch->directory);
    snprintf(scratch->directory, size, "%s/psplat-test-XXXXXX", parent);
    *state = scratch;
    return mkdtemp(scratch->directory) ? 0 : -1;
}

/* A path in the directory; valid until SCRATCH_PATHS more are asked for. */
static inline const char *scratch_path(void **state, const char *name)
{
    struct scratch *scratch = *state;
    char *path = scratch->paths[scratch->next_path++ % SCRATCH_PATHS];
    snprintf(path, sizeof scratch->paths[0], "%s/%s", scratch->directory, name);
    return path;
}

/* Counts the files, hidden ones too, and removes them if asked to. */
static inline int scratch_visit(void **state, int remove_them)
{
    struct scratch *scratch = *state;
    DIR *directory = opendir(scratch->directory);
    int count = 0;
    assert_non_null(directory);
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            count++;
            if (remove_them) {
                remove(scratch_path(state, entry->d_name));
            }
        }
    }
    closedir(directory);
    return count;
}

static inline int scratch_file_count(void **state)
{
    return scratch_visit(state, 0);
}

static inline int scratch_close(void **state)
{
    struct scratch *scratch = *state;
    chmod(scratch->directory, 0700);
    scratch_visit(state, 1);
    int result = rmdir(scratch->directory);
    free(scratch->directory);
    free(scratch);
    return result;
}

/* All bytes of a file; to be freed. */
static inline unsigned char *scratch_load(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size + 1);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, file), *size);
    fclose(file);
    return bytes;
}

static inline void scratch_expect_same_bytes(const char *path_a, const char *path_b)
{
    size_t size_a, size_b;
    unsigned char *a = scratch_load(path_a, &size_a);
    unsigned char *b = scratch_load(path_b, &size_b);
    assert_int_equal(size_a, size_b);
    assert_memory_equal(a, b, size_a);
    free(a);
    free(b);
}

static inline void scratch_store(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

#endif
