/* own_folder.c: the file of this code, by the system's list of what is mapped where.
 *
 * dladdr() has the name that a library was loaded by, which may be relative to a folder that was
 * left since, and of a program whatever it was called by; /proc/self/maps has paths.
 */
#include "plugin/own_folder.h"

#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Something that lies in this file. */
static const char here[] = "here";

/* The file in a line "FROM-TO MODE OFFSET DEVICE INODE PATH" that has the address; NULL: it is not
 * there. */
static const char *file_in_line(char *line, uintptr_t address)
{
    uintptr_t from, to;
    int path = 0;
    if (sscanf(line, "%" SCNxPTR "-%" SCNxPTR " %*s %*s %*s %*s %n", &from, &to, &path) < 2 ||
        address < from || address >= to || path == 0 || line[path] != '/')
        return NULL;
    line[strcspn(line, "\n")] = '\0';
    return line + path;
}

/* The system writes a line's end in a name as "\012"; which may stand in a name by itself. */
static void restore_line_ends(char *path)
{
    static const char escape[] = "\\012";
    size_t length = sizeof escape - 1;
    if (access(path, F_OK) == 0)
        return;
    for (char *at = path; (at = strstr(at, escape)) != NULL; at++) {
        *at = '\n';
        memmove(at + 1, at + length, strlen(at + length) + 1);
    }
}

static bool own_file(char path[LONGEST_PATH])
{
    FILE *maps = fopen("/proc/self/maps", "re");
    char *line = NULL;
    size_t size = 0;
    bool found = false;
    while (maps && !found && getline(&line, &size, maps) > 0) {
        const char *file = file_in_line(line, (uintptr_t)here);
        found = file && (size_t)snprintf(path, LONGEST_PATH, "%s", file) < LONGEST_PATH;
    }
    free(line);
    if (maps)
        fclose(maps);
    if (found)
        restore_line_ends(path);
    return found;
}

static bool is_program(const char *path)
{
    char program[LONGEST_PATH];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program);
    return length > 0 && (size_t)length == strlen(path) &&
           memcmp(program, path, (size_t)length) == 0;
}

bool own_folder_find(char path[LONGEST_PATH])
{
    static const char installed[] = PSPLAT_PLUGINS_INSTALLED;
    if (own_file(path)) {
        const char *from =
            is_program(path) ? PSPLAT_PLUGINS_FROM_PROGRAM : PSPLAT_PLUGINS_FROM_LIBRARY;
        size_t folder = (size_t)(strrchr(path, '/') - path) + 1;
        if ((size_t)snprintf(path + folder, LONGEST_PATH - folder, "%s", from) <
            LONGEST_PATH - folder)
            return true;
    }
    snprintf(path, LONGEST_PATH, "%s", installed);
    return sizeof installed <= LONGEST_PATH;
}
