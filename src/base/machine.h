/* machine.h: what the machine has. */
#ifndef BASE_MACHINE_H
#define BASE_MACHINE_H

/* Bytes of memory that this process may use: the physical memory, or less where its control group
 * (cgroups(7)) or one above it has a limit; infinite where the system does not tell. */
double machine_memory(void);

/* The same, or `limit` where that is less, and not 0. */
double machine_memory_within(double limit);

/* The limit of its control groups alone, by what /proc and /sys say under `root` ("": the
 * machine's). */
double machine_memory_of_groups(const char *root);

/* Bytes that this process has in memory now; 0 where the system does not tell. */
double machine_memory_of_process(void);

/* Bytes that this process may write to and has mapped, in memory or not, as RLIMIT_DATA
 * (getrlimit(2)) counts them, and its stacks; 0 where the system does not tell. */
double machine_data_of_process(void);

#endif
