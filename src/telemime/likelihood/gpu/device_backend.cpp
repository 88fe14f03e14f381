// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/gpu/device_backend.h"

#include <algorithm>

#include "telemime/core/errors.h"
#include "telemime/likelihood/packed_model.h"

namespace telemime::gpu {
namespace {

static_assert(std::size(PoseCounts{}.model) == kSurfaceClassCount);

bool holds(const PackedSegment::LaneSet& set, std::uint32_t lane) {
  return (set[lane / 64] >> (lane % 64) & 1U) != 0;
}

void pack_lanes(const PackedModel& model, DeviceInput& input) {
  const std::size_t size = model.x.size() - PackedModel::kPadding;
  if (size > kMostVertices) {
    throw Error(ErrorKind::usage, "the body's mesh has too many vertices for this back end",
                "Use the back end simd.");
  }
  input.frame.vertices = static_cast<std::int32_t>(size);
  input.vertices.clear();
  for (const std::vector<float>* coordinate : {&model.x, &model.y, &model.z}) {
    input.vertices.insert(input.vertices.end(), coordinate->begin(),
                          coordinate->begin() + static_cast<std::ptrdiff_t>(size));
  }
  input.words.assign(size, 0);
  input.beside.assign(size, 0);
  for (std::uint32_t s = 0; s < kSegmentCount; ++s) {
    const PackedSegment& segment = model.segments[s];
    for (std::uint32_t lane = 0; lane < segment.lanes + segment.stride; ++lane) {
      const std::uint32_t at = segment.begin + lane;
      std::uint32_t word = s << 8 | segment.stride << 16;
      if (lane < segment.lanes && holds(segment.quads, lane)) {
        word |= model.surface[at] & 0x1FU;
        word |= holds(segment.top, lane) ? 0x20U : 0U;
        word |= holds(segment.bottom, lane) ? 0x40U : 0U;
        word |= 0x80U;
      }
      input.words[at] = word;
      input.beside[at] = static_cast<std::int32_t>(
          lane >= segment.stride ? at - segment.stride : at + segment.lanes - segment.stride);
    }
  }
}

void pack_frame(const PreparedFrame& frame, const PackedSkeleton& skeleton, Reduction terms,
                DeviceInput& input) {
  FrameNumbers& numbers = input.frame;
  numbers.fx = static_cast<float>(frame.camera.fx);
  numbers.fy = static_cast<float>(frame.camera.fy);
  numbers.cx = static_cast<float>(frame.camera.cx);
  numbers.cy = static_cast<float>(frame.camera.cy);
  numbers.width = frame.camera.width;
  numbers.height = frame.camera.height;
  numbers.terms = static_cast<std::int32_t>(terms);
  numbers.skeleton = skeleton;
  input.labels = {frame.labels.ptr<std::uint8_t>(), frame.labels.total()};
  input.distance = {frame.distance.ptr<float>(), frame.distance.total()};
}

void pack_poses(std::span<const Pose> poses, std::vector<float>& numbers) {
  numbers.resize(kPoseSize * poses.size());
  auto out = numbers.begin();
  const auto to_float = [](double number) { return static_cast<float>(number); };
  for (const Pose& pose : poses) {
    out = std::transform(pose.root.begin(), pose.root.end(), out, to_float);
    out = std::transform(pose.angles.begin(), pose.angles.end(), out, to_float);
  }
}

Reductions reductions_of(const PoseCounts& counts, Reduction terms) {
  Reductions r;
  if (wants(terms, Reduction::overlap)) {
    std::copy(std::begin(counts.model), std::end(counts.model), r.model.begin());
    std::copy(std::begin(counts.both), std::end(counts.both), r.both.begin());
  }
  if (wants(terms, Reduction::contour)) {
    r.contour_sum = static_cast<double>(counts.sum);
    r.contour_points = counts.points;
  }
  return r;
}

class DeviceBackend final : public Backend {
 public:
  DeviceBackend(std::string_view name, std::unique_ptr<Device> device, CueTable cues)
      : Backend(std::move(cues)), name_(name), device_(std::move(device)) {}

  std::string_view name() const override { return name_; }
  std::optional<DeviceTimes> device_times() const override { return times_; }

  void count(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
             std::span<const Kinematics>, Reduction terms, std::span<Reductions> counts) override {
    if (frame.camera.width > kBandPixels) {
      throw Error(ErrorKind::usage, "the image is too wide for this back end", "Use the back end simd.");
    }
    times_ = DeviceTimes{};
    const PackedModel& packed = models_.of(model.body, model.mesh);
    pack_lanes(packed, input_);
    pack_frame(frame, packed.skeleton, terms, input_);
    for (std::size_t first = 0; first < poses.size(); first += kMostPoses) {
      const std::size_t size = std::min(kMostPoses, poses.size() - first);
      pack_poses(poses.subspan(first, size), input_.poses);
      counts_.resize(std::max(counts_.size(), size));
      const DeviceTimes times = device_->run(input_, std::span(counts_).first(size));
      times_->upload += times.upload;
      times_->kernel += times.kernel;
      times_->download += times.download;
      for (std::size_t i = 0; i < size; ++i) {
        counts[first + i] = reductions_of(counts_[i], terms);
      }
    }
  }

 private:
  std::string_view name_;
  std::unique_ptr<Device> device_;
  PackedModelCache models_;
  DeviceInput input_;
  std::vector<PoseCounts> counts_;
  std::optional<DeviceTimes> times_;
};

}  // namespace

std::unique_ptr<Backend> make_device_backend(std::string_view name, std::unique_ptr<Device> device,
                                             CueTable cues) {
  return std::make_unique<DeviceBackend>(name, std::move(device), std::move(cues));
}

}  // namespace telemime::gpu
