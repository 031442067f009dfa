/* statistics.h: what a render took: seconds by stage, bytes by purpose, counters.
 *
 * Names are literals. Adding is thread-safe; reading is for when the render is done.
 */
#ifndef BASE_STATISTICS_H
#define BASE_STATISTICS_H

#include "base/error.h"
#include <pthread.h>

#define STATISTICS_ROWS 48

struct statistic {
    const char *name;
    double value;   /* seconds, count, or bytes now */
    double largest; /* bytes at most */
};

struct statistic_table {
    struct statistic rows[STATISTICS_ROWS];
    size_t count;
};

struct statistics {
    pthread_mutex_t lock;
    struct statistic_table stages, counters, memory;
};

void statistics_init(struct statistics *statistics);
void statistics_destroy(struct statistics *statistics);

void statistics_add_seconds(struct statistics *statistics, const char *stage, double seconds);
void statistics_count(struct statistics *statistics, const char *counter, double amount);

/* Negative bytes for memory that was released. */
void statistics_add_bytes(struct statistics *statistics, const char *purpose, double bytes);
/* Memory that is measured as a whole rather than followed. */
void statistics_set_bytes(struct statistics *statistics, const char *purpose, double bytes);

/* 0 where nothing of the name was added; for memory, the most at a time. */
double statistics_seconds(const struct statistics *statistics, const char *stage);
double statistics_counter(const struct statistics *statistics, const char *counter);
double statistics_bytes(const struct statistics *statistics, const char *purpose);

/* Writes all as JSON: {"seconds": {...}, "counters": {...}, "bytes": {...}}. */
ps_result statistics_write(const struct statistics *statistics, const char *path,
                           struct error *error);

#endif
