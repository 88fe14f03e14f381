// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/heap.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace telemime {

bool give_heap_back() {
#ifdef __GLIBC__
  return ::malloc_trim(0) != 0;
#else
  return false;
#endif
}

}  // namespace telemime
