/* import.c: a mesh file's content by way of a child process.
 *
 * assimp crashes, hangs or takes all memory on many broken files, in ways that change with its
 * version. Checks of each format before assimp sees it would be a second reader of each. So assimp
 * and all that follows its pointers run in a child with limits, and what was made of the file comes
 * back through a file in memory.
 */
#include "import/import.h"

#include "base/machine.h"
#include "base/text.h"
#include "import/cache.h"
#include "import/child.h"
#include "import/job.h"
#include "import/transfer.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Of the machine's memory: a file's content is there twice at the end, with the child's own
 * work. */
#define SHARE_OF_MEMORY 0.5

#define SECONDS 20 /* of processor time, and one for each MiB of the files (source.c) */

struct task {
    const struct mesh_request *request;
    struct mesh_files files;
    struct mesh_outcome *outcome;
    int transfer;
};

static void work(void *context)
{
    struct task *task = context;
    struct mesh_job job = {
        .request = task->request,
        .fragment = &task->outcome->fragment,
        .report = &task->outcome->report,
        .error = &task->outcome->error,
        .files = task->files,
    };
    task->outcome->result = mesh_job_run(&job);
    mesh_outcome_send(task->outcome, task->transfer);
}

static ps_result import(struct task *task, struct error *error)
{
    const struct mesh_request *request = task->request;
    double share = SHARE_OF_MEMORY * machine_memory();
    const struct child_limits limits = {fmin(share, machine_memory_within(request->memory_limit)),
                                        request->seconds > 0 ? request->seconds : SECONDS};
    char most[TEXT_SIZE_LENGTH];
    struct error reason;
    ps_result result = child_run(work, task, &limits, &reason);
    if (result == PS_ERROR_INVALID)
        return error_set(error, result, "%s: assimp, which reads mesh files, %.1000s",
                         request->path, reason.text);
    if (result != PS_OK)
        return error_set(error, result, "%s: %.1000s", request->path, reason.text);
    if (lseek(task->transfer, 0, SEEK_SET) != 0 ||
        !mesh_outcome_receive(task->outcome, task->transfer))
        return error_set(error, PS_ERROR_MEMORY, "%s: out of memory", request->path);
    if (task->outcome->result == PS_ERROR_MEMORY && isfinite(limits.bytes))
        return error_set(error, PS_ERROR_MEMORY, "%s: %.1000s; to read it may take %s%s",
                         request->path, task->outcome->error.text, text_of_size(limits.bytes, most),
                         limits.bytes < share ? ", by --memory-limit" : "");
    if (task->outcome->result != PS_OK)
        *error = task->outcome->error;
    return task->outcome->result;
}

/* What cannot be stored is told, and made again the next time. */
static void store(const struct task *task, const struct mesh_cache_entry *entry)
{
    struct error reason;
    if (!task->outcome->looks.incomplete &&
        mesh_cache_store(entry, task->transfer, &reason) != PS_OK)
        mesh_note(&task->outcome->report, "it is not kept in the cache: %.1000s", reason.text);
}

static ps_result import_by_cache(struct task *task, struct error *error)
{
    struct mesh_cache_entry entry = mesh_cache_entry(task->request);
    ps_result result = PS_OK;
    if (entry.path)
        task->files.looks = &task->outcome->looks;
    if (!entry.path || !mesh_cache_load(&entry, task->request, task->outcome)) {
        result = import(task, error);
        if (entry.path && result == PS_OK)
            store(task, &entry);
    }
    mesh_looks_release(&task->outcome->looks);
    free(entry.path);
    return result;
}

static ps_result import_files(const struct mesh_request *request, struct mesh_files files,
                              struct scene_description *fragment, struct mesh_report *report,
                              struct error *error)
{
    struct mesh_outcome *outcome = calloc(1, sizeof *outcome);
    *fragment = (struct scene_description){0};
    *report = (struct mesh_report){0};
    if (!outcome)
        return error_memory(error, sizeof *outcome, "a mesh file");
    struct task task = {request, files, outcome, mesh_transfer_open()};
    ps_result result = task.transfer < 0
                           ? error_set(error, PS_ERROR_IO, "%s: no file in memory: %s",
                                       request->path, strerror(errno))
                           : import_by_cache(&task, error);
    if (task.transfer >= 0)
        close(task.transfer);
    *fragment = outcome->fragment;
    *report = outcome->report;
    free(outcome);
    return result;
}

ps_result mesh_import(const struct mesh_request *request, struct scene_description *fragment,
                      struct mesh_report *report, struct error *error)
{
    const struct mesh_files disk = {.folder = request->folder};
    return import_files(request, disk, fragment, report, error);
}

ps_result mesh_import_memory(const struct mesh_request *request,
                             const struct mesh_memory_file *files, size_t file_count,
                             struct scene_description *fragment, struct mesh_report *report,
                             struct error *error)
{
    const struct mesh_files memory = {.memory = files, .memory_count = file_count};
    return import_files(request, memory, fragment, report, error);
}
