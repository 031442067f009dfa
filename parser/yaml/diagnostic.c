/* diagnostic.c: keeps errors and warnings, and prints them sorted, each with its line and a caret.
 *
 * Messages live in fixed slots of the sink, so that running out of memory can be reported too.
 * Lines are found by scanning the text when printing: an index of lines would cost memory on every
 * good scene, to save time on a bad one.
 */
#include "parser/yaml/diagnostic.h"

#include "parser/yaml/encoding.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define NO_SOURCE SIZE_MAX

/* Of a long line, this many characters are shown; where the error is beyond the first of them,
 * those around it. */
#define SHOWN_COLUMNS 120
#define SHOWN_UNMOVED 100
#define SHOWN_BEFORE 60

struct source {
    char *name, *text;
    size_t length;
    size_t includer; /* a source, or NO_SOURCE */
    int includer_line, includer_column;
};

struct entry {
    enum severity severity;
    size_t source;
    int line, column, width;
    char message[sizeof((struct error *)0)->text];
};

struct diagnostics {
    struct source *sources;
    size_t source_count;
    size_t counts[2]; /* by severity */
    size_t kept;      /* of each severity */
    struct entry *entries;
    const struct entry **sorted; /* room for all, to print them */
    size_t entry_count;
};

struct diagnostics *diagnostics_create_for(size_t kept)
{
    struct diagnostics *sink = calloc(1, sizeof *sink);
    if (!sink)
        return NULL;
    sink->kept = kept;
    sink->entries = calloc(2 * kept, sizeof *sink->entries);
    sink->sorted = calloc(2 * kept, sizeof *sink->sorted);
    if (sink->entries && sink->sorted)
        return sink;
    diagnostics_destroy(sink);
    return NULL;
}

struct diagnostics *diagnostics_create(void)
{
    return diagnostics_create_for(DIAGNOSTICS_KEPT);
}

void diagnostics_destroy(struct diagnostics *sink)
{
    if (!sink)
        return;
    for (size_t i = 0; i < sink->source_count; i++) {
        free(sink->sources[i].name);
        free(sink->sources[i].text);
    }
    free(sink->sources);
    free(sink->entries);
    free(sink->sorted);
    free(sink);
}

static size_t find_source(const struct diagnostics *sink, const char *name)
{
    for (size_t i = 0; i < sink->source_count; i++)
        if (strcmp(sink->sources[i].name, name) == 0)
            return i;
    return NO_SOURCE;
}

static char *copy_bytes(const char *bytes, size_t length)
{
    char *copy = malloc(length + 1);
    if (copy) {
        if (length > 0)
            memcpy(copy, bytes, length);
        copy[length] = '\0';
    }
    return copy;
}

static size_t append_source(struct diagnostics *sink, const char *name)
{
    struct source *grown = realloc(sink->sources, (sink->source_count + 1) * sizeof *sink->sources);
    if (!grown)
        return NO_SOURCE;
    sink->sources = grown;
    struct source *source = &grown[sink->source_count];
    *source = (struct source){.name = copy_bytes(name, strlen(name)), .includer = NO_SOURCE};
    return source->name ? sink->source_count++ : NO_SOURCE;
}

const char *diagnostics_add_source(struct diagnostics *sink, const char *name, const char *text,
                                   size_t length)
{
    size_t mark = byte_order_mark_length(text, length);
    char *copy = copy_bytes(text + mark, length - mark);
    if (!copy)
        return NULL;
    size_t index = find_source(sink, name);
    if (index == NO_SOURCE)
        index = append_source(sink, name);
    if (index == NO_SOURCE) {
        free(copy);
        return NULL;
    }
    free(sink->sources[index].text);
    sink->sources[index].text = copy;
    sink->sources[index].length = length - mark;
    return sink->sources[index].name;
}

bool diagnostics_set_includer(struct diagnostics *sink, const char *name, const struct origin *from)
{
    size_t index = find_source(sink, name), includer = find_source(sink, from->file);
    if (index == NO_SOURCE)
        index = append_source(sink, name);
    if (index == NO_SOURCE || includer == NO_SOURCE)
        return false;
    struct source *source = &sink->sources[index];
    source->includer = includer;
    source->includer_line = from->line;
    source->includer_column = from->column;
    return true;
}

