// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "lab/experiments/table.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr double kWidth = 640.0;
constexpr double kHeight = 400.0;
constexpr double kLeft = 68.0;
constexpr double kRight = 616.0;
constexpr double kTop = 40.0;
constexpr double kBottom = 344.0;
// Colours that stay apart for readers who see few of them; the dashes help, too.
constexpr std::array<const char*, 6> kColours = {"#1f4e9c", "#d1601f", "#2a8a4a",
                                                 "#8a3b8f", "#6b6b6b", "#b8860b"};
constexpr std::array<const char*, 6> kDashes = {"", "7 3", "2 3", "9 3 2 3", "4 2", "1 2"};

std::string text_at(double x, double y, const std::string& words, const std::string& more = {}) {
  char place[80];
  std::snprintf(place, sizeof place, "<text x=\"%.1f\" y=\"%.1f\" ", x, y);
  return place + more + ">" + escaped(words) + "</text>\n";
}

std::string rule(double x1, double y1, double x2, double y2, const char* colour) {
  char line[160];
  std::snprintf(line, sizeof line, "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n",
                x1, y1, x2, y2, colour);
  return line;
}

std::string rectangle(double x, double y, double w, double h, const std::string& fill) {
  char box[120];
  std::snprintf(box, sizeof box, "<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"", x, y,
                w, h);
  return box + fill + "\"/>\n";
}

std::string frame_of(const std::string& title, const std::string& x_label, const std::string& y_label) {
  char head[200];
  std::snprintf(head, sizeof head,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" "
                "height=\"%.0f\" font-family=\"sans-serif\" font-size=\"12\">\n",
                kWidth, kHeight, kWidth, kHeight);
  const double middle = 0.5 * (kTop + kBottom);
  return head + rectangle(0, 0, kWidth, kHeight, "white") +
         text_at(kWidth / 2, 22, title, "text-anchor=\"middle\" font-size=\"14\"") +
         text_at(0.5 * (kLeft + kRight), kHeight - 20, x_label, "text-anchor=\"middle\"") +
         text_at(16, middle, y_label,
                 "text-anchor=\"middle\" transform=\"rotate(-90 16 " + number(middle) + ")\"");
}

struct Axis {
  double low = 0.0;
  double high = 1.0;
  double from = 0.0;  ///< pixel of low
  double to = 1.0;    ///< pixel of high
  double at(double value) const { return from + (value - low) / (high - low) * (to - from); }
};

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void add(double value) {
    if (std::isfinite(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }
  void widen() {
    if (!(low <= high)) {
      low = 0.0;
      high = 1.0;
    }
    if (high - low < 1e-12 * std::max(1.0, std::abs(high))) {
      low -= 0.5;
      high += 0.5;
    }
  }
};

std::string stroke_of(std::size_t i) {
  return "stroke-width=\"1.6\" stroke=\"" + std::string(kColours[i % kColours.size()]) +
         "\" stroke-dasharray=\"" + kDashes[i % kDashes.size()] + "\"";
}

void require_sizes(bool match) {
  if (!match) {
    throw Error(ErrorKind::usage, "a plot's x and y must have as many numbers as its values");
  }
}

// Where each point of a series is; runs of finite points become one line each.
template <typename AtX, typename AtY>
std::string polyline(const Series& series, const std::string& stroke, const AtX& at_x, const AtY& at_y) {
  require_sizes(series.x.size() == series.y.size());
  std::string lines;
  std::string points;
  const auto flush = [&] {
    if (!points.empty()) {
      lines += "<polyline fill=\"none\" " + stroke + " points=\"" + points + "\"/>\n";
      points.clear();
    }
  };
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!std::isfinite(series.x[i]) || !std::isfinite(series.y[i])) {
      flush();
      continue;
    }
    char point[48];
    std::snprintf(point, sizeof point, "%.1f,%.1f ", at_x(series.x[i]), at_y(series.y[i]));
    points += point;
  }
  flush();
  return lines;
}

