// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/sequence.h"

#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file) {
  throw Error(ErrorKind::output, "cannot write " + file.string(),
              "give --out a writable folder on a disk with free space");
}

struct Video {
  cv::VideoWriter writer;
  fs::path file;
};

// `file` without its ending; the ending tells the kind.
Video open_video(const fs::path& file, const cv::Size& size, bool lossless) {
  struct Kind {
    std::array<char, 4> code;
    const char* ending;
  };
  constexpr Kind kH264{{'a', 'v', 'c', '1'}, ".mp4"};
  constexpr Kind kMpeg4{{'m', 'p', '4', 'v'}, ".mp4"};
  constexpr Kind kLossless{{'F', 'F', 'V', '1'}, ".mkv"};
  // 4:2:0 colour needs even sizes.
  const bool even = size.width % 2 == 0 && size.height % 2 == 0;
  const std::vector<Kind> kinds =
      lossless || !even ? std::vector<Kind>{kLossless} : std::vector<Kind>{kH264, kMpeg4, kLossless};
  for (const Kind& kind : kinds) {
    Video video;
    video.file = file;
    video.file += kind.ending;
    const auto& c = kind.code;
    if (video.writer.open(video.file.string(), cv::CAP_FFMPEG,
                          cv::VideoWriter::fourcc(c[0], c[1], c[2], c[3]), kGestureFps, size)) {
      return video;
    }
  }
  fail(file);
}

// A full-size clip and, when asked for, its small lossless copy.
struct ClipWriter {
  Video video;
  Video small;
  cv::Size small_size;

  ClipWriter(const fs::path& file, const cv::Size& size, const SequenceOptions& options)
      : video(open_video(file, size, !options.compact)) {
    if (options.small_videos && size.width > 160) {
      small_size = {160, 160 * size.height / size.width};
      fs::path name = file;
      name += "_" + std::to_string(small_size.width) + "x" + std::to_string(small_size.height);
      small = open_video(name, small_size, true);
    }
  }

  void add(const cv::Mat& image) {
    video.writer.write(image);
    if (!small.file.empty()) {
      cv::Mat reduced;
      cv::resize(image, reduced, small_size, 0, 0, cv::INTER_AREA);
      small.writer.write(reduced);
    }
  }

  void finish(std::vector<fs::path>& files) {
    for (Video* each : {&video, &small}) {
      if (!each->file.empty()) {
        each->writer.release();
        // OpenCV does not report a full disk: a missing or empty file is all that can be seen.
        std::error_code error;
        if (fs::file_size(each->file, error) == 0 || error) {
          fail(each->file);
        }
        files.push_back(each->file);
      }
    }
  }
};

// A sheet of eight frames, two rows of four.
struct Preview {
  int frames;
  cv::Size cell;
  cv::Mat sheet;

  explicit Preview(int frame_count, const cv::Size& size)
      : frames(frame_count),
        cell(320, 320 * size.height / size.width),
        sheet(2 * cell.height, 4 * cell.width, CV_8UC3) {
    sheet.setTo(0);
  }
  void add(const cv::Mat& image, int frame) {
    for (int i = 0; i < 8; ++i) {
      if ((frames - 1) * i / 7 == frame) {
        cv::Mat place = sheet(cv::Rect((i % 4) * cell.width, (i / 4) * cell.height, cell.width, cell.height));
        cv::resize(image, place, cell, 0, 0, image.cols > cell.width ? cv::INTER_AREA : cv::INTER_CUBIC);
        cv::putText(place, std::to_string(frame), {6, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {255, 255, 255}, 2,
                    cv::LINE_AA);
        cv::putText(place, std::to_string(frame), {6, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {40, 40, 40}, 1,
                    cv::LINE_AA);
      }
    }
  }
};

// Clips of an earlier run, which may have another ending or size, do not belong to the new truth.
void remove_clips(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> old;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string stem = entry.path().stem().string();
    const std::string ending = entry.path().extension().string();
    const bool clip = (stem.starts_with("video") || stem.starts_with("background")) &&
                      (ending == ".mkv" || ending == ".mp4");
    if (clip || entry.path().filename() == kPreview) {
      old.push_back(entry.path());
    }
  }
  for (const fs::path& file : old) {
    if (!fs::remove(file, error)) {
      throw Error(ErrorKind::output, "cannot remove " + file.string() + ": " + error.message(),
                  "give --out a writable folder");
    }
  }
}

}  // namespace

SequenceFiles make_sequence(const SequenceOptions& options) {
  if (options.background_frames < 0 || options.threads < 0) {
    throw Error(ErrorKind::usage, "the number of background frames or threads is negative",
                "choose 0 or more");
  }
  const Scene scene = make_scene(options.scene);
  const SceneOptions& filmed = scene.options;
  const fs::path folder = options.folder / kGestureNames[static_cast<std::size_t>(filmed.gesture)];
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) {
    throw Error(ErrorKind::output, "cannot make the folder " + folder.string() + ": " + error.message(),
                "give --out a writable folder");
  }
  remove_clips(folder);
  const cv::Size size(filmed.width, filmed.height);
  SequenceFiles files;
  const int cores = tbb::info::default_concurrency();
  tbb::task_arena arena(options.threads > 0 ? std::min(options.threads, cores) : cores);

  const fs::path truth = folder / "truth.json";
  std::ofstream(truth) << truth_json(scene) << '\n' << std::flush;
  if (fs::file_size(truth, error) == 0 || error) {
    fail(truth);
  }
  files.all.push_back(truth);

  const int all = filmed.frames + options.background_frames;
  ClipWriter clip(folder / "video", size, options);
  Preview preview(filmed.frames, size);
  for (int frame = 0; frame < filmed.frames; ++frame) {
    cv::Mat image;
    arena.execute([&] { image = render_frame(scene, frame).image; });
    clip.add(image);
    preview.add(image, frame);
    if (options.progress) {
      options.progress(frame + 1, all);
    }
  }
  files.video = clip.video.file;
  clip.finish(files.all);

  if (options.background_frames > 0) {
    ClipWriter background(folder / "background", size, options);
    for (int index = 0; index < options.background_frames; ++index) {
      cv::Mat image;
      arena.execute([&] { image = render_background(scene, index); });
      background.add(image);
      if (options.progress) {
        options.progress(filmed.frames + index + 1, all);
      }
    }
    background.finish(files.all);
  }
  const fs::path sheet = folder / kPreview;
  if (!cv::imwrite(sheet.string(), preview.sheet)) {
    fail(sheet);
  }
  files.all.push_back(sheet);
  return files;
}

}  // namespace telemime
