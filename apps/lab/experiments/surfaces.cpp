// SPDX-License-Identifier: Apache-2.0
// Figures 3-16 to 3-19, 3-26, 3-27: residuals, mistracked frames and errors over the grid of iterations.
#include <algorithm>

#include "lab/experiments/experiments.h"

namespace telemime {
namespace {

Table grid_table(Lab& lab) {
  Table table{"grid",
              {"sequence", "region iterations", "edge iterations", "mean F", "mean D_C (px)",
               "mistracked by F", "mistracked by D_C", "2-D error (mm)", "3-D error (mm)"},
              {}};
  for (const GridCell& cell : lab.grid().cells) {
    table.rows.push_back(row_of(lab.gestures()[cell.sequence].name, cell.region, cell.edge, cell.mean_region,
                                cell.mean_contour, cell.region_peaks, cell.contour_peaks, cell.error_2d,
                                cell.error_3d));
  }
  return table;
}

// A quantity over the grid of iterations: the mean of the gestures, or one of them.
struct CostSurface {
  std::vector<double> steps;
  std::vector<double> z;  // by edge, then region iterations

  double none() const { return z.front(); }
  double regions() const { return z[steps.size() - 1]; }
  double edges() const { return z[z.size() - steps.size()]; }
  double both() const { return z.back(); }
  std::string described(const std::string& unit) const {
    const std::string full = number(steps.back());
    return number(none()) + unit + " without search, " + number(regions()) + unit + " with " + full +
           " region iterations, " + number(edges()) + unit + " with " + full + " edge iterations, " +
           number(both()) + unit + " with both.";
  }
};

CostSurface mean_surface(Lab& lab, double GridCell::*measure) {
  return {lab.grid().steps, lab.grid().mean_plane(measure)};
}

CostSurface surface_of(Lab& lab, std::size_t sequence, double GridCell::*measure) {
  return {lab.grid().steps, lab.grid().plane(sequence, measure)};
}

}  // namespace

Finding region_residuals(Lab& lab) {
  const CostSurface f = mean_surface(lab, &GridCell::mean_region);
  // The part of the fall from no search to all regions that the first region iterations bring.
  const auto index =
      static_cast<std::size_t>(std::lower_bound(f.steps.begin(), f.steps.end(), 200.0) - f.steps.begin());
  const double early = (f.none() - f.z[index]) / (f.none() - f.regions());
  return {.tables = {grid_table(lab)},
          .notes = {"The first 200 region iterations bring " + number(100.0 * early) +
                    " % of what all of them bring."},
          .verdict = verdict({f.regions() < f.none(), f.regions() < f.edges(), early > 0.6},
                             "mean F is " + f.described(""))};
}

Finding contour_residuals(Lab& lab) {
  const CostSurface d = mean_surface(lab, &GridCell::mean_contour);
  return {.tables = {grid_table(lab)},
          .notes = {"D_C is low wherever the contours lie on any edge, right or wrong; read it together with "
                    "the errors of figures 3-26 and 3-27."},
          .verdict =
              verdict({d.both() < d.regions(), d.both() < d.edges()}, "mean D_C is " + d.described(" px"))};
}

Finding region_mistrackings(Lab& lab) {
  const CostSurface peaks = mean_surface(lab, &GridCell::region_peaks);
  double worst_after = 0.0;
  for (std::size_t i = 0; i < peaks.z.size(); ++i) {
    if (peaks.steps[i % peaks.steps.size()] >= 200.0) {
      worst_after = std::max(worst_after, peaks.z[i]);
    }
  }
  return {.tables = {grid_table(lab)},
          .notes = {"With 200 region iterations or more, at most " + number(worst_after) +
                    " frames of a sequence are mistracked; with edges alone " + number(peaks.edges()) + "."},
          .verdict = verdict({worst_after < 0.25 * peaks.none(), peaks.regions() < peaks.edges()},
                             "frames with a peak of F: " + peaks.described(""))};
}

Finding contour_mistrackings(Lab& lab) {
  const CostSurface peaks = mean_surface(lab, &GridCell::contour_peaks);
  return {.tables = {grid_table(lab)},
          .verdict = verdict({peaks.regions() < peaks.none(), peaks.both() <= peaks.edges()},
                             "frames with a peak of D_C: " + peaks.described(""))};
}

Finding surfaces_3d(Lab& lab) {
  Table table{"mean 3-D error (mm)", {"sequence", "no search", "regions", "edges", "both", "lowest"}, {}};
  bool always = true;
  std::vector<double> lowest;
  for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
    const CostSurface e = surface_of(lab, s, &GridCell::error_3d);
    lowest.push_back(*std::min_element(e.z.begin(), e.z.end()));
    always = always && e.both() <= lowest.back() * 1.02;
    table.rows.push_back(
        row_of(lab.gestures()[s].name, e.none(), e.regions(), e.edges(), e.both(), lowest.back()));
  }
  const std::string most = number(lab.grid().steps.back());
  const bool raising_best = std::min_element(lowest.begin(), lowest.end()) == lowest.begin();
  return {
      .tables = {table, grid_table(lab)},
      .notes = {"The largest search is " + most + " + " + most +
                " iterations. The remaining error is depth: poses that look alike from one camera."},
      .verdict = verdict({!always, raising_best},
                         std::string("the largest search ") +
                             (always ? "is the best one on every gesture" : "is not always the best one") +
                             "; raising arms, the fronto-parallel gesture, " +
                             (raising_best ? "has" : "does not have") + " the lowest error.")};
}

Finding surfaces_2d(Lab& lab) {
  Table table{"mean 2-D error (mm)", {"sequence", "no search", "regions", "edges", "both"}, {}};
  bool falls = true;
  for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
    const CostSurface e = surface_of(lab, s, &GridCell::error_2d);
    falls = falls && e.both() < e.none() && e.both() < e.edges();
    table.rows.push_back(row_of(lab.gestures()[s].name, e.none(), e.regions(), e.edges(), e.both()));
  }
  const CostSurface mean = mean_surface(lab, &GridCell::error_2d);
  return {.tables = {table, grid_table(lab)},
          .verdict = verdict({falls, mean.both() < mean.regions()},
                             "the mean 2-D error is " + mean.described(" mm"))};
}

}  // namespace telemime
