// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/config.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/likelihood/all.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

Error bad(const std::string& what) {
  return {ErrorKind::config, "configuration: " + what,
          "Names, units and defaults are in docs/configuration.md; `telemime config` prints them all."};
}

// Visits every setting as (path, reference), so that reading and writing cannot differ.
template <typename C, typename Visit>
void each_setting(C& c, Visit&& visit) {
  visit("seed", c.seed);
  visit("limits", c.limits);
  visit("backend", c.backend);
  visit("threads", c.threads);
  visit("camera/field_of_view", c.field_of_view);
  visit("budget_ms", c.budget_ms);
  visit("image/width", c.image.width);
  visit("image/height", c.image.height);
  visit("image/face_width", c.image.face_width);
  visit("image/background_rate", c.image.background_rate);
  visit("image/edges/alpha", c.image.edges.alpha);
  visit("image/edges/low", c.image.edges.low);
  visit("image/edges/high", c.image.edges.high);
  visit("image/edges/distance_cap", c.image.edges.distance_cap);
  visit("calibration/stature", c.calibration.stature);
  visit("calibration/nearest", c.calibration.nearest);
  visit("calibration/farthest", c.calibration.farthest);
  visit("calibration/rounds", c.calibration.rounds);
  visit("calibration/pose_iterations", c.calibration.pose_iterations);
  visit("calibration/fronto_parallel", c.calibration.fronto_parallel);
  visit("calibration/worst_region", c.calibration.worst_region);
  visit("calibration/arm_samples", c.calibration.arms.samples);
  visit("calibration/arm_kept", c.calibration.arms.kept);
  visit("calibration/arm_refine", c.calibration.arms.refine);
  visit("calibration/shape_iterations", c.calibration.shape.iterations);
  visit("calibration/look_ahead", c.calibration.look_ahead);
  visit("calibration/keyframes", c.calibration.refine.keyframes);
  visit("calibration/refine_iterations", c.calibration.refine.pose_iterations);
  visit("calibration/refine_rounds", c.calibration.refine.rounds);
  visit("calibration/refine_shapes", c.calibration.refine.shapes);
  visit("calibration/refine_prior_weight", c.calibration.refine.prior_weight);
  visit("calibration/refine_natural_weight", c.calibration.refine.natural_weight);
  visit("calibration/share_sides", c.calibration.shape.share_sides);
  visit("calibration/length_spread", c.calibration.shape.length_spread);
  visit("calibration/girth_spread", c.calibration.shape.girth_spread);
  visit("calibration/ratio_spread", c.calibration.shape.ratio_spread);
  visit("calibration/prior_weight", c.calibration.shape.prior_weight);
  visit("calibration/contour_weight", c.calibration.shape.contour_weight);
  visit("registration/method", c.registration.method);
  visit("registration/iterations", c.registration.iterations);
  visit("registration/region_share", c.registration.region_share);
  visit("registration/simplex_factor", c.registration.simplex_factor);
  visit("registration/edge_factor", c.registration.edge_factor);
  visit("registration/blocks", c.registration.blocks);
  visit("registration/rounds", c.registration.rounds);
  visit("registration/proposal_share", c.registration.proposal_share);
  visit("registration/proposals/directions", c.registration.proposals.directions);
  visit("registration/proposals/arms", c.registration.proposals.arms);
  visit("registration/proposals/flips", c.registration.proposals.flips);
  visit("registration/proposals/upright", c.registration.proposals.upright);
  visit("registration/proposals/kept", c.registration.proposals.kept);
  visit("registration/proposals/turns", c.registration.proposals.turns);
  visit("registration/proposals/refine", c.registration.proposals.refine);
  visit("registration/proposals/margin", c.registration.proposals.margin);
  visit("registration/tolerance", c.registration.tolerance);
  const auto weights = [&](const std::string& step, auto& w) {
    for (std::size_t i = 0; i < kCues.size(); ++i) {
      visit(step + "/" + std::string(kCues[i].name), w.cues[i]);
    }
    visit(step + "/invalid", w.invalid);
    visit(step + "/natural", w.natural);
    visit(step + "/temporal", w.temporal);
    visit(step + "/trunk", w.trunk);
    visit(step + "/fronto_parallel", w.fronto_parallel);
  };
  weights("registration/region_step", c.registration.region);
  weights("registration/edge_step", c.registration.edge);
  visit("filter/particles", c.filter.particles);
  visit("filter/heuristics", c.filter.heuristics);
  visit("filter/estimate", c.filter.estimate);
  visit("filter/model", c.filter.model);
  visit("filter/diffusion", c.filter.diffusion);
  visit("filter/memory", c.filter.memory);
  visit("filter/trust", c.filter.trust);
  visit("filter/natural", c.filter.natural);
  visit("filter/temporal", c.filter.temporal);
  visit("filter/invalid", c.filter.invalid);
  visit("filter/modes", c.filter.modes);
  visit("filter/mode_radius", c.filter.mode_radius);
  visit("filter/mode_least", c.filter.mode_least);
  visit("filter/mode_most", c.filter.mode_most);
  visit("filter/blocks", c.filter.blocks);
  visit("filter/turn_evaluations", c.filter.turn_evaluations);
  visit("filter/walk_evaluations", c.filter.walk_evaluations);
  visit("filter/alternatives", c.filter.flip_candidates);
  visit("tracking/method", c.tracking.method);
  visit("tracking/lost_region", c.tracking.lost_region);
  visit("tracking/found_region", c.tracking.found_region);
  visit("tracking/patience", c.tracking.patience);
  visit("tracking/retry_every", c.tracking.retry_every);
  visit("tracking/calibration_patience", c.tracking.calibration_patience);
  visit("tracking/fill_back", c.tracking.fill_back);
  visit("tracking/velocity", c.tracking.velocity);
  visit("offline/on", c.look_back);
  visit("offline/stretch", c.offline.stretch);
  visit("offline/overlap", c.offline.overlap);
  visit("offline/arms", c.offline.arms);
  visit("offline/kept", c.offline.kept);
  visit("offline/motion", c.offline.motion);
  visit("offline/sweeps", c.offline.sweeps);
  visit("offline/evaluations", c.offline.evaluations);
  visit("offline/between", c.offline.between);
  visit("smoothing/name", c.smoothing.name);
  visit("smoothing/look_ahead", c.smoothing.look_ahead);
  visit("smoothing/recursive_coefficient", c.smoothing.recursive_coefficient);
  visit("smoothing/angles/minimum_cutoff", c.smoothing.angles.minimum_cutoff);
  visit("smoothing/angles/slope", c.smoothing.angles.slope);
  visit("smoothing/angles/speed_cutoff", c.smoothing.angles.speed_cutoff);
  visit("smoothing/root/minimum_cutoff", c.smoothing.root.minimum_cutoff);
  visit("smoothing/root/slope", c.smoothing.root.slope);
  visit("smoothing/root/speed_cutoff", c.smoothing.root.speed_cutoff);
}

