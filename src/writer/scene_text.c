/* scene_text.c: see scene_text.h. */
#include "writer/scene_text.h"

#include "image/image.h"
#include <stdlib.h>
#include <string.h>

bool scene_text_grow(void **items, size_t *capacity, size_t wanted, size_t size)
{
    if (wanted <= *capacity)
        return true;
    size_t larger = wanted + wanted / 2 + 4;
    void *grown = larger <= SIZE_MAX / size ? realloc(*items, larger * size) : NULL;
    if (!grown)
        return false;
    *items = grown;
    *capacity = larger;
    return true;
}

/* --- buffers
 * -------------------------------------------------------------------------------------- */

bool text_buffer_open(struct text_buffer *buffer)
{
    *buffer = (struct text_buffer){0};
    buffer->stream = open_memstream(&buffer->bytes, &buffer->length);
    return buffer->stream != NULL;
}

char *text_buffer_close(struct text_buffer *buffer)
{
    bool good = buffer->stream && !ferror(buffer->stream);
    if (buffer->stream && fclose(buffer->stream) != 0)
        good = false;
    char *bytes = buffer->bytes;
    *buffer = (struct text_buffer){0};
    if (good)
        return bytes;
    free(bytes);
    return NULL;
}

bool scene_text_open(struct scene_text *scene)
{
    *scene = (struct scene_text){0};
    struct text_buffer *const buffers[] = {&scene->camera, &scene->image,  &scene->materials,
                                           &scene->lights, &scene->groups, &scene->objects};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        if (!text_buffer_open(buffers[i])) {
            scene_text_release(scene);
            return false;
        }
    return true;
}

static void release_file(struct side_file *file)
{
    free(file->name);
    free(file->bytes);
    if (file->picture)
        image_release(file->picture);
    free(file->picture);
}

static void release_files(struct side_file *files, size_t count, char **named, size_t named_count)
{
    for (size_t i = 0; i < count; i++)
        release_file(&files[i]);
    free(files);
    for (size_t i = 0; i < named_count; i++)
        free(named[i]);
    free(named);
}

void written_scene_release(struct written_scene *scene)
{
    release_files(scene->files, scene->file_count, scene->named, scene->named_count);
    free(scene->text);
    *scene = (struct written_scene){0};
}

void scene_text_release(struct scene_text *scene)
{
    struct text_buffer *const buffers[] = {&scene->camera, &scene->image,  &scene->materials,
                                           &scene->lights, &scene->groups, &scene->group,
                                           &scene->objects};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        free(text_buffer_close(buffers[i]));
    for (size_t i = 0; i < scene->material_count; i++)
        free(scene->interned[i].text);
    free(scene->interned);
    name_index_release(&scene->by_text);
    name_index_release(&scene->by_name);
    for (size_t i = 0; i < scene->name_count; i++)
        free(scene->names[i].name);
    free(scene->names);
    release_files(scene->files, scene->file_count, scene->named, scene->named_count);
    *scene = (struct scene_text){0};
}

/* Writes "HEADING\n" and the section, unless it is empty. False: out of memory. */
static bool put_section(FILE *out, const char *heading, struct text_buffer *buffer)
{
    char *bytes = text_buffer_close(buffer);
    if (bytes && bytes[0])
        fprintf(out, "%s%s", heading, bytes);
    free(bytes);
    return bytes != NULL;
}

size_t scene_text_values(const char *text)
{
    size_t count = 0;
    bool quoted = false;
    for (; *text; text++) {
        if (quoted && *text == '\\')
            text++; /* a quote may follow */
        else if (*text == '"')
            quoted = !quoted;
        else if (!quoted)
            count += *text == '\n' ? 2 : strchr("[{,:", *text) != NULL;
    }
    return count;
}

bool scene_text_finish(struct scene_text *scene, const char *comment, struct written_scene *result)
{
    struct text_buffer whole;
    bool good = !scene->failed && text_buffer_open(&whole);
    if (!good)
        return false;
    fprintf(whole.stream, "%spsd: 1\n", comment);
    good = put_section(whole.stream, "camera: ", &scene->camera);
    good = put_section(whole.stream, "image: ", &scene->image) && good;
    good = put_section(whole.stream, "materials:\n", &scene->materials) && good;
    good = put_section(whole.stream, "lights:\n", &scene->lights) && good;
    good = put_section(whole.stream, "groups:\n", &scene->groups) && good;
    good = put_section(whole.stream, "objects:\n", &scene->objects) && good;
    fflush(whole.stream);
    size_t length = whole.length;
    char *text = text_buffer_close(&whole);
    if (!good || !text) {
        free(text);
        return false;
    }
    *result = (struct written_scene){
        text, length, scene->files, scene->file_count, scene->named, scene->named_count};
    scene->files = NULL;
    scene->named = NULL;
    scene->file_count = scene->named_count = 0;
    return true;
}

