#include "job/transport.h"

#include "plugin/own_folder.h"
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>

/* POSIX, unlike ISO C, has functions at the addresses that dlsym finds. */
static transport_entry entry_of(void *library)
{
    transport_entry entry;
    void *address = dlsym(library, TRANSPORT_ENTRY);
    memcpy(&entry, &address, sizeof entry);
    return entry;
}

ps_result transport_load_mpi(struct transport *transport, struct error *error)
{
    char folder[LONGEST_PATH], path[LONGEST_PATH + 16], message[256];
    if (!own_folder_find(folder))
        return error_set(error, PS_ERROR_IO, "--mpi: psplat's own folder can't be found");
    snprintf(path, sizeof path, "%s/../mpi.so", folder);
    /* MPI's own modules look for its symbols in the program. */
    void *library = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    transport_entry entry = library ? entry_of(library) : NULL;
    if (!entry)
        return error_set(error, PS_ERROR_IO,
                         "--mpi: this psplat was built without MPI, or MPI is not there: %s",
                         dlerror());
    if (!entry(transport, message, sizeof message))
        return error_set(error, PS_ERROR_IO, "--mpi: %s", message);
    return PS_OK;
}
