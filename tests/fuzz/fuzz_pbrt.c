/* fuzz_pbrt.c: feeds arbitrary bytes to the converter of pbrt scenes (libFuzzer).
 *
 * The first byte chooses the version: 3, 4, or as the words tell. Files are refused: the only
 * folder to read from is one that is not there. Beyond crashes and leaks it checks the converter's
 * promises: a failure has an error in the sink and leaves nothing, a success has none, and the
 * scene that it makes is one that psplat reads, where no file beside it is needed for that.
 */
#include "pbrt/pbrt.h"

#include "parser/psd.h"
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition)
        abort();
}

/* Meshes are read with the scene: those of files would be missed. */
static bool needs_files(const struct written_scene *scene)
{
    return scene->file_count > 0 || strstr(scene->text, "{file: ") != NULL;
}

static void check_scene(const struct written_scene *scene)
{
    struct diagnostics *sink = diagnostics_create();
    struct scene_description description;
    if (!sink)
        return;
    ps_result result = psd_read_text("fuzz.psd", scene->text, scene->length, sink, &description);
    if (result != PS_OK) {
        diagnostics_print(sink, stderr);
        fputs(scene->text, stderr);
    }
    require(result == PS_OK);
    scene_description_release(&description);
    diagnostics_destroy(sink);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const int versions[] = {0, 3, 4};
    struct diagnostics *sink = diagnostics_create();
    if (!sink || size == 0) {
        diagnostics_destroy(sink);
        return 0;
    }
    const struct pbrt_options options = {.version = versions[data[0] % 3],
                                         .folder = "/no/such/folder",
                                         .base = "fuzz",
                                         .scene_folder = "",
                                         .from_output = "",
                                         .most_triangles = 10000};
    struct written_scene scene;
    ps_result result =
        pbrt_convert("fuzz.pbrt", (const char *)data + 1, size - 1, &options, sink, &scene);
    require((result == PS_OK) == (diagnostics_error_count(sink) == 0));
    require((result == PS_OK) == (scene.text != NULL));
    if (result == PS_OK && !needs_files(&scene))
        check_scene(&scene);
    written_scene_release(&scene);
    diagnostics_destroy(sink);
    return 0;
}