// The band of a series as one area; places without a finite end are left out.
std::string band(const Series& series, std::size_t i, const Axis& x, const Axis& y) {
  std::string there;
  std::string back;
  for (std::size_t k = 0; k < series.low.size(); ++k) {
    if (std::isfinite(series.x[k]) && std::isfinite(series.low[k]) && std::isfinite(series.high[k])) {
      char point[48];
      std::snprintf(point, sizeof point, "%.1f,%.1f ", x.at(series.x[k]), y.at(series.high[k]));
      there += point;
      std::snprintf(point, sizeof point, "%.1f,%.1f ", x.at(series.x[k]), y.at(series.low[k]));
      back.insert(0, point);
    }
  }
  return there.empty()
             ? ""
             : "<polygon stroke=\"none\" fill-opacity=\"0.16\" fill=\"" +
                   std::string(kColours[i % kColours.size()]) + "\" points=\"" + there + back + "\"/>\n";
}

std::string legend(const std::vector<Series>& series, double x, double y) {
  std::string svg;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const double row = y + 16.0 * static_cast<double>(i);
    const Series sample{"", {0.0, 1.0}, {0.0, 0.0}};
    svg += polyline(
        sample, stroke_of(i), [x](double t) { return x + 26.0 * t; }, [row](double) { return row - 4.0; });
    svg += text_at(x + 32.0, row, series[i].name);
  }
  return svg;
}

// t in [0, 1]: blue, pale, red.
std::string heat_colour(double t) {
  constexpr std::array<std::array<double, 3>, 3> kStops = {{{44, 84, 160}, {244, 238, 214}, {180, 44, 40}}};
  const double at = std::clamp(t, 0.0, 1.0) * 2.0;
  const std::size_t i = at < 1.0 ? 0 : 1;
  std::array<int, 3> c{};
  for (std::size_t k = 0; k < 3; ++k) {
    c[k] =
        static_cast<int>(std::lround(std::lerp(kStops[i][k], kStops[i + 1][k], at - static_cast<double>(i))));
  }
  char text[24];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", c[0], c[1], c[2]);
  return text;
}

// Cells have one width whatever their x: between the middles of two columns it goes on linearly.
double cell_position(const std::vector<double>& at, double value) {
  const auto next = std::upper_bound(at.begin(), at.end(), value);
  if (next == at.begin()) {
    return 0.5;
  }
  if (next == at.end()) {
    return static_cast<double>(at.size()) - 0.5;
  }
  const auto i = static_cast<std::size_t>(next - at.begin());
  return static_cast<double>(i) - 0.5 + (value - at[i - 1]) / (at[i] - at[i - 1]);
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int most) {
  const double raw = (high - low) / std::max(1, most);
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10.0 * power;
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= raw * (1.0 - 1e-9)) {
      step = factor * power;
      break;
    }
  }
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0) {
    ticks.push_back(k * step + 0.0);  // no -0
  }
  return ticks;
}

