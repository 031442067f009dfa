/* cpu_time.c: by /proc/self/task (proc(5)): `comm`, and `stat`, whose fields 14 and 15 are ticks. */
#include "explore/cpu_time.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* "TID (NAME) STATE ...": the name may hold anything, so that the last bracket ends it. */
static bool read_ticks(const char *line, const char *name, unsigned long long *ticks)
{
    const char *open = strchr(line, '('), *close = strrchr(line, ')');
    unsigned long long user, system;
    if (!open || !close || strlen(name) != (size_t)(close - open - 1) ||
        strncmp(open + 1, name, strlen(name)) != 0)
        return false;
    if (sscanf(close + 1, " %*c %*s %*s %*s %*s %*s %*s %*s %*s %*s %*s %llu %llu", &user,
               &system) != 2)
        return false;
    *ticks = user + system;
    return true;
}

static unsigned long long ticks_of_thread(const char *thread, const char *name)
{
    char path[300], line[1024];
    unsigned long long ticks = 0;
    snprintf(path, sizeof path, "/proc/self/task/%s/stat", thread);
    FILE *file = fopen(path, "re");
    if (!file)
        return 0; /* it has ended */
    if (!fgets(line, sizeof line, file) || !read_ticks(line, name, &ticks))
        ticks = 0;
    fclose(file);
    return ticks;
}

double cpu_time_of_threads(const char *name)
{
    unsigned long long ticks = 0;
    DIR *threads = opendir("/proc/self/task");
    if (!threads)
        return 0.0;
    for (const struct dirent *entry = readdir(threads); entry; entry = readdir(threads))
        if (entry->d_name[0] != '.')
            ticks += ticks_of_thread(entry->d_name, name);
    closedir(threads);
    return (double)ticks / (double)sysconf(_SC_CLK_TCK);
}
