/* test_mapped_file.c: what files that are looked at hold in memory, and that they stay what they
 * are. */
#include "base/mapped_file.h"
#include "base/parallel.h"
#include "scratch.h"

#define BLOCKS 64

static uint8_t byte_at(size_t i)
{
    return (uint8_t)(i * 2654435761u >> 13);
}

/* A file of BLOCKS blocks and a few bytes. */
static const char *create_file(void **state, const char *name, size_t *size)
{
    const char *path = scratch_path(state, name);
    *size = BLOCKS * MAPPED_BLOCK + 5;
    unsigned char *bytes = malloc(*size);
    assert_non_null(bytes);
    for (size_t i = 0; i < *size; i++)
        bytes[i] = byte_at(i);
    scratch_store(path, bytes, *size);
    free(bytes);
    return path;
}

static struct mapped_file *open_file(void **state, struct mapped_budget *budget)
{
    struct error error;
    size_t size;
    struct mapped_file *file = mapped_file_open(create_file(state, "file", &size), budget, &error);
    assert_non_null(file);
    assert_int_equal(file->size, size);
    return file;
}

static void expect_byte(const struct mapped_file *file, size_t i)
{
    mapped_file_touch(file, file->bytes + i, 1);
    if (file->bytes[i] != byte_at(i))
        fail_msg("byte %zu is not that of the file", i);
}

/* The file's start need not be that of a block. */
static void test_budget_is_kept(void **state)
{
    const size_t most = 16 * MAPPED_BLOCK;
    struct mapped_budget *budget = mapped_budget_create((double)most);
    struct mapped_file *file = open_file(state, budget);
    assert_int_equal(mapped_budget_held(budget), 0);
    assert_float_equal(mapped_budget_to_come(budget), (double)most, 0);
    for (int round = 0; round < 3; round++) {
        for (size_t i = 0; i < file->size; i += 1000) {
            expect_byte(file, i);
            assert_true(mapped_budget_held(budget) <= most);
        }
        assert_true(mapped_budget_held(budget) >= most / 2);
    }
    expect_byte(file, file->size - 1);
    mapped_file_close(file);
    assert_int_equal(mapped_budget_held(budget), 0);
    mapped_budget_destroy(budget);
}

static void test_large_budget_gives_nothing_back(void **state)
{
    struct mapped_budget *budget = mapped_budget_create(1e12);
    struct mapped_file *file = open_file(state, budget);
    double all = mapped_budget_to_come(budget);
    assert_true(all >= (double)file->size);
    assert_true(all <= (double)file->size + 2 * (double)MAPPED_BLOCK);
    for (size_t i = 0; i < file->size; i += 4096)
        expect_byte(file, i);
    expect_byte(file, file->size - 1);
    assert_float_equal((double)mapped_budget_held(budget), all, 0);
    assert_float_equal(mapped_budget_to_come(budget), 0, 0);
    mapped_file_close(file);
    mapped_budget_destroy(budget);
}

/* What is looked at between any two others stays. */
static void test_recent_blocks_stay(void **state)
{
    struct mapped_budget *budget = mapped_budget_create(16.0 * (double)MAPPED_BLOCK);
    struct mapped_file *file = open_file(state, budget);
    size_t often = 7 * MAPPED_BLOCK + 1, absent = 0;
    size_t block = ((uintptr_t)(file->bytes + often) >> MAPPED_BLOCK_SHIFT) - file->first;
    for (size_t i = 0; i < file->size; i += MAPPED_BLOCK / 2) {
        absent += i > 0 && file->marks[block] == MAPPED_ABSENT;
        expect_byte(file, often);
        expect_byte(file, i);
    }
    assert_int_equal(absent, 0);
    mapped_file_close(file);
    mapped_budget_destroy(budget);
}

/* Bytes on both sides of a boundary are of two blocks. */
static void test_boundary(void **state)
{
    struct mapped_budget *budget = mapped_budget_create(1e12);
    struct mapped_file *file = open_file(state, budget);
    uintptr_t boundary = (file->first + 3) << MAPPED_BLOCK_SHIFT;
    const unsigned char *at = file->bytes + (boundary - (uintptr_t)file->bytes) - 1;
    mapped_file_touch(file, at, 1);
    assert_int_equal(mapped_budget_held(budget), MAPPED_BLOCK);
    mapped_file_touch(file, at, 3);
    assert_int_equal(mapped_budget_held(budget), 2 * MAPPED_BLOCK);
    mapped_file_close(file);
    mapped_budget_destroy(budget);
}

static void look_around(void *user, uint64_t index, uint32_t worker)
{
    const struct mapped_file *file = user;
    (void)worker;
    for (size_t i = 0; i < 500; i++)
        expect_byte(file, (size_t)(index * 7919 + i * 104729) % file->size);
}

static void test_threads(void **state)
{
    const size_t most = 8 * MAPPED_BLOCK, threads = 4;
    struct mapped_budget *budget = mapped_budget_create((double)most);
    struct mapped_file *file = open_file(state, budget);
    struct workers *workers;
    struct error error;
    assert_int_equal(workers_create((uint32_t)threads, &workers, &error), PS_OK);
    parallel_for(workers, 400, look_around, file);
    workers_destroy(workers);
    assert_true(mapped_budget_held(budget) <= most + threads * MAPPED_BLOCK);
    mapped_file_close(file);
    mapped_budget_destroy(budget);
}

static void test_two_files(void **state)
{
    const size_t most = 8 * MAPPED_BLOCK;
    struct mapped_budget *budget = mapped_budget_create((double)most);
    struct mapped_file *first = open_file(state, budget), *second = open_file(state, budget);
    for (size_t i = 0; i < first->size; i += 5000) {
        expect_byte(first, i);
        expect_byte(second, i);
        assert_true(mapped_budget_held(budget) <= most);
    }
    mapped_file_close(first);
    for (size_t i = 0; i < second->size; i += 5000)
        expect_byte(second, i);
    mapped_file_close(second);
    assert_int_equal(mapped_budget_held(budget), 0);
    mapped_budget_destroy(budget);
}

static void test_no_file(void **state)
{
    struct mapped_budget *budget = mapped_budget_create(1e6);
    struct error error;
    assert_null(mapped_file_open(scratch_path(state, "none"), budget, &error));
    assert_non_null(strstr(error.text, "it cannot be opened: No such file"));
    scratch_store(scratch_path(state, "empty"), "", 0);
    assert_null(mapped_file_open(scratch_path(state, "empty"), budget, &error));
    assert_non_null(strstr(error.text, "it is empty"));
    assert_null(mapped_file_open(scratch_path(state, "."), budget, &error));
    mapped_budget_destroy(budget);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        SCRATCH_TEST(test_budget_is_kept),
        SCRATCH_TEST(test_large_budget_gives_nothing_back),
        SCRATCH_TEST(test_recent_blocks_stay),
        SCRATCH_TEST(test_boundary),
        SCRATCH_TEST(test_threads),
        SCRATCH_TEST(test_two_files),
        SCRATCH_TEST(test_no_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
