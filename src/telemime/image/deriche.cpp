// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/deriche.h"

#include <cmath>
#include <opencv2/core.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

/// A second-order recursive filter as the sum of a pass down and a pass up the image:
/// down[n] = a0 x[n] + a1 x[n-1] + b1 down[n-1] + b2 down[n-2]
/// up[n]   =           c1 x[n+1] + c2 x[n+2] + b1 up[n+1] + b2 up[n+2]
struct Recursion {
  float a0, a1, c1, c2, b1, b2;
};

/// Smoothing filter with sum 1.
Recursion smoothing(double alpha) {
  const double q = std::exp(-alpha);
  const double k = (1 - q) * (1 - q) / (1 + 2 * alpha * q - q * q);
  return {static_cast<float>(k),
          static_cast<float>(k * q * (alpha - 1)),
          static_cast<float>(k * q * (alpha + 1)),
          static_cast<float>(-k * q * q),
          static_cast<float>(2 * q),
          static_cast<float>(-q * q)};
}

/// Derivative filter with gain 1 for a ramp.
Recursion derivative(double alpha) {
  const double q = std::exp(-alpha);
  // The response to a unit ramp is twice the sum of n^2 q^n over n >= 1, which is q (1 + q) / (1 - q)^3.
  const double k = std::pow(1 - q, 3) / (2 * (1 + q));
  return {0.0F, static_cast<float>(-k),    static_cast<float>(k),
          0.0F, static_cast<float>(2 * q), static_cast<float>(-q * q)};
}

/// Filters each column. The inner loop runs over columns, so it is vectorised. A replicated border is
/// equivalent to starting each recursion from its response to a constant.
cv::Mat filter_columns(const cv::Mat& in, const Recursion& f) {
  const int rows = in.rows;
  const int columns = in.cols;
  cv::Mat out(rows, columns, CV_32FC1);
  cv::Mat state(5, columns, CV_32FC1);
  const float feedback = 1 - f.b1 - f.b2;

  // Down: starts from the response to the first row.
  const float down_gain = (f.a0 + f.a1) / feedback;
  auto* before = state.ptr<float>(0);
  const auto* first = in.ptr<float>(0);
  for (int c = 0; c < columns; ++c) {
    before[c] = down_gain * first[c];
  }
  for (int r = 0; r < rows; ++r) {
    const auto* x = in.ptr<float>(r);
    const auto* x1 = in.ptr<float>(r > 0 ? r - 1 : 0);
    const float* y1 = r > 0 ? out.ptr<float>(r - 1) : before;
    const float* y2 = r > 1 ? out.ptr<float>(r - 2) : before;
    auto* y = out.ptr<float>(r);
    for (int c = 0; c < columns; ++c) {
      y[c] = f.a0 * x[c] + f.a1 * x1[c] + f.b1 * y1[c] + f.b2 * y2[c];
    }
  }

  // Up: starts from the response to the last row.
  const float up_gain = (f.c1 + f.c2) / feedback;
  const auto* last = in.ptr<float>(rows - 1);
  for (int s = 0; s < 3; ++s) {
    auto* u = state.ptr<float>(s);
    for (int c = 0; c < columns; ++c) {
      u[c] = up_gain * last[c];
    }
  }
  for (int r = rows - 1, turn = 0; r >= 0; --r, ++turn) {
    const auto* x1 = in.ptr<float>(r + 1 < rows ? r + 1 : rows - 1);
    const auto* x2 = in.ptr<float>(r + 2 < rows ? r + 2 : rows - 1);
    const auto* u1 = state.ptr<float>((turn + 2) % 3);
    const auto* u2 = state.ptr<float>((turn + 1) % 3);
    auto* u = state.ptr<float>(turn % 3);
    auto* sum = state.ptr<float>(3);
    auto* y = out.ptr<float>(r);
    for (int c = 0; c < columns; ++c) {
      sum[c] = f.c1 * x1[c] + f.c2 * x2[c] + f.b1 * u1[c] + f.b2 * u2[c];
    }
    for (int c = 0; c < columns; ++c) {
      u[c] = sum[c];
      y[c] += sum[c];
    }
  }
  return out;
}

}  // namespace

Gradient deriche_gradient(const cv::Mat& grey, double alpha) {
  if (grey.empty() || grey.channels() != 1) {
    throw Error(ErrorKind::usage, "the edge filter needs a grey image with at least one pixel");
  }
  if (!(alpha > 0 && alpha <= 10)) {
    throw Error(ErrorKind::usage, "alpha of the edge filter is " + std::to_string(alpha),
                "use a value above 0 and up to 10, for instance 1");
  }
  cv::Mat image;
  grey.convertTo(image, CV_32FC1);
  const Recursion smooth = smoothing(alpha);
  const Recursion derive = derivative(alpha);

  const auto transposed = [](const cv::Mat& m) {
    cv::Mat t;
    cv::transpose(m, t);
    return t;
  };
  // Each derivative is smoothed along the other axis. Rows are filtered as columns of the transposed image.
  Gradient gradient;
  gradient.dx = transposed(filter_columns(transposed(filter_columns(image, smooth)), derive));
  gradient.dy = filter_columns(transposed(filter_columns(transposed(image), smooth)), derive);
  return gradient;
}

}  // namespace telemime
