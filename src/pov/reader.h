/* reader.h: the tokens of a POV-Ray scene in the order in which they count, and what is known while
 * they are read.
 *
 * Directives are executed, and macros called, where the next token is asked for, as POV-Ray does
 * (reference of POV-Ray 3.7, "Language Directives"): who reads an object sees none of them. After
 * an error there is only POV_END.
 *
 * One thread at a time. Everything is owned by the reader, which pov_convert makes and releases.
 */
#ifndef POV_READER_H
#define POV_READER_H

#include "pov/pov.h"
#include "pov/tokens.h"
#include "pov/value.h"
#include "writer/scene_text.h"

#define POV_MOST_FRAMES 200  /* macros in macros, and files in files */
#define POV_MOST_BLOCKS 1000 /* #if in #while in ... */
#define POV_DEEPEST                                                                                \
    150 /* parentheses, braces and directives in each other, as the C stack has them */

/* A name's meaning at one level; older ones lie below. */
struct pov_binding {
    struct pov_value *value, own; /* by reference: an argument that is a name shares its value */
    uint32_t word;
    size_t level;                   /* frames when it was made; 0: a global one */
    struct pov_binding *below;      /* the same word */
    struct pov_binding *same_frame; /* of the same frame, the one before */
};

/* What is being read: a file, or the body of a macro or function. */
struct pov_frame {
    const struct pov_tokens *tokens;
    size_t at;
    size_t blocks;              /* open ones when it began */
    struct pov_binding *locals; /* the latest */
    bool is_file;
};

enum pov_block_kind {
    POV_BLOCK_IF,
    POV_BLOCK_WHILE,
    POV_BLOCK_FOR,
    POV_BLOCK_SWITCH,
    POV_BLOCK_MACRO
};

struct pov_block {
    enum pov_block_kind kind;
    size_t start;            /* POV_BLOCK_WHILE: its condition; POV_BLOCK_FOR: its body */
    struct pov_token token;  /* the directive */
    struct pov_value *index; /* of POV_BLOCK_FOR */
    double last, step;
};

struct pov_look;
struct pov_object;

struct pov_reader {
    const struct pov_options *options;
    struct diagnostics *sink;
    struct warnings warnings;
    bool stopped, no_memory;

    struct pov_words words;
    struct pov_tokens **files; /* owned, each too */
    size_t file_count, file_capacity;
    struct pov_frame frames[POV_MOST_FRAMES];
    size_t frame_count;
    struct pov_block blocks[POV_MOST_BLOCKS];
    size_t block_count;
    struct pov_binding **bindings; /* by word; NULL: none */
    size_t binding_capacity;
    struct pov_binding *spare;
    struct pov_token pushed; /* read again */
    bool has_pushed;
    /* Frames while a value is read in #declare: a directive of this one ends it; 0: none. */
    size_t declaring;
    size_t declaring_blocks;
    bool raw; /* macros are not called */
    int depth;
    size_t steps, memory;

    double version;
    uint32_t *streams; /* of rand(); owned */
    size_t stream_count, stream_capacity;

    struct arena arena;

    /* The scene. */
    struct pov_look *look; /* of #default; object.h */
    struct pov_object **objects;
    size_t object_count, object_capacity;
    const struct pov_camera *camera;
    struct pov_token camera_token;
    const char *camera_file;
    double background[3], ambient_light[3], gamma;
    bool has_background, has_gamma;
    struct pov_token background_token;
    const char *background_file;
    const struct pov_pigment *sky;
    struct scene_text scene;
};

/* --- messages and memory
 * ------------------------------------------------------------------------ */

void pov_error(struct pov_reader *reader, const struct pov_token *token, const char *format, ...)
    PRINTF_LIKE(3, 4);
/* Once for each text. */
void pov_warn(struct pov_reader *reader, const struct pov_token *token, const char *format, ...)
    PRINTF_LIKE(3, 4);
/* Where a token of an earlier time stands: `file` is its file's name. */
void pov_warn_at(struct pov_reader *reader, const char *file, const struct pov_token *token,
                 const char *format, ...) PRINTF_LIKE(4, 5);
void pov_no_memory(struct pov_reader *reader);
/* The file that is read now; for pov_warn_at. */
const char *pov_file(const struct pov_reader *reader);

