// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "telemime/nets/face_landmarks.h"
#include "telemime/nets/hand_landmarks.h"
#include "telemime/nets/pose_landmarks.h"

namespace telemime {

/// Class of a pixel of the working image, as estimated by the segmentation.
enum class Label : std::uint8_t {
  background = 0,
  head = 1,      ///< face, hair and neck
  arms = 2,      ///< skin outside the head
  clothes = 3,   ///< clothes of the torso and the sleeves
  ignore = 255,  ///< unknown or not modelled (trousers, a chair): no cue counts it
};

/// The head as an upright ellipse, in pixels of the working image.
struct HeadRegion {
  Eigen::Vector2d centre{0.0, 0.0};
  Eigen::Vector2d radii{0.0, 0.0};  ///< half width; half height from crown to chin
  bool detected =
      false;  ///< true: by the face detector in this frame; false: by tracking or from the outline
};

/// What the networks see of a hand in one frame.
struct SeenHand {
  bool looked = false;                 ///< it was searched; hands may take turns
  std::optional<HandLandmarks> found;  ///< in pixels of the working image
};

/// What is extracted from one frame: all that the likelihood and the search see of the image. The planes have
/// the size of the working image, h x w.
struct FrameFeatures {
  cv::Mat labels;      ///< (h x w) CV_8UC1, values of Label
  cv::Mat silhouette;  ///< (h x w) CV_8UC1, 255 on the person
  cv::Mat edges;       ///< (h x w) CV_8UC1, 255 on edges inside the silhouette
  cv::Mat distance;    ///< (h x w) CV_32FC1, pixels to the nearest edge, capped (see distance_map)
  std::optional<HeadRegion> head;  ///< empty: no head was found
  /// What the networks see of the person, in pixels of the working image; empty: no networks, or nobody.
  std::optional<PoseLandmarks> landmarks;
  /// The person's face, in pixels of the frame's own image; empty: faces are not looked for, or none is seen.
  std::optional<FaceLandmarks> face;

  /// The hands where the person's left and right hand should be; whose they are is for the search side to
  /// decide. Empty: hands are not tracked.
  std::optional<std::array<SeenHand, 2>> hands;

  /// The rest is filled in by extract() (tracker/track_frame.h).
  std::int64_t frame = 0;             ///< index of the frame
  double time = 0.0;                  ///< of the frame, s
  bool has_colour_model = true;       ///< the person's colours are known: the labels can be trusted
  bool face_learned = false;          ///< the colours were learned in this frame
  bool person_present = false;        ///< a person is in the image
  bool other_person = false;          ///< somebody else is followed than in the frame before
  std::string note;                   ///< why the person's colours are not known
  std::vector<std::string> warnings;  ///< what breaks the assumptions of the method (light, sleeves, camera)
  double ms = 0.0;                    ///< time that the image side took
  double networks_ms = 0.0;           ///< part of it that the networks of the body took
  double face_ms = 0.0;               ///< and the face
  double hands_ms = 0.0;              ///< and the hands
};

}  // namespace telemime
