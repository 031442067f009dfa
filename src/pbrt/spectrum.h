/* spectrum.h: spectra of pbrt scenes as linear colours with the primaries of Rec. 709, which psplat
 * renders in.
 *
 *     X = integral of x(l) S(l) dl, and so Y, Z;  rgb = M (X, Y, Z)
 *
 * with the CIE 1931 matching functions in the fit of Wyman, Sloan and Shirley, "Simple analytic
 * approximations to the CIE XYZ color matching functions" (JCGT 2013), and M of sRGB (IEC
 * 61966-2-1). Reflectances are seen under CIE D65, and scaled so that one of 1 is white.
 * Illuminants: pbrt-v3 divides by the integral of y, so that a spectrum of 1 has luminance 1;
 * pbrt-v4 divides by the illuminant's own luminance, and leaves its brightness to `scale` and
 * `power`. Wavelengths are in nm, 360 to 830.
 */
#ifndef PBRT_SPECTRUM_H
#define PBRT_SPECTRUM_H

#include "pbrt/statement.h"

enum spectrum_kind {
    SPECTRUM_RGB, /* also a grey number */
    SPECTRUM_SAMPLED,
    SPECTRUM_BLACKBODY,
    SPECTRUM_CHROMATICITY /* of a named illuminant */
};

/* Owns its samples. */
struct spectrum {
    enum spectrum_kind kind;
    double rgb[3];
    double *samples; /* pairs of wavelength and value, wavelengths rising */
    size_t count;    /* of pairs */
    bool is_bounded; /* 0 beyond the samples, as in pbrt-v4; pbrt-v3 goes on with the outermost */
    double temperature, scale; /* K; of pbrt-v3's blackbody */
    double x, y;               /* CIE 1931 chromaticity */
};

void spectrum_release(struct spectrum *spectrum);

/* Reads a parameter of one of the types float, rgb, color, xyz, blackbody, spectrum. False:
 * reported. */
bool spectrum_read(struct importer *importer, const struct parameter *parameter,
                   struct spectrum *spectrum);

/* One of pbrt's named spectra, such as "metal-Cu-eta". False: there is none. */
bool spectrum_named(const char *name, struct spectrum *spectrum);
/* The named spectrum that a word most likely meant, or "". */
void spectrum_suggest(const char *word, char *text);

/* Y of a linear colour. */
double spectrum_luminance(const double rgb[3]);

void spectrum_reflectance(const struct spectrum *spectrum, double rgb[3]);
void spectrum_illuminant(const struct spectrum *spectrum, int version, double rgb[3]);
/* The value at the middle of the spectrum, 550 nm: of an index of refraction. */
double spectrum_middle(const struct spectrum *spectrum);

/* Reflectance at normal incidence of a conductor of index eta + i k:
 *     ((eta - 1)^2 + k^2) / ((eta + 1)^2 + k^2) */
void spectrum_conductor(const struct spectrum *eta, const struct spectrum *k, double rgb[3]);

#endif
