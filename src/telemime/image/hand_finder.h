// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "telemime/image/frame_features.h"
#include "telemime/nets/hand_landmarks.h"

namespace telemime {

/// The same hand in the pixels of the picture at another size.
HandLandmarks scaled_to(HandLandmarks hand, cv::Size from, cv::Size to);

/// Whether two findings, in pixels of one picture, are the same hand.
bool are_same_hand(const HandLandmarks& a, const HandLandmarks& b);

/// Finds the two hands of a person and follows them from frame to frame: where each was in the last frame, or
/// where the pose of the body has it. Copies share the networks: two of them must not be used at the same
/// time.
class HandFinder {
 public:
  /// Without networks: it never looks.
  HandFinder() = default;
  /// Reads the networks from this folder (find_models). Throws Error(config).
  explicit HandFinder(const std::filesystem::path& models);

  bool has_networks() const { return networks_[0] != nullptr; }

  /// The part of find() that needs no pose, so that it can run beside the search for the pose of the same
  /// picture: it looks where the hands were. find() for this time then starts from what was seen there; it
  /// finds the same without it.
  void prepare(const cv::Mat& picture, double time, bool in_turn = false);

  /// The hands in the next picture (CV_8UC3, BGR). `pose` and the result are in pixels of an image of size
  /// `working` that shows the same. `time` is that of the picture, s. With `in_turn` it looks for one hand
  /// only, otherwise for both at the same time.
  std::array<SeenHand, 2> find(const cv::Mat& picture, const PoseLandmarks& pose, cv::Size working,
                               double time, bool in_turn = false);

 private:
  bool is_due(std::size_t hand, bool in_turn) const { return !in_turn || hand != turn_; }
  bool is_followed(std::size_t hand, double time) const;
  std::optional<HandLandmarks> look_where_it_was(const cv::Mat& picture, std::size_t hand, double time);
  std::optional<HandLandmarks> look(const cv::Mat& picture, const PoseLandmarks& pose, HandSide side,
                                    double time);

  /// What was seen where a hand was.
  struct Seen {
    double time = 0.0;
    std::optional<HandLandmarks> hand;
  };
  struct Followed {
    HandLandmarks hand;  ///< in pixels of the picture
    double time = 0.0;
    bool missed = false;  ///< it was looked for since, but not found
  };
  std::array<std::shared_ptr<HandNetworks>, 2> networks_;  ///< of each hand
  std::array<std::optional<Followed>, 2> followed_;
  std::array<std::optional<Seen>, 2> prepared_;
  std::size_t turn_ = 0;  ///< the hand that was looked for last
};

}  // namespace telemime
