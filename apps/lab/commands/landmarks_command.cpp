// SPDX-License-Identifier: Apache-2.0
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <utility>

#include "commands.h"
#include "telemime/capture/source.h"
#include "telemime/core/errors.h"
#include "telemime/nets/find_pose.h"
#include "telemime/nets/models/table.h"

namespace telemime {
namespace {

using Index = PoseLandmarkIndex;

struct LandmarkArguments {
  std::string clip;
  std::string out;
  std::string models;
  PoseModel model = PoseModel::full;
  int pictures = 12;
};

cv::Point point(const PoseLandmark& landmark) {
  return {cvRound(landmark.pixel.x()), cvRound(landmark.pixel.y())};
}

// The person in green, the bones, and each landmark as the ellipse of one standard deviation: red if it is
// hidden.
cv::Mat drawn(const cv::Mat& image, const PoseLandmarks& landmarks) {
  cv::Mat picture = image.clone();
  cv::Mat tinted;
  cv::addWeighted(image, 0.5, cv::Mat(image.size(), CV_8UC3, cv::Scalar(0, 255, 0)), 0.5, 0.0, tinted);
  tinted.copyTo(picture, landmarks.mask > 127);
  constexpr std::array<std::pair<int, int>, 10> kBones = {{{Index::left_shoulder, Index::right_shoulder},
                                                           {Index::left_shoulder, Index::left_elbow},
                                                           {Index::left_elbow, Index::left_wrist},
                                                           {Index::left_wrist, Index::left_index},
                                                           {Index::right_shoulder, Index::right_elbow},
                                                           {Index::right_elbow, Index::right_wrist},
                                                           {Index::right_wrist, Index::right_index},
                                                           {Index::left_shoulder, Index::left_hip},
                                                           {Index::right_shoulder, Index::right_hip},
                                                           {Index::left_hip, Index::right_hip}}};
  for (const auto& [from, to] : kBones) {
    cv::line(picture, point(landmarks.points[from]), point(landmarks.points[to]), {255, 255, 0}, 2);
  }
  for (const PoseLandmark& landmark : landmarks.points) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
    axes.computeDirect(landmark.covariance);
    const Eigen::Vector2d longest = axes.eigenvectors().col(1);
    const cv::Size2d size(2.0 * std::sqrt(axes.eigenvalues()[1]), 2.0 * std::sqrt(axes.eigenvalues()[0]));
    const double degrees = std::atan2(longest.y(), longest.x()) * 180.0 / std::numbers::pi;
    const cv::Scalar colour = landmark.visibility > 0.5 ? cv::Scalar(0, 255, 0) : cv::Scalar(0, 0, 255);
    cv::ellipse(picture, cv::RotatedRect(point(landmark), size, static_cast<float>(degrees)), colour);
  }
  return picture;
}

void run_landmarks(const LandmarkArguments& arguments) {
  PoseNetworks networks = load_pose_networks(find_models(arguments.models), arguments.model);
  const std::unique_ptr<Source> source = open_source(arguments.clip);
  const std::int64_t step = std::max<std::int64_t>(1, source->info().frames / arguments.pictures);
  std::filesystem::create_directories(arguments.out);
  std::optional<PictureRegion> region;
  int frames = 0;
  int found = 0;
  while (const std::optional<Frame> frame = source->next()) {
    const std::optional<PoseLandmarks> landmarks = find_pose(frame->image, networks, region);
    region = landmarks ? std::optional(landmarks->next_region) : std::nullopt;
    ++frames;
    found += landmarks ? 1 : 0;
    if (frame->index % step == 0) {
      const std::filesystem::path file =
          std::filesystem::path(arguments.out) / ("frame_" + std::to_string(frame->index) + ".png");
      if (!cv::imwrite(file.string(), landmarks ? drawn(frame->image, *landmarks) : frame->image)) {
        throw Error(ErrorKind::output, "cannot write " + file.string(), "Choose another folder with --out.");
      }
    }
  }
  std::cout << "a person in " << found << " of " << frames << " frames\n";
}

}  // namespace

void add_landmarks_command(CLI::App& app) {
  const auto arguments = std::make_shared<LandmarkArguments>();
  CLI::App* const command = app.add_subcommand(
      "landmarks", "Draw what the networks find in a clip: landmarks and mask of the person");
  command->add_option("clip", arguments->clip, "video, image folder or camera")->required();
  command->add_option("--out", arguments->out, "folder for the pictures")->required();
  command->add_option("--models", arguments->models,
                      "folder of the models [those that were built or installed]");
  const std::map<std::string, PoseModel> models = {
      {"lite", PoseModel::lite}, {"full", PoseModel::full}, {"heavy", PoseModel::heavy}};
  command->add_option("--model", arguments->model, "lite, full or heavy [full]")
      ->transform(CLI::CheckedTransformer(models));
  command->add_option("--pictures", arguments->pictures, "number of pictures")
      ->capture_default_str()
      ->check(CLI::Range(1, 10000));
  command->callback([arguments] { run_landmarks(*arguments); });
}

}  // namespace telemime
