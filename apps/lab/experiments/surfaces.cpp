// SPDX-License-Identifier: Apache-2.0
// Figures 3-16 to 3-19, 3-26, 3-27: residuals, mistracked frames and errors over the grid of iterations.
#include <algorithm>

#include "lab/experiments/experiments.h"

namespace telemime {
namespace {

using Measure = double GridCell::*;

// (edge x region) values of one sequence.
std::vector<double> plane_of(const Grid& grid, std::size_t sequence, Measure measure) {
  std::vector<double> z;
  for (std::size_t e = 0; e < grid.steps.size(); ++e) {
    for (std::size_t r = 0; r < grid.steps.size(); ++r) {
      z.push_back(grid.at(sequence, e, r).*measure);
    }
  }
  return z;
}

std::vector<double> mean_plane(Lab& lab, Measure measure) {
  const Grid& grid = lab.grid();
  std::vector<double> mean(grid.steps.size() * grid.steps.size(), 0.0);
  for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
    const std::vector<double> plane = plane_of(grid, s, measure);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      mean[i] += plane[i] / static_cast<double>(lab.gestures().size());
    }
  }
  return mean;
}

Table grid_table(Lab& lab) {
  Table table{"grid",
              {"sequence", "region iterations", "edge iterations", "mean F", "mean D_C (px)",
               "mistracked by F", "mistracked by D_C", "2-D error (mm)", "3-D error (mm)"},
              {}};
  for (const GridCell& cell : lab.grid().cells) {
    table.rows.push_back({lab.gestures()[cell.sequence].name, std::to_string(cell.region),
                          std::to_string(cell.edge), number(cell.mean_region), number(cell.mean_contour),
                          number(cell.region_peaks), number(cell.contour_peaks), number(cell.error_2d),
                          number(cell.error_3d)});
  }
  return table;
}

struct Corners {
  double none, regions, edges, both;
};

Corners corners_of(const Grid& grid, const std::vector<double>& z) {
  const std::size_t n = grid.steps.size();
  return {z[0], z[n - 1], z[(n - 1) * n], z[n * n - 1]};
}

Finding with_grid(Lab& lab) {
  Finding finding;
  finding.tables = {grid_table(lab)};
  return finding;
}

std::string described(const Corners& c, const std::string& unit, double most) {
  const std::string full = number(most);
  return number(c.none) + unit + " without search, " + number(c.regions) + unit + " with " + full +
         " region iterations, " + number(c.edges) + unit + " with " + full + " edge iterations, " +
         number(c.both) + unit + " with both.";
}

// The part of the fall from no search to all regions that the first `x` region iterations bring.
double share_of_fall(const Grid& grid, const std::vector<double>& z, double x) {
  const Corners c = corners_of(grid, z);
  for (std::size_t r = 0; r < grid.steps.size(); ++r) {
    if (grid.steps[r] >= x) {
      return (c.none - z[r]) / (c.none - c.regions);
    }
  }
  return 1.0;
}

}  // namespace

Finding region_residuals(Lab& lab) {
  Finding finding = with_grid(lab);
  const Grid& grid = lab.grid();
  const auto z = mean_plane(lab, &GridCell::mean_region);
  const Corners c = corners_of(grid, z);
  const double early = share_of_fall(grid, z, 200.0);
  finding.notes = {"The first 200 region iterations bring " + number(100.0 * early) +
                   " % of what all of them bring."};
  finding.verdict = verdict({c.regions < c.none, c.regions<c.edges, early> 0.6},
                            "mean F is " + described(c, "", grid.steps.back()));
  return finding;
}

Finding contour_residuals(Lab& lab) {
  Finding finding = with_grid(lab);
  const Grid& grid = lab.grid();
  const auto z = mean_plane(lab, &GridCell::mean_contour);
  const Corners c = corners_of(grid, z);
  finding.notes = {
      "D_C is low wherever the contours lie on any edge, right or wrong; read it together with the errors of "
      "figures 3-26 and 3-27."};
  finding.verdict = verdict({c.both < c.regions, c.both < c.edges},
                            "mean D_C is " + described(c, " px", grid.steps.back()));
  return finding;
}

