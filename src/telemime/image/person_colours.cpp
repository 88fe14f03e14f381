// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/person_colours.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace telemime {
namespace {

constexpr ColourTolerance kSkinTolerance{.chroma = 0.05F, .luminance = 0.20F, .stretch = 1.6F, .slope = 0.5F};
constexpr ColourTolerance kClothesTolerance{
    .chroma = 0.05F, .luminance = 0.25F, .stretch = 1.5F, .slope = 0.15F};
constexpr ColourTolerance kHairTolerance{.chroma = 0.07F, .luminance = 0.25F, .stretch = 1.3F, .slope = 0.3F};
constexpr int kMostClothes = 5;

using Samples = std::vector<Eigen::Vector3f>;

Eigen::Vector3f at(const LogColour& image, int row, int column) {
  return {image.u.at<float>(row, column), image.v.at<float>(row, column), image.l.at<float>(row, column)};
}

/// Colours of the silhouette pixels at (x, y) that satisfy `wanted`; x in half widths to the right of and y
/// in half heights below the centre of the head.
Samples collect(const LogColour& image, const cv::Mat& silhouette, const HeadRegion& head,
                const std::function<bool(double, double)>& wanted) {
  Samples samples;
  for (int r = 0; r < silhouette.rows; ++r) {
    const double y = (r - head.centre.y()) / head.radii.y();
    for (int c = 0; c < silhouette.cols; ++c) {
      const double x = (c - head.centre.x()) / head.radii.x();
      if (silhouette.at<unsigned char>(r, c) != 0 && wanted(x, y)) {
        samples.push_back(at(image, r, c));
      }
    }
  }
  return samples;
}

/// Whether a colour is possible for skin: skin of any tone has more red than green and more green than blue
/// under usual lamps, unlike a mask, most beards and the whites of eyes. The bounds are from the ranges of
/// (R - G) / G in surveys of skin colour.
bool may_be_skin(const Eigen::Vector3f& colour) {
  return colour[0] > 0.06F && colour[0] < 1.1F && colour[1] < 0.02F && colour[1] > -1.0F;
}

Samples keep_if(const Samples& samples, const std::function<bool(const Eigen::Vector3f&)>& wanted) {
  Samples kept;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(kept), wanted);
  return kept;
}

/// Adds a Gaussian unless it is so wide that it covers several objects and would take pixels of other
/// classes.
void add_if_narrow(const ColourGaussian& fitted, ColourMixture& mixture) {
  constexpr float kWidest = 0.18F;
  if (fitted.covariance(0, 0) < kWidest * kWidest && fitted.covariance(1, 1) < kWidest * kWidest) {
    mixture.push_back(fitted);
  }
}

}  // namespace

PersonReport learn_person_colours(const LogColour& image, const cv::Mat& silhouette, const HeadRegion& head,
                                  PersonColours& colours) {
  // Skin: inside the face.
  constexpr std::size_t kFewest = 20;
  const Samples face = collect(image, silhouette, head, [](double x, double y) {
    return x * x / 0.49 + (y - 0.25) * (y - 0.25) / 0.36 < 1;
  });
  if (face.size() < kFewest) {
    return {false, "the face covers only " + std::to_string(face.size()) +
                       " pixels of the working image: come closer, or use a larger working size"};
  }
  Samples skin = keep_if(face, may_be_skin);
  // Coloured light can shift skin out of the usual range; then use the whole face.
  if (skin.size() < std::max(kFewest / 2, face.size() / 8)) {
    if (!head.detected) {
      return {false, "the head found by its outline has no skin colour: show your face"};
    }
    skin = face;
  }
  PersonColours learned;
  learned.skin = {fit_robust(skin, kSkinTolerance)};

  // Clothes: below the chin.
  const auto unlike_skin = [&](const Eigen::Vector3f& c) { return mahalanobis2(learned.skin, c) > 9; };
  const Samples torso = collect(image, silhouette, head,
                                [](double x, double y) { return std::abs(x) < 1.5 && y > 1.5 && y < 3.4; });
  const Samples clothes = keep_if(torso, unlike_skin);
  if (clothes.size() < kFewest) {
    return {false,
            "no clothes are visible below the face: keep head and chest in the image and the arms away from "
            "the chest"};
  }
  // A quarter of the torso must not be skin: a bare or covered chest would give a wrong colour.
  if (clothes.size() * 4 < torso.size()) {
    return {false, "the area below the face has the colour of skin: take the hands off the chest"};
  }
  learned.clothes = fit_mixture(clothes, kMostClothes, kClothesTolerance);

  // Trousers or a skirt: below the clothes, of another colour.
  const Samples below =
      collect(image, silhouette, head, [](double x, double y) { return std::abs(x) < 3.5 && y > 3.4; });
  const Samples lower = keep_if(below, [&](const Eigen::Vector3f& c) {
    return mahalanobis2(learned.skin, c) > 12 && mahalanobis2(learned.clothes, c) > 9;
  });
  if (lower.size() >= kFewest && lower.size() * 8 >= below.size()) {
    add_if_narrow(fit_robust(lower, kHairTolerance), learned.other);
  }

  // Hair: above the brow.
  const Samples above = collect(image, silhouette, head, [](double x, double y) {
    return x * x + y * y < 1 && y < -0.45 && x * x + y * y > 0.2;
  });
  const Samples hair = keep_if(above, unlike_skin);
  if (hair.size() >= kFewest / 2 && hair.size() * 4 >= above.size()) {
    add_if_narrow(fit_robust(hair, kHairTolerance), learned.hair);
  }

  // Mask: inside the face, neither skin nor hair (a beard) nor clothes. If its colour were not learned,
  // objects of that colour, such as shoes or paper, would be classified as skin.
  const Samples mask = keep_if(face, [&](const Eigen::Vector3f& c) {
    return !may_be_skin(c) && mahalanobis2(learned.clothes, c) > 9 && mahalanobis2(learned.hair, c) > 9;
  });
  if (skin.size() != face.size() && mask.size() >= kFewest && mask.size() * 5 >= face.size()) {
    add_if_narrow(fit_robust(mask, kClothesTolerance), learned.other);
  }
  colours = learned;
  return {true, {}};
}

double possible_skin(const LogColour& image, const cv::Rect& box) {
  const cv::Rect inside = box & cv::Rect(0, 0, image.u.cols, image.u.rows);
  int skin = 0;
  for (int r = inside.y; r < inside.br().y; ++r) {
    for (int c = inside.x; c < inside.br().x; ++c) {
      skin += may_be_skin(at(image, r, c)) ? 1 : 0;
    }
  }
  return inside.area() > 0 ? static_cast<double>(skin) / inside.area() : 0.0;
}

}  // namespace telemime
