/* write_picture.c: the pictures that the scene names; see write.h.
 *
 * A picture that psplat can't read would be an error of the new scene: each is read once, and left
 * out where it fails.
 */
#include "pov/write.h"

#include "parser/yaml/encoding.h"
#include "scene/texture.h"
#include <stdlib.h>
#include <string.h>

/* The path from the new scene's folder, for a file below the old one's; else an absolute one. To be
 * freed. NULL: there is no such path, or out of memory. */
static char *path_from_output(const struct pov_options *options, const char *path)
{
    size_t folder = strlen(options->scene_folder);
    if (*path == '/' || strncmp(path, options->scene_folder, folder) != 0)
        return realpath(path, NULL);
    size_t size = strlen(options->from_output) + strlen(path) + 1;
    char *shown = malloc(size);
    if (shown)
        snprintf(shown, size, "%s%s", options->from_output, path + folder);
    return shown;
}

/* Whether psplat can read it; else a warning says why not. */
static bool can_be_read(struct pov_writer *writer, const char *file, const struct pov_token *token,
                        const char *name, const char *path, bool is_system)
{
    const struct pov_options *options = writer->reader->options;
    const struct texture_description description = {.path = (char *)path};
    const struct texture_storage storage = {.folder =
                                                is_system ? options->system : options->folder};
    struct texture texture;
    struct error error;
    if (texture_load(&description, &storage, &texture, &error) != PS_OK) {
        pov_warn_at(writer->reader, file, token, "%.200s: %.200s: left out", name, error.text);
        return false;
    }
    texture_release(&texture);
    return true;
}

/* NULL: reported, or left out, with a warning. */
static const char *look_at_picture(struct pov_writer *writer, const char *file,
                                   const struct pov_token *token, const char *name,
                                   const char *path, bool is_system)
{
    struct pov_reader *reader = writer->reader;
    const char *kept = NULL;
    if (!can_be_read(writer, file, token, name, path, is_system))
        return NULL;
    char *shown = path_from_output(reader->options, path);
    if (!shown || !scene_text_note(&reader->scene, path))
        pov_no_memory(reader);
    else if (!utf8_is_valid(shown, strlen(shown)))
        pov_warn_at(reader, file, token, "%.200s: its path is not UTF-8: left out", name);
    else
        kept = pov_copy(reader, shown, strlen(shown) + 1);
    free(shown);
    return kept;
}

const char *pov_write_file_name(struct pov_writer *writer, const char *file,
                                const struct pov_token *token, const char *name)
{
    struct pov_reader *reader = writer->reader;
    bool is_system = false;
    char *path = pov_find(reader, name, &is_system);
    if (!path) {
        pov_warn_at(reader, file, token, "%.200s: there is no readable file of that name: left out",
                    name);
        return NULL;
    }
    uint64_t hash = name_index_hash(path);
    size_t i = name_index_find(&writer->picture_index, hash);
    while (i != NAME_INDEX_NONE && strcmp(writer->pictures[i].path, path) != 0)
        i = name_index_before(&writer->picture_index, i);
    if (i == NAME_INDEX_NONE &&
        pov_grow(reader, (void **)&writer->pictures, &writer->picture_capacity,
                 writer->picture_count + 1, sizeof *writer->pictures)) {
        const char *kept = pov_copy(reader, path, strlen(path) + 1);
        if (kept && name_index_add(&writer->picture_index, hash)) {
            i = writer->picture_count++;
            writer->pictures[i] = (struct pov_picture){
                kept, look_at_picture(writer, file, token, name, path, is_system)};
        } else {
            pov_no_memory(reader);
        }
    }
    free(path);
    return i == NAME_INDEX_NONE ? NULL : writer->pictures[i].shown;
}