template <typename T>
Json value_of(const T& value) {
  return value;
}
Json value_of(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}
Json value_of(const Method& value) {
  return to_string(value);
}

void read(double& to, const Json& from) {
  to = from.get<double>();
  if (!std::isfinite(to)) {
    throw std::invalid_argument("a number is not finite");
  }
}
void read(float& to, const Json& from) {
  double wide = 0.0;
  read(wide, from);
  to = static_cast<float>(wide);
}
void read(int& to, const Json& from) {
  if (!from.is_number_integer() || std::abs(from.get<double>()) > 2e9) {
    throw std::invalid_argument("a whole number is needed, not " + from.dump());
  }
  to = from.get<int>();
}
void read(std::uint64_t& to, const Json& from) {
  if (!from.is_number_unsigned() && !(from.is_number_integer() && from.get<std::int64_t>() >= 0)) {
    throw std::invalid_argument("a whole number from 0 is needed, not " + from.dump());
  }
  to = from.get<std::uint64_t>();
}
void read(bool& to, const Json& from) {
  to = from.get<bool>();
}
void read(std::string& to, const Json& from) {
  to = from.get<std::string>();
}
void read(Method& to, const Json& from) {
  to = parse_method(from.get<std::string>());
}
void read(std::optional<double>& to, const Json& from) {
  if (from.is_null()) {
    to.reset();
    return;
  }
  double number = 0.0;
  read(number, from);
  to = number;
}

void collect_leaves(const Json& json, const std::string& path, std::vector<std::string>& leaves) {
  for (const auto& [key, value] : json.items()) {
    std::string here = path;
    here.append(path.empty() ? "" : "/").append(key);
    if (value.is_object() && value.empty()) {
      leaves.push_back(here + "/");  // a group from which nothing is set
    } else if (value.is_object()) {
      collect_leaves(value, here, leaves);
    } else {
      leaves.push_back(here);
    }
  }
}

}  // namespace

