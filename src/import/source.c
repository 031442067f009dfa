/* source.c: assimp reads through us.
 *
 * Every file that assimp opens comes from mesh_files, as a block of memory: the one that was looked
 * at before is the one that is read. aiImportFileFromMemory could not find an MTL or .bin file.
 */
#include "import/source.h"

#include "import/child.h"
#include "import/text.h"
#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST_PATH 4096

struct stream {
    struct aiFile functions;
    const struct mesh_file *file;
    size_t position;
};

static struct stream *stream_of(struct aiFile *file)
{
    return (struct stream *)(void *)file->UserData;
}

static size_t read_stream(struct aiFile *file, char *buffer, size_t size, size_t count)
{
    struct stream *stream = stream_of(file);
    size_t left = stream->file->length - stream->position;
    if (size == 0 || count == 0)
        return 0;
    if (count > left / size)
        count = left / size;
    memcpy(buffer, stream->file->bytes + stream->position, size * count);
    stream->position += size * count;
    return count;
}

static size_t write_stream(struct aiFile *file, const char *buffer, size_t size, size_t count)
{
    (void)file;
    (void)buffer;
    (void)size;
    (void)count;
    return 0;
}

static size_t tell_stream(struct aiFile *file)
{
    return stream_of(file)->position;
}

static size_t stream_size(struct aiFile *file)
{
    return stream_of(file)->file->length;
}

static enum aiReturn seek_stream(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    struct stream *stream = stream_of(file);
    size_t base = origin == aiOrigin_CUR   ? stream->position
                  : origin == aiOrigin_END ? stream->file->length
                                           : 0;
    size_t target = base + offset;
    if (target > stream->file->length)
        return aiReturn_FAILURE;
    stream->position = target;
    return aiReturn_SUCCESS;
}

static void flush_stream(struct aiFile *file)
{
    (void)file;
}

static bool clean_path(const char *path, char *clean)
{
    size_t length = strlen(path);
    while (length > 0 && strchr(" \t\r\n", path[length - 1]))
        length--;
    if (length >= LONGEST_PATH)
        return false;
    for (size_t i = 0; i < length; i++)
        clean[i] = path[i];
    clean[length] = '\0';
    for (char *c = clean; *c; c++)
        if (*c == '\\')
            *c = '/';
    return true;
}

/* A larger file takes longer, by at most a second for each MiB. */
static ps_result read_file(struct mesh_job *job, const char *path, struct mesh_file **file,
                           struct error *error)
{
    ps_result result = mesh_files_read(&job->files, path, file, error);
    if (result == PS_OK)
        child_extend_time((unsigned)((*file)->length >> 20));
    return result;
}

static struct mesh_file *read_companion(struct mesh_job *job, const char *path)
{
    struct error ignored;
    struct mesh_file *file = NULL;
    ps_result result = read_file(job, path, &file, &ignored);
    job->out_of_memory |= result == PS_ERROR_MEMORY;
    return result == PS_OK ? file : NULL;
}

static struct mesh_file *find_companion(struct mesh_job *job, char *path)
{
    struct mesh_file *file = read_companion(job, path);
    if (file)
        return file;
    mesh_decode_percent(path);
    return read_companion(job, path);
}

static struct mesh_file *find_file(struct mesh_job *job, const char *path)
{
    char clean[LONGEST_PATH];
    if (strcmp(path, job->main_file->path) == 0)
        return job->format == FORMAT_OBJ ? &job->obj.outline
               : job->ply.is_read        ? &job->ply.outline
                                         : job->main_file;
    return clean_path(path, clean) ? find_companion(job, clean) : NULL;
}

/* assimp goes on without it, and tries the name of the mesh with another suffix next. */
static void miss_library(struct mesh_job *job, const char *path)
{
    if (job->missing_library)
        return;
    job->missing_library = strdup(path);
    job->out_of_memory |= !job->missing_library;
}

