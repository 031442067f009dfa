/* command_fmt.c: psplat fmt: lays out scenes as those that psplat ships are. */
#include "base/file.h"
#include "base/output_file.h"
#include "cli/command.h"
#include "parser/format.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const struct option options[] = {
    {0, "check", NULL, "write nothing; name the files that would change, and exit with 1"},
};

enum outcome { UNCHANGED, CHANGED, FAULTY, FAILED };

/* The new file gets the owner and the permissions of the old one; a change of owner takes bits of
 * the permissions away. */
static void keep_owner_and_permissions(int descriptor, const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return;
    bool kept = fchown(descriptor, status.st_uid, status.st_gid) == 0;
    if (!kept && fchown(descriptor, (uid_t)-1, status.st_gid) != 0)
        status.st_mode &= ~(mode_t)S_IRWXG | (status.st_mode & S_IRWXO) << 3; /* of another group */
    if (fchmod(descriptor, status.st_mode & 07777) != 0 || !kept)
        print_warning("fmt: the owner or the permissions of a file could not be kept");
}

/* Another text in the same file, as its owner sees it. */
static ps_result replace(const char *path, const char *text, size_t length, struct error *error)
{
    struct output_file file;
    ps_result result = output_file_open(&file, path, error);
    if (result != PS_OK)
        return result;
    if (file.temporary)
        keep_owner_and_permissions(file.descriptor, path);
    result = output_file_write(&file, 0, text, length, error);
    if (result == PS_OK)
        return output_file_commit(&file, error);
    output_file_discard(&file);
    return result;
}

static enum outcome put(const char *path, bool only_checks, const struct file_text *before,
                        const char *text, size_t length)
{
    struct error error;
    bool same = before->length == length && memcmp(before->bytes, text, length) == 0;
    if (only_checks) {
        if (!same)
            printf("%s\n", path);
    } else if (strcmp(path, "-") == 0) {
        fwrite(text, 1, length, stdout);
    } else if (!same && replace(path, text, length, &error) != PS_OK) {
        print_error(error.text);
        return FAILED;
    }
    return same ? UNCHANGED : CHANGED;
}

static enum outcome format_text(const char *path, bool only_checks, const struct file_text *before)
{
    struct diagnostics *sink = diagnostics_create();
    char *text = NULL;
    size_t length = 0;
    enum outcome outcome = FAILED;
    ps_result result = PS_ERROR_MEMORY;
    if (sink)
        result = psd_format_text(strcmp(path, "-") == 0 ? "<stdin>" : path, before->bytes,
                                 before->length, sink, &text, &length);
    if (result == PS_ERROR_MEMORY)
        print_error("out of memory");
    else if (result != PS_OK)
        outcome = FAULTY;
    else
        outcome = put(path, only_checks, before, text, length);
    if (sink)
        diagnostics_print(sink, stderr);
    diagnostics_destroy(sink);
    free(text);
    return outcome;
}

static enum outcome format_file(const char *path, bool only_checks)
{
    struct file_text before = {0};
    struct error error;
    enum outcome outcome = FAULTY;
    if (file_read(path, &before, &error) == PS_OK)
        outcome = format_text(path, only_checks, &before);
    else
        fprintf(stderr, "psplat: error: %s: %s\n", path, error.text);
    file_release(&before);
    return outcome;
}

static int run(const struct argument *arguments, size_t count)
{
    size_t outcomes[FAILED + 1] = {0}, files = 0;
    bool only_checks = false;
    for (size_t i = 0; i < count; i++)
        only_checks |= arguments[i].option != NULL;
    for (size_t i = 0; i < count; i++)
        if (!arguments[i].option) {
            outcomes[format_file(arguments[i].value, only_checks)]++;
            files++;
        }
    if (files == 0)
        print_error("fmt: which files? Try 'psplat fmt --help'.");
    if (files == 0 || outcomes[FAULTY] > 0)
        return STATUS_USAGE;
    return outcomes[FAILED] > 0 || (only_checks && outcomes[CHANGED] > 0) ? STATUS_FAILED
                                                                          : STATUS_OK;
}

const struct command command_fmt = {
    .name = "fmt",
    .operands = "SCENE.psd...",
    .summary = "lays out scenes evenly, and changes nothing else",
    .options = options,
    .option_count = sizeof options / sizeof options[0],
    .run = run,
};