std::string to_svg(const LinePlot& plot) {
  Extent xs;
  Extent ys;
  for (const Series& s : plot.series) {
    require_sizes(s.x.size() == s.y.size());
    std::for_each(s.x.begin(), s.x.end(), [&](double v) { xs.add(v); });
    require_sizes(s.low.size() == s.high.size() && (s.low.empty() || s.low.size() == s.x.size()));
    for (const auto* values : {&s.y, &s.low, &s.high}) {
      std::for_each(values->begin(), values->end(), [&](double v) { ys.add(v); });
    }
  }
  if (plot.from_zero) {
    ys.add(0.0);
  }
  xs.widen();
  ys.widen();
  // Room above the lines for the names.
  const double room = 0.06 + 0.055 * static_cast<double>(plot.series.size());
  const Axis x{xs.low, xs.high, kLeft, kRight};
  const Axis y{ys.low, ys.high + room * (ys.high - ys.low), kBottom, kTop};
  std::string svg = frame_of(plot.title, plot.x_label, plot.y_label);
  for (const double tick : round_ticks(y.low, y.high, 7)) {
    svg += rule(kLeft, y.at(tick), kRight, y.at(tick), "#dddddd");
    svg += text_at(kLeft - 6, y.at(tick) + 4, number(tick), "text-anchor=\"end\"");
  }
  for (const double tick : round_ticks(x.low, x.high, 10)) {
    svg += rule(x.at(tick), kBottom, x.at(tick), kBottom + 4, "#444444");
    svg += text_at(x.at(tick), kBottom + 18, number(tick), "text-anchor=\"middle\"");
  }
  svg += rule(kLeft, kBottom, kRight, kBottom, "#444444") + rule(kLeft, kTop, kLeft, kBottom, "#444444");
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    svg += band(plot.series[i], i, x, y);
  }
  for (std::size_t i = 0; i < plot.series.size(); ++i) {
    svg += polyline(
        plot.series[i], stroke_of(i), [&](double v) { return x.at(v); }, [&](double v) { return y.at(v); });
  }
  return svg + legend(plot.series, kLeft + 12, kTop + 14) + "</svg>\n";
}

std::string to_svg(const HeatMap& map) {
  require_sizes(!map.x.empty() && !map.y.empty() && map.z.size() == map.x.size() * map.y.size());
  Extent range;
  std::for_each(map.z.begin(), map.z.end(), [&](double v) { range.add(v); });
  range.widen();
  const double right = kRight - 70.0;
  const double w = (right - kLeft) / static_cast<double>(map.x.size());
  const double h = (kBottom - kTop) / static_cast<double>(map.y.size());
  std::string svg = frame_of(map.title, map.x_label, map.y_label);
  const bool numbers = map.z.size() <= 64;
  for (std::size_t r = 0; r < map.y.size(); ++r) {
    for (std::size_t c = 0; c < map.x.size(); ++c) {
      const double z = map.z[r * map.x.size() + c];
      const double t = (z - range.low) / (range.high - range.low);
      const double left = kLeft + w * static_cast<double>(c);
      const double top = kBottom - h * static_cast<double>(r + 1);
      svg += rectangle(left, top, w + 0.5, h + 0.5, std::isfinite(z) ? heat_colour(t) : "#cccccc");
      if (numbers) {
        const bool dark = t < 0.25 || t > 0.8;
        svg += text_at(left + 0.5 * w, top + 0.5 * h + 4, number(z),
                       std::string("text-anchor=\"middle\" fill=\"") + (dark ? "white" : "#222222") + "\"");
      }
    }
  }
  const std::size_t every_x = (map.x.size() + 10) / 11;
  for (std::size_t c = 0; c < map.x.size(); c += every_x) {
    svg += text_at(kLeft + w * (static_cast<double>(c) + 0.5), kBottom + 18, number(map.x[c]),
                   "text-anchor=\"middle\"");
  }
  const std::size_t every_y = (map.y.size() + 10) / 11;
  for (std::size_t r = 0; r < map.y.size(); r += every_y) {
    svg += text_at(kLeft - 6, kBottom - h * (static_cast<double>(r) + 0.5) + 4, number(map.y[r]),
                   "text-anchor=\"end\"");
  }
  for (const Series& line : map.lines) {
    svg += polyline(
        line, "stroke-width=\"2\" stroke=\"black\"",
        [&](double v) { return kLeft + w * cell_position(map.x, v); },
        [&](double v) { return kBottom - h * cell_position(map.y, v); });
  }
  for (int i = 0; i < 32; ++i) {
    svg += rectangle(right + 16, kBottom - (kBottom - kTop) * (i + 1) / 32.0, 14, 10, heat_colour(i / 31.0));
  }
  svg += text_at(right + 34, kBottom, number(range.low)) + text_at(right + 34, kTop + 10, number(range.high));
  return svg + "</svg>\n";
}

}  // namespace telemime
