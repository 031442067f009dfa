#include "tools/candidates.h"

#include "cli/progress.h"
#include "compare/metric.h"
#include "debug/debug.h"
#include "model/model.h"
#include "pipeline/render.h"
#include "session/scene_input.h"
#include "settings/quality.h"
#include "tools/candidates_plugin.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A command line whose last word is to be completed. */
struct line {
    const struct command *command;
    const char *const *words; /* behind the command's name */
    size_t count;
    size_t operands;              /* before the last word */
    const char *scene;            /* the first operand that ends in .psd, or NULL */
    bool only_operands;           /* "--" stands before */
    const struct option *pending; /* the option whose value the last word is, or NULL */
};

/* The length up to the first control character, which would end a line or a column. */
static size_t printable_length(const char *text)
{
    size_t length = 0;
    while ((unsigned char)text[length] >= 0x20 && text[length] != 0x7f)
        length++;
    return length;
}

void candidate_print(const struct prefix *prefix, const char *word, const char *help, bool goes_on)
{
    if (word[printable_length(word)] == '\0' &&
        strncmp(word, prefix->typed, strlen(prefix->typed)) == 0)
        printf("%s%s\t%s\t%.*s\n", prefix->before, word, goes_on ? "+" : "-",
               (int)printable_length(help), help);
}

/* --- values by their form
 * ----------------------------------------------------------------------------- */

/* Names of an option's values, with a comma and a blank between them. */
#define JOIN_WORD(name_, word_, ...) word_ ", "
#define JOIN_MODE(mode_, word_) word_ ", "
static const struct {
    const char *option, *names;
} named_values[] = {
    {"quality", QUALITIES(JOIN_WORD)},
    {"progress", PROGRESS_MODES(JOIN_MODE)},
    {"compression", IMAGE_COMPRESSIONS},
    {"isa", "baseline, avx2, avx512"},
    {"layer", RENDER_LAYERS},
    {"display", "tev"},
};

static void print_list(const struct prefix *prefix, const char *names)
{
    while (*names) {
        char name[64];
        size_t length = strcspn(names, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, names);
        candidate_print(prefix, name, "", false);
        names += length;
        names += strspn(names, ", ");
    }
}

/* Of "a,b,c" the last name; those before it are not offered again. */
static void print_layers(const struct prefix *prefix)
{
    const char *comma = strrchr(prefix->typed, ',');
    char before[512];
    snprintf(before, sizeof before, "%s%.*s", prefix->before,
             comma ? (int)(comma - prefix->typed + 1) : 0, prefix->typed);
    const struct prefix last = {before, comma ? comma + 1 : prefix->typed};
    print_list(&last, comma ? RENDER_LAYERS ", all" : RENDER_LAYERS ", all, none");
}

static void print_metrics(const struct prefix *prefix)
{
    for (int i = 0; i < METRIC_COUNT; i++)
        candidate_print(prefix, metric_name((enum metric)i), "", false);
}

static void print_parts_of_gbuffer(const struct prefix *prefix)
{
    char word[64];
    for (size_t i = 0; debug_gbuffer.parts[i]; i++) {
        snprintf(word, sizeof word, "%s:%s", debug_gbuffer.name, debug_gbuffer.parts[i]);
        candidate_print(prefix, word, "", false);
    }
}

static void print_model_suffixes(void)
{
    for (size_t i = 0; model_extension(i); i++)
        printf(" .%s", model_extension(i));
}

/* One of the forms that '|' separates: a word that stands for itself is in lower case or a digit.
 * Whether it is a file, for which `suffixes` then has its suffixes. */
static bool print_form(const struct prefix *prefix, const char *form, size_t length)
{
    char word[64];
    snprintf(word, sizeof word, "%.*s", (int)length, form);
    if ((word[0] >= 'a' && word[0] <= 'z') || (word[0] >= '0' && word[0] <= '9')) {
        bool goes_on = strchr(word, '[') != NULL;
        word[strcspn(word, "[")] = '\0';
        candidate_print(prefix, word, "", goes_on);
    }
    return strchr(word, '.') || strcmp(word, "MODEL") == 0 || strcmp(word, "FILE") == 0;
}

/* "FILE.exr", "SCENE.psd|MODEL...", "rays|shadowmap", "DIR", ... */
static void print_by_form(const struct prefix *prefix, const char *forms)
{
    const char *form = forms;
    size_t length, files = 0;
    if (strcmp(forms, "DIR") == 0)
        printf(":folders\t-\t\n");
    for (; *form; form += length + (form[length] == '|')) {
        length = strcspn(form, "|");
        files += print_form(prefix, form, length);
    }
    if (files == 0)
        return;
    printf(":files\t-\t");
    for (form = forms; *form; form += length + (form[length] == '|')) {
        length = strcspn(form, "|");
        size_t stem = strcspn(form, ".|");
        if (strncmp(form, "MODEL", 5) == 0)
            print_model_suffixes();
        else if (stem < length)
            printf(" %.*s", (int)strcspn(form + stem + 1, ".|") + 1, form + stem);
    }
    printf("\n");
}

/* --- values by the scene
 * ------------------------------------------------------------------------------ */

static void print_parameter(void *user, const struct psd_parameter *parameter)
{
    char word[256];
    snprintf(word, sizeof word, "%s=", parameter->name);
    candidate_print(user, word, parameter->help ? parameter->help : "", true);
}

static void print_parameters(const struct prefix *prefix, const char *scene)
{
    static const struct psd_options none = {0};
    struct prefix copy = *prefix;
    struct diagnostics *sink = diagnostics_create();
    if (sink)
        psd_list_parameters(scene, &none, sink, print_parameter, &copy);
    diagnostics_destroy(sink);
}

