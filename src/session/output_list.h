/* output_list.h: the files that a picture is written to, and how. */
#ifndef SESSION_OUTPUT_LIST_H
#define SESSION_OUTPUT_LIST_H

#include "session/output.h"
#include "session/word_list.h"

/* Zeroed: no files. */
struct output_list {
    struct word_list paths;
    struct output_options options;
};

/* Adds a file. PS_ERROR_INVALID where its name ends in no format that psplat writes. */
ps_result output_list_add(struct output_list *list, const char *path, struct error *error);
void output_list_release(struct output_list *list);

/* Checks before rendering that the files can be written: PS_ERROR_IO. */
ps_result output_list_check(const struct output_list *list, struct error *error);

/* PS_ERROR_INVALID where one of them is a file that the scene was read from. */
ps_result output_list_check_not_input(const struct output_list *list,
                                      const struct scene_description *description,
                                      struct error *error);

/* Whether layers beside the picture are asked for; and that which tells the denoiser's error. */
bool output_list_wants_layers(const struct output_list *list);
bool output_list_wants_error(const struct output_list *list);

/* Whether what a display shows is asked for: by a PNG, or by its layer. */
bool output_list_wants_display(const struct output_list *list);

/* Writes all files that can be written, and tells of each by `tell`, unless that is NULL; the error
 * is the first one's. */
typedef void (*output_list_tell)(void *user, const char *path);
ps_result output_list_write(const struct output_list *list, const struct image *image,
                            struct workers *workers, output_list_tell tell, void *user,
                            struct error *error);

/* About how many seconds it takes to write so many pixels of the channels of `image`, by so many
 * threads. */
double output_list_guess_seconds(const struct output_list *list, const struct image *image,
                                 double pixels, uint32_t threads);

#endif
