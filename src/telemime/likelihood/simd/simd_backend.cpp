// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/simd/simd_backend.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

#include "telemime/core/errors.h"
#include "telemime/core/in_parallel.h"
#include "telemime/core/loop_order.h"
#include "telemime/core/text.h"
#include "telemime/likelihood/simd/kernel.h"

namespace telemime {
namespace {

// Poses of a task; fewer are not worth one.
constexpr std::size_t kGrain = 64;

simd::InstructionSet chosen(const std::string& name) {
  const std::vector<simd::InstructionSet> sets = simd::instruction_sets();
  if (name.empty()) {
    return sets.front();
  }
  const auto found = std::find_if(sets.begin(), sets.end(),
                                  [&](const simd::InstructionSet& set) { return set.name == name; });
  if (found == sets.end()) {
    throw Error(ErrorKind::usage, "the instruction set " + name + " is not available",
                "Choose one of: " + joined(sets, &simd::InstructionSet::name) + ".");
  }
  return *found;
}

simd::Placement placement_of(const Kinematics& kinematics) {
  simd::Placement placement;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const Eigen::Isometry3d& transform = kinematics.camera_from_segment[s];
    Eigen::Map<Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(placement[s].data()) =
        transform.linear().cast<float>();
    Eigen::Map<Eigen::Vector3f>(placement[s].data() + 9) = transform.translation().cast<float>();
  }
  return placement;
}

int checked_threads(int threads) {
  if (threads < 0 || threads > 1024) {
    throw Error(ErrorKind::usage, std::to_string(threads) + " threads are not possible",
                "Give a number from 0 (as many as the machine has) to 1024.");
  }
  return usable_threads(threads);
}

class SimdBackend final : public Backend {
 public:
  explicit SimdBackend(const SimdOptions& options)
      : Backend(options.cues),
        set_(chosen(options.instruction_set)),
        last_stage_(options.last_stage),
        arena_(checked_threads(options.threads)) {
    for (int i = 0; i < arena_.max_concurrency(); ++i) {
      workspaces_.push_back(std::make_unique<simd::Workspace>());
    }
  }

  std::string_view name() const override { return "simd"; }

  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
             std::span<const Kinematics> kinematics, Reduction terms, std::span<Reductions> counts) override {
    const simd::Pinhole camera = {.fx = static_cast<float>(frame.camera.fx),
                                  .fy = static_cast<float>(frame.camera.fy),
                                  .cx = static_cast<float>(frame.camera.cx),
                                  .cy = static_cast<float>(frame.camera.cy)};
    const simd::Batch batch = {.model = models_.of(model.body, model.mesh),
                               .frame = frame.tiles,
                               .camera = camera,
                               .terms = terms,
                               .last_stage = last_stage_};
    const auto count_some = [&](std::size_t first, std::size_t end, simd::Workspace& workspace) {
      for (std::size_t i = first; i < end; ++i) {
        set_.kernel(
            batch,
            placement_of(kinematics.empty() ? forward_kinematics(model.body, poses[i]) : kinematics[i]),
            counts[i], workspace);
      }
    };
    if (workspaces_.size() == 1 || poses.size() <= kGrain) {
      count_some(0, poses.size(), *workspaces_.front());
      return;
    }
    // Threads take tasks of several poses.
    const LoopOrder order;
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, poses.size(), kGrain),
          [&](const auto& range) {
            const LoopOrder::Task task(order);
            const auto thread = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
            count_some(range.begin(), range.end(), *workspaces_[thread]);
          },
          tbb::simple_partitioner());
    });
  }

 private:
  simd::InstructionSet set_;
  SimdStage last_stage_;
  tbb::task_arena arena_;
  PackedModelCache models_;
  std::vector<std::unique_ptr<simd::Workspace>> workspaces_;  ///< by the arena's thread
};

}  // namespace

std::vector<std::string> simd_instruction_sets() {
  std::vector<std::string> names;
  for (const simd::InstructionSet& set : simd::instruction_sets()) {
    names.emplace_back(set.name);
  }
  return names;
}

std::unique_ptr<Backend> make_simd_backend(const SimdOptions& options) {
  return std::make_unique<SimdBackend>(options);
}

}  // namespace telemime
