// SPDX-License-Identifier: Apache-2.0
// Figures 2-22, 3-13, 3-14, 3-24, 3-25: residuals and errors by simplex size, stopping rule and kind of step.
#include <algorithm>

#include "lab/experiments/experiments.h"

namespace telemime {
namespace {

RegistrationConfig single_step(Method method, int evaluations) {
  RegistrationConfig config = reference_registration();
  config.method = method;
  config.iterations = evaluations + 1;
  return config;
}

// Percentage of the values that are at most the limit.
double share_below(const std::vector<double>& values, double limit) {
  return 100.0 - 100.0 * static_cast<double>(count_above(values, limit)) /
                     static_cast<double>(std::max<std::size_t>(1, values.size()));
}

// Means of several searches by gesture, and their values in each frame of joy.
struct Comparison {
  Table means;
  Table joy_frames;
  std::vector<double> joy;   ///< by search
  std::vector<double> mean;  ///< by search, over the gestures
};

Comparison compare_searches(Lab& lab, const std::string& title, const std::vector<std::string>& names,
                            const std::vector<RegistrationConfig>& searches,
                            std::vector<double> Trace::*measure) {
  Comparison result;
  result.means = {title, {"sequence"}, {}};
  result.means.columns.insert(result.means.columns.end(), names.begin(), names.end());
  result.mean.resize(searches.size());
  for (const PreparedSequence& sequence : lab.gestures()) {
    const auto traces = track_all(sequence, searches, lab.options().seed);
    result.means.rows.push_back({sequence.name});
    std::vector<Column> columns = {{"frame", traces.front().frame}};
    std::vector<double> values;
    for (std::size_t i = 0; i < searches.size(); ++i) {
      values.push_back(mean_of(traces[i].*measure));
      result.mean[i] += values.back() / static_cast<double>(lab.gestures().size());
      result.means.rows.back().push_back(number(values.back()));
      columns.push_back({names[i], traces[i].*measure});
    }
    if (sequence.name == "joy") {
      result.joy = values;
      result.joy_frames = table_of("frames of joy", columns);
    }
  }
  return result;
}

// Two searches on joy, frame by frame.
struct OnJoy {
  std::vector<Trace> traces;
  std::array<const char*, 2> names;

