/* spectrum.c: see spectrum.h. */
#include "pbrt/spectrum.h"
#include "pbrt/importer.h"

#include "base/file.h"
#include "base/suggestion.h"
#include "base/text.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FIRST_WAVELENGTH 360
#define LAST_WAVELENGTH 830
#define WAVELENGTH_STEP 1 /* nm */
#define MOST_FILE_BYTES ((size_t)16 << 20)

static double lobe(double wavelength, double middle, double below, double above)
{
    double t = (wavelength - middle) / (wavelength < middle ? below : above);
    return exp(-0.5 * t * t);
}

static void matching_functions(double l, double xyz[3])
{
    xyz[0] = 1.056 * lobe(l, 599.8, 37.9, 31.0) + 0.362 * lobe(l, 442.0, 16.0, 26.7) -
             0.065 * lobe(l, 501.1, 20.4, 26.2);
    xyz[1] = 0.821 * lobe(l, 568.8, 46.9, 40.5) + 0.286 * lobe(l, 530.9, 16.3, 31.1);
    xyz[2] = 1.217 * lobe(l, 437.0, 11.8, 36.0) + 0.681 * lobe(l, 459.0, 26.0, 13.8);
}

static void rgb_from_xyz(const double xyz[3], double rgb[3])
{
    static const double m[3][3] = {{3.2404542, -1.5371385, -0.4985314},
                                   {-0.9692660, 1.8760108, 0.0415560},
                                   {0.0556434, -0.2040259, 1.0572252}};
    for (int i = 0; i < 3; i++)
        rgb[i] = m[i][0] * xyz[0] + m[i][1] * xyz[1] + m[i][2] * xyz[2];
}

/* CIE D65, relative, each 20 nm from 360 (CIE 15:2004). */
static double d65(double wavelength)
{
    static const double table[] = {46.64,  49.98,  82.75,  93.43, 104.86, 117.81, 115.92,
                                   109.35, 104.79, 104.41, 100.0, 95.79,  90.01,  87.70,
                                   83.70,  80.21,  78.28,  71.61, 61.60,  75.09,  46.42,
                                   63.38,  64.30,  60.30,  60.30};
    double place = (wavelength - 360.0) / 20.0;
    size_t i = (size_t)place, last = sizeof table / sizeof table[0] - 2;
    i = i < last ? i : last;
    return table[i] + (table[i + 1] - table[i]) * (place - (double)i);
}

/* Planck's law, relative. */
static double planck(double wavelength, double temperature)
{
    double l = wavelength * 1e-9;
    return 1.0 / (pow(l, 5) * (exp(0.014387769 / (l * temperature)) - 1.0));
}

/* Linear between samples; where there are none, 0. */
static double sampled(const struct spectrum *spectrum, double wavelength)
{
    const double *s = spectrum->samples;
    size_t low = 0, high = spectrum->count;
    if (high == 0 || (spectrum->is_bounded && (wavelength < s[0] || wavelength > s[2 * high - 2])))
        return 0.0;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        *(s[2 * middle] <= wavelength ? &low : &high) = middle;
    }
    if (wavelength <= s[2 * low] || low + 1 == spectrum->count)
        return s[2 * low + 1];
    double width = s[2 * low + 2] - s[2 * low];
    double share = width > 0.0 ? (wavelength - s[2 * low]) / width : 0.0;
    return s[2 * low + 1] + share * (s[2 * low + 3] - s[2 * low + 1]);
}

static double value_at(const struct spectrum *spectrum, double wavelength)
{
    if (spectrum->kind == SPECTRUM_SAMPLED)
        return sampled(spectrum, wavelength);
    if (spectrum->kind == SPECTRUM_BLACKBODY)
        return planck(wavelength, spectrum->temperature);
    return spectrum->rgb[wavelength > 590.0 ? 0 : wavelength > 490.0 ? 1 : 2];
}

/* Its XYZ, of a reflectance under D65; divided by the integral of y. */
static void integrate(double value(const void *, double), const void *of, bool under_d65,
                      double xyz[3])
{
    double luminous = 0.0;
    xyz[0] = xyz[1] = xyz[2] = 0.0;
    for (int l = FIRST_WAVELENGTH; l <= LAST_WAVELENGTH; l += WAVELENGTH_STEP) {
        double matching[3], weight = value(of, l) * (under_d65 ? d65(l) : 1.0);
        matching_functions(l, matching);
        luminous += matching[1];
        for (int i = 0; i < 3; i++)
            xyz[i] += matching[i] * weight;
    }
    for (int i = 0; i < 3; i++)
        xyz[i] /= luminous;
}

