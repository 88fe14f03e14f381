// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/colour_votes.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/core/in_parallel.h"

namespace telemime {
namespace {

/// The mean energy of the 3x3 neighbours, each limited so that one pixel cannot outvote all others.
cv::Mat smoothed(const cv::Mat& energy, float limit) {
  cv::Mat out;
  cv::min(energy, limit, out);
  cv::blur(out, out, cv::Size(3, 3), cv::Point(-1, -1), cv::BORDER_REPLICATE);
  return out;
}

}  // namespace

ColourEnergies colour_energies(const LogColour& image, const PersonColours& colours) {
  ColourEnergies out;
  in_parallel(
      [&] { out.skin = energy(colours.skin, image); }, [&] { out.clothes = energy(colours.clothes, image); },
      [&] { out.hair = energy(colours.hair, image); }, [&] { out.other = energy(colours.other, image); });
  return out;
}

ColourVotes vote(const ColourEnergies& energies, const std::optional<HeadRegion>& head,
                 const SegmentationConfig& config) {
  // Energies of all classes.
  cv::Mat skin = energies.skin;
  cv::Mat clothes = energies.clothes;
  cv::Mat known = energies.other;
  cv::Mat other;
  cv::min(known, config.unknown_cost, other);
  cv::Mat hair = head ? energies.hair : other;
  const float limit = config.unknown_cost + config.vote_limit;
  const cv::Size size = skin.size();
  ColourVotes out{cv::Mat(size, CV_32FC1), cv::Mat(size, CV_8UC1), cv::Mat(size, CV_8UC1)};
  for (int r = 0; r < size.height; ++r) {
    const auto* s = skin.ptr<float>(r);
    const auto* c = clothes.ptr<float>(r);
    const auto* h = hair.ptr<float>(r);
    const auto* o = other.ptr<float>(r);
    auto* b = out.best.ptr<float>(r);
    for (int i = 0; i < size.width; ++i) {
      b[i] = std::min(std::min(s[i], c[i]), std::min(h[i], o[i]));
    }
  }
  // The best class after the vote.
  in_parallel([&] { skin = smoothed(skin, limit); }, [&] { clothes = smoothed(clothes, limit); },
              [&] { hair = smoothed(hair, limit); }, [&] { known = smoothed(known, limit); },
              [&] { other = smoothed(other, limit); });
  for (int r = 0; r < size.height; ++r) {
    const auto* s = skin.ptr<float>(r);
    const auto* c = clothes.ptr<float>(r);
    const auto* h = hair.ptr<float>(r);
    const auto* o = other.ptr<float>(r);
    const auto* k = known.ptr<float>(r);
    auto* colour = out.colour.ptr<unsigned char>(r);
    auto* learned = out.learned.ptr<unsigned char>(r);
    for (int i = 0; i < size.width; ++i) {
      const bool is_skin = s[i] < c[i];
      unsigned char best = is_skin ? kSkin : kClothes;
      const float least = is_skin ? s[i] : c[i];
      learned[i] = k[i] < least ? static_cast<unsigned char>(kOther) : best;
      if (head && h[i] < least && h[i] < o[i]) {
        const float dx = (static_cast<float>(i) - static_cast<float>(head->centre.x())) /
                         static_cast<float>(head->radii.x());
        const float dy = (static_cast<float>(r) - static_cast<float>(head->centre.y())) /
                         static_cast<float>(head->radii.y());
        if (dx > -2.2F && dx < 2.2F && dy < 3.2F) {
          best = kHair;
        }
      }
      if (best != kHair && least >= o[i]) {
        best = kOther;
      }
      colour[i] = best;
    }
  }
  return out;
}

}  // namespace telemime