Finding region_mistrackings(Lab& lab) {
  Finding finding = with_grid(lab);
  const Grid& grid = lab.grid();
  const auto z = mean_plane(lab, &GridCell::region_peaks);
  double worst_after = 0.0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (grid.steps[i % grid.steps.size()] >= 200.0) {
      worst_after = std::max(worst_after, z[i]);
    }
  }
  const Corners c = corners_of(grid, z);
  finding.notes = {"With 200 region iterations or more, at most " + number(worst_after) +
                   " frames of a sequence are mistracked; with edges alone " + number(c.edges) + "."};
  finding.verdict = verdict({worst_after < 0.25 * c.none, c.regions < c.edges},
                            "frames with a peak of F: " + described(c, "", grid.steps.back()));
  return finding;
}

Finding contour_mistrackings(Lab& lab) {
  Finding finding = with_grid(lab);
  const Grid& grid = lab.grid();
  const auto z = mean_plane(lab, &GridCell::contour_peaks);
  const Corners c = corners_of(grid, z);
  finding.verdict = verdict({c.regions < c.none, c.both <= c.edges},
                            "frames with a peak of D_C: " + described(c, "", grid.steps.back()));
  return finding;
}

Finding surfaces_3d(Lab& lab) {
  Finding finding = with_grid(lab);
  const Grid& grid = lab.grid();
  const std::size_t n = grid.steps.size();
  Table table{"mean 3-D error (mm)", {"sequence", "no search", "regions", "edges", "both", "lowest"}, {}};
  bool always = true;
  std::vector<double> lowest;
  for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
    const auto z = plane_of(grid, s, &GridCell::error_3d);
    const Corners c = corners_of(grid, z);
    lowest.push_back(*std::min_element(z.begin(), z.end()));
    always = always && c.both <= lowest.back() * 1.02;
    table.rows.push_back({lab.gestures()[s].name, number(c.none), number(c.regions), number(c.edges),
                          number(c.both), number(lowest.back())});
  }
  finding.tables.insert(finding.tables.begin(), table);
  finding.notes = {"The largest search is " + std::to_string(static_cast<int>(grid.steps[n - 1])) + " + " +
                   std::to_string(static_cast<int>(grid.steps[n - 1])) +
                   " iterations. The remaining error is depth: poses that look alike from one camera."};
  const bool raising_best = std::min_element(lowest.begin(), lowest.end()) == lowest.begin();
  finding.verdict = verdict({!always, raising_best},
                            std::string("the largest search ") +
                                (always ? "is the best one on every gesture" : "is not always the best one") +
                                "; raising arms, the fronto-parallel gesture, " +
                                (raising_best ? "has" : "does not have") + " the lowest error.");
  return finding;
}

Finding surfaces_2d(Lab& lab) {
  Finding finding = with_grid(lab);
  const Grid& grid = lab.grid();
  Table table{"mean 2-D error (mm)", {"sequence", "no search", "regions", "edges", "both"}, {}};
  int falls = 0;
  for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
    const Corners c = corners_of(grid, plane_of(grid, s, &GridCell::error_2d));
    falls += c.both < c.none && c.both < c.edges ? 1 : 0;
    table.rows.push_back(
        {lab.gestures()[s].name, number(c.none), number(c.regions), number(c.edges), number(c.both)});
  }
  finding.tables.insert(finding.tables.begin(), table);
  const Corners mean = corners_of(grid, mean_plane(lab, &GridCell::error_2d));
  finding.verdict = verdict({falls == static_cast<int>(lab.gestures().size()), mean.both < mean.regions},
                            "the mean 2-D error is " + described(mean, " mm", grid.steps.back()));
  return finding;
}

}  // namespace telemime
