/* psd.h: reads a .psd scene text into a scene description.
 *
 * .psd is YAML 1.1 with POV-Ray's vocabulary; man/psd.5 is its reference, schema.h the tables
 * behind it. libyaml reads the text; what libyaml accepts and a scene must not (duplicate keys,
 * undefined or recursive aliases, alias bombs, deep nesting, several documents) is rejected here.
 * What the language has beyond YAML works on the tree, in this order: files are included, values
 * of the command line set, names defined, then formulas, loops and conditions expanded.
 */
#ifndef PARSER_PSD_H
#define PARSER_PSD_H

#include "parser/language/include.h"
#include "parser/language/parameter.h"

struct mesh_ahead;

/* Zeroed: nothing of this. */
struct psd_options {
    const char *const *parameters; /* "NAME=VALUE": for parameters that the scene declares */
    size_t parameter_count;
    const char *const *sets; /* "KEY.KEY=VALUE": values to put into the tree */
    size_t set_count;
    const struct psd_files *files; /* NULL: the file system */
    const char *folder;      /* the only one to read files from (input_folder_resolve), or NULL */
    const char *cache;       /* keeps what is made of meshes and pictures, or NULL */
    double texture_memory;   /* bytes that pictures may take; 0: half of the following */
    double memory_limit;     /* bytes that all may take; 0: the machine's */
    bool allow_plugin_paths; /* whether the scene may name plugins, which are programs, by path */
    size_t most_values;      /* 0: 4 million */
    /* A mesh file that was read already, and is taken where the scene asks for it; or NULL. */
    struct mesh_ahead *ahead;
};

/* Reads the file ("-" is standard input). PS_OK when nothing but warnings was reported; otherwise
 * PS_ERROR_INVALID (bad text), PS_ERROR_IO or PS_ERROR_MEMORY, always with at least one error in
 * the sink, and the description is released. Origins in the description point to names that the
 * description owns (a copy). What `description` held before is overwritten, not released. `options`
 * may be NULL. */
ps_result psd_read_file_with(const char *path, const struct psd_options *options,
                             struct diagnostics *sink, struct scene_description *description);
ps_result psd_read_file(const char *path, struct diagnostics *sink,
                        struct scene_description *description);

/* The same for a text in memory; `name` stands for the file in messages, and the files that it
 * includes are looked for beside that. */
ps_result psd_read_text_with(const char *name, const char *text, size_t length,
                             const struct psd_options *options, struct diagnostics *sink,
                             struct scene_description *description);
ps_result psd_read_text(const char *name, const char *text, size_t length, struct diagnostics *sink,
                        struct scene_description *description);

/* Calls back for each parameter that the scene, or a file that it includes, declares, in their
 * order, and reads the scene no further: what else is wrong with it is not looked at. */
ps_result psd_list_parameters(const char *path, const struct psd_options *options,
                              struct diagnostics *sink,
                              void (*each)(void *user, const struct psd_parameter *parameter),
                              void *user);

#endif
