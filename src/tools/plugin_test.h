/* plugin_test.h: psplat plugins --test: tries the strategies of a module as its author would want
 * to.
 *
 * On a small room with every kind of surface, each strategy of the module has to start, to make a
 * picture of numbers, the same for any number of threads and any batches, to stop when it is asked
 * to, to give back its memory, and to make no light: photons carry no more than the lights, merging
 * keeps their power, and bloom shows no more than there was.
 */
#ifndef TOOLS_PLUGIN_TEST_H
#define TOOLS_PLUGIN_TEST_H

#include "plugin/loader.h"

/* Tries "FILE[:KEY=VALUE,...]" and prints a line for each trial. STATUS_OK; STATUS_FAILED where a
 * trial fails; STATUS_USAGE where the module can't be used. */
int plugin_test(struct loader *loader, const char *text);

#endif
