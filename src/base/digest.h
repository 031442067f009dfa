/* digest.h: a number that stands for bytes: those that differ have another, but by a chance of one
 * in 2^64. Not against forgery. FNV-1a (Fowler, Noll, Vo; RFC 9923).
 */
#ifndef BASE_DIGEST_H
#define BASE_DIGEST_H

#include <stddef.h>
#include <stdint.h>

#define DIGEST_START UINT64_C(0xcbf29ce484222325)

static inline void digest_add(uint64_t *digest, const void *bytes, size_t size)
{
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size; i++)
        *digest = (*digest ^ byte[i]) * UINT64_C(0x100000001b3);
}

#endif
