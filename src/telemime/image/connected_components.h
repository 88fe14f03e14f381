// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

namespace telemime {

/// Which pixels are neighbours: the four that share an edge, or also those that share a corner.
enum class Connectivity { four, eight };

/// The pixels [first, last) of a row.
struct PixelRun {
  int row = 0;
  int first = 0;
  int last = 0;
};

/// A connected set of pixels.
struct Component {
  int area = 0;  ///< pixels
  cv::Rect box;  ///< bounding box
  std::size_t first_run = 0;
  std::size_t run_count = 0;
};

/// The connected components of a mask, ordered by their first pixels, as runs of pixels from top to bottom
/// (A. Rosenfeld and J. L. Pfaltz, Sequential operations in digital picture processing, 1966). A silhouette
/// has few runs, so this is faster than OpenCV's connectedComponentsWithStats, which labels every pixel.
class ConnectedComponents {
 public:
  /// Finds the components of the pixels of `mask` ((h x w) CV_8UC1) that are not 0. Throws Error(usage) for
  /// another type.
  ConnectedComponents(const cv::Mat& mask, Connectivity connectivity);

  std::span<const Component> all() const { return components_; }
  /// The pixels of a component.
  std::span<const PixelRun> runs(const Component& component) const {
    return std::span(runs_).subspan(component.first_run, component.run_count);
  }
  /// The number of pixels of the component that satisfy `holds(row, column)`.
  template <typename Predicate>
  int count(const Component& component, Predicate holds) const {
    int n = 0;
    for (const PixelRun& run : runs(component)) {
      for (int c = run.first; c < run.last; ++c) {
        n += holds(run.row, c) ? 1 : 0;
      }
    }
    return n;
  }
  /// Writes `value` to the pixels of the component. `image` (CV_8UC1) starts at pixel `origin` of the mask.
  void paint(const Component& component, unsigned char value, cv::Mat& image,
             const cv::Point& origin = {}) const;

 private:
  std::vector<PixelRun> runs_;  ///< sorted by component
  std::vector<Component> components_;
};

}  // namespace telemime