/* Bytes that the options still allow. */
size_t pov_memory_left(const struct pov_reader *reader);
/* Counts memory; false: reported, there is more than the options allow. */
bool pov_charge(struct pov_reader *reader, size_t count, size_t size);
/* Zeroed, from the arena, within what the options allow; NULL: reported. */
void *pov_allocate(struct pov_reader *reader, size_t count, size_t size);
void *pov_copy(struct pov_reader *reader, const void *from, size_t size);
/* Room for `wanted` items in a list of its own; false: reported. */
bool pov_grow(struct pov_reader *reader, void **items, size_t *capacity, size_t wanted,
              size_t size);

/* Guards the C stack: each true is followed by a pov_leave. False: reported. */
bool pov_enter(struct pov_reader *reader, const struct pov_token *token);
void pov_leave(struct pov_reader *reader);

/* --- tokens
 * ------------------------------------------------------------------------------------- */

struct pov_token pov_next(struct pov_reader *reader);
/* The same, where names of macros are names. */
struct pov_token pov_next_raw(struct pov_reader *reader);
void pov_unread(struct pov_reader *reader, struct pov_token token);
/* What stands behind the last token that was read, be it a directive or a macro's name. */
const struct pov_token *pov_peek(const struct pov_reader *reader);
bool pov_is(const struct pov_token *token, uint32_t symbol);
bool pov_is_word(const struct pov_token *token, enum pov_word word);
/* Reads a token if it is that one. */
bool pov_accept(struct pov_reader *reader, uint32_t symbol);
bool pov_accept_word(struct pov_reader *reader, enum pov_word word);
/* Reads that token; false: reported. */
bool pov_expect(struct pov_reader *reader, uint32_t symbol);
void pov_unexpected(struct pov_reader *reader, const struct pov_token *token, const char *expected);
/* The text of a word. */
const char *pov_text(const struct pov_reader *reader, uint32_t word);
/* Reads from behind an open brace up to its closing one. */
void pov_skip_block(struct pov_reader *reader);
/* Skips "{ ... }", if it follows. */
void pov_skip_braces(struct pov_reader *reader);

/* --- frames and names
 * ---------------------------------------------------------------------------- */

/* The text becomes the outermost file. False: reported. */
bool pov_start(struct pov_reader *reader, const char *name, const char *text, size_t length);
void pov_release(struct pov_reader *reader);
/* Goes on in a file; `token`: where it is named. */
void pov_include(struct pov_reader *reader, const struct pov_token *token, const char *name);
/* Where a file lies that the scene names: in its folder, beside the scene, or in a library. To be
 * freed. NULL: nowhere (not reported). */
char *pov_find(struct pov_reader *reader, const char *name, bool *is_system);
bool pov_push_frame(struct pov_reader *reader, const struct pov_token *token,
                    const struct pov_tokens *tokens, size_t at, bool is_file);
void pov_pop_frame(struct pov_reader *reader);
/* NULL: the word stands for nothing. */
struct pov_value *pov_lookup(const struct pov_reader *reader, uint32_t word);
/* A name of the current frame, or of all; `shared`: the value, or NULL for a new one. NULL:
 * reported. */
struct pov_value *pov_bind(struct pov_reader *reader, uint32_t word, bool local,
                           struct pov_value *shared);
/* Whether the word's meaning belongs to the current frame. */
bool pov_is_own(const struct pov_reader *reader, uint32_t word);
/* Forgets the latest meaning. */
void pov_unbind(struct pov_reader *reader, uint32_t word);

/* Reads "[i]..." behind the name of an array, as far as there are such. NULL: reported. */
struct pov_value *pov_element(struct pov_reader *reader, const struct pov_token *name,
                              struct pov_value *value);

/* --- directive.c, macro.c
 * ------------------------------------------------------------------------- */

/* Executes; false: it ends the value that a #declare reads, and is to be read again. */
bool pov_directive(struct pov_reader *reader, const struct pov_token *token);
void pov_define_macro(struct pov_reader *reader, const struct pov_token *token);
void pov_call_macro(struct pov_reader *reader, const struct pov_token *token,
                    const struct pov_macro *macro);
/* "function (...) {...}" behind its first word. */
struct pov_value pov_define_function(struct pov_reader *reader);
struct pov_value pov_call_function(struct pov_reader *reader, const struct pov_token *token,
                                   const struct pov_macro *function);

#endif
