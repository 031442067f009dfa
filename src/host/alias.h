/* alias.h: the service of psplat/alias.h. */
#ifndef HOST_ALIAS_H
#define HOST_ALIAS_H

#include <psplat/alias.h>

extern const ps_alias_service alias_service;

#endif
