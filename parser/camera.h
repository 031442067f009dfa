/* camera.h: the sections of cameras. */
#ifndef PARSER_CAMERA_H
#define PARSER_CAMERA_H

#include "parser/reader.h"

/* Adds `camera` and `cameras` to the description. */
void cameras_read(struct reader *reader, const struct node *root);

/* Room for one more camera, or NULL, noted. */
struct camera_description *camera_add(struct reader *reader);

/* Whether the description has a camera of that name. */
bool camera_exists(const struct reader *reader, const char *name);

#endif
