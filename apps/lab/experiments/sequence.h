// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "telemime/core/frame.h"
#include "telemime/evaluation/truth.h"
#include "telemime/tracker/config.h"
#include "telemime/tracking/filter_config.h"

namespace telemime {

/// A clip with its truth, read into memory.
struct Clip {
  std::string name;
  Camera camera;
  std::vector<Frame> background;
  std::vector<Frame> frames;
  Truth truth;
};

/// Reads FOLDER/video.* , FOLDER/background.* and FOLDER/truth.json; at most `most_frames` frames of the
/// video (0: all). Throws Error(input) that says what is missing.
Clip read_clip(const std::filesystem::path& folder, std::size_t most_frames);

/// FOLDER/STEM.mp4, .mkv or .avi.
std::optional<std::filesystem::path> find_video(const std::filesystem::path& folder, const std::string& stem);
/// The same. Throws Error(input) when there is none.
std::filesystem::path video_in(const std::filesystem::path& folder, const std::string& stem);

/// A clip after image processing: the prepared frames, and the pose and body that calibration found on the
/// first good frame. Many searches can share it.
struct PreparedSequence {
  std::string name;
  Camera camera;  ///< of the input
  Truth truth;
  JointLimits limits;
  std::size_t first = 0;              ///< frame in which the person was calibrated; `start` is its pose
  std::vector<PreparedFrame> frames;  ///< by frame number; those before `first` are never searched
  Model model;
  Pose start;
};

/// Runs features once over the clip and calibrates. Throws Error(tracking) when no person can be calibrated.
PreparedSequence prepare_sequence(const Clip& clip, const Config& config);

/// Result of one search over a sequence, by frame from `first` on.
struct Trace {
  std::vector<double> frame;
  std::vector<double> region;    ///< F after the frame's search
  std::vector<double> contour;   ///< D_C, px of the working image
  std::vector<double> error_2d;  ///< mm at the person's depth, elbows and wrists (thesis 3.18)
  std::vector<double> error_3d;  ///< mm, mid-shoulders coincide, elbows and wrists (thesis 3.16)
  std::vector<double> evaluations;
  std::vector<double> effective;  ///< particles that carry the weight; a search without particles: none
  std::vector<double> moving;     ///< share of the body's parts that it diffused; as above
  double jitter = 0.0;            ///< second difference of the wrists, mm/frame^2
};

/// A frame is mistracked with F or D_C above these (thesis 3.6.1: a "peak"). Chosen for the development clips
/// at 160x120, where acceptable poses have F of 0.1 to 0.2 and D_C of 1 to 2.
struct PeakThresholds {
  double region = 0.30;
  double contour = 2.5;  ///< px at 160x120
};

/// Mean of the finite values; NaN of none.
double mean_of(const std::vector<double>& values);

/// Values above the threshold: the thesis's mistracked frames ("peaks").
std::size_t count_above(const std::vector<double>& values, double threshold);

/// Frames with a peak of F, of D_C or of both.
std::size_t count_mistracked(const Trace& trace, const PeakThresholds& peaks);

/// Tracks the whole sequence, each frame from the pose of the one before (thesis 2.4.4.4). The same seed
/// gives the same trace.
Trace track_sequence(const PreparedSequence& sequence, const RegistrationConfig& config, std::uint64_t seed,
                     const std::string& backend = "scalar");

/// A particle filter and its inputs.
struct FilterSetup {
  FilterConfig filter;
  RegistrationConfig search;  ///< the filter's local search
  double velocity = 0.0;      ///< share of the arms' last motion that is predicted to continue
  CueTable cues = {};         ///< what the image is compared by
};

/// The thesis's filter with these heuristics alone; none is CONDENSATION.
FilterSetup reference_setup(const std::string& heuristics);
/// Ours, as `telemime track` runs it.
FilterSetup our_setup();

/// The same with a particle filter that starts at the first pose of the sequence, on the calling thread only.
Trace track_filter(const PreparedSequence& sequence, const FilterSetup& setup, std::uint64_t seed);

/// The thesis's search with exactly x region and y edge evaluations a frame.
RegistrationConfig reference_with(int region, int edge);

}  // namespace telemime
