// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

namespace telemime {

/// Which pixels touch: the four beside each, or those at its corners, too.
enum class Connectivity { four, eight };

/// Pixels [first, last) of one row.
struct PixelRun {
  int row = 0;
  int first = 0;
  int last = 0;
};

struct Component {
  int area = 0;  ///< pixels
  cv::Rect box;  ///< the smallest that holds it
  std::size_t first_run = 0;
  std::size_t run_count = 0;
};

/// The connected components of a mask, by runs (A. Rosenfeld and J. L. Pfaltz, Sequential operations in
/// digital picture processing, 1966): in the order of their first pixels, and their runs from the top down.
/// A silhouette has few runs: OpenCV's connectedComponentsWithStats, which writes and counts a label for
/// every pixel, took a third of the whole image side.
class ConnectedComponents {
 public:
  /// mask: (h x w) CV_8UC1, not zero where it is set. Throws Error(usage) for another type.
  ConnectedComponents(const cv::Mat& mask, Connectivity connectivity);

  std::span<const Component> all() const { return components_; }
  std::span<const PixelRun> runs(const Component& component) const {
    return std::span(runs_).subspan(component.first_run, component.run_count);
  }
  /// How many of the component's pixels satisfy `holds(row, column)`.
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
  /// Writes `value` where the component is; picture: CV_8UC1, the mask's `origin` at its first pixel.
  void paint(const Component& component, unsigned char value, cv::Mat& picture,
             const cv::Point& origin = {}) const;

 private:
  std::vector<PixelRun> runs_;  ///< those of one component after those of another
  std::vector<Component> components_;
};

}  // namespace telemime
