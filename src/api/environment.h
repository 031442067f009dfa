/* environment.h: the floating-point environment that renders count on.
 *
 * A program may round otherwise, or have denormal numbers flushed (as -ffast-math does for all of
 * it); pictures must not depend on that. All that computes runs between enter and leave, with the
 * environment that processes start with; threads that start there inherit it.
 */
#ifndef API_ENVIRONMENT_H
#define API_ENVIRONMENT_H

#include <fenv.h>

static inline void environment_enter(fenv_t *caller)
{
    fegetenv(caller);
    fesetenv(FE_DFL_ENV);
}

static inline void environment_leave(const fenv_t *caller)
{
    fesetenv(caller);
}

#endif
