/* result.h: what a function that can fail returns; 0 is success. */
#ifndef PSPLAT_RESULT_H
#define PSPLAT_RESULT_H

typedef enum ps_result {
    PS_OK = 0,
    PS_ERROR_MEMORY = 1,
    PS_ERROR_INVALID = 2, /* a setting or input that makes no sense */
    PS_ERROR_IO = 3,
    PS_CANCELLED = 4
} ps_result;

#endif