/* Replaces what would garble or steer a terminal: control characters and broken UTF-8. */
static void sanitize(char *text)
{
    size_t length = strlen(text), to = 0;
    for (size_t from = 0; from < length;) {
        uint32_t code;
        size_t bytes = utf8_decode(text + from, length - from, &code);
        if (bytes == 0 || code < 0x20 || (code >= 0x7f && code < 0xa0)) {
            text[to++] = '?';
            from += bytes > 0 ? bytes : 1;
        } else {
            memmove(text + to, text + from, bytes);
            to += bytes;
            from += bytes;
        }
    }
    text[to] = '\0';
}

static bool is_same(const struct entry *a, const struct entry *b)
{
    return a->severity == b->severity && a->source == b->source && a->line == b->line &&
           a->column == b->column && strcmp(a->message, b->message) == 0;
}

void diagnostics_report_list(struct diagnostics *sink, enum severity severity,
                             const struct origin *origin, int width, const char *format,
                             va_list arguments)
{
    if (sink->counts[severity] >= sink->kept) {
        sink->counts[severity]++;
        return;
    }
    struct entry *entry = &sink->entries[sink->entry_count];
    *entry = (struct entry){.severity = severity, .source = NO_SOURCE};
    if (origin && origin->file) {
        entry->source = find_source(sink, origin->file);
        if (entry->source == NO_SOURCE)
            entry->source = append_source(sink, origin->file);
        entry->line = origin->line;
        entry->column = origin->column;
        entry->width = width > 0 ? width : 1;
    }
    vsnprintf(entry->message, sizeof entry->message, format, arguments);
    sanitize(entry->message);
    for (size_t i = 0; i < sink->entry_count; i++)
        if (is_same(&sink->entries[i], entry))
            return;
    sink->entry_count++;
    sink->counts[severity]++;
}

void diagnostics_report(struct diagnostics *sink, enum severity severity,
                        const struct origin *origin, int width, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    diagnostics_report_list(sink, severity, origin, width, format, arguments);
    va_end(arguments);
}

size_t diagnostics_error_count(const struct diagnostics *sink)
{
    return sink->counts[SEVERITY_ERROR];
}

size_t diagnostics_warning_count(const struct diagnostics *sink)
{
    return sink->counts[SEVERITY_WARNING];
}

bool diagnostics_count_text(const struct diagnostics *sink, char text[DIAGNOSTICS_COUNT_TEXT])
{
    size_t errors = sink->counts[SEVERITY_ERROR];
    if (errors > sink->kept)
        snprintf(text, DIAGNOSTICS_COUNT_TEXT, "%zu errors (%zu shown)", errors, sink->kept);
    else
        snprintf(text, DIAGNOSTICS_COUNT_TEXT, "%zu errors", errors);
    return errors > 1;
}

bool diagnostics_warnings_text(const struct diagnostics *sink, char text[DIAGNOSTICS_COUNT_TEXT])
{
    size_t warnings = sink->counts[SEVERITY_WARNING];
    snprintf(text, DIAGNOSTICS_COUNT_TEXT, "%zu warnings (%zu shown)", warnings, sink->kept);
    return warnings > sink->kept;
}

bool diagnostics_is_full(const struct diagnostics *sink)
{
    return sink->counts[SEVERITY_ERROR] >= sink->kept;
}

/* Where the line starts in the source; its length in bytes goes to `length`. NULL: no such line. */
static const char *find_line(const struct source *source, int line, size_t *length)
{
    size_t start = 0, at = 0;
    for (int current = 1; at < source->length;) {
        size_t line_break = line_break_length(source->text + at, source->length - at);
        if (line_break > 0 && current == line)
            break;
        at += line_break > 0 ? line_break : 1;
        if (line_break > 0) {
            start = at;
            current++;
        }
        if (at >= source->length && current != line)
            return NULL;
    }
    *length = at - start;
    return source->text ? source->text + start : NULL;
}

/* Prints columns first..first+SHOWN_COLUMNS-1 of a line; returns how many there were. */
static int print_columns(FILE *stream, const char *line, size_t length, int first)
{
    int column = 1, printed = 0;
    for (size_t at = 0; at < length && printed < SHOWN_COLUMNS; column++) {
        char character[5] = {0};
        uint32_t code;
        size_t bytes = utf8_decode(line + at, length - at, &code);
        memcpy(character, line + at, bytes > 0 ? bytes : 1);
        at += bytes > 0 ? bytes : 1;
        if (column < first)
            continue;
        if (strcmp(character, "\t") == 0)
            character[0] = ' '; /* so that the caret needs no tab stops */
        sanitize(character);
        fputs(*character ? character : "?", stream);
        printed++;
    }
    return printed;
}

