// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace telemime {
namespace {

// Canvas: 4 x 3 pictures are laid out in units of 1/1600 of the width, the middle of the image at (800, 600).
// Other shapes see more or less at the top and bottom.
constexpr double kUnits = 1600.0;

struct Canvas {
  cv::Mat image;  // CV_8UC3
  double scale;   // pixels per unit
  double top;     // unit row of the first canvas row

  cv::Point at(double x, double y) const { return {cvRound(x * scale), cvRound((y - top) * scale)}; }
  void box(double x, double y, double w, double h, const cv::Scalar& colour) {
    cv::rectangle(image, at(x, y), at(x + w, y + h) - cv::Point(1, 1), colour, cv::FILLED);
  }
};

cv::Scalar shade(const cv::Scalar& c, double factor) {
  return {std::min(c[0] * factor, 255.0), std::min(c[1] * factor, 255.0), std::min(c[2] * factor, 255.0)};
}

// Smooth noise of zero mean, `cells` blobs across the canvas.
cv::Mat cloud(const cv::Size& size, int cells, double deviation, Random& random) {
  cv::Mat coarse(std::max(cells * size.height / size.width, 2), cells, CV_32F);
  for (int y = 0; y < coarse.rows; ++y) {
    for (int x = 0; x < coarse.cols; ++x) {
      coarse.at<float>(y, x) = static_cast<float>(random.normal(0.0, deviation));
    }
  }
  cv::Mat fine;
  cv::resize(coarse, fine, size, 0, 0, cv::INTER_CUBIC);
  return fine;
}

void add_cloud(cv::Mat& image, const cv::Mat& noise) {
  cv::Mat noise3;
  cv::merge(std::array<cv::Mat, 3>{noise, noise, noise}, noise3);
  cv::Mat sum;
  cv::add(image, noise3, sum, cv::noArray(), CV_8U);
  image = sum;
}

void draw_window(Canvas& c, double x, double y, Random& random) {
  const double w = 390;
  const double h = 430;
  c.box(x + 10, y + 12, w + 14, h + 14, {104, 106, 108});  // its shadow on the wall
  c.box(x, y, w, h, {92, 94, 98});
  c.box(x + 18, y + 18, w - 36, h - 36, {206, 208, 208});
  const double horizon = random.uniform(0.58, 0.72);
  const cv::Rect glass(c.at(x + 30, y + 30), c.at(x + w - 30, y + h - 30));
  const cv::Rect seen = glass & cv::Rect({0, 0}, c.image.size());
  const double phase = random.uniform(0.0, 6.0);
  for (int v = seen.y; v < seen.br().y; ++v) {
    const double down = static_cast<double>(v - glass.y) / glass.height;
    for (int u = seen.x; u < seen.br().x; ++u) {
      const double across = static_cast<double>(u - glass.x) / glass.width;
      const double hills = horizon + 0.03 * std::sin(9.0 * across + phase) + 0.012 * std::sin(37.0 * across);
      auto& pixel = c.image.at<cv::Vec3b>(v, u);
      if (down < hills) {
        pixel = {cv::saturate_cast<uchar>(238 - 20 * down), cv::saturate_cast<uchar>(206 + 34 * down),
                 cv::saturate_cast<uchar>(176 + 52 * down)};
      } else {
        const double deep = down - hills;
        pixel = {cv::saturate_cast<uchar>(86 - 60 * deep), cv::saturate_cast<uchar>(122 - 50 * deep),
                 cv::saturate_cast<uchar>(96 - 70 * deep)};
      }
    }
  }
  c.box(x + w / 2 - 8, y + 18, 16, h - 36, {206, 208, 208});
  c.box(x + 18, y + 0.42 * h, w - 36, 14, {206, 208, 208});
}

void draw_shelf(Canvas& c, double x, double y, double w, const cv::Scalar& accent, Random& random) {
  c.box(x + 8, y + 22, w, 26, {112, 114, 116});
  const std::array<cv::Scalar, 6> covers = {
      {{60, 56, 54}, {150, 146, 140}, accent, shade(accent, 0.6), {96, 84, 66}, {178, 178, 172}}};
  double at = x + 8;
  while (at < x + w - 40) {
    const double thick = random.uniform(14, 34);
    const double tall = random.uniform(92, 142);
    const cv::Scalar colour = shade(covers[random.below(covers.size())], random.uniform(0.75, 1.15));
    if (random.uniform() < 0.06) {
      at += random.uniform(16, 46);
      continue;
    }
    c.box(at, y - tall, thick, tall, colour);
    c.box(at + 0.72 * thick, y - tall, 0.28 * thick, tall, shade(colour, 0.72));
    if (random.uniform() < 0.6) {
      c.box(at + 0.15 * thick, y - random.uniform(0.45, 0.8) * tall, 0.5 * thick, 10, shade(colour, 1.6));
    }
    at += thick + 1.5;
  }
  c.box(x, y, w, 20, {52, 50, 50});
  c.box(x, y, w, 5, {82, 80, 80});
}

void draw_picture(Canvas& c, double x, double y, double w, double h, const cv::Scalar& accent,
                  Random& random) {
  c.box(x + 7, y + 9, w, h, {116, 118, 120});
  c.box(x, y, w, h, {54, 54, 58});
  c.box(x + 7, y + 7, w - 14, h - 14, {196, 194, 190});
  cv::Mat inside = c.image(cv::Rect(c.at(x + 16, y + 16), c.at(x + w - 16, y + h - 16)) &
                           cv::Rect({0, 0}, c.image.size()));
  for (int i = 0; i < 18; ++i) {
    const cv::Point centre(static_cast<int>(random.below(static_cast<std::uint32_t>(inside.cols))),
                           static_cast<int>(random.below(static_cast<std::uint32_t>(inside.rows))));
    const cv::Size axes(cvRound(c.scale * random.uniform(12, 60)), cvRound(c.scale * random.uniform(10, 46)));
    const double tone = random.uniform(0.4, 1.5);
    cv::ellipse(inside, centre, axes, random.uniform(0, 180), 0, 360, shade(accent, tone), cv::FILLED,
                cv::LINE_AA);
  }
}

void draw_notice(Canvas& c, double x, double y, double w, double h, const cv::Scalar& accent,
                 Random& random) {
  c.box(x + 6, y + 8, w, h, {118, 120, 122});
  c.box(x, y, w, h, {70, 70, 72});
  c.box(x + 4, y + 4, w - 8, h - 8, {204, 206, 204});
  c.box(x + 16, y + 16, w - 32, 0.32 * h, shade(accent, 0.9));
  const int lines = static_cast<int>(std::ceil((0.54 * h - 18) / 16));
  for (int i = 0; i < lines; ++i) {
    c.box(x + 16, y + 0.46 * h + 16 * i, (w - 32) * random.uniform(0.5, 1.0), 6, {96, 96, 98});
  }
}

}  // namespace

