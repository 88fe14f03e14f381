// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/report.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<double>& value, double unit = 1.0) {
  return value ? Json(rounded(*value * unit, 4)) : Json(nullptr);
}

Json millimetres(const std::optional<double>& metres) {
  return number(metres, kMillimetresPerMetre);
}

Json means_json(const MeanErrors& errors) {
  return {{"camera_mm", millimetres(errors.camera)},
          {"aligned_mm", millimetres(errors.aligned)},
          {"aligned_image_plane_mm", millimetres(errors.image_plane)},
          {"aligned_depth_mm", millimetres(errors.depth)},
          {"similarity_mm", millimetres(errors.fitted)},
          {"image_px", number(errors.pixels)},
          {"image_mm_at_depth", millimetres(errors.pixels_at_depth)}};
}

Json errors_json(const ErrorReport& report) {
  Json joints = Json::object();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints[std::string(kJointNames[j])] = means_json(report.by_joint[j]);
  }
  Json result = {{"frames", report.frames}};
  result.update(means_json(report.scored));
  result["aligned_median_mm"] = millimetres(report.aligned_median);
  result["aligned_p95_mm"] = millimetres(report.aligned_p95);
  result["joints"] = joints;
  return result;
}

Json covered_json(const Evaluation& evaluation) {
  Json joints = Json::object();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    joints[std::string(kJointNames[j])] = number(evaluation.covered_by_joint[j]);
  }
  return joints;
}

Json bones_json(const Evaluation& evaluation) {
  Json bones = Json::object();
  const auto length = [](const std::optional<BoneLength>& bone) {
    return Json{{"mean_mm", bone ? Json(rounded(bone->mean * kMillimetresPerMetre, 4)) : Json(nullptr)},
                {"variation", bone ? Json(rounded(bone->variation, 6)) : Json(nullptr)}};
  };
  for (std::size_t b = 0; b < kBoneNames.size(); ++b) {
    bones[std::string(kBoneNames[b])] = {{"estimate", length(evaluation.bones[b])},
                                         {"truth", length(evaluation.truth_bones[b])}};
  }
  return bones;
}

Json hands_json(const std::optional<HandReport>& hands) {
  return hands ? Json{{"in_image", hands->hands},
                      {"seen", rounded(hands->seen, 6)},
                      {"palm_aligned_mm", millimetres(hands->palm_aligned)},
                      {"palm_aligned_p95_mm", millimetres(hands->palm_aligned_p95)}}
               : Json(nullptr);
}

Json turn_json(const std::optional<TurnReport>& turn) {
  return turn ? Json{{"frames", turn->frames},
                     {"degrees", number(turn->error, kDegreesPerRadian)},
                     {"turned_frames", turn->turned},
                     {"turned_degrees", number(turn->error_turned, kDegreesPerRadian)},
                     {"wrong_way_frames", turn->wrong_way}}
              : Json(nullptr);
}

Json head_json(const std::optional<HeadReport>& head) {
  return head ? Json{{"in_truth", head->heads},
                     {"seen", rounded(head->seen, 6)},
                     {"degrees", number(head->angle, kDegreesPerRadian)},
                     {"p95_degrees", number(head->angle_p95, kDegreesPerRadian)},
                     {"yaw_degrees", number(head->yaw, kDegreesPerRadian)},
                     {"pitch_degrees", number(head->pitch, kDegreesPerRadian)},
                     {"roll_degrees", number(head->roll, kDegreesPerRadian)}}
              : Json(nullptr);
}

}  // namespace

Json evaluation_json(const Evaluation& evaluation) {
  Json times = Json::object();
  for (const StageTime& time : evaluation.times) {
    times[time.stage] = {{"median_ms", rounded(time.median_ms, 4)}, {"p95_ms", rounded(time.p95_ms, 4)}};
  }
  const auto& lag = evaluation.lag;
  return {
      {"format", "telemime-evaluation"},
      {"version", 1},
      {"truth", evaluation.truth_name},
      {"scale", {{"known", !evaluation.fitted_scale}, {"fitted_factor", number(evaluation.fitted_scale)}}},
      {"frames",
       {{"truth", evaluation.truth_frames},
        {"scored", evaluation.scored_frames},
        {"in_pose_file", evaluation.pose_frames},
        {"beyond_truth", evaluation.extra_pose_frames},
        {"before_first_pose", evaluation.unmeasured_frames}}},
      {"error", {{"tracked", errors_json(evaluation.tracked)}, {"all", errors_json(evaluation.all)}}},
      {"lost",
       {{"all_frames", rounded(evaluation.lost, 6)},
        {"scored_frames", rounded(evaluation.lost_scored, 6)},
        {"empty_frames", number(evaluation.lost_empty)}}},
      {"score", {{"mean_F", number(evaluation.mean_region)}, {"mean_D_C", number(evaluation.mean_contour)}}},
      {"mistracked",
       {{"frames", evaluation.mistracked},
        {"threshold_F", evaluation.options.max_region_score},
        {"threshold_D_C", evaluation.options.max_contour_score}}},
      {"swapped", {{"frames", evaluation.swapped.size()}, {"list", evaluation.swapped}}},
      {"spread",
       {{"covered", number(evaluation.covered)},
        {"joints", covered_json(evaluation)},
        {"stated_across_mm", millimetres(evaluation.stated_across)},
        {"stated_depth_mm", millimetres(evaluation.stated_depth)}}},
      {"jitter",
       {{"estimate_mm", millimetres(evaluation.jitter)}, {"truth_mm", millimetres(evaluation.truth_jitter)}}},
      {"lag",
       {{"frames", lag ? Json(rounded(lag->frames, 4)) : Json(nullptr)},
        {"ms", lag ? Json(rounded(lag->frames * 1000.0 / evaluation.fps, 2)) : Json(nullptr)},
        {"correlation", lag ? Json(rounded(lag->correlation, 4)) : Json(nullptr)}}},
      {"turn", turn_json(evaluation.turn)},
      {"bones", bones_json(evaluation)},
      {"hands", hands_json(evaluation.hands)},
      {"head", head_json(evaluation.head)},
      {"stages", times},
  };
}

}  // namespace telemime
