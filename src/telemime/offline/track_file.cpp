// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/track_file.h"

#include <chrono>
#include <memory>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/offline/file_run.h"
#include "telemime/offline/look_ahead.h"
#include "telemime/tracker/person_file.h"
#include "telemime/tracker/scene.h"
#include "telemime/tracker/set_up.h"

namespace telemime {
namespace {

// An opened file and the run that tracks it, with what the background clip or a calibration file teaches.
struct OpenedFile {
  std::unique_ptr<Source> source;
  TrackingRun run;
  std::vector<std::string> messages;  ///< how person and background became known
};

OpenedFile open_file(const TrackRequest& request, const RunHooks& hooks) {
  auto source = open_source(request.input, request.input_options);
  if (source->info().live) {
    throw Error(ErrorKind::usage, source->info().name + " is a camera: `telemime live` tracks cameras",
                "Run `telemime live`, or record a clip first and track the clip.");
  }
  source = without_distortion(std::move(source), request);
  std::vector<std::string> messages;
  TrackingRun run = open_run(request, source->info(), messages);
  if (request.calibration.empty()) {
    messages.push_back(learn_scene(request, source->info(), run));
  }
  if (hooks.message) {
    for (const std::string& message : messages) {
      hooks.message(message);
    }
  }
  return {std::move(source), std::move(run), std::move(messages)};
}

// Frames of the source, no more than the request asks for.
std::function<std::optional<Frame>()> frames_of(const TrackRequest& request, Source& source) {
  // Copies of the function count together.
  return [&source, most = request.most_frames, count = std::make_shared<std::int64_t>(0)] {
    return most == 0 || (*count)++ < most ? source.next() : std::nullopt;
  };
}

bool looks_ahead(const TrackRequest& request) {
  return request.calibration.empty() && request.config.calibration.look_ahead > 0;
}

// Where the look-ahead asks the viewer whether to go on.
std::function<bool(const FrameRecord&)> go_on_of(const RunHooks& hooks, std::int64_t total) {
  return [&hooks, total, start = std::chrono::steady_clock::now()](const FrameRecord& record) {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start;
    return !hooks.progress ||
           hooks.progress({.frames = record.frame.index + 1, .total = total, .seconds = passed.count()}) !=
               ViewerRequest::stop;
  };
}

void report_fit(const FittedPerson& person, const RunHooks& hooks) {
  if (hooks.message) {
    hooks.message(person.keyframes > 0 ? "the body was fitted to " + std::to_string(person.keyframes) +
                                             " of the first " + std::to_string(person.frames) + " frames"
                                       : "the body was fitted to one frame: too few others show both arms");
  }
}

}  // namespace

CalibratedPerson calibrate_file(const TrackRequest& request, const RunHooks& hooks,
                                const std::filesystem::path& file) {
  prepare_file(file, request);
  TrackRequest forward = request;
  forward.config.look_back = false;
  OpenedFile opened = open_file(forward, hooks);
  TrackingRun& run = opened.run;
  const auto next = frames_of(request, *opened.source);
  std::string reason = "the input holds no frame that can be read";
  std::optional<CalibratedPerson> person;
  if (looks_ahead(forward)) {
    const auto keep_reason = [&](FrameRecord record) {
      reason = record.estimate.note.empty() ? reason : record.estimate.note;
    };
    LookAhead ahead = look_ahead({.next = next,
                                  .settle = keep_reason,
                                  .go_on = go_on_of(hooks, frames_to_come(request, opened.source->info()))},
                                 run);
    if (ahead.person) {
      report_fit(*ahead.person, hooks);
      person = ahead.person->start.person;
    }
    for (FrameRecord& record : ahead.records) {
      keep_reason(std::move(record));
    }
  }
  while (!person) {
    const std::optional<Frame> frame = next();
    if (!frame) {
      throw Error(ErrorKind::tracking,
                  "no frame of " + opened.source->info().name + " could be used to calibrate: " + reason,
                  "Face the camera with the arms a little apart from the body.");
    }
    const FrameRecord record = track_frame(*frame, run);
    person = run.state.person;
    reason = record.estimate.note.empty() ? reason : record.estimate.note;
  }
  save_person({.person = *person,
               .camera = run.tracker.camera,
               .image = run.scene.features.calibration(),
               .lens = lens_for(opened.source->info(), request)},
              file);
  if (const std::string complaint = opened.source->complaint(); hooks.message && !complaint.empty()) {
    hooks.message(opened.source->info().name + ": " + complaint);
  }
  return *person;
}

TrackSummary track_file(const TrackRequest& request, const RunHooks& hooks) {
  prepare_outputs(request);
  OpenedFile opened = open_file(request, hooks);
  TrackingRun& run = opened.run;
  FileRun file(request, hooks, opened.source->info(), run);
  const auto next = frames_of(request, *opened.source);
  ViewerRequest asked = ViewerRequest::none;
  // Every tracked frame is written, whatever the viewer has asked for in the meantime.
  const auto add = [&](FrameRecord record) {
    const ViewerRequest wish = file.add(std::move(record));
    asked = wish == ViewerRequest::none || asked == ViewerRequest::stop ? asked : wish;
  };

  // The body, fitted to many frames before the first is written.
  if (looks_ahead(request)) {
    const auto goes_on = go_on_of(hooks, frames_to_come(request, opened.source->info()));
    const auto go_on = [&](const FrameRecord& record) {
      asked = goes_on(record) ? asked : ViewerRequest::stop;
      return asked != ViewerRequest::stop;
    };
    LookAhead ahead =
        look_ahead({.next = next, .settle = add, .go_on = go_on, .longest_side = file.picture_side()}, run);
    if (ahead.person) {
      report_fit(*ahead.person, hooks);
    }
    if (asked == ViewerRequest::recalibrate) {
      asked = ViewerRequest::none;  // that has just been done
    }
    for (FrameRecord& record : ahead.records) {
      add(std::move(record));
    }
  }
  // Frame by frame, until the input ends or the viewer stops.
  while (asked != ViewerRequest::stop) {
    if (asked == ViewerRequest::recalibrate) {
      file.end_person();
      forget_person(run);
      asked = ViewerRequest::none;
    }
    const std::optional<Frame> frame = next();
    if (!frame) {
      break;
    }
    add(track_frame(*frame, run));
  }
  if (file.frames() == 0) {
    throw Error(ErrorKind::input, opened.source->info().name + " holds no frame that can be read",
                opened.source->complaint());
  }
  return file.finish(asked == ViewerRequest::stop, opened.source->complaint(), opened.messages);
}

}  // namespace telemime
