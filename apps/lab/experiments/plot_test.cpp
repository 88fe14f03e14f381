// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/plot.h"

#include <gtest/gtest.h>

#include <limits>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

std::size_t count(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    ++found;
  }
  return found;
}

TEST(RoundTicks, AreRoundAndInside) {
  EXPECT_EQ(round_ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const auto ticks = round_ticks(-0.37, 0.62, 7);
  ASSERT_GE(ticks.size(), 3U);
  EXPECT_GE(ticks.front(), -0.37);
  EXPECT_LE(ticks.back(), 0.62);
  EXPECT_LE(ticks.size(), 8U);
}

TEST(LinePlotSvg, DrawsOneLineForEachRunOfFinitePoints) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const LinePlot plot{"t", "x", "y", {{"a", {0, 1, 2, 3, 4}, {1, 2, nan, 3, 4}}, {"b", {0, 4}, {0, 1}}}};
  const std::string svg = to_svg(plot);
  // Two pieces of a, one of b, and a sample of each in the legend.
  EXPECT_EQ(count(svg, "<polyline"), 5U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find(">-0<"), std::string::npos);
  EXPECT_EQ(svg.rfind("<svg", 0), 0U);
}

TEST(LinePlotSvg, DrawsABandForEachSeriesThatHasOne) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Series banded{"a", {0, 1, 2}, {5, 5, 5}, {4, nan, 3}, {6, 7, 10}};
  const std::string svg = to_svg(LinePlot{"t", "x", "y", {banded, {"b", {0, 2}, {1, 1}}}});
  EXPECT_EQ(count(svg, "<polygon"), 1U);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  // The axis reaches to the end of the band.
  EXPECT_NE(svg.find(">10</text>"), std::string::npos);
  banded.high.pop_back();
  EXPECT_THROW(to_svg(LinePlot{"t", "x", "y", {banded}}), Error);
}

TEST(LinePlotSvg, SurvivesNothingToDraw) {
  EXPECT_NE(to_svg(LinePlot{"t", "x", "y", {{"a", {}, {}}}}).find("</svg>"), std::string::npos);
  EXPECT_NE(to_svg(LinePlot{"t", "x", "y", {{"a", {1}, {5}}}}).find("</svg>"), std::string::npos);
}

TEST(LinePlotSvg, EscapesWords) {
  const std::string svg = to_svg(LinePlot{"F < D_C & \"so\"", "x", "y", {}});
  EXPECT_NE(svg.find("F &lt; D_C &amp; &quot;so&quot;"), std::string::npos);
}

TEST(HeatMapSvg, LowestIsBlueHighestIsRed) {
  const std::string svg = to_svg(HeatMap{"t", "x", "y", {0, 50}, {0}, {1.0, 2.0}, {}});
  EXPECT_NE(svg.find("#2c54a0"), std::string::npos);
  EXPECT_NE(svg.find("#b42c28"), std::string::npos);
}

TEST(PlotSvg, RefusesSizesThatDoNotMatch) {
  EXPECT_THROW(to_svg(LinePlot{"t", "x", "y", {{"a", {1, 2}, {1}}}}), Error);
  EXPECT_THROW(to_svg(HeatMap{"t", "x", "y", {1, 2}, {1}, {1.0}, {}}), Error);
}

}  // namespace
}  // namespace telemime