static double spectrum_value(const void *spectrum, double wavelength)
{
    return value_at(spectrum, wavelength);
}

static double one(const void *unused, double wavelength)
{
    (void)unused;
    (void)wavelength;
    return 1.0;
}

/* The colour under D65, where a reflectance of 1 is white. */
static void reflectance_of(double value(const void *, double), const void *of, double rgb[3])
{
    double xyz[3], white[3];
    integrate(value, of, true, xyz);
    rgb_from_xyz(xyz, rgb);
    integrate(one, NULL, true, xyz);
    rgb_from_xyz(xyz, white);
    for (int i = 0; i < 3; i++)
        rgb[i] = fmax(rgb[i] / white[i], 0.0);
}

void spectrum_reflectance(const struct spectrum *spectrum, double rgb[3])
{
    memcpy(rgb, spectrum->rgb, sizeof spectrum->rgb);
    if (spectrum->kind == SPECTRUM_SAMPLED || spectrum->kind == SPECTRUM_BLACKBODY)
        reflectance_of(spectrum_value, spectrum, rgb);
}

double spectrum_luminance(const double rgb[3])
{
    return 0.2126729 * rgb[0] + 0.7151522 * rgb[1] + 0.0721750 * rgb[2];
}

void spectrum_illuminant(const struct spectrum *spectrum, int version, double rgb[3])
{
    double xyz[3] = {0, 0, 0}, factor = 1.0;
    memcpy(rgb, spectrum->rgb, sizeof spectrum->rgb);
    if (spectrum->kind == SPECTRUM_RGB)
        return;
    if (spectrum->kind == SPECTRUM_CHROMATICITY) {
        xyz[0] = spectrum->x / spectrum->y;
        xyz[1] = 1.0;
        xyz[2] = (1.0 - spectrum->x - spectrum->y) / spectrum->y;
    } else {
        integrate(spectrum_value, spectrum, false, xyz);
    }
    rgb_from_xyz(xyz, rgb);
    if (version == 4)
        factor = spectrum_luminance(rgb) > 0.0 ? 1.0 / spectrum_luminance(rgb) : 0.0;
    else if (spectrum->kind == SPECTRUM_BLACKBODY) /* its largest value is 1: Wien's law */
        factor =
            spectrum->scale / planck(2.8977721e6 / spectrum->temperature, spectrum->temperature);
    for (int i = 0; i < 3; i++)
        rgb[i] = fmax(factor * rgb[i], 0.0);
}

double spectrum_middle(const struct spectrum *spectrum)
{
    return value_at(spectrum, 550.0);
}

struct conductor {
    const struct spectrum *eta, *k;
};

static double normal_reflectance(double eta, double k)
{
    double below = (eta + 1.0) * (eta + 1.0) + k * k;
    return below > 0.0 ? ((eta - 1.0) * (eta - 1.0) + k * k) / below : 0.0;
}

static double conductor_value(const void *user, double wavelength)
{
    const struct conductor *conductor = user;
    return normal_reflectance(value_at(conductor->eta, wavelength),
                              value_at(conductor->k, wavelength));
}

void spectrum_conductor(const struct spectrum *eta, const struct spectrum *k, double rgb[3])
{
    if (eta->kind == SPECTRUM_RGB && k->kind == SPECTRUM_RGB)
        for (int i = 0; i < 3; i++)
            rgb[i] = normal_reflectance(eta->rgb[i], k->rgb[i]);
    else
        reflectance_of(conductor_value, &(struct conductor){eta, k}, rgb);
}

/* --- reading
 * -------------------------------------------------------------------------------------- */

void spectrum_release(struct spectrum *spectrum)
{
    free(spectrum->samples);
    *spectrum = (struct spectrum){0};
}

/* Pairs of rising wavelengths. False: reported. */
static bool check_samples(struct importer *importer, const struct parameter *parameter,
                          const char *what, const double *numbers, size_t count)
{
    bool good = count >= 2 && count % 2 == 0;
    for (size_t i = 2; i < count && good; i += 2)
        good = numbers[i] > numbers[i - 2];
    if (!good)
        importer_error(importer, &parameter->origin, parameter->width,
                       "%s: expected pairs of a rising wavelength in nm and a value", what);
    return good;
}

