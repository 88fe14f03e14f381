// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace telemime {

/// A line through points; points that are not finite leave a gap. x and y have the same size.
struct Series {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  /// Ends of a band around the line, such as the spread over several runs; as many as x, or none. Not drawn
  /// over a heat map.
  std::vector<double> low = {};
  std::vector<double> high = {};
};

struct LinePlot {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  bool from_zero = true;  ///< the y axis begins at 0
};

/// A grid of coloured cells, blue low, red high.
struct HeatMap {
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<double> x;      ///< of the columns, increasing
  std::vector<double> y;      ///< of the rows, increasing upwards
  std::vector<double> z;      ///< (rows x columns), a row after the other
  std::vector<Series> lines;  ///< drawn over the cells, in the units of x and y
};

/// Standalone SVG pictures, 640 x 400. Throw Error(usage) when sizes do not match.
std::string to_svg(const LinePlot& plot);
std::string to_svg(const HeatMap& map);

/// Up to `most` round numbers that cover [low, high], for the ticks of an axis.
std::vector<double> round_ticks(double low, double high, int most);

}  // namespace telemime
