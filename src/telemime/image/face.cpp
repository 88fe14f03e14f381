// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/face.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

cv::CascadeClassifier load_cascade(const std::filesystem::path& folder, const std::string& name) {
  const std::filesystem::path file = find_cascade(folder, name);
  cv::CascadeClassifier cascade;
  if (!cascade.load(file.string())) {
    throw Error(ErrorKind::config, "the face detector's file " + file.string() + " cannot be read",
                "reinstall the package opencv-data, or choose another folder of cascades");
  }
  return cascade;
}

}  // namespace

std::filesystem::path find_cascade(const std::filesystem::path& folder, const std::string& name) {
  std::vector<std::filesystem::path> places;
  if (!folder.empty()) {
    places.push_back(folder);
  } else {
    std::error_code failed;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
    places.push_back(program.parent_path() / "share" / "opencv4" / "haarcascades");
    for (const char* place : {"/usr/share/opencv4/haarcascades", "/usr/local/share/opencv4/haarcascades",
                              "/opt/homebrew/share/opencv4/haarcascades", "/usr/share/opencv/haarcascades"}) {
      places.emplace_back(place);
    }
  }
  std::string searched;
  for (const auto& place : places) {
    std::error_code ignored;
    if (std::filesystem::is_regular_file(place / name, ignored)) {
      return place / name;
    }
    searched += (searched.empty() ? "" : ", ") + place.string();
  }
  throw Error(ErrorKind::config, "the face detector's file " + name + " was not found in " + searched,
              "install the package opencv-data, or choose the folder that contains the cascades");
}

FaceDetector::FaceDetector(const std::filesystem::path& folder)
    : frontal_(load_cascade(folder, "haarcascade_frontalface_alt2.xml")) {}

std::optional<cv::Rect> FaceDetector::find(const cv::Mat& grey, const cv::Rect& region, int smallest,
                                           int largest, const FaceTest& is_face) {
  const cv::Rect inside = region & cv::Rect(0, 0, grey.cols, grey.rows);
  if (inside.width < 20 || inside.height < 20) {
    return std::nullopt;
  }
  const cv::Mat window = grey(inside);
  const cv::Size least(smallest, smallest);
  const cv::Size most(largest, largest);
  std::vector<cv::Rect> faces;
  frontal_.detectMultiScale(window, faces, 1.1, 3, 0, least, most);
  // The detector's threads report faces in no particular order.
  std::sort(faces.begin(), faces.end(), [](const auto& a, const auto& b) {
    return std::tuple(-a.width, a.y, a.x) < std::tuple(-b.width, b.y, b.x);
  });
  for (const cv::Rect& face : faces) {
    if (is_face(face + inside.tl())) {
      return face + inside.tl();
    }
  }
  return std::nullopt;
}

}  // namespace telemime
