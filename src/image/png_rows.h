/* png_rows.h: a PNG file that is written row by row, for pictures that do not fit into memory. */
#ifndef IMAGE_PNG_ROWS_H
#define IMAGE_PNG_ROWS_H

#include "image/image.h"

struct png_rows;

/* Begins a file; arguments as of image_write_png. */
ps_result png_rows_create(const char *path, size_t width, size_t height,
                          const struct image_attribute *texts, size_t text_count,
                          struct png_rows **rows, struct error *error);

/* The next rows, 3 bytes a pixel. */
ps_result png_rows_add(struct png_rows *rows, const uint8_t *rgb, size_t count,
                       struct error *error);

/* When all rows are there: lets the file appear. The writer is destroyed in any case. */
ps_result png_rows_finish(struct png_rows *rows, struct error *error);

/* Instead: there will be no file. NULL is none. */
void png_rows_discard(struct png_rows *rows);

#endif
