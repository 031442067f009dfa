/* spectrum_named.c: the spectra that pbrt-v4 has names for.
 *
 * Illuminants are their chromaticities (CIE 15:2004, 2 degrees); metals their optical constants at
 * the middle of red, green and blue, 650, 550 and 450 nm, from P. B. Johnson and R. W. Christy
 * (1972) for the noble metals and from refractiveindex.info for the others; glasses their index at
 * 587.6 nm, from Schott's catalogue.
 */
#include "pbrt/spectrum.h"

#include "base/suggestion.h"
#include <string.h>

static const struct named {
    const char *name;
    double values[3]; /* rgb; of illuminants x, y, 0 */
} named[] = {
    {"glass-BK7", {1.5168, 1.5168, 1.5168}},   {"glass-BAF10", {1.67, 1.67, 1.67}},
    {"glass-FK51A", {1.4866, 1.4866, 1.4866}}, {"glass-LASF9", {1.8503, 1.8503, 1.8503}},
    {"glass-F5", {1.6725, 1.6725, 1.6725}}, /* SF5, SF10 and SF11, whatever their names */
    {"glass-F10", {1.7281, 1.7281, 1.7281}},   {"glass-F11", {1.7845, 1.7845, 1.7845}},
    {"metal-Ag-eta", {0.140, 0.129, 0.151}},   {"metal-Ag-k", {4.15, 3.25, 2.47}},
    {"metal-Al-eta", {1.49, 0.958, 0.618}},    {"metal-Al-k", {7.82, 6.69, 5.47}},
    {"metal-Au-eta", {0.155, 0.430, 1.50}},    {"metal-Au-k", {3.60, 2.46, 1.88}},
    {"metal-Cu-eta", {0.214, 1.04, 1.15}},     {"metal-Cu-k", {3.67, 2.59, 2.50}},
    {"metal-CuZn-eta", {0.444, 0.527, 1.19}},  {"metal-CuZn-k", {3.70, 2.77, 1.82}},
    {"metal-MgO-eta", {1.736, 1.740, 1.748}},  {"metal-MgO-k", {0, 0, 0}},
    {"metal-TiO2-eta", {2.57, 2.65, 2.80}},    {"metal-TiO2-k", {0, 0, 0}},
    {"stdillum-A", {0.44757, 0.40745, 0}},     {"stdillum-D50", {0.34567, 0.35850, 0}},
    {"stdillum-D55", {0.33242, 0.34743, 0}},   {"stdillum-D65", {0.31271, 0.32902, 0}},
    {"stdillum-F1", {0.31310, 0.33727, 0}},    {"stdillum-F2", {0.37208, 0.37529, 0}},
    {"stdillum-F3", {0.40910, 0.39430, 0}},    {"stdillum-F4", {0.44018, 0.40329, 0}},
    {"stdillum-F5", {0.31379, 0.34531, 0}},    {"stdillum-F6", {0.37790, 0.38835, 0}},
    {"stdillum-F7", {0.31292, 0.32933, 0}},    {"stdillum-F8", {0.34588, 0.35875, 0}},
    {"stdillum-F9", {0.37417, 0.37281, 0}},    {"stdillum-F10", {0.34609, 0.35986, 0}},
    {"stdillum-F11", {0.38052, 0.37713, 0}},   {"stdillum-F12", {0.43695, 0.40441, 0}},
    {"illum-acesD60", {0.32168, 0.33767, 0}},
};

bool spectrum_named(const char *name, struct spectrum *spectrum)
{
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++) {
        const struct named *row = &named[i];
        if (strcmp(row->name, name) != 0)
            continue;
        *spectrum = (struct spectrum){.kind = SPECTRUM_RGB};
        memcpy(spectrum->rgb, row->values, sizeof row->values);
        if (strstr(name, "illum")) {
            spectrum->kind = SPECTRUM_CHROMATICITY;
            spectrum->x = row->values[0];
            spectrum->y = row->values[1];
        }
        return true;
    }
    return false;
}

void spectrum_suggest(const char *word, char *text)
{
    struct suggestion suggestion = suggestion_start(word);
    for (size_t i = 0; i < sizeof named / sizeof named[0]; i++)
        suggestion_consider(&suggestion, named[i].name);
    suggestion_text(&suggestion, text);
}
