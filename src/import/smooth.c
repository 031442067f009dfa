/* smooth.c: smoothing groups of OBJ, which assimp leaves out.
 *
 * assimp gives each corner of each face a vertex of its own, in the file's order, mesh after mesh;
 * so the n-th corner of the text is the n-th vertex of assimp's. A corner's normal is the sum over
 * the faces that share its vertex and group, weighted by area. Group 0, or "off", is flat. That the
 * two orders agree is checked: by the number of corners, and by each `v` having one place only.
 */
#include "import/geometry.h"
#include "import/text.h"
#include <stdlib.h>
#include <string.h>

struct corner {
    uint32_t vertex, group;
    uint32_t sum; /* index into sums */
};

struct smoothing {
    struct mesh_job *job;
    struct corner *corners;
    size_t corner_count, capacity;
    size_t vertex_count; /* `v` lines so far */
    uint32_t group;
    bool any, overflow, out_of_memory;
};

/* --- the text ------------------------------------------------------------------------------------- */

static void add_corner(struct smoothing *s, long long vertex)
{
    if (s->corner_count == s->capacity) {
        size_t wanted = s->capacity > 0 ? 2 * s->capacity : 4096;
        struct corner *corners = realloc(s->corners, wanted * sizeof *corners);
        if (!corners) {
            s->out_of_memory = true;
            return;
        }
        s->corners = corners;
        s->capacity = wanted;
    }
    if (vertex < 0 || vertex >= (long long)s->vertex_count) {
        s->overflow = true;
        return;
    }
    s->corners[s->corner_count++] = (struct corner){(uint32_t)vertex, s->group, 0};
}

/* A word of a face: "7", "7/1", "-2//3". */
static void read_corner(struct smoothing *s, const char *word)
{
    long long index = strtoll(word, NULL, 10);
    add_corner(s, index < 0 ? (long long)s->vertex_count + index : index - 1);
}

static bool is_index(char c)
{
    return (c >= '0' && c <= '9') || c == '-';
}

static void read_face(struct smoothing *s, const struct text_line *words)
{
    const char *at = words->start;
    while (at < words->end && !s->out_of_memory && !s->overflow) {
        if (is_index(*at))
            read_corner(s, at);
        while (at < words->end && *at != ' ' && *at != '\t')
            at++;
        while (at < words->end && (*at == ' ' || *at == '\t'))
            at++;
    }
}

static void read_group(struct smoothing *s, const struct text_line *words)
{
    bool has_number = words->start < words->end && is_index(*words->start);
    long long group = has_number ? strtoll(words->start, NULL, 10) : 0;
    bool is_on = words->end - words->start == 2 && memcmp(words->start, "on", 2) == 0;
    s->group = is_on ? 1 : (uint32_t)group;
    s->any |= s->group != 0;
}

/* Lines and points have corners too; a statement may go on in the next line. */
static bool cannot_be_followed(const struct text_line *line)
{
    struct text_line words;
    return (line->start < line->end && line->end[-1] == '\\') ||
           text_line_starts(line, "l", &words) || text_line_starts(line, "p", &words);
}

static void read_text(struct smoothing *s)
{
    const struct mesh_file *file = s->job->main_file;
    const char *at = file->bytes, *end = file->bytes + file->length;
    struct text_line line, words;
    while (!s->out_of_memory && !s->overflow && text_next_line(&at, end, &line)) {
        if (cannot_be_followed(&line))
            s->overflow = true;
        else if (text_line_starts(&line, "v", &words))
            s->vertex_count++;
        else if (text_line_starts(&line, "f", &words))
            read_face(s, &words);
        else if (text_line_starts(&line, "s", &words))
            read_group(s, &words);
    }
}

/* Whether there is a group at all, without keeping anything. */
static bool has_groups(const struct mesh_job *job)
{
    struct smoothing scan = {.group = 0};
    const char *at = job->main_file->bytes, *end = at + job->main_file->length;
    struct text_line line, words;
    while (!scan.any && text_next_line(&at, end, &line))
        if (text_line_starts(&line, "s", &words))
            read_group(&scan, &words);
    return scan.any;
}

/* --- normals -------------------------------------------------------------------------------------- */

static bool has_same_place(const struct aiVector3D *a, const struct aiVector3D *b)
{
    return a->x == b->x && a->y == b->y && a->z == b->z;
}

static size_t count_vertices(const struct aiScene *scene)
{
    size_t count = 0;
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        count += scene->mMeshes[i]->mNumVertices;
    return count;
}

/* Each `v` must lie in one place in all of its corners. */
static ps_result check_order(const struct smoothing *s, bool *agrees)
{
    const struct aiScene *scene = s->job->scene;
    const struct aiVector3D **places = calloc(s->vertex_count + 1, sizeof(void *));
    if (!places)
        return mesh_out_of_memory(s->job, s->vertex_count * sizeof(void *));
    size_t corner = 0;
    *agrees = !s->overflow && s->corners && count_vertices(scene) == s->corner_count;
    for (unsigned i = 0; *agrees && i < scene->mNumMeshes; i++)
        for (unsigned j = 0; *agrees && s->corners && j < scene->mMeshes[i]->mNumVertices; j++) {
            const struct aiVector3D *place = &scene->mMeshes[i]->mVertices[j];
            const struct aiVector3D **known = &places[s->corners[corner++].vertex];
            *agrees = !*known || has_same_place(*known, place);
            *known = place;
        }
    free(places);
    return PS_OK;
}

