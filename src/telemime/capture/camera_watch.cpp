// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/camera_watch.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "telemime/capture/picture.h"

namespace telemime {
namespace {

constexpr double kFew = 10.0;      // frames per second
constexpr double kEnough = 12.0;   // hysteresis
constexpr double kShortest = 2.0;  // s, shortest interval of the measurement
constexpr double kLongest = 3.0;
constexpr double kSecond = 1.01;  // s, so that five frames per second are five intervals
constexpr double kGap = 1.5;      // s without an image: the camera stopped and was not slow
constexpr std::size_t kDamages = 3;
constexpr double kDamageSpan = 2.0;  // s
constexpr double kWhole = 3.0;       // s

using Kind = SourceNews::Kind;
using Matter = SourceNews::Matter;

std::string seconds(double s) {
  std::ostringstream text;
  text.precision(1);
  text << std::fixed << s << " s";
  return text.str();
}

}  // namespace

std::optional<SourceNews> CameraWatch::back(double taken) {
  const double away = taken - newest_;
  newest_ = taken;
  if (stopped_) {
    outcome_ = "it was opened again";
  }
  const bool was_away = stopped_ || gone_;
  stopped_ = false;
  gone_ = false;
  if (!was_away) {
    return std::nullopt;
  }
  taken_.clear();
  return SourceNews{Kind::better, "the camera is back after " + seconds(away)};
}

std::optional<SourceNews> CameraWatch::size(cv::Size size) {
  if (size == last_) {
    return std::nullopt;
  }
  last_ = size;
  if (size == first_) {
    return SourceNews{Kind::better, "the camera images have " + in_words(first_) + " pixels again",
                      Matter::size};
  }
  const std::string change =
      "the camera images now have " + in_words(size) + " pixels instead of " + in_words(first_);
  if (same_shape(size, first_)) {
    return SourceNews{Kind::worse, change + "; they are resized, and tracking continues", Matter::size};
  }
  return SourceNews{Kind::worse,
                    change +
                        ", which is another aspect ratio: they get black bars, and poses may be wrong. "
                        "Restore the settings of the camera, or start again",
                    Matter::size};
}

std::optional<SourceNews> CameraWatch::rate(double taken) {
  if (!taken_.empty() && taken - taken_.back() > kGap) {
    taken_.clear();
  }
  taken_.push_back(taken);
  while (taken - taken_.front() > kLongest) {
    taken_.pop_front();
  }
  const double span = taken - taken_.front();
  if (span < kShortest) {
    return std::nullopt;
  }
  const double now = static_cast<double>(taken_.size() - 1) / span;
  // The message states the rate of the last second: it may have changed within the interval.
  const auto recent =
      std::find_if(taken_.begin(), taken_.end(), [taken](double time) { return taken - time < kSecond; });
  const double words =
      recent + 1 == taken_.end() ? now : static_cast<double>(taken_.end() - recent - 1) / (taken - *recent);
  const std::string pictures = std::to_string(std::lround(words)) + " frames per second";
  if (!few_ && now < kFew) {
    few_ = true;
    return SourceNews{
        Kind::worse,
        "the camera delivers only " + pictures + ": fast motion is lost. Many cameras are slow in dim light",
        Matter::rate};
  }
  if (few_ && now > kEnough) {
    few_ = false;
    return SourceNews{Kind::better, "the camera delivers " + pictures + " again", Matter::rate};
  }
  return std::nullopt;
}

std::optional<SourceNews> CameraWatch::damaged(double now) {
  ++all_damaged_;
  damages_.push_back(now);
  while (damages_.size() > kDamages) {
    damages_.pop_front();
  }
  if (damage_reported_ || damages_.size() < kDamages || now - damages_.front() > kDamageSpan) {
    return std::nullopt;
  }
  damage_reported_ = true;
  return SourceNews{Kind::worse, "camera images are damaged and dropped: a bad cable or network?",
                    Matter::damage};
}

std::optional<SourceNews> CameraWatch::whole(double now) {
  if (!damage_reported_ || now - damages_.back() < kWhole) {
    return std::nullopt;
  }
  damage_reported_ = false;
  damages_.clear();
  return SourceNews{Kind::better, "the camera images are no longer damaged", Matter::damage};
}

std::optional<SourceNews> CameraWatch::stopped(double now) {
  if (stopped_) {
    return std::nullopt;  // it was opened again but delivered nothing
  }
  stopped_ = true;
  ++interruptions_;
  stopped_at_ = now - start_;
  outcome_ = "it did not come back";
  return SourceNews{Kind::worse, "the camera stopped; trying to open it again"};
}

std::optional<SourceNews> CameraWatch::silent() {
  if (gone_) {
    return std::nullopt;
  }
  gone_ = true;
  return SourceNews{Kind::gone, "the camera delivers no images at the moment; waiting for it"};
}

void CameraWatch::given_up(std::size_t attempts) {
  outcome_ = "it did not come back in " + std::to_string(attempts) + " attempts";
}

std::string CameraWatch::summary() const {
  Notes all;
  if (interruptions_ > 0) {
    all.add("it stopped " + (interruptions_ == 1 ? "once" : std::to_string(interruptions_) + " times") +
            ", last after " + seconds(stopped_at_) + "; " + outcome_);
  }
  if (all_damaged_ > 0) {
    all.add(std::to_string(all_damaged_) + " damaged images were dropped");
  }
  return all.text();
}

}  // namespace telemime