  Table frames(std::vector<double> Trace::*measure) const {
    return table_of(
        "frames of joy",
        {{"frame", traces[0].frame}, {names[0], traces[0].*measure}, {names[1], traces[1].*measure}});
  }
};

// 500 evaluations of one step against convergence, on joy.
Finding limited(Lab& lab, Method method, bool contour) {
  const OnJoy joy = {
      track_all(lab.gesture("joy"), {single_step(method, lab.to_convergence()), single_step(method, 500)},
                lab.options().seed),
      {"to convergence", "500 iterations"}};
  const auto& traces = joy.traces;
  const auto residual = contour ? &Trace::contour : &Trace::region;
  const std::string measure = contour ? "D_C (px)" : "F";
  const double threshold = contour ? lab.options().peaks.contour : lab.options().peaks.region;
  Table table{"means",
              {"search", "mean " + measure, "mistracked frames", "mean 2-D error (mm)", "mean 3-D error (mm)",
               "mean evaluations"},
              {}};
  for (std::size_t i = 0; i < traces.size(); ++i) {
    const auto& values = traces[i].*residual;
    table.rows.push_back(row_of(joy.names[i], mean_of(values), count_above(values, threshold),
                                mean_of(traces[i].error_2d), mean_of(traces[i].error_3d),
                                mean_of(traces[i].evaluations)));
  }
  const double to_the_end = mean_of(traces[0].*residual);
  const double stopped = mean_of(traces[1].*residual);
  return {
      .tables = {table, joy.frames(residual)},
      .notes = {"Convergence means that the costs of the simplex differ by less than 0.01 %, or that " +
                std::to_string(lab.to_convergence()) + " evaluations are used up. It took " +
                number(mean_of(traces[0].evaluations)) + " evaluations on average; " +
                number(share_below(traces[0].evaluations, 500.0)) +
                " % of the frames needed at most 500. Each frame starts from the previous frame's pose, so "
                "the two runs drift apart: the run that leaves a fast motion on the wrong side stays there."},
      .verdict =
          verdict({stopped >= to_the_end}, "stopping at 500 evaluations changes mean " + measure + " from " +
                                               number(to_the_end) + " to " + number(stopped) + ".")};
}

}  // namespace

Finding simplex_size(Lab& lab) {
  constexpr std::array<double, 3> kFactors = {0.5, 1.5, 3.0};
  std::vector<RegistrationConfig> searches;
  for (const double factor : kFactors) {
    searches.push_back(single_step(Method::regions, lab.to_convergence()));
    searches.back().simplex_factor = factor;
  }
  Comparison c =
      compare_searches(lab, "mean F", {"factor 0.5", "factor 1.5", "factor 3.0"}, searches, &Trace::region);
  c.means.rows.push_back(row_of("all four", c.mean[0], c.mean[1], c.mean[2]));
  const auto best = static_cast<std::size_t>(std::min_element(c.mean.begin(), c.mean.end()) - c.mean.begin());
  return {.tables = {c.means, c.joy_frames},
          .notes = {"The first simplex reaches the factor times each number's typical change from frame to "
                    "frame. A small one stays behind when the arm moves fast; a large one jumps between "
                    "minima and needs more evaluations."},
          .verdict = verdict({best == 1, c.mean[0] > c.mean[1]},
                             "the smallest mean F is that of factor " + number(kFactors[best]) + " (" +
                                 number(c.mean[0]) + ", " + number(c.mean[1]) + ", " + number(c.mean[2]) +
                                 " for 0.5, 1.5, 3.0).")};
}

Finding limited_regions(Lab& lab) {
  return limited(lab, Method::regions, false);
}

Finding limited_edges(Lab& lab) {
  return limited(lab, Method::edges, true);
}

Finding steps_to_convergence(Lab& lab) {
  const OnJoy joy = {track_all(lab.gesture("joy"),
                               {single_step(Method::regions, lab.to_convergence()),
                                single_step(Method::edges, lab.to_convergence())},
                               lab.options().seed),
                     {"regions", "edges"}};
  const double regions = mean_of(joy.traces[0].error_3d);
  const double edges = mean_of(joy.traces[1].error_3d);
  return {.tables = {{"means",
                      {"step", "mean 3-D error (mm)", "mean 2-D error (mm)"},
                      {row_of("regions", regions, mean_of(joy.traces[0].error_2d)),
                       row_of("edges", edges, mean_of(joy.traces[1].error_2d))}},
                     joy.frames(&Trace::error_3d)},
          .notes = {"Both start from the previous frame's pose. Edges alone can lock onto the wrong contour "
                    "in a fast motion, and then nothing pulls them back."},
          .verdict = verdict({edges < regions},
                             "regions " + number(regions) + " mm, edges " + number(edges) + " mm.")};
}

Finding steps_sharing(Lab& lab) {
  RegistrationConfig ours;
  ours.iterations = 501;
  const Comparison c = compare_searches(
      lab, "mean 3-D error (mm)", {"500 on regions", "500 on edges", "250 and 250", "ours, 500 in blocks"},
      {reference_with(500, 0), reference_with(0, 500), reference_with(250, 250), ours}, &Trace::error_3d);
  return {.tables = {c.means, c.joy_frames},
          .notes = {"'Ours' searches trunk and arms in turn with forearm directions, random arms, depth "
                    "flips, an upright trunk and a mild prior, but without the predicted motion and the "
                    "smoothing that `telemime track` adds."},
          .verdict = verdict({c.joy[2] < c.joy[0], c.joy[2] < c.joy[1]},
                             "on joy 250 + 250 gives " + number(c.joy[2]) + " mm, regions alone " +
                                 number(c.joy[0]) + " mm, edges alone " + number(c.joy[1]) +
                                 " mm; our search " + number(c.joy[3]) + " mm.")};
}

}  // namespace telemime