static bool take_samples(struct importer *importer, const struct parameter *parameter,
                         const char *what, const double *numbers, size_t count,
                         struct spectrum *spectrum)
{
    if (!check_samples(importer, parameter, what, numbers, count))
        return false;
    spectrum->samples = malloc(count * sizeof *numbers);
    if (!spectrum->samples)
        return importer_no_memory(importer);
    memcpy(spectrum->samples, numbers, count * sizeof *numbers);
    spectrum->kind = SPECTRUM_SAMPLED;
    spectrum->count = count / 2;
    spectrum->is_bounded = importer->version == 4;
    return true;
}

/* An .spd file: numbers, and comments after #. */
static bool read_file(struct importer *importer, const struct parameter *parameter,
                      const char *path, const char *shown, struct spectrum *spectrum)
{
    struct file_text text = {0};
    struct error error;
    double *numbers = NULL;
    size_t count = 0, capacity = 0;
    bool good =
        file_read_regular(path, importer->options->folder, MOST_FILE_BYTES, &text, &error) == PS_OK;
    if (!good) {
        char hint[SUGGESTION_TEXT];
        spectrum_suggest(shown, hint);
        importer_error(importer, &parameter->origin, parameter->width,
                       "spectrum '%.200s': no such name%s, and %s", shown, hint, error.text);
    }
    struct lexer lexer = lexer_start(shown, text.bytes, text.length);
    while (good) {
        struct token token = lexer_next(&lexer);
        if (token.kind == TOKEN_END)
            break;
        good = token.kind == TOKEN_NUMBER;
        if (!good)
            importer_error(importer, &parameter->origin, parameter->width,
                           "spectrum '%.200s': expected a number in its line %d", shown,
                           token.origin.line);
        else if (importer_grow(importer, (void **)&numbers, &capacity, count + 1, sizeof *numbers))
            numbers[count++] = token.number;
        else
            good = false;
    }
    good = good && take_samples(importer, parameter, shown, numbers, count, spectrum);
    lexer_release(&lexer);
    free(numbers);
    file_release(&text);
    return good;
}

static bool read_text(struct importer *importer, const struct parameter *parameter,
                      struct spectrum *spectrum)
{
    if (parameter->count != 1) {
        importer_error(importer, &parameter->origin, parameter->width,
                       "%s: expected one name of a spectrum or of its file", parameter->name);
        return false;
    }
    if (spectrum_named(parameter->strings[0], spectrum))
        return true;
    char *path = importer_file_path(importer, parameter->strings[0]);
    bool good = path && read_file(importer, parameter, path, parameter->strings[0], spectrum);
    free(path);
    return good;
}

static bool read_numbers(struct importer *importer, const struct parameter *parameter,
                         struct spectrum *spectrum)
{
    const char *type = parameter->type->name;
    const double *numbers = parameter->numbers;
    if (strcmp(type, "spectrum") == 0)
        return take_samples(importer, parameter, parameter->name, numbers, parameter->count,
                            spectrum);
    if (strcmp(type, "blackbody") == 0 && (parameter->count == 1 || parameter->count == 2) &&
        numbers[0] >= 100.0 && numbers[0] <= 1e6) {
        spectrum->kind = SPECTRUM_BLACKBODY;
        spectrum->temperature = numbers[0];
        spectrum->scale = parameter->count == 2 ? numbers[1] : 1.0;
        return true;
    }
    if (strcmp(type, "float") == 0 && parameter->count == 1) {
        spectrum->rgb[0] = spectrum->rgb[1] = spectrum->rgb[2] = numbers[0];
        return true;
    }
    bool is_xyz = strcmp(type, "xyz") == 0;
    if ((is_xyz || strcmp(type, "rgb") == 0 || strcmp(type, "color") == 0) &&
        parameter->count == 3) {
        memcpy(spectrum->rgb, numbers, sizeof spectrum->rgb);
        if (is_xyz)
            rgb_from_xyz(numbers, spectrum->rgb);
        return true;
    }
    importer_error(importer, &parameter->origin, parameter->width,
                   "%s: expected rgb, a spectrum, or blackbody with 100..1e6 K, got %zu of type %s",
                   parameter->name, parameter->count, type);
    return false;
}

bool spectrum_read(struct importer *importer, const struct parameter *parameter,
                   struct spectrum *spectrum)
{
    *spectrum = (struct spectrum){.kind = SPECTRUM_RGB};
    return parameter->strings ? read_text(importer, parameter, spectrum)
                              : read_numbers(importer, parameter, spectrum);
}
