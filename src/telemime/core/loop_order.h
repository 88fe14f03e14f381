// SPDX-License-Identifier: Apache-2.0
#pragma once

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace telemime {

/// The order of a parallel loop, told to the thread sanitizer, which cannot see it inside Debian's TBB: what
/// came before the loop comes before each of its tasks, and these before the end of the scope. Nothing in
/// other builds.
class LoopOrder {
 public:
  /// One task of the loop: to be made first in its body.
  class Task {
   public:
    explicit Task(const LoopOrder& loop) : loop_(loop) { loop_.acquire(); }
    ~Task() { loop_.release(); }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

   private:
    const LoopOrder& loop_;
  };

  LoopOrder() { release(); }
  ~LoopOrder() { acquire(); }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;

 private:
#ifdef __SANITIZE_THREAD__
  // The sanitizer takes no address of a constant.
  void acquire() const {
    __tsan_acquire(const_cast<LoopOrder*>(this));
  }
  void release() const {
    __tsan_release(const_cast<LoopOrder*>(this));
  }
#else
  void acquire() const {}
  void release() const {}
#endif
};

}  // namespace telemime
