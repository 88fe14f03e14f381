// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/file_run.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "telemime/offline/finished_run.h"
#include "telemime/offline/overlay.h"
#include "telemime/tracker/set_up.h"

namespace telemime {

void RunStatistics::add(const MotionFrame& motion) {
  ++frames;
  for (const auto& [stage, ms] : motion.stage_ms) {
    stage_ms[stage].push_back(ms);
  }
  if (motion.state != TrackState::tracking) {
    return;
  }
  first_tracked = first_tracked < 0 ? motion.frame : first_tracked;
  ++tracked;
  region += motion.region_score;
  contour += motion.contour_score;
  evaluations += motion.evaluations;
}

nlohmann::json RunStatistics::json() const {
  const double n = std::max<double>(1.0, static_cast<double>(tracked));
  nlohmann::json json = {
      {"frames", frames},     {"tracked", tracked},      {"first_tracked", first_tracked},
      {"mean_F", region / n}, {"mean_D_C", contour / n}, {"mean_evaluations", evaluations / n}};
  for (const auto& [stage, values] : stage_ms) {
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const auto at = [&](double q) { return sorted[static_cast<std::size_t>(q * (sorted.size() - 1))]; };
    json["ms"][stage] = {{"median", at(0.5)}, {"p95", at(0.95)}};
  }
  return json;
}

FileRun::FileRun(const TrackRequest& request, const RunHooks& hooks, const SourceInfo& info,
                 const TrackingRun& run)
    : request_(request),
      asked_(request_json(request)),
      hooks_(hooks),
      info_(info),
      run_(run),
      outputs_(request, info.fps, [this](const std::string& words) { note(words); }),
      fill_seeds_(fill_back_seeds(run.tracker.config)),
      window_(run.tracker.config) {}

int FileRun::picture_side() const {
  constexpr int kLongestSide = 960;
  return outputs_.has_overlay() || hooks_.picture ? kLongestSide : 0;
}

ViewerRequest FileRun::add(FrameRecord record) {
  ++frames_;
  note(record.estimate.note);
  for (const std::string& warning : record.features.warnings) {
    note(warning);
  }
  if (run_.state.person && (!smoothing_ || person_ended_)) {
    begin();
  }
  keep_picture(picture_side(), record.frame);
  // Of the features only what fill_back() asks for and what is drawn is still needed.
  FrameFeatures kept;
  kept.person_present = record.features.person_present;
  kept.face = std::move(record.features.face);
  kept.hands = std::move(record.features.hands);
  record.features = std::move(kept);
  queue_.records.push_back(std::move(record));
  const std::size_t filled = fill_back(run_.tracker, run_.state, fill_seeds_, queue_);
  note(filled == 0 ? ""
                   : "found, and followed back through the " + std::to_string(filled) + " frames before");
  const MotionFrame motion = queue_.records.back().estimate.motion;
  advance(false);
  if (!hooks_.progress) {
    return ViewerRequest::none;
  }
  return hooks_.progress(
      {.frames = frames_,
       .total = frames_to_come(request_, info_),
       .seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(),
       .motion = &motion});
}

void FileRun::end_person() {
  end_fill_back(run_.tracker, queue_);
  advance(true);
  person_ended_ = true;
}

TrackSummary FileRun::finish(bool interrupted, const std::string& complaint,
                             const std::vector<std::string>& scene_messages) {
  if (!smoothing_) {
    begin();
  }
  end_fill_back(run_.tracker, queue_);
  if (interrupted) {
    keep_forward_poses(queue_);  // a user who stops a run does not want to wait for it
  }
  advance(true);
  write_ready(true);
  outputs_.close_overlay();
  if (hooks_.message && !complaint.empty()) {
    hooks_.message(info_.name + ": " + complaint);
  }
  // What the run was like.
  TrackSummary summary;
  summary.frames = statistics_.frames;
  summary.tracked = statistics_.tracked;
  summary.first_tracked = statistics_.first_tracked;
  summary.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  summary.interrupted = interrupted;
  summary.report = statistics_.json();
  summary.report["input"] = info_.name;
  summary.report["request"] = asked_;
  summary.report["fps"] = info_.fps;
  summary.report["seconds"] = summary.seconds;
  summary.report["interrupted"] = interrupted;
  summary.report["scene"] = scene_messages;
  summary.report["notes"] = notes_;
  if (!complaint.empty()) {
    summary.report["complaint"] = complaint;
  }
  if (run_.state.person) {
    summary.report["scale_from"] = run_.state.person->scale_from;
    summary.report["calibration_refusal"] = run_.state.person->refusal;
  }
  summary.report["files"] = outputs_.files();
  outputs_.close(summary.report);
  return summary;
}

// Every output file begins with the first person's shape.
void FileRun::begin() {
  const StreamHeader header = header_of(info_, run_);
  if (smoothing_) {
    write_ready(true);
    outputs_.set_body(header.body);
  } else {
    outputs_.begin(header);
    if (hooks_.person) {
      hooks_.person(header);
    }
  }
  person_ended_ = false;
  smoothing_ = make_two_way_smoothing(request_.config.smoothing, header.body, header.camera);
  write_early();
}

// The frames before the first person pass the queue before those that wait there.
void FileRun::write_early() {
  RecordQueue later = std::exchange(queue_, {});
  drawn_ = early_.size();
  for (; !early_.empty(); early_.pop_front()) {
    queue_.records.emplace_back().estimate.motion = std::move(early_.front());
    ++queue_.filled;
    ++queue_.chosen;
    smooth_forward(*smoothing_, queue_);
    write_ready(false);
  }
  std::move(later.records.begin(), later.records.end(), std::back_inserter(queue_.records));
  queue_.filled += later.filled;
  queue_.chosen += later.chosen;
}

// The passes in turn, each as far as it can go. `last`: no frame of the same person follows.
void FileRun::advance(bool last) {
  choose_poses(run_.tracker, run_.state.model, last, window_, queue_);
  if (smoothing_) {
    smooth_forward(*smoothing_, queue_);
    write_ready(false);
    return;
  }
  // Nobody was found yet, maybe for a long time: of these frames only the motion is kept.
  for (; queue_.chosen > 0; --queue_.chosen, --queue_.filled) {
    FrameRecord& record = queue_.records.front();
    draw(record, record.estimate.motion);
    early_.push_back(std::move(record.estimate.motion));
    queue_.records.pop_front();
  }
}

void FileRun::write_ready(bool last) {
  while (const auto motion = smoothed_front(*smoothing_, queue_, last)) {
    const FrameRecord& record = queue_.records.front();
    outputs_.write(*motion);
    if (hooks_.motion) {
      hooks_.motion(*motion);
    }
    statistics_.add(*motion);
    if (drawn_ > 0) {
      --drawn_;
    } else {
      draw(record, *motion);
    }
    queue_.records.pop_front();
    --queue_.filled;
    --queue_.chosen;
    --queue_.smoothed;
  }
}

void FileRun::draw(const FrameRecord& record, const MotionFrame& motion) {
  if (picture_side() == 0) {
    return;
  }
  // The overlay is a side result: an image that cannot be drawn is left out.
  try {
    const cv::Mat overlay =
        draw_overlay(record.frame.image, {.motion = &motion,
                                          .model = &run_.state.model,
                                          .camera = run_.tracker.camera,
                                          .face = record.features.face ? &*record.features.face : nullptr,
                                          .note = record.estimate.note});
    outputs_.write_overlay(overlay, motion.time);
    if (hooks_.picture) {
      hooks_.picture(overlay);
    }
  } catch (const cv::Exception& e) {
    note(std::string("the overlay cannot be drawn: ") + e.what());
  }
}

// Each note once, whatever its numbers, with the frame at which it came up first.
void FileRun::note(const std::string& message) {
  if (message.empty() || !reported_.first_time(message)) {
    return;
  }
  notes_.push_back({{"frame", std::max<std::int64_t>(0, frames_ - 1)}, {"note", message}});
  if (hooks_.message) {
    hooks_.message((frames_ == 0 ? "" : "frame " + std::to_string(frames_ - 1) + ": ") + message);
  }
}

}  // namespace telemime
