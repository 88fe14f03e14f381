// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/image_calibration.h"

#include <array>
#include <opencv2/core.hpp>
#include <opencv2/core/persistence.hpp>
#include <string>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr int kVersion = 2;

/// One row for each Gaussian: weight, mean (3), covariance (9).
cv::Mat table_of(const ColourMixture& mixture) {
  cv::Mat table(static_cast<int>(mixture.size()), 13, CV_32FC1);
  for (int i = 0; i < table.rows; ++i) {
    const ColourGaussian& g = mixture[static_cast<std::size_t>(i)];
    auto* row = table.ptr<float>(i);
    row[0] = g.weight;
    for (int a = 0; a < 3; ++a) {
      row[1 + a] = g.mean[a];
      for (int b = 0; b < 3; ++b) {
        row[4 + 3 * a + b] = g.covariance(a, b);
      }
    }
  }
  return table;
}

ColourMixture mixture_of(const cv::Mat& table, const std::string& name, const std::string& file) {
  ColourMixture mixture;
  if (table.empty()) {
    return mixture;
  }
  if (table.cols != 13 || table.type() != CV_32FC1 || !cv::checkRange(table)) {
    throw Error(
        ErrorKind::config,
        "the calibration " + file + " is damaged: the colours '" + name + "' are not a table with 13 columns",
        "calibrate again");
  }
  for (int i = 0; i < table.rows; ++i) {
    const auto* row = table.ptr<float>(i);
    ColourGaussian g;
    g.weight = row[0];
    for (int a = 0; a < 3; ++a) {
      g.mean[a] = row[1 + a];
      for (int b = 0; b < 3; ++b) {
        g.covariance(a, b) = row[4 + 3 * a + b];
      }
    }
    mixture.push_back(g);
  }
  return mixture;
}

/// The planes of a background by name, for writing and reading.
std::array<std::pair<const char*, cv::Mat*>, 7> planes_of(BackgroundModel& model) {
  return {{{"mean_u", &model.mean.u},
           {"mean_v", &model.mean.v},
           {"mean_l", &model.mean.l},
           {"chroma_variance", &model.chroma_variance},
           {"luminance_variance", &model.luminance_variance},
           {"valid", &model.valid},
           {"seen", &model.seen}}};
}

std::array<std::pair<const char*, ColourMixture*>, 5> mixtures_of(ImageCalibration& calibration) {
  return {{{"surroundings", &calibration.surroundings},
           {"skin", &calibration.colours.skin},
           {"clothes", &calibration.colours.clothes},
           {"hair", &calibration.colours.hair},
           {"other", &calibration.colours.other}}};
}

/// Opens the storage unless the file or its folder does not exist: OpenCV would print an error message.
cv::FileStorage open(const std::filesystem::path& file, int mode) {
  std::error_code ignored;
  const bool writes = (mode & cv::FileStorage::WRITE) != 0;
  const std::filesystem::path folder = file.parent_path();
  const bool there = writes ? folder.empty() || std::filesystem::is_directory(folder, ignored)
                            : std::filesystem::is_regular_file(file, ignored);
  if (!there) {
    return {};
  }
  try {
    return cv::FileStorage(file.string(), mode);
  } catch (const cv::Exception&) {
    return {};
  }
}

/// Whether the file can be read to its end.
bool is_whole(const std::filesystem::path& file) {
  try {
    load_calibration(file);
    return true;
  } catch (const Error&) {
  } catch (const cv::Exception&) {
  }
  return false;
}

}  // namespace

void save_calibration(const ImageCalibration& calibration, const std::filesystem::path& file) {
  // Beside it at first, so that a file that was there stays until this one is whole. The end of the name says
  // how it is written.
  const std::filesystem::path part = file.parent_path() / (".part." + file.filename().string());
  cv::FileStorage storage = open(part, cv::FileStorage::WRITE | cv::FileStorage::BASE64);
  if (!storage.isOpened()) {
    throw Error(ErrorKind::output, "the calibration cannot be written to " + file.string(),
                "choose an existing, writable folder and a file name that ends in .yml.gz");
  }
  storage << "telemime_image_calibration" << kVersion;
  ImageCalibration copy = calibration;  // shares the planes; the lists below need non-const pointers
  storage << "doubtful" << (calibration.doubtful ? 1 : 0);
  for (const auto& [name, plane] : planes_of(copy.background)) {
    storage << name << *plane;
  }
  for (const auto& [name, mixture] : mixtures_of(copy)) {
    storage << name << table_of(*mixture);
  }
  storage.release();
  // OpenCV does not tell of a full disk.
  std::error_code failure;
  if (!is_whole(part)) {
    std::filesystem::remove(part, failure);
    throw Error(ErrorKind::output, "the calibration could not be written to " + file.string(),
                "make room on the disk");
  }
  std::filesystem::rename(part, file, failure);
  if (failure) {
    throw Error(ErrorKind::output,
                "the calibration cannot be written to " + file.string() + ": " + failure.message());
  }
}

ImageCalibration load_calibration(const std::filesystem::path& file) {
  cv::FileStorage storage = open(file, cv::FileStorage::READ);
  if (!storage.isOpened()) {
    throw Error(ErrorKind::config, "the calibration " + file.string() + " cannot be read",
                "check the file name, or calibrate again");
  }
  int version = 0;
  storage["telemime_image_calibration"] >> version;
  if (version != kVersion) {
    throw Error(ErrorKind::config, file.string() + " is not an image calibration of this program version",
                "calibrate again with this version");
  }
  ImageCalibration out;
  int doubtful = 0;
  storage["doubtful"] >> doubtful;
  out.doubtful = doubtful != 0;
  for (const auto& [name, plane] : planes_of(out.background)) {
    storage[name] >> *plane;
  }
  const cv::Size size = out.background.valid.size();
  for (const auto& [name, plane] : planes_of(out.background)) {
    const int wanted = plane == &out.background.valid || plane == &out.background.seen ? CV_8UC1 : CV_32FC1;
    if (plane->size() != size || (!plane->empty() && plane->type() != wanted)) {
      throw Error(
          ErrorKind::config,
          "the calibration " + file.string() + " is damaged: '" + name + "' has the wrong size or type",
          "calibrate again");
    }
  }
  for (const auto& [name, mixture] : mixtures_of(out)) {
    cv::Mat table;
    storage[name] >> table;
    *mixture = mixture_of(table, name, file.string());
  }
  return out;
}

}  // namespace telemime
