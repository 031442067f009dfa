/* isa.h: functions that are compiled for several instruction sets.
 *
 *     PS_EVERY_ISA static void add(float *sums, const float *values, size_t n) { ... }
 *
 * Of x86-64 processors these are AVX-512, AVX2 and the baseline, of which the processor's best is
 * picked as the library is loaded; elsewhere, and with the address sanitizer, there is one. Loops
 * that a compiler makes vectors of take the widest there are; what such functions call is compiled
 * with them only if it is PS_INLINED. They are static, since compilers differ in how they name
 * those of other files.
 *
 * All give the same result to the last bit if no multiplication is joined with an addition
 * (-ffp-contract=off, or ISO C, is what gcc needs for that; clang gets the pragma) and sums keep
 * their order.
 */
#ifndef PSPLAT_ISA_H
#define PSPLAT_ISA_H

#ifndef __has_feature
#define __has_feature(feature) 0
#endif
#if defined(__GNUC__) && defined(__x86_64__) && defined(__GLIBC__) &&                              \
    !defined(__SANITIZE_ADDRESS__) && !__has_feature(address_sanitizer)
#define PS_EVERY_ISA __attribute__((target_clones("avx512f", "avx2", "default")))
#define PS_INLINED inline __attribute__((always_inline))
#else
#define PS_EVERY_ISA
#define PS_INLINED inline
#endif
#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

#endif
