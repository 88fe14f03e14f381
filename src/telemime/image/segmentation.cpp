// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/segmentation.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/image/colour_votes.h"
#include "telemime/image/connected_components.h"

namespace telemime {
namespace {

// Values of the ellipse of the head (1 on its outline, squared radius): within the first, pixels are voted
// for the person; face and hair are sure within the second and likely up to the third, where ears and curls
// are.
constexpr float kVotedHead = 0.9F;
constexpr float kSureHead = 0.8F;
constexpr float kNearHead = 1.45F;
// Half heights of the head below its centre: where the chin hides clothes, and where the neck begins.
constexpr float kAboveChin = 0.6F;
constexpr float kAboveNeck = 0.85F;
constexpr double kVoteDeviation = 0.8;  // px, of the Gaussian weights of the 3x3 vote
// Without a head, a part of this many times the least size is the person.
constexpr int kLargePart = 10;
// Where a trunk may be, in half widths and half heights of the head from its centre: shoulders are three
// heads wide, hips four heads below.
constexpr float kTrunkAside = 2.5F;
constexpr float kTrunkDown = 8.0F;
// Holes of up to this many times the size that is always filled may be shadows, or the person's colours.
constexpr int kLargestHole = 30;
constexpr int kLargestShadow = 3;  // the same with a background that is sure
// Tenths of a hole, and of what surrounds an island, that must agree: clearly more than half.
constexpr int kOwnTenths = 7;
constexpr int kShadedTenths = 6;
constexpr int kAroundTenths = 7;
// The neck in half widths and half heights of the head from its centre: from above the chin to the collar,
// hardly wider than the head; the shade under the chin is narrower.
constexpr float kCollarAside = 1.05F;
constexpr float kNeckTop = 0.5F;
constexpr float kNeckBottom = 1.75F;
constexpr float kShadeAside = 0.7F;
// Sizes over that of the smallest part: holes and islands are as small as half of it, folds four times as
// large.
constexpr double kHoleSize = 0.5;
constexpr double kScrapSize = 4.0;
constexpr double kIslandSize = 0.5;
constexpr float kNearCamera = 0.9F;  // sine of the angle of the reach: a hand may be anywhere in the image

/// The pixels where the colours of the person explain the image better than the background, after a vote.
cv::Mat silhouette_of(const BackgroundEnergy& background, const ColourVotes& votes,
                      const std::optional<HeadRegion>& head, const SegmentationConfig& config) {
  cv::Mat margin = background.energy - votes.best - config.person_cost;
  if (head) {
    const Ellipse ellipse(*head);
    for (int r = 0; r < margin.rows; ++r) {
      auto* m = margin.ptr<float>(r);
      for (int c = 0; c < margin.cols; ++c) {
        m[c] += ellipse.at(r, c) < kVotedHead ? config.head_bonus : 0.0F;
      }
    }
  }
  cv::max(margin, -config.vote_limit, margin);
  cv::min(margin, config.vote_limit, margin);
  cv::GaussianBlur(margin, margin, cv::Size(3, 3), kVoteDeviation, kVoteDeviation, cv::BORDER_REPLICATE);
  cv::Mat silhouette;
  cv::compare(margin, 0, silhouette, cv::CMP_GT);
  return silhouette;
}

/// Removes components that are too small or do not belong to the person: those that neither contain the head,
/// nor are mostly skin (a hand at the image border), nor have the person's colours at the place of the body.
void remove_foreign_components(cv::Mat& silhouette, const ColourVotes& votes,
                               const std::optional<HeadRegion>& head, bool colours_known,
                               const SegmentationConfig& config) {
  const double least = config.least_part * static_cast<double>(silhouette.total());
  const ConnectedComponents pieces(silhouette, Connectivity::eight);
  const auto is_person = [&](const Component& piece) {
    if (!head && piece.area > kLargePart * least) {
      return true;
    }
    if (head) {
      const Ellipse e(*head);
      if (pieces.count(piece, [&](int r, int c) { return e.at(r, c) < 1; }) > 0) {
        return true;
      }
    }
    if (!colours_known) {
      return false;
    }
    const int own =
        pieces.count(piece, [&](int r, int c) { return votes.colour.at<unsigned char>(r, c) == kSkin; });
    if (own * 2 > piece.area) {
      return true;
    }
    const int clothes =
        pieces.count(piece, [&](int r, int c) { return votes.colour.at<unsigned char>(r, c) == kClothes; });
    if (!head || (own + clothes) * 2 <= piece.area) {
      return false;
    }
    const Ellipse e(*head);
    const int in_body = pieces.count(piece, [&](int r, int c) {
      const float aside = std::abs(static_cast<float>(c) - e.x) / e.rx;
      const float down = (static_cast<float>(r) - e.y) / e.ry;
      return aside < kTrunkAside && down > 1 && down < kTrunkDown;
    });
    return in_body * 3 > piece.area;
  };
  for (const Component& piece : pieces.all()) {
    if (piece.area < least || !is_person(piece)) {
      pieces.paint(piece, 0, silhouette);
    }
  }
}

/// Fills holes of the silhouette. Holes of up to `most` pixels are always filled; larger ones, up to
/// kLargestHole times, only if most of their pixels would have to be a shadow or, with a doubtful background,
/// have colours of the person. Other holes show the background between arm and body.
void fill_holes(cv::Mat& silhouette, const BackgroundEnergy& background, const cv::Mat& colour, double most) {
  cv::Mat outside;
  cv::bitwise_not(silhouette, outside);
  const ConnectedComponents holes(outside, Connectivity::four);
  const auto is_filled = [&](const Component& hole) {
    if (hole.area <= most) {
      return true;
    }
    if (hole.area > kLargestHole * most) {
      return false;
    }
    const auto own = [&](int r, int c) { return colour.at<unsigned char>(r, c) != kOther; };
    if (background.doubtful && holes.count(hole, own) * 10 > hole.area * kOwnTenths) {
      return true;
    }
    const auto shaded = [&](int r, int c) { return background.shaded.at<unsigned char>(r, c) != 0; };
    return (background.doubtful || hole.area <= kLargestShadow * most) &&
           holes.count(hole, shaded) * 10 > hole.area * kShadedTenths;
  };
  for (const Component& hole : holes.all()) {
    if (is_filled(hole)) {
      holes.paint(hole, 255, silhouette);
    }
  }
}

/// Relabels pixels of unknown colours with the best learned colour if they form strips of one or two pixels
/// (mixed pixels between two colours) or small patches (folds, deep shade). Patches that reach the bottom of
/// the image remain: trousers begin there.
void relabel_unknown_scraps(ColourVotes& votes, const cv::Mat& silhouette, double most) {
  const cv::Mat other = (votes.colour == kOther) & silhouette;
  cv::Mat thick;
  cv::morphologyEx(other, thick, cv::MORPH_OPEN, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3)));
  const ConnectedComponents patches(thick, Connectivity::four);
  for (const Component& patch : patches.all()) {
    if (patch.area <= most && patch.box.br().y < other.rows) {
      patches.paint(patch, 0, thick);
    }
  }
  votes.learned.copyTo(votes.colour, other & ~thick);
}

