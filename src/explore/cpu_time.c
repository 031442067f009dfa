/* cpu_time.c: by /proc/self/task (proc(5)): `schedstat` begins with nanoseconds, where the system
 * keeps them; fields 14 and 15 of `stat` are ticks. */
#include "explore/cpu_time.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* The first line of a thread's file; false where it has ended. */
static bool read_line(const char *thread, const char *name, char *line, int size)
{
    char path[300];
    snprintf(path, sizeof path, "/proc/self/task/%s/%s", thread, name);
    FILE *file = fopen(path, "re");
    bool good = file && fgets(line, size, file);
    if (file)
        fclose(file);
    return good;
}

/* "TID (NAME) STATE ...": the name may hold anything, so that the last bracket ends it. */
static bool read_ticks(const char *line, const char *name, double *seconds)
{
    const char *open = strchr(line, '('), *close = strrchr(line, ')');
    unsigned long long user, system;
    if (!open || !close || strlen(name) != (size_t)(close - open - 1) ||
        strncmp(open + 1, name, strlen(name)) != 0)
        return false;
    if (sscanf(close + 1, " %*c %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %llu %llu", &user,
               &system) != 2)
        return false;
    *seconds = (double)(user + system) / (double)sysconf(_SC_CLK_TCK);
    return true;
}

static double seconds_of_thread(const char *thread, const char *name)
{
    char line[1024];
    double seconds;
    unsigned long long nanoseconds;
    if (!read_line(thread, "stat", line, sizeof line) || !read_ticks(line, name, &seconds))
        return 0.0;
    if (read_line(thread, "schedstat", line, sizeof line) &&
        sscanf(line, "%llu", &nanoseconds) == 1)
        return 1e-9 * (double)nanoseconds;
    return seconds;
}

double cpu_time_of_threads(const char *name)
{
    double seconds = 0.0;
    DIR *threads = opendir("/proc/self/task");
    if (!threads)
        return 0.0;
    for (const struct dirent *entry = readdir(threads); entry; entry = readdir(threads))
        if (entry->d_name[0] != '.')
            seconds += seconds_of_thread(entry->d_name, name);
    closedir(threads);
    return seconds;
}
