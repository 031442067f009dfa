/* fuzz_psd.c: feeds arbitrary bytes to the scene parser (libFuzzer).
 *
 *     clang -fsanitize=fuzzer,address,undefined ... && ./fuzz_psd tests/fuzz/corpus_psd
 *
 * The parser reads no files here. Lines of "%%%%%%" cut an input into pieces: the first is the
 * scene, the next what it finds in every file that it includes, and any further ones what --set is
 * given; --param is given the scene's own parameters n and s. Beyond crashes and leaks it checks
 * the parser's promise: a failure has an error in the sink, a success has none and holds what a
 * scene needs; and the formatter's: what is laid out means the same, and stays as it is when it is
 * laid out again.
 */
#include "parser/format.h"
#include "parser/psd.h"
#include "parser/yaml/encoding.h"
#include "parser/yaml/tokens.h"

#include <stdlib.h>
#include <string.h>

#define SEPARATOR "%%%%%%\n"
#define MOST_PIECES 6
#define MOST_VALUES 100000 /* a larger scene teaches nothing, and takes its time */

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition)
        abort();
}

static void check_pigment(const struct scene_description *description,
                          const struct pigment_description *pigment)
{
    require(pigment->kind != PIGMENT_IMAGE || pigment->texture < description->texture_count);
}

static void check_materials(const struct scene_description *description)
{
    for (size_t i = 0; i < description->material_count; i++) {
        const struct material_description *material = &description->materials[i];
        check_pigment(description, &material->color);
        check_pigment(description, &material->emission);
        check_pigment(description, &material->bump);
        require((material->kind == MATERIAL_MIX) == (material->component_count > 0));
        for (size_t j = 0; j < material->component_count; j++)
            require(material->components[j] < i && material->weights[j] > 0);
    }
}

static void check_objects(const struct scene_description *description,
                          const struct object_description *objects, size_t count, bool in_group)
{
    for (size_t i = 0; i < count; i++) {
        const struct object_description *object = &objects[i];
        struct affine inverse;
        require(affine_invert(&object->placement, &inverse));
        if (object->kind == OBJECT_INSTANCE)
            require(!in_group && object->group < description->group_count);
        else
            require(object->material < description->material_count);
        require(object->kind != OBJECT_MESH || object->mesh < description->mesh_count);
        for (size_t j = 0; j < object->triangle_count; j++)
            for (int k = 0; k < 3; k++)
                require(object->triangles[j][k] < object->vertex_count);
    }
}

static void check_description(const struct scene_description *description)
{
    require(description->image.width >= 1 && description->image.height >= 1);
    require(description->camera_count >= 1);
    for (size_t i = 0; i < description->camera_count; i++) {
        const struct camera_description *camera = &description->cameras[i];
        int sizes = (camera->angle > 0) + (camera->vertical_angle > 0) + (camera->width > 0);
        require(camera->name && sizes == 1);
    }
    check_materials(description);
    check_objects(description, description->objects, description->object_count, false);
    for (size_t i = 0; i < description->group_count; i++)
        check_objects(description, description->groups[i].objects,
                      description->groups[i].object_count, true);
}

static void discard_printed(const struct diagnostics *sink)
{
    FILE *stream = fopen("/dev/null", "w");
    if (stream) {
        diagnostics_print(sink, stream);
        fclose(stream);
    }
}

struct piece {
    const char *text;
    size_t length;
};

/* Cuts the input at its separators; the last piece has all that is left. */
static size_t cut(const char *text, size_t size, struct piece pieces[MOST_PIECES])
{
    size_t count = 0, length = sizeof SEPARATOR - 1;
    const char *end = text + size, *next;
    while (count + 1 < MOST_PIECES &&
           (next = memmem(text, (size_t)(end - text), SEPARATOR, length))) {
        pieces[count++] = (struct piece){text, (size_t)(next - text)};
        text = next + length;
    }
    pieces[count++] = (struct piece){text, (size_t)(end - text)};
    return count;
}

static ps_result read_piece(void *user, const char *path, size_t most, struct file_text *text,
                            struct error *error)
{
    const struct piece *piece = user;
    if (!piece || piece->length > most || strstr(path, "gone"))
        return error_set(error, PS_ERROR_IO, "not there");
    text->bytes = malloc(piece->length + 1);
    if (!text->bytes)
        return error_memory(error, piece->length, "a file");
    memcpy(text->bytes, piece->text, piece->length);
    text->length = piece->length;
    return PS_OK;
}

/* Copies the pieces from `first` on; returns how many. */
static size_t copy_texts(const struct piece *pieces, size_t first, size_t count,
                         char *texts[MOST_PIECES])
{
    size_t copied = 0;
    for (size_t i = first; i < count; i++) {
        texts[copied] = strndup(pieces[i].text, pieces[i].length);
        if (texts[copied])
            copied++;
    }
    return copied;
}

/* Whether the text can be laid out; if so, what becomes of it is to be freed. */
static bool format(const struct piece *piece, struct piece *formatted)
{
    struct diagnostics *sink = diagnostics_create();
    char *text = NULL;
    if (!sink)
        return false;
    ps_result result =
        psd_format_text("fuzz.psd", piece->text, piece->length, sink, &text, &formatted->length);
    require((result == PS_OK) == (diagnostics_error_count(sink) == 0));
    diagnostics_destroy(sink);
    formatted->text = text;
    return result == PS_OK;
}

static void check_format(const struct piece *piece)
{
    struct piece once, twice;
    if (!format(piece, &once))
        return;
    size_t mark = byte_order_mark_length(piece->text, piece->length);
    require(tokens_same_meaning(piece->text + mark, piece->length - mark, once.text, once.length));
    require(format(&once, &twice));
    require(once.length == twice.length && memcmp(once.text, twice.text, once.length) == 0);
    free((char *)once.text);
    free((char *)twice.text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const parameters[] = {"n=2", "s=white"};
    struct diagnostics *sink = diagnostics_create();
    if (!sink)
        return 0;
    struct piece pieces[MOST_PIECES];
    char *sets[MOST_PIECES];
    size_t count = cut((const char *)data, size, pieces);
    size_t set_count = copy_texts(pieces, 2, count, sets);
    const struct psd_files files = {count > 1 ? &pieces[1] : NULL, read_piece};
    const struct psd_options options = {.parameters = parameters,
                                        .parameter_count = count > 1 ? 2 : 0,
                                        .sets = (const char *const *)sets,
                                        .set_count = set_count,
                                        .files = &files,
                                        .most_values = MOST_VALUES};
    struct scene_description description;
    ps_result result = psd_read_text_with("fuzz.psd", pieces[0].text, pieces[0].length, &options,
                                          sink, &description);
    for (size_t i = 0; i < set_count; i++)
        free(sets[i]);
    require((result == PS_OK) == (diagnostics_error_count(sink) == 0));
    if (result == PS_OK)
        check_description(&description);
    scene_description_release(&description);
    discard_printed(sink);
    diagnostics_destroy(sink);
    check_format(&pieces[0]);
    return 0;
}