/// Labels the neck as head: in each column, skin and the unknown colours of the shade below the chin, from
/// the chin down to the clothes.
void label_neck(cv::Mat& labels, const Ellipse& ellipse) {
  const auto code = [](Label l) { return static_cast<unsigned char>(l); };
  const int first = std::max(0, static_cast<int>(ellipse.x - kCollarAside * ellipse.rx));
  const int last = std::min(labels.cols - 1, static_cast<int>(ellipse.x + kCollarAside * ellipse.rx));
  const int bottom = std::min(labels.rows - 1, static_cast<int>(ellipse.y + kNeckBottom * ellipse.ry));
  for (int c = first; c <= last; ++c) {
    int r = std::max(0, static_cast<int>(ellipse.y + kNeckTop * ellipse.ry));
    for (; r <= bottom; ++r) {
      auto& l = labels.at<unsigned char>(r, c);
      const bool below = ellipse.at(r, c) > 1;
      if (below && (l == code(Label::clothes) || l == code(Label::background))) {
        break;
      }
      if (l == code(Label::arms) ||
          (below && l == code(Label::ignore) &&
           std::abs(static_cast<float>(c) - ellipse.x) < kShadeAside * ellipse.rx)) {
        l = code(Label::head);
      }
    }
  }
}

/// Relabels small components of `island` that are surrounded by `surroundings`: a highlight on an arm, a
/// pattern on a shirt.
void relabel_islands(cv::Mat& labels, Label island, Label surroundings, double most) {
  const ConnectedComponents islands(labels == static_cast<unsigned char>(island), Connectivity::eight);
  for (const Component& component : islands.all()) {
    if (component.area > most) {
      continue;
    }
    // The pixels around the component.
    const cv::Rect box =
        cv::Rect(component.box.tl() - cv::Point(1, 1), component.box.br() + cv::Point(1, 1)) &
        cv::Rect(cv::Point(0, 0), labels.size());
    cv::Mat self = cv::Mat::zeros(box.size(), CV_8UC1);
    islands.paint(component, 255, self, box.tl());
    cv::Mat ring;
    cv::dilate(self, ring, cv::getStructuringElement(cv::MORPH_RECT, cv::Size(3, 3)));
    ring &= ~self;
    const int around = cv::countNonZero(ring);
    const int matching = cv::countNonZero((labels(box) == static_cast<unsigned char>(surroundings)) & ring);
    if (matching * 10 > around * kAroundTenths) {
      islands.paint(component, static_cast<unsigned char>(surroundings), labels);
    }
  }
}

/// Distance from the centre of the head to the hips in half heights of the head (a trunk is 3.2 heads long).
/// Pixels with the colour of clothes below belong to the trousers.
constexpr float kHips = 6.6F;

