// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/all.h"
#include "telemime/streaming/udp_link.h"
#include "telemime/streaming/vmc_messages.h"

namespace telemime {
namespace {

class VmcLink final : public UdpLink {
 public:
  VmcLink(SendLoop& loop, const SendUrl& url, const VmcOptions& options)
      : UdpLink(loop, url, kMarionettePort), options_(options) {}

 private:
  std::vector<std::string> datagrams(const HumanoidSkeleton& skeleton, const HumanoidMotion* motion,
                                     const MotionFrame& frame) override {
    options_.largest = largest();
    std::vector<std::string> all =
        vmc_datagrams(skeleton, motion, face_to_show(frame.face), frame.time, options_);
    followed_ = motion != nullptr;
    face_shown_ = frame.face.has_value();
    time_ = frame.time;
    return all;
  }

  /// Receivers keep the last face: when it is no longer seen, one at rest is sent.
  const FaceMotion* face_to_show(const std::optional<FaceMotion>& face) const {
    static const FaceMotion rest;
    return face ? &*face : face_shown_ ? &rest : nullptr;
  }

  /// The last message to a receiver says that nobody is tracked, and brings the face to rest.
  std::vector<std::string> farewell(const HumanoidSkeleton& skeleton) override {
    if (!followed_ && !face_shown_) {
      return {};
    }
    std::vector<std::string> all =
        vmc_datagrams(skeleton, nullptr, face_to_show(std::nullopt), time_, options_);
    followed_ = face_shown_ = false;
    return all;
  }

  VmcOptions options_;
  bool followed_ = false;    ///< the last frame showed a person
  bool face_shown_ = false;  ///< and a face
  double time_ = 0.0;        ///< of the last frame, s
};

}  // namespace

std::unique_ptr<Sender> make_vmc_sender(const SendUrl& url) {
  check_options(url, {"bundle", "positions", "root", "expressions", "mirror"});
  check_no_path(url, "vmc://localhost:39539");
  VmcOptions options;
  options.bundles = option(url, "bundle", {"1", "0"}) == "1";
  options.all_positions = option(url, "positions", {"all", "hips"}) == "all";
  options.root_moves = option(url, "root", {"still", "moves"}) == "moves";
  const std::string expressions = option(url, "expressions", {"vrm0", "vrm1", "arkit"});
  options.expressions = expressions == "arkit"  ? VmcExpressions::arkit
                        : expressions == "vrm1" ? VmcExpressions::vrm1
                                                : VmcExpressions::vrm0;
  return make_queued_sender(url,
                            [&](SendLoop& loop) { return std::make_unique<VmcLink>(loop, url, options); });
}

}  // namespace telemime
