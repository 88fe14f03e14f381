// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "telemime/likelihood/cues/table.h"
#include "telemime/likelihood/gpu/device.h"
#include "telemime/likelihood/prepared_frame.h"

namespace telemime {

/// How one pose agrees with one frame.
struct Score {
  /// Cost of each cue, by its position in the table. A cue that was not asked for keeps its number from here.
  CueValues costs = {1.0};
  Reductions reductions;

  double region() const { return costs[cue::kRegion]; }    ///< F, in [0, 1] (thesis 2.4.4.3)
  double contour() const { return costs[cue::kContour]; }  ///< D_C, px of the working image (thesis 3.5)
};

/// Evaluates batches of poses: an implementation counts reductions, the cues of its table turn them into
/// costs. One virtual call a batch, no hidden current frame. Implementations must agree with `scalar`, which
/// is the definition. Not to be used by two threads at a time.
class Backend {
 public:
  explicit Backend(CueTable cues = {}) : cues_(std::move(cues)) {}
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;
  virtual ~Backend() = default;
  virtual std::string_view name() const = 0;
  const CueTable& cues() const { return cues_; }

  /// scores[i] of poses[i], by all cues whose reductions `terms` contains. `kinematics` are those of the
  /// poses, where the caller has them. Throws Error(usage) when the sizes differ.
  void evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses, Reduction terms,
                std::span<Score> scores, std::span<const Kinematics> kinematics = {});

  /// Adds to counts[i], which come in as Reductions{}, what `terms` asks for of poses[i]. `kinematics` are
  /// empty or those of the poses: a back end may read either. `observed` is left to evaluate().
  virtual void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
                     std::span<const Kinematics> kinematics, Reduction terms,
                     std::span<Reductions> counts) = 0;

  /// Times of the last batch; none from back ends that run on the processor.
  virtual std::optional<DeviceTimes> device_times() const { return std::nullopt; }

 private:
  CueTable cues_;
  std::vector<Reductions> counts_;
};

/// The definition: exact z-buffered meshes, one pose after the other.
std::unique_ptr<Backend> make_scalar_backend(CueTable cues = {});

}  // namespace telemime
