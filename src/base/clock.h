/* clock.h: elapsed time for statistics. */
#ifndef BASE_CLOCK_H
#define BASE_CLOCK_H

/* Seconds on a clock that never goes back, from an arbitrary start. */
double clock_seconds(void);

#endif
