// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/filter_config.h"

#include "telemime/core/errors.h"
#include "telemime/tracking/heuristics/all.h"

namespace telemime {

namespace {

SettingRule known_heuristics(const std::string& names) {
  try {
    parse_heuristics(names);
    return {};
  } catch (const Error& error) {
    return {false, std::string("filter.heuristics: ") + error.what()};
  }
}

}  // namespace

SettingTable settings_of(FilterConfig& c) {
  SettingTable table;
  table.rows = {
      number(
          "particles", &c.particles, {1, 1000000}, "evaluations",
          "Particles of a frame with the methods heuristics and condensation, without landmarks; searches of "
          "turned trunks come on top."),
      text("filter.heuristics", c.heuristics, {},
           "Heuristics of the particle filter, separated by commas: " + heuristic_names() + "."),
      text("filter.estimate", c.estimate, {"heaviest", "mean"}, "The pose that represents all particles."),
      text("filter.model", c.model, {},
           "File of noise and motion parameters that `telemime-lab learn` writes; empty: the built-in ones."),
      number("filter.diffusion", &c.diffusion, {0.001, 100}, "",
             "Factor of all standard deviations of the motion (S of equation 4.13)."),
      number("filter.memory", &c.memory, {0, 1}, "",
             "Share of the logarithmic weights of the modes that the next frame keeps."),
      number("filter.trust", &c.trust, {0.001, 10}, "", "Factor of the log likelihood of the image."),
      number("filter.natural", &c.natural, {0, 1e6}, "nats", "Log prior of natural poses."),
      number("filter.temporal", &c.temporal, {0, 1e6}, "nats",
             "Log prior of the squared distance (over 0.15 m) of elbows and wrists from their predicted "
             "places."),
      number("filter.invalid", &c.invalid, {0, 1e9}, "nats/m", "Log prior of interpenetration."),
      number("filter.modes", &c.modes, {1, 1000}, "", "Largest number of modes."),
      number("filter.mode_radius", &c.mode_radius, {0.001, 1}, "m",
             "Largest distance of an elbow or wrist from that of the best particle of its mode."),
      number("filter.mode_least", &c.mode_least, {10, 1000000}, "evaluations", "Smallest effort for a mode."),
      number("filter.mode_most", &c.mode_most, {10, 1000000}, "evaluations",
             "Largest effort for the local search of a mode."),
      flag("filter.blocks", c.blocks,
           "Local search with the settings of `registration`; false: one simplex over all moving numbers, as "
           "in the thesis."),
      number("filter.turn_evaluations", &c.turn_evaluations, {10, 1000000}, "evaluations",
             "Effort of the search of each turned trunk."),
      number("filter.walk_evaluations", &c.walk_evaluations, {10, 1000000}, "evaluations",
             "The same where the trunk is far from upright; at most half of the particles."),
      number("filter.flip_candidates", &c.flip_candidates, {0, 1000}, "",
             "Modes whose best particle is flipped in depth."),
      number("filter.landmark_searches", &c.landmark_searches, {0, 100}, "",
             "Poses fitted to the landmarks that are searched further by all cues."),
      number("filter.landmark_evaluations", &c.landmark_evaluations, {0, 1000000}, "evaluations",
             "Effort of each of these searches; 0: none."),
      number("filter.second_evaluations", &c.second_evaluations, {0, 1000000}, "evaluations",
             "Effort of the second search of the best mode in a frame with landmarks, without proposals; 0: "
             "none."),
      number("filter.landmark_share", &c.landmark_share, {0.001, 1}, "",
             "Share of the particles that a frame with landmarks needs: its proposals are nearer."),
  };
  table.rules = {known_heuristics(c.heuristics),
                 {c.mode_least <= c.mode_most, "filter.mode_least must not be above filter.mode_most"}};
  return table;
}

FilterConfig with_effort(FilterConfig config, double share) {
  for (int* number : {&config.particles, &config.mode_least, &config.mode_most, &config.turn_evaluations,
                      &config.walk_evaluations, &config.landmark_evaluations, &config.second_evaluations}) {
    *number = std::max(1, static_cast<int>(std::lround(share * *number)));
  }
  return config;
}

FilterConfig with_landmarks(FilterConfig config) {
  config.particles = std::max(1, static_cast<int>(std::lround(config.landmark_share * config.particles)));
  return config;
}

FilterConfig for_time_step(FilterConfig config, double frames) {
  config.diffusion *= std::sqrt(frames);
  config.temporal /= frames;
  return config;
}

FilterConfig reference_filter(const std::string& heuristics) {
  FilterConfig config;
  config.heuristics = heuristics;
  config.particles = 1000;
  config.memory = 1.0;
  config.trust = 1.0;
  config.natural = 0.0;
  config.temporal = 0.0;
  config.blocks = false;
  config.landmark_share = 1.0;
  return config;
}

}  // namespace telemime
