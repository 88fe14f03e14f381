// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/core/sanitizers.h"

#if TELEMIME_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace telemime {

#if TELEMIME_THREAD_SANITIZER

/// The order of a parallel loop, told to the thread sanitizer, which cannot see it inside Debian's TBB: what
/// came before the loop comes before each of its tasks, and these before the end of the scope. Nothing is
/// said of one task and another, so that a race between two is seen. Nothing in other builds.
class LoopOrder {
 public:
  /// One task of the loop: to be made first in its body.
  class Task {
   public:
    explicit Task(const LoopOrder& loop) : loop_(loop) { __tsan_acquire(&loop_.begin_); }
    ~Task() { __tsan_release(&loop_.end_); }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

   private:
    const LoopOrder& loop_;
  };

  LoopOrder() { __tsan_release(&begin_); }
  ~LoopOrder() { __tsan_acquire(&end_); }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;

 private:
  // Their addresses alone count; the sanitizer takes none of a constant.
  mutable char begin_ = 0;
  mutable char end_ = 0;
};

#else

class [[maybe_unused]] LoopOrder {
 public:
  struct [[maybe_unused]] Task {
    explicit Task(const LoopOrder& /*loop*/) {}
  };
};

#endif

}  // namespace telemime
