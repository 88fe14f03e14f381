// SPDX-License-Identifier: Apache-2.0
// What each cue and each heuristic of a particle filter contributes: each left out, each heuristic also
// alone.

#include "lab/experiments/experiments.h"
#include "telemime/tracking/heuristics/all.h"

namespace telemime {
namespace {

struct Variant {
  std::string name;
  FilterSweep sweep;
};

std::string list_of(const std::vector<const Heuristic*>& heuristics, const Heuristic* without) {
  std::string names;
  for (const Heuristic* heuristic : heuristics) {
    if (heuristic != without) {
      names.append(names.empty() ? "" : ",").append(heuristic->name);
    }
  }
  return names;
}

Variant measured_filter(Lab& lab, const std::string& name, FilterSetup setup, const std::string& heuristics) {
  lab.log("tracking the four gestures with " + name);
  setup.filter.heuristics = heuristics;
  return {name, lab.sweep_gestures({setup.filter.particles},
                                   [&](const PreparedSequence& sequence, int, std::uint64_t seed) {
                                     return track_filter(sequence, setup, seed);
                                   })};
}

// The filter as it is, each cue left out, each heuristic of its list left out, each heuristic alone, and
// none.
std::vector<Variant> variants_of(Lab& lab, const FilterSetup& setup) {
  const auto heuristics = parse_heuristics(setup.filter.heuristics);
  std::vector<Variant> variants;
  const auto add = [&](const std::string& name, const std::string& list) {
    variants.push_back(measured_filter(lab, name, setup, list));
  };
  add("everything: " + list_of(heuristics, nullptr), setup.filter.heuristics);
  for (std::size_t i = 0; i < setup.cues.size(); ++i) {
    const std::string name = "without the cue " + std::string(setup.cues[i].name);
    FilterSetup less = setup;
    less.cues.enable(i, false);
    variants.push_back(measured_filter(lab, name, less, setup.filter.heuristics));
  }
  for (const Heuristic* heuristic : heuristics) {
    add("without " + std::string(heuristic->name), list_of(heuristics, heuristic));
  }
  for (const Heuristic& heuristic : kHeuristics) {
    add(std::string(heuristic.name) + " alone", std::string(heuristic.name));
  }
  add("no heuristic", "");
  return variants;
}

Variant single_search(Lab& lab, const std::string& name, const RegistrationConfig& search) {
  lab.log("tracking the four gestures with " + name);
  return {name, lab.sweep_gestures({search.iterations},
                                   [&](const PreparedSequence& sequence, int, std::uint64_t seed) {
                                     return track_sequence(sequence, search, seed, "simd");
                                   })};
}

Table table_of(const std::string& title, const std::vector<Variant>& variants) {
  Table table{title,
              {"what", "3-D error (mm)", "2-D error (mm)", "mistracked frames", "jitter (mm/frame^2)",
               "evaluations / frame", "effective particles"},
              {}};
  for (const Variant& variant : variants) {
    std::vector<std::string> row = {variant.name};
    for (const FilterMeasure measure :
         {&FilterRun::error_3d, &FilterRun::error_2d, &FilterRun::mistracked, &FilterRun::jitter}) {
      row.push_back(mean_and_range(variant.sweep.over_sequences(0, measure)));
    }
    row.push_back(number(variant.sweep.mean_of_all(&FilterRun::evaluations)));
    row.push_back(number(variant.sweep.mean_of_all(&FilterRun::effective)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table by_gesture(Lab& lab, const std::string& title, const std::vector<Variant>& variants) {
  Table table{title, {"what"}, {}};
  for (const PreparedSequence& sequence : lab.gestures()) {
    table.columns.push_back(sequence.name);
  }
  for (const Variant& variant : variants) {
    table.rows.push_back({variant.name});
    for (std::size_t s = 0; s < lab.gestures().size(); ++s) {
      table.rows.back().push_back(mean_and_range(variant.sweep.at(s, 0, &FilterRun::error_3d)));
    }
  }
  return table;
}

// "wd +12 mm, ...": how the mean error changes when one is left out.
std::string cost_of_leaving_out(const std::vector<Variant>& variants, FilterMeasure measure,
                                const std::string& unit) {
  const double everything = variants.front().sweep.over_sequences(0, measure).mean;
  std::string list;
  for (const Variant& variant : variants) {
    if (variant.name.rfind("without ", 0) == 0) {
      const double change = variant.sweep.over_sequences(0, measure).mean - everything;
      list.append(list.empty() ? "" : ", ")
          .append(variant.name + (change < 0.0 ? " " : " +") + number(change) + unit);
    }
  }
  return list;
}

}  // namespace

Finding ablation(Lab& lab) {
  FilterSetup reference = reference_setup(kAllTogether);
  FilterSetup ours = our_setup();
  reference.filter.particles = 500;
  if (lab.options().quick) {
    reference.filter.particles = ours.filter.particles = ours.search.iterations = 100;
  }
  const std::vector<Variant> theirs = variants_of(lab, reference);
  const std::vector<Variant> own = variants_of(lab, ours);
  RegistrationConfig two_step =
      reference_with(reference.filter.particles / 2, reference.filter.particles / 2);
  const std::vector<Variant> single = {single_search(lab, "two-step registration, the thesis's", two_step),
                                       single_search(lab, "two-step registration, ours", ours.search)};
  const std::string of_theirs =
      "the thesis's filter, " + std::to_string(reference.filter.particles) + " particles";
  const std::string of_ours = "our filter, " + std::to_string(ours.filter.particles) + " particles";
  const auto error = [](const Variant& v) { return v.sweep.over_sequences(0, &FilterRun::error_3d).mean; };
  return {
      .tables = {table_of(of_theirs, theirs), table_of(of_ours, own),
                 table_of("one search from frame to frame", single),
                 by_gesture(lab, of_theirs + ", 3-D error (mm) by gesture", theirs),
                 by_gesture(lab, of_ours + ", 3-D error (mm) by gesture", own),
                 by_gesture(lab, "one search from frame to frame, 3-D error (mm) by gesture", single)},
      .notes =
          {"Means over the four gestures; in brackets the lowest and highest of the " +
               std::to_string(lab.seeds()) +
               " seeds. 'Without' leaves one cue or heuristic out of everything; 'alone' is that heuristic "
               "and no other. The single searches start from the last pose, without a prediction.",
           "Left out of the thesis's filter: " + cost_of_leaving_out(theirs, &FilterRun::error_3d, " mm") +
               "; " + cost_of_leaving_out(theirs, &FilterRun::mistracked, " frames") + ".",
           "Left out of ours: " + cost_of_leaving_out(own, &FilterRun::error_3d, " mm") + "; " +
               cost_of_leaving_out(own, &FilterRun::mistracked, " frames") + "."},
      .verdict = verdict(
          {error(theirs.front()) < error(theirs.back()), error(theirs.front()) < error(single.front())},
          "all heuristics together leave " + number(error(theirs.front())) + " mm, none " +
              number(error(theirs.back())) + " mm, one search from frame to frame " +
              number(error(single.front())) + " mm; ours " + number(error(own.front())) +
              " mm, our single search " + number(error(single.back())) + " mm.")};
}

}  // namespace telemime