static int compare_corners(const void *a, const void *b)
{
    const struct corner *p = *(const struct corner *const *)a;
    const struct corner *q = *(const struct corner *const *)b;
    if (p->vertex != q->vertex)
        return p->vertex < q->vertex ? -1 : 1;
    return p->group < q->group ? -1 : p->group > q->group;
}

/* Numbers the pairs of vertex and group. */
static ps_result number_sums(struct smoothing *s, size_t *count)
{
    if (!s->corners)
        return PS_OK;
    struct corner **order = malloc((s->corner_count + 1) * sizeof(struct corner *));
    if (!order)
        return mesh_out_of_memory(s->job, s->corner_count * sizeof(struct corner *));
    for (size_t i = 0; i < s->corner_count; i++)
        order[i] = &s->corners[i];
    qsort(order, s->corner_count, sizeof(struct corner *), compare_corners);
    *count = 0;
    for (size_t i = 0; i < s->corner_count; i++) {
        if (i == 0 || compare_corners(&order[i - 1], &order[i]) != 0)
            ++*count;
        order[i]->sum = (uint32_t)(*count - 1);
    }
    free(order);
    return PS_OK;
}

/* Twice the area times the normal. */
static ps_vec3 area_vector(const struct aiMesh *mesh, const struct aiFace *face)
{
    ps_vec3 a = mesh_vector(mesh->mVertices[face->mIndices[0]]);
    ps_vec3 b = mesh_vector(mesh->mVertices[face->mIndices[1]]);
    ps_vec3 c = mesh_vector(mesh->mVertices[face->mIndices[2]]);
    return ps_cross(ps_subtract(b, a), ps_subtract(c, a));
}

static void add_areas(const struct smoothing *s, ps_vec3 *sums)
{
    size_t first = 0;
    for (unsigned i = 0; s->corners && i < s->job->scene->mNumMeshes; i++) {
        const struct aiMesh *mesh = s->job->scene->mMeshes[i];
        for (unsigned j = 0; j < mesh->mNumFaces; j++) {
            const struct aiFace *face = &mesh->mFaces[j];
            if (face->mNumIndices != 3)
                continue;
            ps_vec3 area = area_vector(mesh, face);
            for (int k = 0; mesh_is_finite(area) && k < 3; k++) {
                ps_vec3 *sum = &sums[s->corners[first + face->mIndices[k]].sum];
                *sum = ps_add(*sum, area);
            }
        }
        first += mesh->mNumVertices;
    }
}

/* Zero, which means that of the triangle, in group 0. */
static ps_vec3 *normals_of_mesh(const struct smoothing *s, size_t first, size_t count,
                                const ps_vec3 *sums)
{
    ps_vec3 *normals = calloc(count + 1, sizeof *normals);
    for (size_t i = 0; normals && s->corners && i < count; i++) {
        const struct corner *corner = &s->corners[first + i];
        float length = ps_length(sums[corner->sum]);
        if (corner->group != 0 && length > 0 && isfinite(length))
            normals[i] = ps_scale(sums[corner->sum], 1.0f / length);
    }
    return normals;
}

static bool has_group(const struct smoothing *s, size_t first, size_t count)
{
    for (size_t i = 0; s->corners && i < count; i++)
        if (s->corners[first + i].group != 0)
            return true;
    return false;
}

static ps_result make_normals(struct smoothing *s, ps_vec3 **normals)
{
    size_t sum_count = 0, first = 0;
    ps_result result = number_sums(s, &sum_count);
    ps_vec3 *sums = result == PS_OK ? calloc(sum_count + 1, sizeof *sums) : NULL;
    if (!sums)
        return mesh_out_of_memory(s->job, s->corner_count * sizeof *sums);
    add_areas(s, sums);
    for (unsigned i = 0; result == PS_OK && i < s->job->scene->mNumMeshes; i++) {
        const struct aiMesh *mesh = s->job->scene->mMeshes[i];
        if (!mesh->mNormals && has_group(s, first, mesh->mNumVertices)) {
            normals[i] = normals_of_mesh(s, first, mesh->mNumVertices, sums);
            if (!normals[i])
                result = mesh_out_of_memory(s->job, mesh->mNumVertices * sizeof *sums);
        }
        first += mesh->mNumVertices;
    }
    free(sums);
    return result;
}

static bool lacks_normals(const struct aiScene *scene)
{
    for (unsigned i = 0; i < scene->mNumMeshes; i++)
        if (!scene->mMeshes[i]->mNormals)
            return true;
    return false;
}

ps_result mesh_smooth_normals(struct mesh_job *job, ps_vec3 ***normals)
{
    struct smoothing s = {.job = job};
    bool agrees = false;
    *normals = NULL;
    if (job->format != FORMAT_OBJ || !lacks_normals(job->scene) || !has_groups(job))
        return PS_OK;
    read_text(&s);
    ps_result result =
        s.out_of_memory ? mesh_out_of_memory(job, s.capacity) : check_order(&s, &agrees);
    if (result == PS_OK && !agrees)
        mesh_note(job, "its smoothing groups cannot be followed: it is flat");
    if (result == PS_OK && agrees) {
        *normals = calloc(job->scene->mNumMeshes + (size_t)1, sizeof(ps_vec3 *));
        result = *normals ? make_normals(&s, *normals)
                          : mesh_out_of_memory(job, job->scene->mNumMeshes * sizeof(ps_vec3 *));
    }
    free(s.corners);
    return result;
}

void mesh_smooth_release(const struct mesh_job *job, ps_vec3 **normals)
{
    for (unsigned i = 0; normals && i < job->scene->mNumMeshes; i++)
        free(normals[i]);
    free(normals);
}
