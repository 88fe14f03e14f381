// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "telemime/image/colour_model.h"
#include "telemime/image/frame_features.h"

namespace telemime {

/// The colours of one person, learned at a frame with a face. Empty mixtures: not learned.
struct PersonColours {
  ColourMixture skin;
  ColourMixture clothes;
  ColourMixture hair;
  ColourMixture other;  ///< what is neither: trousers or a skirt, a mask, when seen at the start
  bool known() const { return !skin.empty(); }
};

/// What came of an attempt to learn a person's colours.
struct PersonReport {
  bool accepted = false;
  std::string reason;  ///< why not, and what to do; empty when accepted
};

/// Learns skin inside the face, clothes in a rectangle under the chin and hair above the brow (thesis
/// 2.4.4.1), each from pixels of `silhouette` (CV_8UC1, not 0: person) only. Skin is what most of the face
/// is: eyes, glasses, beard, hair and a mask are trimmed away. `head` in pixels of the picture.
/// On refusal `colours` stays as it was.
PersonReport learn_person_colours(const LogColour& picture, const cv::Mat& silhouette, const HeadRegion& head,
                                  PersonColours& colours);

/// Share of the pixels of a box in which the colour of any human skin would be possible. Coloured light can
/// deceive it: a test against faces in wallpaper, not for skin.
double possible_skin(const LogColour& picture, const cv::Rect& box);

}  // namespace telemime