Config::Config() {
  image.width = 320;
  image.height = 240;
}

void Config::validate() const {
  const auto require = [](bool good, const std::string& what) {
    if (!good) {
      throw bad(what);
    }
  };
  image.validate();
  calibration.validate();
  registration.validate();
  filter.validate();
  offline.validate();
  make_smoother(smoothing, make_body(Shape{}), Camera{});  // throws when it cannot be made
  require(field_of_view > 1.0 && field_of_view < 179.0,
          "camera.field_of_view must be between 1 and 179 degrees");
  require(std::any_of(kBackends.begin(), kBackends.end(),
                      [&](const BackendKind& kind) { return kind.name == backend; }),
          "backend must be one of " + backend_names());
  require(!budget_ms || (*budget_ms > 0.0 && *budget_ms < 1e5), "budget_ms must be above 0 and below 100000");
  require(
      tracking.method == "heuristics" || tracking.method == "condensation" || tracking.method == "two-step",
      "tracking.method must be heuristics, condensation or two-step");
  require(!look_back || tracking.method != "two-step",
          "offline.on needs the method heuristics or condensation");
  require(threads >= 0 && threads <= 1024, "threads must be between 0 and 1024");
  require(tracking.lost_region > 0.0 && tracking.lost_region <= 1.0,
          "tracking.lost_region must be in (0, 1]");
  require(tracking.found_region > 0.0 && tracking.found_region <= 1.0,
          "tracking.found_region must be in (0, 1]");
  require(tracking.fill_back >= 0 && tracking.fill_back <= 1000,
          "tracking.fill_back must be between 0 and 1000 frames");
  require(tracking.patience >= 1 && tracking.retry_every >= 1 && tracking.calibration_patience >= 0,
          "tracking.patience, retry_every and calibration_patience must be positive");
  require(tracking.velocity >= 0.0 && tracking.velocity <= 1.0, "tracking.velocity must be between 0 and 1");
}

void add_cue(Config& config, const Cue& cue) {
  config.cues.add(cue);
  config.registration = with_cues(config.registration, config.cues);
}

FilterConfig filter_of(const Config& config) {
  if (config.tracking.method != "condensation") {
    return config.filter;
  }
  FilterConfig filter = reference_filter("");
  filter.particles = config.filter.particles;
  filter.model = config.filter.model;
  filter.diffusion = config.filter.diffusion;
  filter.estimate = config.filter.estimate;
  return filter;
}

Json to_json(const Config& config) {
  Json json = Json::object();
  each_setting(config, [&](const std::string& path, const auto& value) {
    json[Json::json_pointer("/" + path)] = value_of(value);
  });
  return json;
}

void update_from_json(Config& config, const Json& json) {
  if (!json.is_object()) {
    throw bad("the file must hold one JSON object");
  }
  std::vector<std::string> leaves;
  collect_leaves(json, "", leaves);
  Config updated = config;
  each_setting(updated, [&](const std::string& path, auto& value) {
    const Json::json_pointer pointer("/" + path);
    std::erase_if(leaves,
                  [&](const std::string& leaf) { return leaf.ends_with('/') && path.starts_with(leaf); });
    if (!json.contains(pointer)) {
      return;
    }
    try {
      read(value, json.at(pointer));
    } catch (const Json::exception&) {
      throw bad("'" + path + "' cannot be " + json.at(pointer).dump());
    } catch (const std::exception& e) {
      throw bad("'" + path + "': " + e.what());
    }
    std::erase(leaves, path);
  });
  if (!leaves.empty()) {
    const std::string& name = leaves.front();
    throw bad("there is no setting '" + name.substr(0, name.find_last_not_of('/') + 1) + "'");
  }
  updated.validate();
  config = updated;
}

void parse_config(Config& config, std::string_view text, const std::filesystem::path& name) {
  const Json json = Json::parse(text, nullptr, false, true);
  if (json.is_discarded()) {
    throw Error(ErrorKind::config, "configuration file " + name.string() + " is not valid JSON",
                "JSON knows no NaN or Infinity; `telemime config` prints a file to start from.");
  }
  update_from_json(config, json);
}

void update_from_file(Config& config, const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) {
    throw Error(ErrorKind::config, "configuration file " + file.string() + " cannot be opened",
                "Check the path and its permissions.");
  }
  parse_config(config, std::string(std::istreambuf_iterator<char>(in), {}), file);
}

}  // namespace telemime
