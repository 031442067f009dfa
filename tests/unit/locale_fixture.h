/* locale_fixture.h: tests in locales with another decimal point. */
#ifndef TESTS_LOCALE_FIXTURE_H
#define TESTS_LOCALE_FIXTURE_H

#include "unit/scratch.h"

#include <locale.h>
#include <stdbool.h>

/* Switches to a locale with the decimal point `point`, made on the spot where the system's parts
 * are there but the locale is not. */
static inline bool use_locale(void **state, const char *name, const char *point)
{
    char command[1200];
    const char *folder = scratch_path(state, "locale");
    if (setlocale(LC_ALL, name) && strcmp(localeconv()->decimal_point, point) == 0)
        return true;
    snprintf(command, sizeof command, "mkdir -p %s && localedef -i %.5s -f UTF-8 %s/%s 2>/dev/null",
             folder, name, folder, name);
    if (system(command) != 0)
        return false;
    setenv("LOCPATH", folder, 1);
    return setlocale(LC_ALL, name) && strcmp(localeconv()->decimal_point, point) == 0;
}

/* Back to the usual locale; also after a failure. */
static inline int leave_locale(void **state)
{
    char command[1200];
    setlocale(LC_ALL, "C");
    unsetenv("LOCPATH");
    snprintf(command, sizeof command, "rm -rf %s", scratch_path(state, "locale"));
    return system(command) == 0 ? scratch_close(state) : -1;
}

#define LOCALE_TEST(function) cmocka_unit_test_setup_teardown(function, scratch_open, leave_locale)

#endif