Backdrop make_backdrop(const Camera& camera, int shirt_index, Random& random) {
  // BGR: blue, teal, green, violet, slate - in the order of kShirts in avatar.cpp.
  const std::array<cv::Scalar, 5> accents = {
      {{168, 112, 52}, {140, 128, 44}, {92, 132, 62}, {150, 74, 108}, {128, 92, 70}}};
  const auto shirt = static_cast<std::size_t>(shirt_index);
  const cv::Scalar& accent = accents[(shirt + 1 + random.below(3)) % accents.size()];
  const cv::Scalar& accent2 = accents[(shirt + 4) % accents.size()];

  // Drawn several times larger, so that the reduction makes clean edges.
  const int over = std::max(2, static_cast<int>(std::ceil(1280.0 / camera.width)));
  Canvas c;
  c.image = cv::Mat(camera.height * over, camera.width * over, CV_8UC3);
  c.scale = camera.width * over / kUnits;
  c.top = 600.0 - 0.5 * c.image.rows / c.scale;
  const double warm = random.uniform(-4.0, 4.0);
  c.image.setTo(cv::Scalar(176 - warm, 176, 172 + warm));
  add_cloud(c.image, cloud(c.image.size(), 9, 3.0, random));
  add_cloud(c.image, cloud(c.image.size(), 60, 1.6, random));

  const bool window_left = random.uniform() < 0.5;
  const auto across = [&](double x, double w) { return window_left ? kUnits - x - w : x; };
  const double jitter = random.uniform(-30, 30);
  draw_window(c, across(1130 + jitter, 390), 165 + random.uniform(-30, 30), random);
  for (const double y : {215.0, 520.0, 815.0}) {
    const double w = random.uniform(430, 500);
    const double edge = random.uniform(-40, 0);
    draw_shelf(c, window_left ? kUnits - edge - w : edge, y + random.uniform(-15, 15), w, accent, random);
  }
  draw_picture(c, across(560 + jitter, 210), 150 + random.uniform(-30, 40), 210, 280, accent2, random);
  draw_picture(c, across(880 + jitter, 200), 540 + random.uniform(-30, 30), 200, 230, accent, random);
  draw_notice(c, across(850 - jitter, 190), 190 + random.uniform(-20, 20), 190, 240, accent2, random);
  draw_notice(c, across(1240 + jitter, 200), 700 + random.uniform(-20, 20), 200, 250, accent, random);

  Backdrop backdrop;
  backdrop.distance = random.uniform(2.2, 2.6);
  cv::Mat small;
  cv::resize(c.image, small, cv::Size(camera.width, camera.height), 0, 0, cv::INTER_AREA);
  small.convertTo(backdrop.albedo, CV_32FC3, 1.0 / 255.0);
  backdrop.albedo = backdrop.albedo.mul(backdrop.albedo);
  return backdrop;
}

}  // namespace telemime
