/* progress.h: tells how far a render is: by a bar, by lines for people, or by lines of JSON for
 * programs.
 *
 * Bar and plain lines go to standard error, as all messages do; lines of JSON, one object each, to
 * standard output, which has nothing else then:
 *
 *     {"stage": "indirect light", "fraction": 0.25, "passes": 4, "error": 0.021, "seconds": 12.5,
 *      "seconds_left": 37.5, "bytes": 104857600}
 *
 * `error` and `seconds_left` are null while they are not known. The last one has the stage "done"
 * and fraction 1.
 */
#ifndef CLI_PROGRESS_H
#define CLI_PROGRESS_H

#include <psplat/host.h>
#include <stdbool.h>
#include <stdint.h>

/* X(MODE, word) */
#define PROGRESS_MODES(X)                                                                          \
    X(PROGRESS_AUTO, "auto")                                                                       \
    X(PROGRESS_BAR, "bar")                                                                         \
    X(PROGRESS_PLAIN, "plain")                                                                     \
    X(PROGRESS_JSON, "json")                                                                       \
    X(PROGRESS_NONE, "none")

#define PROGRESS_MODE(mode_, word_) mode_,
enum progress_mode { PROGRESS_MODES(PROGRESS_MODE) };
#undef PROGRESS_MODE

/* Row for a command's table. */
#define PROGRESS_OPTION                                                                            \
    {                                                                                              \
        0, "progress", "NAME",                                                                     \
            "auto, bar, plain, json or none; auto: a bar in a terminal, plain lines elsewhere"     \
    }

struct progress {
    enum progress_mode mode; /* not PROGRESS_AUTO, once it is started */
    bool quiet;              /* messages, too, but errors and warnings */
    double start;            /* seconds */
    double next_update; /* seconds; nothing is shown before, but another tenth by plain lines */
    int last_tenth;
    uint32_t passes; /* that are done, and */
    double error;    /* what the error is then; negative: not known */
};

/* The mode of that name; false, printed, where there is none. */
bool progress_parse_mode(const char *name, enum progress_mode *mode);

/* `quiet` stands for PROGRESS_NONE where nothing else is asked for. */
void progress_start(struct progress *progress, enum progress_mode mode, bool quiet);
void progress_update(struct progress *progress, const char *stage, double fraction);

/* A message of the render or a plugin. */
void progress_message(const struct progress *progress, ps_log_level level, const char *message);

/* Removes the bar, so that other lines can be printed; it comes again with the next update. */
void progress_clear(struct progress *progress);

/* All is done: where a program follows, it is told. */
void progress_end(struct progress *progress);

#endif
