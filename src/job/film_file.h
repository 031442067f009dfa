/* film_file.h: films on disk: OpenEXR files that hold the sums of passes without loss.
 *
 * Layers R, G, B are the picture so far, without normalization and denoiser, for viewers; nothing
 * reads them back. A sum is the sum of its channels in layers "sum", "rest", "rest2", ...
 * (exact_plane_term); "sum.odd" and "sum.half" are of parts of the passes (struct film). Attribute
 * "psplat.film" is the version of this format, "psplat.pass_set" the set of passes; the others are
 * those of facts.h.
 */
#ifndef JOB_FILM_FILE_H
#define JOB_FILM_FILE_H

#include "film/film_sum.h"
#include "image/image.h"

/* Writes a sum of at least one pass; `facts` has its attributes. Nothing changes on disk where that
 * fails. */
ps_result film_file_write(const char *path, const struct film_sum *sum, const struct image *facts,
                          enum image_compression compression, struct workers *workers,
                          struct error *error);

/* Reads a film; `facts` gets the attributes alone. PS_ERROR_INVALID where the file is a picture, or
 * was damaged; both are empty then. Release them. */
ps_result film_file_read(const char *path, struct film_sum *sum, struct image *facts,
                         struct error *error);

/* The sums of a film's file that was read as a picture; `path` is for messages. Likewise. */
ps_result film_file_sums(const char *path, const struct image *image, struct film_sum *sum,
                         struct error *error);

#endif
