// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "telemime/image/landmark_sides.h"
#include "telemime/nets/find_pose.h"
#include "telemime/nets/pose_detector.h"

namespace telemime {

/// Where a person is in a picture and how large.
struct PersonPlace {
  Eigen::Vector2d shoulders = Eigen::Vector2d::Zero();  ///< their middle, pixels
  double size = 1.0;  ///< radius of the circle about the hips that contains the body: about 0.95 m, pixels
};

PersonPlace place_of(const PoseLandmarks& landmarks);
PersonPlace place_of(const Detection& person);

/// Whether a person who was at `before` can be at `now` after this time: how far people move, and come
/// nearer. `error` is that of the places, m.
bool may_be_same(const PersonPlace& before, const PersonPlace& now, double seconds, double error);

/// The places in the order in which a person is to be looked for there. Nearest first, in place and size, to
/// the person who is followed; without one the large and central first. Indices.
std::vector<std::size_t> order_of_search(std::span<const PersonPlace> places,
                                         const std::optional<PersonPlace>& followed, cv::Size picture);

/// Finds one person with learned networks and follows them from frame to frame. Of several people it takes
/// the largest and most central, and then stays with that person: somebody who is farther away than a person
/// can move is not taken for the one who is followed. Only somebody who stays much nearer to the camera for 2
/// seconds takes their place. Copies share the networks: two of them must not be used at the same time.
class PersonFinder {
 public:
  /// Without networks: it never finds anybody.
  PersonFinder() = default;
  /// Reads the networks from this folder (find_models). Throws Error(config).
  explicit PersonFinder(const std::filesystem::path& models);

  bool has_networks() const { return networks_ != nullptr; }

  /// The landmarks of the person in the next picture (CV_8UC3, BGR), in its pixels, without the mask. `time`
  /// is that of the picture, s.
  std::optional<PoseLandmarks> find(const cv::Mat& picture, double time);

  /// The mask of the person whom find() found in the last picture, of that picture's size; empty if it found
  /// nobody. It is computed when it is asked for. With `keep` it may be that of a picture up to 45 ms before:
  /// computing one takes up to a third of the networks' time. The finder keeps it, too: do not write to it.
  cv::Mat mask(bool keep);

  /// People in the picture when they were last counted, at most 1 s ago.
  int people() const { return people_; }

  /// Whether the last find() went over from the person who was followed to somebody nearer, or may have come
  /// back from them.
  bool switched() const { return switched_; }

  /// Forgets where the person was.
  void reset() {
    followed_.reset();
    found_ = went_over_ = false;
    nearer_since_.reset();
    last_.reset();
  }

 private:
  struct Followed {
    PictureRegion region;  ///< in which to look for the person in the next frame
    PersonPlace place;
    double time = 0.0;
    cv::Size picture;
    MaskInput mask_input;  ///< of the last picture
    cv::Mat mask;          ///< the last that was computed
    double mask_time = 0.0;
    bool own_mask = false;  ///< the mask is that of the last picture
    std::optional<TrunkFacing> facing;
  };
  bool is_followed(const PoseLandmarks& landmarks, double time) const;
  std::optional<SeenPerson> detected(const cv::Mat& picture, double time);
  /// Counts the people, once a second. Returns whether somebody much nearer to the camera has been there for
  /// a while.
  bool count(const cv::Mat& picture, const PersonPlace& person, double time);

  std::shared_ptr<PoseNetworks> networks_;
  std::optional<Followed> followed_;
  bool found_ = false;               ///< somebody, in the last picture
  bool switched_ = false;            ///< to somebody else, in the last picture
  bool went_over_ = false;           ///< to somebody nearer, in some picture before
  std::optional<PersonPlace> last_;  ///< where somebody was found last
  int people_ = 0;
  std::optional<double> counted_;       ///< when the people were counted
  std::optional<double> nearer_since_;  ///< since when somebody is much nearer than the person, s
};

/// The landmarks in the pixels of the same picture at another size, without the mask.
PoseLandmarks scaled_to(PoseLandmarks landmarks, cv::Size from, cv::Size to);

/// The square in which a detector of frontal faces sees this head, in pixels of the landmarks. Empty if the
/// face is not in the picture.
std::optional<cv::Rect2d> face_square(const PoseLandmarks& landmarks);

/// What a person mask (CV_8UC1, 255 is 1) adds to the energy of the background: positive inside the person.
/// -2 ln of the odds, within +-`most`.
cv::Mat mask_energy(const cv::Mat& mask, float most);

}  // namespace telemime
