// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include "telemime/core/loop_order.h"

namespace telemime {

/// Runs tasks that do not share what any of them changes, on the threads of the caller's arena. Returns when
/// all have ended; an exception of one is passed on.
template <typename... Task>
void in_parallel(const Task&... tasks) {
  const LoopOrder order;
  const auto ordered = [&order](const auto& task) {
    return [&order, &task] {
      const LoopOrder::Task within(order);
      task();
    };
  };
  tbb::parallel_invoke(ordered(tasks)...);
}

/// Runs a task whose parallel loops use at most this many threads; 0: one for each processor.
template <typename Task>
void on_threads(int threads, const Task& task) {
  tbb::task_arena arena(threads > 0 ? threads : tbb::task_arena::automatic);
  arena.execute(task);
}

}  // namespace telemime
