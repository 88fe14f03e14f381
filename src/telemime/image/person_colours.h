// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "telemime/image/colour_model.h"
#include "telemime/image/frame_features.h"

namespace telemime {

/// The colours of a person, learned from a frame with a visible face. An empty mixture was not learned.
struct PersonColours {
  ColourMixture skin;
  ColourMixture clothes;
  ColourMixture hair;
  ColourMixture other;  ///< trousers, a skirt or a mask, if visible in that frame
  bool known() const { return !skin.empty(); }
};

/// Energies of an image under the colours of a person, as energy() gives them: CV_32FC1.
struct ColourEnergies {
  cv::Mat skin;
  cv::Mat clothes;
  cv::Mat hair;
  cv::Mat other;
};

/// The energies of all pixels under each mixture, on the threads of the caller's arena.
ColourEnergies colour_energies(const LogColour& image, const PersonColours& colours);

/// Result of an attempt to learn the colours of a person.
struct PersonReport {
  bool accepted = false;
  std::string reason;  ///< why the frame was refused and what to do; empty if accepted
};

/// Learns the colours of skin from the face, of clothes from a rectangle below the chin, and of hair from
/// above the brow (thesis 2.4.4.1), using only pixels where `silhouette` (CV_8UC1) is not 0. Eyes, glasses, a
/// beard, hair and a mask are trimmed from the skin. `head` is in pixels of `image`. If the frame is refused,
/// `colours` does not change.
PersonReport learn_person_colours(const LogColour& image, const cv::Mat& silhouette, const HeadRegion& head,
                                  PersonColours& colours);

/// Share of the pixels of a box whose colour is possible for human skin. Rejects false detections of faces,
/// for instance in wallpaper. Not a skin detector: coloured light can shift skin out of the range.
double possible_skin(const LogColour& image, const cv::Rect& box);

}  // namespace telemime
