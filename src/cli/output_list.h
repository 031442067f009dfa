/* output_list.h: the files that a picture is written to, and the options that say how. */
#ifndef CLI_OUTPUT_LIST_H
#define CLI_OUTPUT_LIST_H

#include "cli/command.h"
#include "session/output.h"

#define MOST_OUTPUTS 16

/* Rows for a command's table. */
#define OUTPUT_OPTIONS                                                                             \
    {'o', "output", "FILE", "write FILE (.exr or .png); may be given several times"},              \
        {0, "layers", "NAME,...",                                                                  \
         "layers of EXR files beside the picture; or none, or all (default), which is all but "    \
         "display"},                                                                               \
    {                                                                                              \
        0, "compression", "NAME",                                                                  \
            "compression of EXR files, all lossless: " IMAGE_COMPRESSIONS "; default: zip"         \
    }

struct output_list {
    const char *paths[MOST_OUTPUTS];
    size_t count;
    char *defaults[2]; /* owned */
    struct output_options options;
};

/* Takes those of the arguments that are its options. False, printed, where one is wrong. */
bool output_list_take(struct output_list *list, const struct argument *arguments, size_t count);
void output_list_release(struct output_list *list);

/* Adds the scene's name with both suffixes. False, printed, when out of memory. */
bool output_list_add_defaults(struct output_list *list, const char *scene_path);

/* Finds out before the work what can be told by then; false, printed. */
bool output_list_check(const struct output_list *list);

/* Whether none of them is a file that the scene was read from; false, printed. */
bool output_list_spares(const struct output_list *list,
                        const struct scene_description *description);

/* Whether layers beside the picture are asked for; and that which tells the denoiser's error. */
bool output_list_wants_layers(const struct output_list *list);
bool output_list_wants_error(const struct output_list *list);

/* Whether what a display shows is asked for: by a PNG, or by its layer. */
bool output_list_wants_display(const struct output_list *list);

/* Whether the denoiser makes what is asked for; if not, says so. */
bool output_list_suits(const struct output_list *list, const struct render_settings *settings);

/* Writes all files that can be written; the error is the first one's. Says what was written unless `quiet`. */
ps_result output_list_write(const struct output_list *list, const struct image *image,
                            struct workers *workers, bool quiet, struct error *error);

/* About how many seconds it takes to write so many pixels of the channels of `image`, by so many threads. */
double output_list_guess_seconds(const struct output_list *list, const struct image *image,
                                 double pixels, uint32_t threads);

/* Says that all of them were written unless `quiet`. */
void output_list_tell(const struct output_list *list, bool quiet);

#endif
