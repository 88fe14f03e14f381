// SPDX-License-Identifier: Apache-2.0
// Macros of the kernel for OpenCL C 1.2.
#pragma OPENCL FP_CONTRACT OFF
// PoCL 3.1 passes structs wrongly to functions that it does not inline.
#define FN static inline __attribute__((always_inline))
#define KERNEL __kernel __attribute__((reqd_work_group_size(GROUP_SIZE, 1, 1))) void
#define GLOBAL __global
#define LOCAL __local
#define THREAD ((int)get_local_id(0))
#define POSE ((int)get_group_id(0))
#define SYNCHRONISE barrier(CLK_LOCAL_MEM_FENCE)
#define ATOMIC_ADD(address, value) atomic_add(address, value)
#define ATOMIC_MIN(address, value) atomic_min(address, value)
#define ATOMIC_MAX(address, value) atomic_max(address, value)
#define BITS_OF(x) as_uint(x)
#define FLOAT_OF(x) as_float(x)
#define FUSED(a, b, c) fma(a, b, c)
#define SINE_COSINE(angle, sine, cosine) *(sine) = sincos(angle, cosine)
#define FLOOR(x) floor(x)
#define CEIL(x) ceil(x)
#define SQRT(x) sqrt(x)
#define FMIN(a, b) fmin(a, b)
#define FMAX(a, b) fmax(a, b)
#define SELECT(m, a, b) ((m) ? (a) : (b))
#define SHARED __local
#define REAL float
#define MASK int
#define NUMBER(x) (x)
#define LESS(a, b) ((a) < (b))