static void print_cameras(const struct prefix *prefix, const char *scene)
{
    static const struct scene_options none = {0};
    struct scene_input input;
    struct error error;
    if (scene_input_create(&input, &error) == PS_OK &&
        scene_input_read(&input, scene, &none) == PS_OK)
        for (size_t i = 0; i < input.description.camera_count; i++)
            candidate_print(prefix, input.description.cameras[i].name, "", false);
    scene_input_release(&input);
}

/* --- words of the line
 * -------------------------------------------------------------------------------- */

/* Commands that take the last stages' strategies alone. */
static ps_kind first_kind(const struct command *command)
{
    if (strcmp(command->name, "view") == 0)
        return PS_BLOOM;
    return strcmp(command->name, "resolve") == 0 ? PS_NORMALIZATION : PS_INJECTION;
}

static void print_values(const struct line *line, const struct option *option,
                         const struct prefix *prefix)
{
    for (size_t i = 0; i < sizeof named_values / sizeof named_values[0]; i++)
        if (strcmp(option->name, named_values[i].option) == 0) {
            print_list(prefix, named_values[i].names);
            return;
        }
    if (strncmp(option->argument, "KIND=", 5) == 0)
        candidates_print_plugins(prefix, first_kind(line->command), true);
    else if (strcmp(option->name, "layers") == 0)
        print_layers(prefix);
    else if (strcmp(option->name, "metric") == 0)
        print_metrics(prefix);
    else if (strcmp(option->name, "param") == 0 && line->scene)
        print_parameters(prefix, line->scene);
    else if (strcmp(option->name, "camera") == 0 && line->scene)
        print_cameras(prefix, line->scene);
    else
        print_by_form(prefix, option->argument);
}

static const struct option *find_option(const struct command *command, const char *word)
{
    size_t length = strcspn(word + 2, "=");
    for (size_t i = 0; i < command->option_count; i++) {
        const struct option *option = &command->options[i];
        bool is_long = word[1] == '-' && strlen(option->name) == length &&
                       strncmp(option->name, word + 2, length) == 0;
        if (is_long || (word[1] != '-' && option->letter == word[1]))
            return option;
    }
    return NULL;
}

/* Where the value is that an option's own word holds, or NULL. */
static const char *attached_value(const char *word)
{
    const char *equals = strchr(word, '=');
    if (word[1] == '-')
        return equals ? equals + 1 : NULL;
    return word[2] ? word + 2 : NULL;
}

static void print_options(const struct command *command, const struct prefix *prefix)
{
    char word[80];
    for (size_t i = 0; i < command->option_count; i++) {
        snprintf(word, sizeof word, "--%s", command->options[i].name);
        candidate_print(prefix, word, command->options[i].help, false);
    }
    candidate_print(prefix, "--help", "print this help", false);
    candidate_print(prefix, "--version", "print the version", false);
}

/* The form of the operand of that number; forms end where options are shown among them. */
static void print_operands(const struct line *line, const struct prefix *prefix)
{
    char forms[128], *rest = forms, *form = NULL;
    snprintf(forms, sizeof forms, "%s", line->command->operands);
    for (size_t i = 0; i <= line->operands; i++) {
        char *next = strsep(&rest, " ");
        bool repeats = form && strstr(form, "...");
        if (next && strcmp(next, "...") == 0)
            repeats = true;
        else if (next && next[0] != '-')
            form = next;
        else if (!repeats)
            return;
        if (repeats)
            break;
    }
    if (form && strncmp(form, "[KIND", 5) == 0) {
        candidates_print_plugins(prefix, PS_INJECTION, false);
    } else if (form) {
        if (strstr(form, "gbuffer"))
            print_parts_of_gbuffer(prefix);
        print_by_form(prefix, form);
    }
}

static void print_last_word(const struct line *line)
{
    const char *word = line->words[line->count - 1];
    const char *value = word[0] == '-' && word[1] ? attached_value(word) : NULL;
    const struct option *option = value ? find_option(line->command, word) : NULL;
    if (line->pending) {
        print_values(line, line->pending, &(struct prefix){"", word});
    } else if (line->only_operands || word[0] != '-') {
        print_operands(line, &(struct prefix){"", word});
    } else if (!value) {
        print_options(line->command, &(struct prefix){"", word});
    } else if (option && option->argument) {
        char before[128];
        snprintf(before, sizeof before, "%.*s", (int)(value - word), word);
        print_values(line, option, &(struct prefix){before, value});
    }
}

/* Takes the words before the last one; the scene may also stand behind it, where a shell gives only
 * those up to the cursor, so that it is not known. */
static void take_word(struct line *line, const char *word)
{
    size_t length = strlen(word);
    if (line->pending) {
        line->pending = NULL;
    } else if (!line->only_operands && strcmp(word, "--") == 0) {
        line->only_operands = true;
    } else if (!line->only_operands && word[0] == '-' && word[1]) {
        const struct option *option = find_option(line->command, word);
        line->pending = option && option->argument && !attached_value(word) ? option : NULL;
    } else {
        line->operands++;
        if (!line->scene && length > 4 && strcmp(word + length - 4, ".psd") == 0)
            line->scene = word;
    }
}

void candidates_print(const char *const words[], size_t count)
{
    struct line line = {.command = commands[0], .words = words, .count = count};
    for (size_t i = 0; i < command_count; i++) {
        if (count == 1)
            candidate_print(&(struct prefix){"", words[0]}, commands[i]->name, commands[i]->summary,
                            false);
        if (count > 1 && strcmp(commands[i]->name, words[0]) == 0) {
            line.command = commands[i];
            line.words = words + 1;
            line.count = count - 1;
        }
    }
    for (size_t i = 0; i + 1 < line.count; i++)
        take_word(&line, line.words[i]);
    print_last_word(&line);
}
