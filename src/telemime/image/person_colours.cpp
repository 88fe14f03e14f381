// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/person_colours.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace telemime {
namespace {

constexpr ColourTolerance kSkinTolerance{0.05F, 0.20F, 1.6F, 0.5F};
constexpr ColourTolerance kClothesTolerance{0.05F, 0.25F, 1.5F, 0.15F};
constexpr ColourTolerance kHairTolerance{0.07F, 0.25F, 1.3F, 0.3F};
constexpr int kMostClothes = 5;

using Samples = std::vector<Eigen::Vector3f>;

Eigen::Vector3f at(const LogColour& picture, int row, int column) {
  return {picture.u.at<float>(row, column), picture.v.at<float>(row, column),
          picture.l.at<float>(row, column)};
}

/// Pixels of the silhouette whose position, in half widths right of and half heights below the head's centre,
/// satisfies `wanted`.
Samples collect(const LogColour& picture, const cv::Mat& silhouette, const HeadRegion& head,
                const std::function<bool(double, double)>& wanted) {
  Samples samples;
  for (int r = 0; r < silhouette.rows; ++r) {
    const double y = (r - head.centre.y()) / head.radii.y();
    for (int c = 0; c < silhouette.cols; ++c) {
      const double x = (c - head.centre.x()) / head.radii.x();
      if (silhouette.at<unsigned char>(r, c) != 0 && wanted(x, y)) {
        samples.push_back(at(picture, r, c));
      }
    }
  }
  return samples;
}

/// Skin of every tone has more red than green and more green than blue, under any usual lamp: a mask, most
/// beards and the whites of eyes have not. Bounds from the ranges of (R - G) / G in skin colour surveys.
bool may_be_skin(const Eigen::Vector3f& colour) {
  return colour[0] > 0.06F && colour[0] < 1.1F && colour[1] < 0.02F && colour[1] > -1.0F;
}

Samples keep_if(const Samples& samples, const std::function<bool(const Eigen::Vector3f&)>& wanted) {
  Samples kept;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(kept), wanted);
  return kept;
}

/// A Gaussian as wide as this is a mixture of things, and would claim other classes' pixels.
void add_if_narrow(const ColourGaussian& fitted, ColourMixture& mixture) {
  constexpr float kWidest = 0.18F;
  if (fitted.covariance(0, 0) < kWidest * kWidest && fitted.covariance(1, 1) < kWidest * kWidest) {
    mixture.push_back(fitted);
  }
}

}  // namespace

PersonReport learn_person_colours(const LogColour& picture, const cv::Mat& silhouette, const HeadRegion& head,
                                  PersonColours& colours) {
  constexpr std::size_t kFewest = 20;
  const Samples face = collect(picture, silhouette, head, [](double x, double y) {
    return x * x / 0.49 + (y - 0.25) * (y - 0.25) / 0.36 < 1;
  });
  if (face.size() < kFewest) {
    return {false, "the face covers only " + std::to_string(face.size()) +
                       " pixels of the working picture: come nearer, or use a larger working size"};
  }
  Samples skin = keep_if(face, may_be_skin);
  // Coloured light can move skin out of the usual range; then the whole face must do.
  if (skin.size() < std::max(kFewest / 2, face.size() / 8)) {
    if (!head.detected) {
      return {false, "what looks like a head from its outline has no skin in it: show your face"};
    }
    skin = face;
  }
  PersonColours learned;
  learned.skin = {fit_robust(skin, kSkinTolerance)};

  const auto unlike_skin = [&](const Eigen::Vector3f& c) { return mahalanobis2(learned.skin, c) > 9; };
  const Samples torso = collect(picture, silhouette, head,
                                [](double x, double y) { return std::abs(x) < 1.5 && y > 1.5 && y < 3.4; });
  const Samples clothes = keep_if(torso, unlike_skin);
  if (clothes.size() < kFewest) {
    return {false,
            "no clothes are seen under the face: keep head and chest in the picture and the arms off it"};
  }
  // Half the torso must be something else than skin; a bare or hidden chest would teach a wrong colour.
  if (clothes.size() * 4 < torso.size()) {
    return {false, "what is seen under the face has the colour of skin: take the hands off the chest"};
  }
  learned.clothes = fit_mixture(clothes, kMostClothes, kClothesTolerance);

  const Samples below =
      collect(picture, silhouette, head, [](double x, double y) { return std::abs(x) < 3.5 && y > 3.4; });
  const Samples lower = keep_if(below, [&](const Eigen::Vector3f& c) {
    return mahalanobis2(learned.skin, c) > 12 && mahalanobis2(learned.clothes, c) > 9;
  });
  if (lower.size() >= kFewest && lower.size() * 8 >= below.size()) {
    add_if_narrow(fit_robust(lower, kHairTolerance), learned.other);
  }

  const Samples above = collect(picture, silhouette, head, [](double x, double y) {
    return x * x + y * y < 1 && y < -0.45 && x * x + y * y > 0.2;
  });
  const Samples hair = keep_if(above, unlike_skin);
  if (hair.size() >= kFewest / 2 && hair.size() * 4 >= above.size()) {
    add_if_narrow(fit_robust(hair, kHairTolerance), learned.hair);
  }

  // A mask has a colour of its own, which shoes, paper or a cup may have, too: as long as it is not known,
  // skin is the nearest that is. A beard has the colour of hair.
  const Samples mask = keep_if(face, [&](const Eigen::Vector3f& c) {
    return !may_be_skin(c) && mahalanobis2(learned.clothes, c) > 9 && mahalanobis2(learned.hair, c) > 9;
  });
  if (skin.size() != face.size() && mask.size() >= kFewest && mask.size() * 5 >= face.size()) {
    add_if_narrow(fit_robust(mask, kClothesTolerance), learned.other);
  }
  colours = learned;
  return {true, {}};
}

double possible_skin(const LogColour& picture, const cv::Rect& box) {
  const cv::Rect inside = box & cv::Rect(0, 0, picture.u.cols, picture.u.rows);
  int skin = 0;
  for (int r = inside.y; r < inside.br().y; ++r) {
    for (int c = inside.x; c < inside.br().x; ++c) {
      skin += may_be_skin(at(picture, r, c)) ? 1 : 0;
    }
  }
  return inside.area() > 0 ? static_cast<double>(skin) / inside.area() : 0.0;
}

}  // namespace telemime