/* --- names
 * ---------------------------------------------------------------------------------------- */

static struct scene_name *find_name(const struct scene_text *scene, const char *name)
{
    size_t i = name_index_find(&scene->by_name, name_index_hash(name));
    for (; i != NAME_INDEX_NONE; i = name_index_before(&scene->by_name, i))
        if (strcmp(scene->names[i].name, name) == 0)
            return &scene->names[i];
    return NULL;
}

/* Names are keys and formulas' words in psd(5): what they can't be made of becomes a line. */
static void make_plain(char *name)
{
    for (char *c = name; *c; c++) {
        bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') ||
                     (*c >= '0' && *c <= '9') || strchr("_-. ", *c);
        if (!plain)
            *c = '_';
    }
}

const char *scene_text_name(struct scene_text *scene, const char *wanted)
{
    size_t size = strlen(wanted) + 32;
    char *name = malloc(size);
    if (!name || !scene_text_grow((void **)&scene->names, &scene->name_capacity,
                                  scene->name_count + 1, sizeof *scene->names)) {
        free(name);
        scene->failed = true;
        return NULL;
    }
    snprintf(name, size, "%s", *wanted ? wanted : "_");
    make_plain(name);
    size_t length = strlen(name);
    struct scene_name *same = find_name(scene, name);
    for (struct scene_name *taken = same; taken; taken = find_name(scene, name))
        snprintf(name + length, size - length, "-%zu", same->next++);
    if (!name_index_add(&scene->by_name, name_index_hash(name))) {
        free(name);
        scene->failed = true;
        return NULL;
    }
    scene->names[scene->name_count++] = (struct scene_name){name, 2};
    return name;
}

const char *scene_text_material(struct scene_text *scene, const char *wanted, const char *text)
{
    uint64_t hash = name_index_hash(text);
    size_t i = name_index_find(&scene->by_text, hash);
    for (; i != NAME_INDEX_NONE; i = name_index_before(&scene->by_text, i))
        if (strcmp(scene->interned[i].text, text) == 0)
            return scene->interned[i].name;
    const char *name = scene_text_name(scene, wanted);
    char *copy = strdup(text);
    if (!name || !copy ||
        !scene_text_grow((void **)&scene->interned, &scene->material_capacity,
                         scene->material_count + 1, sizeof *scene->interned) ||
        !name_index_add(&scene->by_text, hash)) {
        free(copy);
        scene->failed = true;
        return NULL;
    }
    scene->interned[scene->material_count++] = (struct scene_material){(char *)name, copy};
    fputs("  ", scene->materials.stream);
    put_text(scene->materials.stream, name);
    fprintf(scene->materials.stream, ": {%s}\n", text);
    return name;
}

struct side_file *scene_text_file(struct scene_text *scene, const char *base, const char *what,
                                  const char *suffix)
{
    size_t size = strlen(base) + strlen(what) + strlen(suffix) + 32;
    char *name = malloc(size);
    if (!name || !scene_text_grow((void **)&scene->files, &scene->file_capacity,
                                  scene->file_count + 1, sizeof *scene->files)) {
        free(name);
        scene->failed = true;
        return NULL;
    }
    snprintf(name, size, "%s-%s-%zu.%s", base, what, scene->file_count, suffix);
    struct side_file *file = &scene->files[scene->file_count++];
    *file = (struct side_file){.name = name};
    return file;
}

bool scene_text_note(struct scene_text *scene, const char *path)
{
    char *copy = strdup(path);
    if (!copy || !scene_text_grow((void **)&scene->named, &scene->named_capacity,
                                  scene->named_count + 1, sizeof *scene->named)) {
        free(copy);
        scene->failed = true;
        return false;
    }
    scene->named[scene->named_count++] = copy;
    return true;
}
