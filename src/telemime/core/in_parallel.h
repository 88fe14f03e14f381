// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tbb/info.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>

#include "telemime/core/loop_order.h"

namespace telemime {

/// Runs tasks that do not share what any of them changes, on the threads of the caller's arena. Returns when
/// all have ended; an exception of one is passed on. May be called within such a task: an exception of
/// another task outside ends nothing here.
template <typename... Task>
void in_parallel(const Task&... tasks) {
  const LoopOrder order;
  const auto ordered = [&order](const auto& task) {
    return [&order, &task] {
      const LoopOrder::Task within(order);
      task();
    };
  };
  tbb::task_group_context own(tbb::task_group_context::isolated);
  tbb::parallel_invoke(ordered(tasks)..., own);
}

/// The threads that parallel loops can use of those asked for; 0: one for each processor, which is the most.
inline int usable_threads(int threads) {
  const int most = tbb::info::default_concurrency();
  return threads > 0 ? std::min(threads, most) : most;
}

/// Runs a task whose parallel loops use at most this many threads; 0: one for each processor.
template <typename Task>
void on_threads(int threads, const Task& task) {
  tbb::task_arena arena(usable_threads(threads));
  arena.execute(task);
}

}  // namespace telemime
