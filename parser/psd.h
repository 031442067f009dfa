/* psd.h: reads a .psd scene text into a scene description.
 *
 * .psd is YAML 1.1 with POV-Ray's vocabulary; man/psd.5 is its reference, schema.h the tables
 * behind it. libyaml reads the text; what libyaml accepts and a scene must not (duplicate keys,
 * undefined or recursive aliases, alias bombs, deep nesting, several documents) is rejected here.
 */
#ifndef PARSER_PSD_H
#define PARSER_PSD_H

#include "parser/diagnostic.h"
#include "scene/description.h"

/* Reads the file ("-" is standard input). PS_OK when nothing but warnings was reported; otherwise
 * PS_ERROR_INVALID (bad text), PS_ERROR_IO or PS_ERROR_MEMORY, always with at least one error in
 * the sink, and the description is released. Origins in the description point to names that the
 * description owns (a copy). What `description` held before is overwritten, not released. */
ps_result psd_read_file(const char *path, struct diagnostics *sink,
                        struct scene_description *description);

/* The same for a text in memory; `name` stands for the file in messages. */
ps_result psd_read_text(const char *name, const char *text, size_t length, struct diagnostics *sink,
                        struct scene_description *description);

#endif
