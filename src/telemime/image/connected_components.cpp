// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/connected_components.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

/// The first column at or after `from` that is set, or `columns`.
int next_set(const unsigned char* row, int from, int columns) {
  int c = from;
  for (std::uint64_t eight = 0; c + 8 <= columns; c += 8) {
    std::memcpy(&eight, row + c, sizeof eight);
    if (eight != 0) {
      break;
    }
  }
  while (c < columns && row[c] == 0) {
    ++c;
  }
  return c;
}

/// The first column at or after `from` that is not set, or `columns`.
int next_unset(const unsigned char* row, int from, int columns) {
  const void* found = std::memchr(row + from, 0, static_cast<std::size_t>(columns - from));
  return found != nullptr ? static_cast<int>(static_cast<const unsigned char*>(found) - row) : columns;
}

/// Disjoint sets of runs; the first run represents its set.
class Sets {
 public:
  void add() { parent_.push_back(parent_.size()); }
  std::size_t first_of(std::size_t run) {
    while (parent_[run] != run) {
      parent_[run] = parent_[parent_[run]];
      run = parent_[run];
    }
    return run;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t x = first_of(a);
    const std::size_t y = first_of(b);
    parent_[std::max(x, y)] = std::min(x, y);
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

ConnectedComponents::ConnectedComponents(const cv::Mat& mask, Connectivity connectivity) {
  if (mask.type() != CV_8UC1) {
    throw Error(ErrorKind::usage, "connected components: the type of the mask is not CV_8UC1");
  }
  const int corner = connectivity == Connectivity::eight ? 1 : 0;
  // Find the runs, and join each with the runs of the row above that it touches.
  std::vector<PixelRun> found;
  Sets sets;
  std::size_t above = 0;  // first run of the row above that can still touch
  for (int r = 0; r < mask.rows; ++r) {
    const auto* row = mask.ptr<unsigned char>(r);
    const std::size_t below = found.size();
    for (int c = next_set(row, 0, mask.cols); c < mask.cols; c = next_set(row, c, mask.cols)) {
      const PixelRun run{r, c, next_unset(row, c, mask.cols)};
      c = run.last;
      const std::size_t index = found.size();
      found.push_back(run);
      sets.add();
      while (above < below && found[above].last + corner <= run.first) {
        ++above;
      }
      for (std::size_t i = above; i < below && found[i].first < run.last + corner; ++i) {
        sets.join(i, index);
      }
    }
    above = below;
  }

  // Number the sets by their first runs and accumulate areas and boxes.
  constexpr std::size_t kNone = SIZE_MAX;
  std::vector<std::size_t> component_of(found.size(), kNone);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::size_t first = sets.first_of(i);
    if (first == i) {
      component_of[i] = components_.size();
      components_.push_back({0, cv::Rect(found[i].first, found[i].row, 0, 0)});
    }
    component_of[i] = component_of[first];
    Component& component = components_[component_of[i]];
    const PixelRun& run = found[i];
    component.area += run.last - run.first;
    component.box |= cv::Rect(run.first, run.row, run.last - run.first, 1);
    ++component.run_count;
  }
  // Sort the runs by component.
  std::size_t start = 0;
  for (Component& component : components_) {
    component.first_run = std::exchange(start, start + component.run_count);
  }
  runs_.resize(found.size());
  std::vector<std::size_t> next(components_.size());
  std::transform(components_.begin(), components_.end(), next.begin(),
                 [](const Component& component) { return component.first_run; });
  for (std::size_t i = 0; i < found.size(); ++i) {
    runs_[next[component_of[i]]++] = found[i];
  }
}

void ConnectedComponents::paint(const Component& component, unsigned char value, cv::Mat& image,
                                const cv::Point& origin) const {
  for (const PixelRun& run : runs(component)) {
    auto* row = image.ptr<unsigned char>(run.row - origin.y);
    std::fill(row + (run.first - origin.x), row + (run.last - origin.x), value);
  }
}

}  // namespace telemime