/// Ignores skin that is farther from the head than hands can be: bare legs, feet, wood. Near the camera, an
/// outstretched hand can appear anywhere, so nothing is ignored.
void ignore_out_of_reach(cv::Mat& labels, const Ellipse& head, const SegmentationConfig& config) {
  constexpr float kHalfHead = 0.12F;  // m, including hair
  constexpr float kReach = 1.15F;     // m: neck and shoulder 0.3, arm and hand 0.7, and a margin
  const float focal_length = config.focal_length * static_cast<float>(labels.cols);
  const float sine = kReach * head.ry / (kHalfHead * focal_length);
  if (sine > kNearCamera) {
    return;
  }
  const float reach = kReach / kHalfHead * head.ry / std::sqrt(1.0F - sine * sine);
  for (int r = 0; r < labels.rows; ++r) {
    auto* l = labels.ptr<unsigned char>(r);
    const float dy = static_cast<float>(r) - head.y;
    for (int c = 0; c < labels.cols; ++c) {
      const float dx = static_cast<float>(c) - head.x;
      if (l[c] == static_cast<unsigned char>(Label::arms) && dx * dx + dy * dy > reach * reach) {
        l[c] = static_cast<unsigned char>(Label::ignore);
      }
    }
  }
}

/// Labels of the silhouette pixels by colour and position.
cv::Mat label(const cv::Mat& silhouette, const ColourVotes& votes, const std::optional<HeadRegion>& head,
              bool colours_known, const SegmentationConfig& config) {
  cv::Mat labels = cv::Mat::zeros(silhouette.size(), CV_8UC1);
  const std::optional<Ellipse> ellipse = head ? std::optional<Ellipse>(Ellipse(*head)) : std::nullopt;
  const auto code = [](Label l) { return static_cast<unsigned char>(l); };
  for (int r = 0; r < labels.rows; ++r) {
    const auto* s = silhouette.ptr<unsigned char>(r);
    const auto* colour = votes.colour.ptr<unsigned char>(r);
    auto* out = labels.ptr<unsigned char>(r);
    for (int c = 0; c < labels.cols; ++c) {
      if (s[c] == 0) {
        continue;
      }
      // By colour.
      Label chosen = Label::ignore;
      if (colours_known) {
        chosen = colour[c] == kSkin ? Label::arms : colour[c] == kClothes ? Label::clothes : Label::ignore;
      }
      // By position relative to the head: face, hair and ears near it, trousers.
      if (ellipse) {
        const float t = ellipse->at(r, c);
        const float dy = (static_cast<float>(r) - ellipse->y) / ellipse->ry;
        const bool face = t < kSureHead || (t < 1 && (dy < kAboveChin || colour[c] != kClothes));
        const bool near = t < kNearHead && dy < kAboveNeck && (colour[c] == kSkin || colour[c] == kHair);
        if (face || near) {
          chosen = Label::head;
        } else if (chosen == Label::clothes && dy > kHips) {
          chosen = Label::ignore;
        }
      }
      out[c] = code(chosen);
    }
  }
  if (ellipse && colours_known) {
    label_neck(labels, *ellipse);
    ignore_out_of_reach(labels, *ellipse, config);
  }
  return labels;
}

/// Share of the ellipse of the head with the colour of skin or hair.
double share_of_skin_and_hair(const ColourVotes& votes, const HeadRegion& head) {
  const Ellipse ellipse(head);
  int inside = 0;
  int own = 0;
  for (int r = 0; r < votes.colour.rows; ++r) {
    const auto* colour = votes.colour.ptr<unsigned char>(r);
    for (int c = 0; c < votes.colour.cols; ++c) {
      if (ellipse.at(r, c) < 1) {
        ++inside;
        own += colour[c] == kSkin || colour[c] == kHair ? 1 : 0;
      }
    }
  }
  return inside > 0 ? static_cast<double>(own) / inside : 0.0;
}

}  // namespace

Segmentation segment(const LogColour& image, const BackgroundEnergy& background, const PersonColours& colours,
                     const std::optional<HeadRegion>& head, const SegmentationConfig& config) {
  return segment(colour_energies(image, colours), background, colours.known(), head, config);
}

Segmentation segment(const ColourEnergies& colours, const BackgroundEnergy& background, bool colours_known,
                     const std::optional<HeadRegion>& head, const SegmentationConfig& config) {
  // Silhouette.
  ColourVotes votes = vote(colours, head, config);
  Segmentation out;
  out.head_share = head ? share_of_skin_and_hair(votes, *head) : 0.0;
  out.silhouette = silhouette_of(background, votes, head, config);
  remove_foreign_components(out.silhouette, votes, head, colours_known, config);
  fill_holes(out.silhouette, background, votes.colour,
             config.least_part * static_cast<double>(out.silhouette.total()) * kHoleSize);
  relabel_unknown_scraps(votes, out.silhouette,
                         kScrapSize * config.least_part * static_cast<double>(out.silhouette.total()));
  // Labels.
  cv::compare(votes.colour, static_cast<int>(kSkin), out.skin, cv::CMP_EQ);
  out.labels = label(out.silhouette, votes, head, colours_known, config);
  const double island = kIslandSize * config.least_part * static_cast<double>(out.silhouette.total());
  relabel_islands(out.labels, Label::clothes, Label::arms, 2 * island);
  relabel_islands(out.labels, Label::arms, Label::clothes, island);
  return out;
}

}  // namespace telemime
