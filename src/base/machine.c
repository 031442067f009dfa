/* machine.c: questions to the system. */
#include "base/machine.h"

#include <math.h>
#include <unistd.h>

double machine_memory(void)
{
    long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    return pages > 0 && page > 0 ? (double)pages * (double)page : INFINITY;
}
