/* test_machine.c: limits of control groups of both versions, by files as the system has them. */
#include "base/machine.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cmocka.h>

/* Writes a file below the root, and the folders that it lies in. */
static void write_below(const char *root, const char *name, const char *text)
{
    char path[512];
    snprintf(path, sizeof path, "%s%s", root, name);
    for (char *slash = strchr(path + strlen(root) + 1, '/'); slash;
         slash = strchr(slash + 1, '/')) {
        *slash = '\0';
        mkdir(path, 0700);
        *slash = '/';
    }
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static char *new_root(void)
{
    char *root = strdup("/tmp/psplat-machine-XXXXXX");
    assert_non_null(mkdtemp(root));
    return root;
}

static void remove_root(char *root)
{
    char command[600];
    snprintf(command, sizeof command, "rm -r '%s'", root);
    assert_int_equal(system(command), 0);
    free(root);
}

static void test_version_2(void **state)
{
    (void)state;
    char *root = new_root();
    assert_true(isinf(machine_memory_of_groups(root)));
    write_below(root, "/proc/self/cgroup", "0::/user/job\n");
    assert_true(isinf(machine_memory_of_groups(root)));
    write_below(root, "/sys/fs/cgroup/user/job/memory.max", "max\n");
    assert_true(isinf(machine_memory_of_groups(root)));
    write_below(root, "/sys/fs/cgroup/user/memory.max", "3000000000\n");
    assert_true(machine_memory_of_groups(root) == 3e9);
    write_below(root, "/sys/fs/cgroup/user/job/memory.max", "2000000000\n");
    assert_true(machine_memory_of_groups(root) == 2e9);
    write_below(root, "/sys/fs/cgroup/memory.max", "1000000000\n"); /* within a container */
    assert_true(machine_memory_of_groups(root) == 1e9);
    remove_root(root);
}

static void test_version_1(void **state)
{
    (void)state;
    char *root = new_root();
    write_below(root, "/proc/self/cgroup", "5:cpu:/user\n4:memory:/user/job\n0::/\n");
    write_below(root, "/sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
    write_below(root, "/sys/fs/cgroup/memory/user/job/memory.limit_in_bytes", "4096\n");
    assert_true(machine_memory_of_groups(root) == 4096);
    remove_root(root);
}

static void test_what_there_is(void **state)
{
    (void)state;
    assert_true(machine_memory() > 1e6);
    assert_true(machine_memory_of_process() > 1e5);
    assert_true(machine_memory_of_process() < machine_memory());
    double before = machine_data_of_process();
    size_t size = (size_t)1 << 30;
    int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
    void *mapped = mmap(NULL, size, PROT_READ | PROT_WRITE, flags, -1, 0);
    assert_true(mapped != MAP_FAILED);
    assert_true(machine_data_of_process() > before + 0.99 * (double)size);
    munmap(mapped, size);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_version_2),
        cmocka_unit_test(test_version_1),
        cmocka_unit_test(test_what_there_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