static struct aiFile *open_stream(struct aiFileIO *io, const char *path, const char *mode)
{
    struct mesh_job *job = (struct mesh_job *)(void *)io->UserData;
    struct mesh_file *file = mode[0] == 'r' ? find_file(job, path) : NULL;
    if (!file && job->format == FORMAT_OBJ)
        miss_library(job, path);
    if (!file)
        return NULL;
    if (job->format == FORMAT_OBJ && file != &job->obj.outline) {
        mtl_blank_preamble(file);
        job->library = file;
    }
    struct stream *stream = calloc(1, sizeof *stream);
    if (!stream) {
        job->out_of_memory = true;
        return NULL;
    }
    *stream = (struct stream){
        .functions = {.ReadProc = read_stream,
                      .WriteProc = write_stream,
                      .TellProc = tell_stream,
                      .FileSizeProc = stream_size,
                      .SeekProc = seek_stream,
                      .FlushProc = flush_stream,
                      .UserData = (aiUserData)(void *)stream},
        .file = file,
    };
    return &stream->functions;
}

static void close_stream(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    free(stream_of(file));
}

/* assimp's own words, without a newline at the end. */
static ps_result report_assimp(struct mesh_job *job)
{
    const char *text = aiGetErrorString();
    size_t length = text ? strlen(text) : 0;
    while (length > 0 && strchr(" \r\n", text[length - 1]))
        length--;
    if (text && strstr(text, "bad_alloc"))
        return error_set(job->error, PS_ERROR_INVALID,
                         "%s: the file is broken, or too large for the memory that there is",
                         job->request->path);
    return error_set(job->error, PS_ERROR_INVALID, "%s: %.*s", job->request->path,
                     length < 1000 ? (int)length : 1000,
                     length > 0 ? text : "the file cannot be read as a mesh");
}

ps_result mesh_source_open(struct mesh_job *job)
{
    struct aiFileIO io = {open_stream, close_stream, (aiUserData)(void *)job};
    ps_result result = read_file(job, job->request->path, &job->main_file, job->error);
    if (result == PS_OK && job->main_file->length == 0)
        result =
            error_set(job->error, PS_ERROR_INVALID, "%s: the file is empty", job->request->path);
    if (result == PS_OK && (job->format == FORMAT_GLTF || job->format == FORMAT_GLB))
        result = gltf_open(&job->gltf, job->main_file, &job->files, job->format == FORMAT_GLB,
                           job->error);
    if (result == PS_OK && job->format == FORMAT_PLY)
        result = ply_open(&job->ply, job->main_file, job->error);
    if (result == PS_OK && job->format == FORMAT_PLY && !job->ply.is_read)
        result = ply_guard_data(job->main_file, job->error);
    if (result == PS_OK && job->format == FORMAT_OBJ)
        result = obj_open(&job->obj, job->main_file, job->error);
    if (result != PS_OK)
        return result;
    job->scene = aiImportFileEx(job->request->path, 0, &io);
    if (job->out_of_memory)
        return mesh_out_of_memory(job, sizeof(struct stream));
    if (job->scene && job->gltf.draco_integers)
        mesh_note(
            job->report,
            "normals or texture coordinates that are integers compressed by Draco are left out");
    if (job->scene && job->missing_library && !job->library && job->request->materials)
        mesh_note(job->report, "cannot read its library %.1000s", job->missing_library);
    if (job->scene && job->format == FORMAT_OBJ &&
        job->scene->mNumMeshes != job->obj.material_count + 1)
        return error_set(job->error, PS_ERROR_INVALID, "%s: not all of the materials were read",
                         job->request->path);
    return job->scene ? PS_OK : report_assimp(job);
}

ps_result mesh_source_triangulate(struct mesh_job *job)
{
    job->scene = aiApplyPostProcessing(job->scene, aiProcess_Triangulate);
    return job->scene ? PS_OK : report_assimp(job);
}
