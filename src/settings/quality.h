/* quality.h: how much work a picture is worth, where nobody says it in numbers.
 *
 * X(NAME, word, effort, passes) for each quality, from the fastest: defaults of parameters that are
 * numbers of samples (PS_PARAM_QUALITY) are multiplied by the effort, and a render has so many
 * passes. Passes add up everything, also smooth edges, and what mirrors and glass choose by lot;
 * the time of a picture is in proportion to effort times passes.
 */
#ifndef SETTINGS_QUALITY_H
#define SETTINGS_QUALITY_H

#define QUALITIES(X)                                                                               \
    X(QUALITY_DRAFT, "draft", 0.25, 1)                                                             \
    X(QUALITY_NORMAL, "normal", 1, 1)                                                              \
    X(QUALITY_HIGH, "high", 1, 4)                                                                  \
    X(QUALITY_FINAL, "final", 4, 16)

#define QUALITY_NAME(name_, word_, effort_, passes_) name_,
enum quality { QUALITIES(QUALITY_NAME) };
#undef QUALITY_NAME

#define QUALITY_WORD(name_, word_, effort_, passes_) word_,
#define QUALITY_WORDS                                                                              \
    {                                                                                              \
        QUALITIES(QUALITY_WORD) NULL                                                               \
    }

/* What a default is multiplied by. */
static inline double quality_effort(enum quality quality)
{
#define QUALITY_EFFORT(name_, word_, effort_, passes_) effort_,
    static const double efforts[] = {QUALITIES(QUALITY_EFFORT)};
#undef QUALITY_EFFORT
    return efforts[quality];
}

static inline unsigned quality_passes(enum quality quality)
{
#define QUALITY_PASSES(name_, word_, effort_, passes_) passes_,
    static const unsigned passes[] = {QUALITIES(QUALITY_PASSES)};
#undef QUALITY_PASSES
    return passes[quality];
}

#endif
