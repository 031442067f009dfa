/* plugin.h: all that a plugin includes. The interface is described in psplat-plugins(7). */
#ifndef PSPLAT_PLUGIN_H
#define PSPLAT_PLUGIN_H

#include <psplat/alias.h>
#include <psplat/bundle.h>
#include <psplat/cells.h>
#include <psplat/display.h>
#include <psplat/host.h>
#include <psplat/light_map.h>
#include <psplat/math.h>
#include <psplat/module.h>
#include <psplat/param.h>
#include <psplat/path.h>
#include <psplat/result.h>
#include <psplat/strata.h>
#include <psplat/strategy.h>
#include <psplat/tile.h>
#include <psplat/types.h>

#endif
