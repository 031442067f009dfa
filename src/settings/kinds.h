/* kinds.h: the kinds of strategy, stated once.
 *
 * X(KIND, name, summary, default) for each, in the order of ps_kind: the name is that of scene
 * files, --plugin and the plugin folders, and the default is what is used where nothing is said.
 */
#ifndef SETTINGS_KINDS_H
#define SETTINGS_KINDS_H

#define STRATEGY_KINDS(X)                                                                          \
    X(PS_INJECTION, "injection", "makes photons: indirect light that leaves surfaces", "photon")   \
    X(PS_STRATIFICATION, "stratification", "combines neighbouring photons into fewer", "none")     \
    X(PS_VISIBILITY, "visibility", "decides what a bundled light ray lights", "shadowmap")         \
    X(PS_FILTER, "filter", "radial weight of a splat", "gaussian")                                 \
    X(PS_ESTIMATOR, "estimator", "turns photons into light on the picture", "gather")              \
    X(PS_NORMALIZATION, "normalization", "turns accumulated light into radiance", "density")       \
    X(PS_DENOISER, "denoiser", "smooths the light", "regression")                                  \
    X(PS_BLOOM, "bloom", "spreads bright light, for display", "none")                              \
    X(PS_TONEMAP, "tonemap", "brings radiance into the range of a display", "filmic")

#endif
