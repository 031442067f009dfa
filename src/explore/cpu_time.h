/* cpu_time.h: processor time of some of a process's threads.
 *
 * Where several renders run at once, the process's clock has the time of all. Threads take their
 * name from the one that starts them, so that those of a render have that of the thread that it
 * runs in.
 */
#ifndef EXPLORE_CPU_TIME_H
#define EXPLORE_CPU_TIME_H

#define THREAD_NAME_LENGTH 16

/* Seconds of processor time that the threads of that name, those that are there, have taken so far.
 * 0 where the system does not say. */
double cpu_time_of_threads(const char *name);

#endif
