/* machine.c: questions to the system. */
#include "base/machine.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Where the limit of a group stands. */
struct hierarchy {
    const char *root, *folder, *file; /* root: of the file system */
};

/* The number in its file; infinite where there is no file, or it says "max". */
static double read_limit(const struct hierarchy *hierarchy, const char *group)
{
    char path[4400];
    double limit = INFINITY;
    snprintf(path, sizeof path, "%.1000s%s%.3000s/%s", hierarchy->root, hierarchy->folder, group,
             hierarchy->file);
    FILE *file = fopen(path, "r");
    if (file && fscanf(file, "%lf", &limit) != 1)
        limit = INFINITY;
    if (file)
        fclose(file);
    return limit;
}

/* The least limit of a group and those that it lies in. */
static double limit_of_group(const struct hierarchy *hierarchy, char *group)
{
    double least = read_limit(hierarchy, "");
    for (char *end = group + strlen(group); end > group; end = strrchr(group, '/')) {
        *end = '\0';
        least = fmin(least, read_limit(hierarchy, group));
    }
    return least;
}

/* Lines are "ID:CONTROLLERS:/GROUP"; of version 2 "0::/GROUP". */
double machine_memory_of_groups(const char *root)
{
    const struct hierarchy v1 = {root, "/sys/fs/cgroup/memory", "memory.limit_in_bytes"};
    const struct hierarchy v2 = {root, "/sys/fs/cgroup", "memory.max"};
    char line[4200], path[1100];
    double least = INFINITY;
    snprintf(path, sizeof path, "%.1000s/proc/self/cgroup", root);
    FILE *groups = fopen(path, "r");
    while (groups && fgets(line, sizeof line, groups)) {
        line[strcspn(line, "\n")] = '\0';
        char *group = strchr(line, '/');
        const char *controllers = strchr(line, ':');
        if (!group || !controllers)
            continue;
        if (strncmp(controllers, "::", 2) == 0)
            least = fmin(least, limit_of_group(&v2, group));
        else if (strncmp(controllers, ":memory:", 8) == 0)
            least = fmin(least, limit_of_group(&v1, group));
    }
    if (groups)
        fclose(groups);
    return least;
}

double machine_memory(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    double physical = pages > 0 && page > 0 ? (double)pages * (double)page : INFINITY;
    return fmin(physical, machine_memory_of_groups(""));
}

double machine_memory_within(double limit)
{
    double machine = machine_memory();
    return limit > 0.0 ? fmin(limit, machine) : machine;
}

/* Of proc(5)'s statm, which counts pages: size, resident, shared, text, lib, data. */
static double bytes_of_process(int field)
{
    double pages = 0.0;
    FILE *file = fopen("/proc/self/statm", "r");
    for (int i = 0; file && i <= field; i++)
        if (fscanf(file, "%lf", &pages) != 1)
            pages = 0.0;
    if (file)
        fclose(file);
    return pages * (double)sysconf(_SC_PAGESIZE);
}

double machine_memory_of_process(void)
{
    return bytes_of_process(1);
}

double machine_data_of_process(void)
{
    return bytes_of_process(5);
}
