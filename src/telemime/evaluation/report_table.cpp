// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "telemime/evaluation/report.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

constexpr std::size_t kLabelWidth = 26;
constexpr std::size_t kCellWidth = 10;

std::string right(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string left(std::string_view text, std::size_t width) {
  return std::string(text) + std::string(text.size() < width ? width - text.size() : 1, ' ');
}

std::string fixed(double value, int decimals) {
  std::string text;
  append_fixed(text, value, decimals);
  return text;
}

/// "-" for what could not be measured.
std::string fixed(const std::optional<double>& value, int decimals, double unit = 1.0) {
  return value ? fixed(*value * unit, decimals) : "-";
}

std::string millimetres(const std::optional<double>& metres) {
  return fixed(metres, 1, kMillimetresPerMetre);
}

std::string percent(double fraction) {
  return fixed(fraction * 100.0, 1) + " %";
}

/// A label, cells in columns, and the rest of the line.
void row(std::string& table, std::string_view label, const std::vector<std::string>& cells) {
  table += "  " + left(label, kLabelWidth);
  for (const std::string& cell : cells) {
    table += right(cell, kCellWidth);
  }
  table += "\n";
}

void error_rows(std::string& table, const Evaluation& evaluation) {
  const ErrorReport& tracked = evaluation.tracked;
  const ErrorReport& all = evaluation.all;
  table += "\nerror, elbows and wrists\n";
  row(table, "", {"tracked", "all"});
  row(table, "frames", {std::to_string(tracked.frames), std::to_string(all.frames)});
  const auto both = [&](std::string_view label, std::optional<double> MeanErrors::*member) {
    row(table, label, {millimetres(tracked.scored.*member), millimetres(all.scored.*member)});
  };
  both("3-D, shoulders aligned, mm", &MeanErrors::aligned);
  row(table, "  median, mm", {millimetres(tracked.aligned_median), millimetres(all.aligned_median)});
  row(table, "  95th percentile, mm", {millimetres(tracked.aligned_p95), millimetres(all.aligned_p95)});
  both("  in the image plane, mm", &MeanErrors::image_plane);
  both("  in depth, mm", &MeanErrors::depth);
  both("3-D, camera frame, mm", &MeanErrors::camera);
  both("3-D, similarity fit, mm", &MeanErrors::fitted);
  row(table, "2-D, pixels", {fixed(tracked.scored.pixels, 2), fixed(all.scored.pixels, 2)});
  both("2-D at depth, mm", &MeanErrors::pixels_at_depth);
  table += "  (all: a lost frame counts with its last known pose)\n";
}

void joint_rows(std::string& table, const Evaluation& evaluation) {
  table += "\nby joint, tracked frames, mean\n";
  row(table, "", {"aligned", "plane", "depth", "camera", "similar", "pixels"});
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const MeanErrors& errors = evaluation.tracked.by_joint[j];
    if (errors.camera) {
      row(table, kJointNames[j],
          {millimetres(errors.aligned), millimetres(errors.image_plane), millimetres(errors.depth),
           millimetres(errors.camera), millimetres(errors.fitted), fixed(errors.pixels, 2)});
    }
  }
}

void state_rows(std::string& table, const Evaluation& evaluation) {
  table += "\ntracking\n";
  row(table, "lost, scored frames", {percent(evaluation.lost_scored)});
  row(table, "lost, all frames", {percent(evaluation.lost)});
  if (evaluation.lost_empty) {
    row(table, "lost, empty frames", {percent(*evaluation.lost_empty), " (100 % is right)"});
  }
  if (evaluation.unmeasured_frames > 0) {
    row(table, "before the first pose",
        {std::to_string(evaluation.unmeasured_frames), " frames, in no error"});
  }
  row(table, "mean F", {fixed(evaluation.mean_region, 4)});
  row(table, "mean D_C, px", {fixed(evaluation.mean_contour, 3)});
  row(table, "mistracked frames",
      {std::to_string(evaluation.mistracked), "   F > " + fixed(evaluation.options.max_region_score, 2) +
                                                  " or D_C > " +
                                                  fixed(evaluation.options.max_contour_score, 2) + " px"});
  row(table, "left and right swapped", {std::to_string(evaluation.swapped.size()), " frames"});
}

