/* fuzz_pov.c: feeds arbitrary bytes to the converter of POV-Ray scenes (libFuzzer).
 *
 * Files are refused: the only folder to read from is one that is not there. Tokens and memory are
 * limited, so that what does not end does so soon. Beyond crashes and leaks it checks the
 * converter's promises: a failure has an error in the sink and leaves nothing, a success has none,
 * and the scene that it makes is one that psplat reads, where no file beside it is needed for that.
 */
#include "pov/pov.h"

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
    struct diagnostics *sink = diagnostics_create();
    const struct pov_options options = {.folder = "/no/such/folder",
                                        .base = "fuzz",
                                        .scene_folder = "",
                                        .from_output = "",
                                        .most_steps = 200000,
                                        .most_memory = (size_t)32 << 20};
    struct written_scene scene;
    if (!sink)
        return 0;
    ps_result result = pov_convert("fuzz.pov", (const char *)data, size, &options, sink, &scene);
    require((result == PS_OK) == (diagnostics_error_count(sink) == 0));
    require((result == PS_OK) == (scene.text != NULL));
    if (result == PS_OK && !needs_files(&scene))
        check_scene(&scene);
    written_scene_release(&scene);
    diagnostics_destroy(sink);
    return 0;
}
