/* machine.h: what the machine has. */
#ifndef BASE_MACHINE_H
#define BASE_MACHINE_H

/* Bytes of physical memory; infinite where the system does not tell. */
double machine_memory(void);

#endif
