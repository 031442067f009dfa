/* fuzz_psd.c: feeds arbitrary bytes to the scene parser (libFuzzer).
 *
 *     clang -fsanitize=fuzzer,address,undefined ... && ./fuzz_psd tests/fuzz/corpus_psd
 *
 * Beyond crashes and leaks it checks the parser's promise: a failure has an error in the sink, a
 * success has none and holds what a scene needs.
 */
#include "parser/psd.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void require(bool condition)
{
    if (!condition)
        abort();
}

static void check_description(const struct scene_description *description)
{
    require(description->image.width >= 1 && description->image.height >= 1);
    require((description->camera.angle > 0) != (description->camera.vertical_angle > 0));
    for (size_t i = 0; i < description->object_count; i++) {
        const struct object_description *object = &description->objects[i];
        require(object->material < description->material_count);
        for (size_t j = 0; j < object->triangle_count; j++)
            for (int k = 0; k < 3; k++)
                require(object->triangles[j][k] < object->vertex_count);
    }
}

static void discard_printed(const struct diagnostics *sink)
{
    FILE *stream = fopen("/dev/null", "w");
    if (stream) {
        diagnostics_print(sink, stream);
        fclose(stream);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct diagnostics *sink = diagnostics_create();
    if (!sink)
        return 0;
    struct scene_description description;
    ps_result result = psd_read_text("fuzz.psd", (const char *)data, size, sink, &description);
    require((result == PS_OK) == (diagnostics_error_count(sink) == 0));
    if (result == PS_OK)
        check_description(&description);
    scene_description_release(&description);
    discard_printed(sink);
    diagnostics_destroy(sink);
    return 0;
}