void spread_rows(std::string& table, const Evaluation& evaluation) {
  if (!evaluation.covered) {
    return;
  }
  table += "\nstated spread, elbows and wrists\n";
  row(table, "truth in the 95 % region", {percent(*evaluation.covered)});
  const auto of = [&](Joint left_joint, Joint right_joint) {
    const auto& l = evaluation.covered_by_joint[static_cast<std::size_t>(left_joint)];
    const auto& r = evaluation.covered_by_joint[static_cast<std::size_t>(right_joint)];
    return (l ? percent(*l) : "-") + " left, " + (r ? percent(*r) : "-") + " right";
  };
  row(table, "  elbows", {"  " + of(Joint::l_elbow, Joint::r_elbow)});
  row(table, "  wrists", {"  " + of(Joint::l_wrist, Joint::r_wrist)});
  row(table, "standard deviation, mm",
      {millimetres(evaluation.stated_across), "   in depth " + millimetres(evaluation.stated_depth)});
}

void motion_rows(std::string& table, const Evaluation& evaluation) {
  table += "\nmotion\n";
  row(table, "wrist jitter, mm/frame^2",
      {millimetres(evaluation.jitter), "   truth " + millimetres(evaluation.truth_jitter)});
  if (const auto& lag = evaluation.lag) {
    row(table, "lag, frames",
        {fixed(lag->frames, 2), "   " + fixed(lag->frames * 1000.0 / evaluation.fps, 0) +
                                    " ms, correlation " + fixed(lag->correlation, 3)});
  } else {
    row(table, "lag, frames", {"-"});
  }
  if (const auto& turn = evaluation.turn) {
    const auto degrees = [](double angle) { return fixed(angle * kDegreesPerRadian, 1); };
    row(table, "trunk's direction, degrees",
        {degrees(turn->error), "   turned " + (turn->error_turned ? degrees(*turn->error_turned) : "-") +
                                   ", the wrong way in " + std::to_string(turn->wrong_way) + " of " +
                                   std::to_string(turn->turned) + " frames"});
  }
  table += "\nbone lengths\n";
  row(table, "", {"mm", "varies", "truth mm", "varies"});
  for (std::size_t b = 0; b < kBoneNames.size(); ++b) {
    std::vector<std::string> cells;
    for (const auto& bone : {evaluation.bones[b], evaluation.truth_bones[b]}) {
      cells.push_back(bone ? fixed(bone->mean * kMillimetresPerMetre, 1) : "-");
      cells.push_back(bone ? percent(bone->variation) : "-");
    }
    row(table, kBoneNames[b], cells);
  }
}

void hand_rows(std::string& table, const Evaluation& evaluation) {
  if (!evaluation.hands) {
    return;
  }
  table += "\nfingers, palm aligned\n";
  row(table, "hands in the image",
      {std::to_string(evaluation.hands->hands), "   seen " + percent(evaluation.hands->seen)});
  row(table, "3-D, seen hands, mm",
      {millimetres(evaluation.hands->palm_aligned),
       "   95th percentile " + millimetres(evaluation.hands->palm_aligned_p95)});
}

void head_rows(std::string& table, const Evaluation& evaluation) {
  if (!evaluation.head) {
    return;
  }
  const HeadReport& head = *evaluation.head;
  const auto degrees = [](const std::optional<double>& angle) {
    return angle ? fixed(*angle * kDegreesPerRadian, 1) : "-";
  };
  table += "\nhead\n";
  row(table, "heads", {std::to_string(head.heads), "   seen " + percent(head.seen)});
  row(table, "rotation, degrees",
      {degrees(head.angle), "   yaw " + degrees(head.yaw) + ", pitch " + degrees(head.pitch) + ", roll " +
                                degrees(head.roll) + ", 95th percentile " + degrees(head.angle_p95)});
}

}  // namespace

std::string evaluation_table(const Evaluation& evaluation) {
  std::string table = "truth  " + evaluation.truth_name + "\n";
  table += "frames " + std::to_string(evaluation.scored_frames) + " scored of " +
           std::to_string(evaluation.truth_frames) + "; " + std::to_string(evaluation.pose_frames) +
           " in the pose file";
  if (evaluation.extra_pose_frames > 0) {
    table += ", " + std::to_string(evaluation.extra_pose_frames) + " more beyond the truth were ignored";
  }
  table += "\n";
  if (evaluation.fitted_scale) {
    table += "scale  the truth's size is unknown: the poses were multiplied by " +
             fixed(*evaluation.fitted_scale, 4) + " (least squares) first\n";
  }
  error_rows(table, evaluation);
  joint_rows(table, evaluation);
  state_rows(table, evaluation);
  spread_rows(table, evaluation);
  motion_rows(table, evaluation);
  hand_rows(table, evaluation);
  head_rows(table, evaluation);
  if (!evaluation.times.empty()) {
    table += "\ntime, ms\n";
    row(table, "", {"median", "95 %"});
    for (const StageTime& time : evaluation.times) {
      row(table, time.stage, {fixed(time.median_ms, 2), fixed(time.p95_ms, 2)});
    }
  }
  return table;
}

}  // namespace telemime
