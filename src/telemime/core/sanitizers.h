// SPDX-License-Identifier: Apache-2.0
#pragma once

// Which sanitizer this is built with, said alike for GCC and Clang.
#ifdef __has_feature
#define TELEMIME_HAS_FEATURE(name) __has_feature(name)
#else
#define TELEMIME_HAS_FEATURE(name) 0
#endif

#if defined(__SANITIZE_ADDRESS__) || TELEMIME_HAS_FEATURE(address_sanitizer)
#define TELEMIME_ADDRESS_SANITIZER 1
#else
#define TELEMIME_ADDRESS_SANITIZER 0
#endif

#if defined(__SANITIZE_THREAD__) || TELEMIME_HAS_FEATURE(thread_sanitizer)
#define TELEMIME_THREAD_SANITIZER 1
#else
#define TELEMIME_THREAD_SANITIZER 0
#endif
