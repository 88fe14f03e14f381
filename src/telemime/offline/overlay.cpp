// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/overlay.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "telemime/render/renderer.h"

namespace telemime {
namespace {

const cv::Scalar kLeft(80, 200, 255);    // orange
const cv::Scalar kRight(255, 190, 70);   // light blue
const cv::Scalar kTrunk(120, 230, 120);  // green
const cv::Scalar kContour(255, 255, 255);
const cv::Scalar kInk(235, 235, 235);
const cv::Scalar kFaint(90, 90, 90);
const cv::Scalar kPanel(32, 30, 28);

struct Bone {
  Joint from, to;
  const cv::Scalar* colour;
};

const std::array<Bone, 11> kBones = {{{Joint::root, Joint::neck, &kTrunk},
                                      {Joint::neck, Joint::head, &kTrunk},
                                      {Joint::head, Joint::head_top, &kTrunk},
                                      {Joint::neck, Joint::l_shoulder, &kLeft},
                                      {Joint::l_shoulder, Joint::l_elbow, &kLeft},
                                      {Joint::l_elbow, Joint::l_wrist, &kLeft},
                                      {Joint::l_wrist, Joint::l_hand, &kLeft},
                                      {Joint::neck, Joint::r_shoulder, &kRight},
                                      {Joint::r_shoulder, Joint::r_elbow, &kRight},
                                      {Joint::r_elbow, Joint::r_wrist, &kRight},
                                      {Joint::r_wrist, Joint::r_hand, &kRight}}};

constexpr int kFractionBits = 4;  // of the coordinates that OpenCV draws with

cv::Point fixed(double u, double v) {
  const double scale = 1 << kFractionBits;
  const auto clip = [](double x) { return std::clamp(x, -1e5, 1e5); };
  return {static_cast<int>(std::lround(clip(u) * scale)), static_cast<int>(std::lround(clip(v) * scale))};
}

void draw_skeleton(cv::Mat& canvas, const OverlayView& view, const Camera& camera, double unit) {
  const int thick = std::max(1, static_cast<int>(std::lround(unit * 2.0)));
  const auto at = [&](Joint j) {
    const Eigen::Vector2d p = view.camera.pixel_in(camera, view.motion->pixels[static_cast<std::size_t>(j)]);
    return fixed(p.x(), p.y());
  };
  for (const Bone& bone : kBones) {
    cv::line(canvas, at(bone.from), at(bone.to), cv::Scalar(0, 0, 0), thick + 2, cv::LINE_AA, kFractionBits);
    cv::line(canvas, at(bone.from), at(bone.to), *bone.colour, thick, cv::LINE_AA, kFractionBits);
  }
  for (const Bone& bone : kBones) {
    cv::circle(canvas, at(bone.to), static_cast<int>(unit * 2.6 * (1 << kFractionBits)), *bone.colour,
               cv::FILLED, cv::LINE_AA, kFractionBits);
  }
}

// Eyes, irises, brows and lips.
void draw_face(cv::Mat& canvas, const OverlayView& view, double unit) {
  static const std::vector<std::vector<std::size_t>> kLines = {
      {33, 246, 161, 160, 159, 158, 157, 173, 133, 155, 154, 153, 145, 144, 163, 7, 33},
      {263, 466, 388, 387, 386, 385, 384, 398, 362, 382, 381, 380, 374, 373, 390, 249, 263},
      {469, 470, 471, 472, 469},
      {474, 475, 476, 477, 474},
      {70, 63, 105, 66, 107},
      {300, 293, 334, 296, 336},
      {61, 185, 40, 39, 37, 0, 267, 269, 270, 409, 291, 375, 321, 405, 314, 17, 84, 181, 91, 146, 61},
      {78, 191, 80, 81, 82, 13, 312, 311, 310, 415, 308, 324, 318, 402, 317, 14, 87, 178, 88, 95, 78}};
  const double scale = static_cast<double>(canvas.cols) / view.camera.width;
  for (const std::vector<std::size_t>& line : kLines) {
    for (std::size_t k = 1; k < line.size(); ++k) {
      const auto at = [&](std::size_t i) {
        const Eigen::Vector2d p = (view.face->points[i].pixel.array() + 0.5) * scale - 0.5;
        return fixed(p.x(), p.y());
      };
      cv::line(canvas, at(line[k - 1]), at(line[k]), kContour, std::max(1, static_cast<int>(unit)),
               cv::LINE_AA, kFractionBits);
    }
  }
}

// The fingers of hands that are seen.
void draw_hands(cv::Mat& canvas, const MotionFrame& motion, const Camera& camera, double unit) {
  constexpr double kNearest = 0.01;  // m
  const int thick = std::max(1, static_cast<int>(std::lround(unit)));
  for (std::size_t side = 0; motion.hands && side < 2; ++side) {
    const HandMotion& hand = (*motion.hands)[side];
    const auto at = [&](std::size_t joint) {
      Eigen::Vector3d p = hand.joints[joint];
      p.z() = std::max(p.z(), kNearest);
      const Eigen::Vector2d pixel = camera.project(p);
      return fixed(pixel.x(), pixel.y());
    };
    for (std::size_t joint = 1; hand.visibility > 0.0 && joint < kHandJointCount; ++joint) {
      const std::size_t parent = joint % 4 == 1 ? 0 : joint - 1;
      cv::line(canvas, at(parent), at(joint), cv::Scalar(0, 0, 0), thick + 2, cv::LINE_AA, kFractionBits);
      cv::line(canvas, at(parent), at(joint), side == 0 ? kLeft : kRight, thick, cv::LINE_AA, kFractionBits);
    }
  }
}

void draw_contour(cv::Mat& canvas, const OverlayView& view, const Camera& camera) {
  Rendering rendering;
  std::vector<Eigen::Vector2f> contour;
  render(view.model->mesh, forward_kinematics(view.model->body, view.motion->pose), camera, rendering);
  occluding_contour(view.model->mesh, rendering, contour);
  for (const Eigen::Vector2f& p : contour) {
    cv::circle(canvas, fixed(p.x(), p.y()), 1 << (kFractionBits - 1), kContour, cv::FILLED, cv::LINE_AA,
               kFractionBits);
  }
}

void text(cv::Mat& canvas, const std::string& words, cv::Point at, double unit, const cv::Scalar& colour) {
  cv::putText(canvas, words, at, cv::FONT_HERSHEY_SIMPLEX, 0.42 * unit, colour, 1, cv::LINE_AA);
}

// The 95 % region of a joint in the plane x-z.
void draw_spread(cv::Mat& panel, const Eigen::Matrix3d& covariance, cv::Point at, double pixels_a_metre,
                 const cv::Scalar& colour) {
  constexpr double kRadius =
      2.4477;  // standard deviations: the 95 % region of a normal distribution in a plane
  Eigen::Matrix2d plane;
  plane << covariance(0, 0), -covariance(0, 2), -covariance(2, 0),
      covariance(2, 2);  // z is up in the picture
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(plane);
  const auto half = [&](int i) {
    const double length = kRadius * std::sqrt(std::max(0.0, axes.eigenvalues()[i])) * pixels_a_metre;
    return std::max(1, static_cast<int>(length * (1 << kFractionBits)));
  };
  const Eigen::Vector2d major = axes.eigenvectors().col(1);
  const double degrees = std::atan2(major.y(), major.x()) * 180.0 / std::numbers::pi;
  cv::ellipse(panel, at, {half(1), half(0)}, degrees, 0.0, 360.0, 0.5 * colour, 1, cv::LINE_AA,
              kFractionBits);
}

// The scene from above: the camera at the lower edge, one ring each half metre.
void draw_top_view(cv::Mat& panel, const MotionFrame& motion, double unit) {
  const double range = 2.0 * std::max(0.5, std::ceil(motion.joints[Joint::neck].z() + 0.3)) / 2.0;
  const double pixels_a_metre = 0.86 * panel.rows / range;
  const double middle = panel.cols / 2.0;
  const auto at = [&](const Eigen::Vector3d& p) {
    return fixed(middle + p.x() * pixels_a_metre, panel.rows * 0.95 - p.z() * pixels_a_metre);
  };
  const int rings = static_cast<int>(std::floor(range / 0.5 + 0.02));
  for (int i = 1; i <= rings; ++i) {
    const double ring = 0.5 * i;
    cv::circle(panel, at(Eigen::Vector3d::Zero()),
               static_cast<int>(ring * pixels_a_metre * (1 << kFractionBits)), kFaint, 1, cv::LINE_AA,
               kFractionBits);
    const cv::Point label = at({0.0, 0.0, ring});
    std::array<char, 16> words{};
    std::snprintf(words.data(), words.size(), "%.1f m", ring);
    text(panel, words.data(), {label.x / (1 << kFractionBits) + 3, label.y / (1 << kFractionBits) - 3},
         0.8 * unit, kFaint);
  }
  cv::drawMarker(panel, {static_cast<int>(middle), static_cast<int>(panel.rows * 0.95)}, kInk,
                 cv::MARKER_TRIANGLE_UP, static_cast<int>(8 * unit), 1, cv::LINE_AA);
  if (motion.spread) {
    for (const auto& [joint, colour] :
         {std::pair{Joint::l_elbow, kLeft}, std::pair{Joint::l_wrist, kLeft},
          std::pair{Joint::r_elbow, kRight}, std::pair{Joint::r_wrist, kRight}}) {
      draw_spread(panel, motion.spread->covariance[static_cast<std::size_t>(joint)], at(motion.joints[joint]),
                  pixels_a_metre, colour);
    }
  }
  const int thick = std::max(1, static_cast<int>(std::lround(2.0 * unit)));
  for (const Bone& bone : kBones) {
    cv::line(panel, at(motion.joints[bone.from]), at(motion.joints[bone.to]), *bone.colour, thick,
             cv::LINE_AA, kFractionBits);
  }
  for (const Bone& bone : kBones) {
    cv::circle(panel, at(motion.joints[bone.to]), static_cast<int>(2.2 * unit * (1 << kFractionBits)),
               *bone.colour, cv::FILLED, cv::LINE_AA, kFractionBits);
  }
  text(panel, "from above", {static_cast<int>(6 * unit), static_cast<int>(14 * unit)}, unit, kInk);
}

void draw_gauge(cv::Mat& panel, const std::string& name, double value, double full, int row, double unit) {
  std::array<char, 32> words{};
  std::snprintf(words.data(), words.size(), "%s %.2f", name.c_str(), value);
  const int y = static_cast<int>((18 + 26 * row) * unit);
  text(panel, words.data(), {static_cast<int>(6 * unit), y}, unit, kInk);
  const cv::Rect bar(static_cast<int>(6 * unit), y + static_cast<int>(4 * unit),
                     panel.cols - static_cast<int>(12 * unit), std::max(2, static_cast<int>(6 * unit)));
  cv::rectangle(panel, bar, kFaint, 1);
  cv::Rect filled = bar;
  filled.width = static_cast<int>(bar.width * std::clamp(value / full, 0.0, 1.0));
  cv::rectangle(panel, filled, kTrunk, cv::FILLED);
}

}  // namespace

cv::Mat draw_overlay(const cv::Mat& image, const OverlayView& view) {
  const double unit = std::max(0.6, image.rows / 480.0);
  const int side = (static_cast<int>(image.cols * 0.42) + image.cols) / 2 * 2 - image.cols;
  cv::Mat canvas(image.rows / 2 * 2, (image.cols + side) / 2 * 2, CV_8UC3, kPanel);
  cv::Mat picture = canvas(cv::Rect(0, 0, image.cols, canvas.rows));
  image(cv::Rect(0, 0, image.cols, canvas.rows)).copyTo(picture);
  const bool tracking = view.motion->state == TrackState::tracking;
  cv::Mat panel = canvas(cv::Rect(image.cols, 0, canvas.cols - image.cols, canvas.rows));
  const int top_rows = static_cast<int>(panel.rows * 0.78);
  if (tracking) {
    const Camera camera = view.camera.scaled_to(image.cols, image.rows);
    draw_contour(picture, view, camera);
    draw_skeleton(picture, view, camera, unit);
    draw_hands(picture, *view.motion, camera, unit);
    cv::Mat top = panel.rowRange(0, top_rows);
    draw_top_view(top, *view.motion, unit);
  }
  if (view.face != nullptr) {
    draw_face(picture, view, unit);
  }
  cv::Mat gauges = panel.rowRange(top_rows, panel.rows);
  draw_gauge(gauges, "regions F", tracking ? view.motion->region_score : 0.0, 1.0, 0, unit);
  draw_gauge(gauges, "contours D_C px", tracking ? view.motion->contour_score : 0.0, 10.0, 1, unit);
  text(gauges, "frame " + std::to_string(view.motion->frame) + (tracking ? "  tracking" : "  LOST"),
       {static_cast<int>(6 * unit), static_cast<int>(72 * unit)}, unit,
       tracking ? kInk : cv::Scalar(80, 80, 255));
  if (!view.note.empty()) {
    const cv::Rect strip(0, picture.rows - static_cast<int>(20 * unit), picture.cols,
                         static_cast<int>(20 * unit));
    cv::rectangle(picture, strip, kPanel, cv::FILLED);
    text(picture, view.note, {static_cast<int>(6 * unit), picture.rows - static_cast<int>(6 * unit)}, unit,
         kInk);
  }
  return canvas;
}

}  // namespace telemime
