#include "base/statistics.h"

#include "base/json_writer.h"
#include "base/output_file.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void statistics_init(struct statistics *statistics)
{
    memset(statistics, 0, sizeof *statistics);
    pthread_mutex_init(&statistics->lock, NULL);
}

void statistics_destroy(struct statistics *statistics)
{
    pthread_mutex_destroy(&statistics->lock);
}

static const struct statistic *find(const struct statistic_table *table, const char *name)
{
    for (size_t i = 0; i < table->count; i++)
        if (strcmp(table->rows[i].name, name) == 0)
            return &table->rows[i];
    return NULL;
}

/* The row of a name, made if need be; the last row takes what finds no room. */
static struct statistic *row_of(struct statistic_table *table, const char *name)
{
    const struct statistic *found = find(table, name);
    if (found)
        return &table->rows[found - table->rows];
    if (table->count == STATISTICS_ROWS)
        return &table->rows[STATISTICS_ROWS - 1];
    table->rows[table->count] = (struct statistic){.name = name};
    return &table->rows[table->count++];
}

/* With the lock held. */
static void add_to(struct statistic *row, double amount)
{
    row->value += amount;
    row->largest = row->value > row->largest ? row->value : row->largest;
}

static void add(struct statistics *statistics, struct statistic_table *table, const char *name,
                double amount)
{
    pthread_mutex_lock(&statistics->lock);
    add_to(row_of(table, name), amount);
    pthread_mutex_unlock(&statistics->lock);
}

void statistics_add_seconds(struct statistics *statistics, const char *stage, double seconds)
{
    add(statistics, &statistics->stages, stage, seconds);
}

void statistics_count(struct statistics *statistics, const char *counter, double amount)
{
    add(statistics, &statistics->counters, counter, amount);
}

void statistics_add_bytes(struct statistics *statistics, const char *purpose, double bytes)
{
    add(statistics, &statistics->memory, purpose, bytes);
}

void statistics_set_bytes(struct statistics *statistics, const char *purpose, double bytes)
{
    pthread_mutex_lock(&statistics->lock);
    struct statistic *row = row_of(&statistics->memory, purpose);
    add_to(row, bytes - row->value);
    pthread_mutex_unlock(&statistics->lock);
}

double statistics_seconds(const struct statistics *statistics, const char *stage)
{
    const struct statistic *row = find(&statistics->stages, stage);
    return row ? row->value : 0;
}

double statistics_counter(const struct statistics *statistics, const char *counter)
{
    const struct statistic *row = find(&statistics->counters, counter);
    return row ? row->value : 0;
}

double statistics_bytes(const struct statistics *statistics, const char *purpose)
{
    const struct statistic *row = find(&statistics->memory, purpose);
    return row ? row->largest : 0;
}

static void write_table(struct json_writer *writer, const char *name,
                        const struct statistic_table *table)
{
    json_writer_open_of(writer, name, '{');
    for (size_t i = 0; i < table->count; i++)
        json_writer_number_of(writer, table->rows[i].name, table->rows[i].largest);
    json_writer_close(writer, '{');
}

static void write_json(const struct statistics *statistics, FILE *stream)
{
    struct json_writer writer = {.stream = stream};
    json_writer_open(&writer, '{');
    write_table(&writer, "seconds", &statistics->stages);
    write_table(&writer, "counters", &statistics->counters);
    write_table(&writer, "bytes", &statistics->memory);
    json_writer_close(&writer, '{');
    fputc('\n', stream);
}

ps_result statistics_write(const struct statistics *statistics, const char *path,
                           struct error *error)
{
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (!stream)
        return error_memory(error, 4096, "statistics");
    write_json(statistics, stream);
    if (fclose(stream) != 0) {
        free(text);
        return error_memory(error, length, "statistics");
    }
    struct output_file file;
    ps_result result = output_file_open(&file, path, error);
    if (result == PS_OK) {
        result = output_file_write(&file, 0, text, length, error);
        if (result == PS_OK)
            result = output_file_commit(&file, error);
        else
            output_file_discard(&file);
    }
    free(text);
    return result;
}