static void print_line(FILE *stream, const struct source *source, const struct entry *entry)
{
    size_t length = 0;
    const char *line = find_line(source, entry->line, &length);
    if (!line || length == 0 || entry->column < 1)
        return;
    int first = entry->column > SHOWN_UNMOVED ? entry->column - SHOWN_BEFORE : 1;
    fprintf(stream, "%5d | ", entry->line);
    int printed = print_columns(stream, line, length, first);
    int caret = entry->column - first;
    fprintf(stream, "\n      | %*s^", caret, "");
    for (int i = 1; i < entry->width && caret + i < printed; i++)
        fputc('~', stream);
    fputc('\n', stream);
}

static void print_entry(const struct diagnostics *sink, const struct entry *entry, FILE *stream)
{
    const struct source *source = entry->source == NO_SOURCE ? NULL : &sink->sources[entry->source];
    if (source && entry->line > 0)
        fprintf(stream, "%s:%d:%d: ", source->name, entry->line, entry->column);
    else
        fprintf(stream, "%s: ", source ? source->name : "psplat");
    fprintf(stream, "%s: %s\n", entry->severity == SEVERITY_ERROR ? "error" : "warning",
            entry->message);
    if (source && entry->line > 0)
        print_line(stream, source, entry);
}

/* A file is included by one that was there before it, so that this ends. */
static void print_includers(const struct diagnostics *sink, size_t source, FILE *stream)
{
    const char *lead = "In file included from";
    for (; source != NO_SOURCE; lead = "                 from") {
        const struct source *included = &sink->sources[source];
        source = included->includer < source ? included->includer : NO_SOURCE;
        if (source != NO_SOURCE)
            fprintf(stream, "%s %s:%d:%d:\n", lead, sink->sources[source].name,
                    included->includer_line, included->includer_column);
    }
}

/* Entries that tie are in the order of their reports, which is the order of their addresses. */
static int compare_entries(const void *a, const void *b)
{
    const struct entry *first = *(const struct entry *const *)a;
    const struct entry *second = *(const struct entry *const *)b;
    if (first->source != second->source)
        return first->source < second->source ? -1 : 1;
    if (first->line != second->line)
        return first->line < second->line ? -1 : 1;
    if (first->column != second->column)
        return first->column < second->column ? -1 : 1;
    return first < second ? -1 : 1;
}

static const struct entry **sort_entries(const struct diagnostics *sink)
{
    for (size_t i = 0; i < sink->entry_count; i++)
        sink->sorted[i] = &sink->entries[i];
    qsort(sink->sorted, sink->entry_count, sizeof sink->sorted[0], compare_entries);
    return sink->sorted;
}

static void visit_entry(const struct diagnostics *sink, const struct entry *entry,
                        bool first_of_source, diagnostics_visit visit, void *user)
{
    const struct origin origin = {sink->sources[entry->source].name, entry->line, entry->column};
    char *text = NULL;
    size_t length = 0;
    FILE *stream = open_memstream(&text, &length);
    if (stream && first_of_source)
        print_includers(sink, entry->source, stream);
    if (stream)
        print_entry(sink, entry, stream);
    if (stream && fclose(stream) == 0) {
        text[length - 1] = '\0'; /* the last line's end */
        visit(user, entry->severity, &origin, text);
    } else {
        visit(user, entry->severity, &origin, entry->message);
    }
    free(text);
}

void diagnostics_each(const struct diagnostics *sink, diagnostics_visit visit, void *user)
{
    static const struct origin nowhere = {.file = NULL};
    const struct entry **sorted = sort_entries(sink);
    for (size_t i = 0; i < sink->entry_count; i++)
        if (sorted[i]->source == NO_SOURCE)
            visit(user, sorted[i]->severity, &nowhere, sorted[i]->message);
        else
            visit_entry(sink, sorted[i], i == 0 || sorted[i]->source != sorted[i - 1]->source,
                        visit, user);
}

void diagnostics_print(const struct diagnostics *sink, FILE *stream)
{
    const struct entry **sorted = sort_entries(sink);
    for (size_t i = 0; i < sink->entry_count; i++) {
        if (i == 0 || sorted[i]->source != sorted[i - 1]->source)
            print_includers(sink, sorted[i]->source, stream);
        print_entry(sink, sorted[i], stream);
    }
    char count[DIAGNOSTICS_COUNT_TEXT];
    if (diagnostics_warnings_text(sink, count))
        fprintf(stream, "%s\n", count);
    if (diagnostics_count_text(sink, count))
        fprintf(stream, "%s\n", count);
}
