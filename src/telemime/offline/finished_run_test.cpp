// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/finished_run.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <utility>

#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

// A run that is finished: its clip, one output and its report.
struct FinishedExample {
  ScratchFolder folder;
  TrackRequest request;

  FinishedExample() {
    request.input = folder.file("clip.mp4");
    request.out = folder.path() / "out";
    fs::create_directories(request.out);
    std::ofstream(request.input) << "a clip";
    std::ofstream(request.out / "pose.jsonl") << "poses";
    write({{"request", request_json(request)}, {"interrupted", false}, {"files", {pose()}}});
  }
  std::string pose() const { return (request.out / "pose.jsonl").string(); }
  void write(const nlohmann::json& report) const { std::ofstream(request.out / "report.json") << report; }
};

TEST(FinishedRun, IsOneWithAReportOfTheSameRequest) {
  FinishedExample run;
  EXPECT_EQ(finished_run(run.request), FinishedRun::complete);
  run.request.config.threads = 3;
  EXPECT_EQ(finished_run(run.request), FinishedRun::complete) << "threads change no result";
}

TEST(FinishedRun, AnyOtherRequestIsNot) {
  const std::vector<void (*)(TrackRequest&)> changes = {
      [](TrackRequest& r) { r.config.seed = 7; },
      [](TrackRequest& r) { r.config.quality = "fast"; },
      [](TrackRequest& r) { r.config.smoothing.name = "none"; },
      [](TrackRequest& r) { r.background = "empty.mp4"; },
      [](TrackRequest& r) { r.camera = "camera.yml"; },
      [](TrackRequest& r) { r.calibration = "person.json"; },
      [](TrackRequest& r) { r.input_options.rate = 12.0; },
      [](TrackRequest& r) { r.input_options.mirrored = true; },
      [](TrackRequest& r) { r.formats = {"bvh"}; },
      [](TrackRequest& r) { r.overlay = false; },
      [](TrackRequest& r) { r.output_options.fingers = false; },
      [](TrackRequest& r) { r.most_frames = 5; },
      [](TrackRequest& r) { r.version = "99.0.0"; },
      [](TrackRequest& r) { r.out = r.out.parent_path(); },
  };
  for (std::size_t i = 0; i < changes.size(); ++i) {
    FinishedExample run;
    changes[i](run.request);
    EXPECT_EQ(finished_run(run.request), FinishedRun::none) << "change " << i;
  }
}

TEST(FinishedRun, OneThatWasStoppedOrIsIncompleteIsNot) {
  FinishedExample run;
  run.write({{"request", request_json(run.request)}, {"interrupted", true}, {"files", {run.pose()}}});
  EXPECT_EQ(finished_run(run.request), FinishedRun::none);
  run.write({{"request", request_json(run.request)}, {"interrupted", false}});
  EXPECT_EQ(finished_run(run.request), FinishedRun::none) << "no files";
  for (const char* text : {"", "{", "[]", "null", "{\"files\": 3}", "{\"request\": {}}"}) {
    std::ofstream(run.request.out / "report.json") << text;
    EXPECT_EQ(finished_run(run.request), FinishedRun::none) << text;
  }
  FinishedExample without;
  fs::remove(without.pose());
  EXPECT_EQ(finished_run(without.request), FinishedRun::none);
}

TEST(FinishedRun, AnotherInputOfTheSameNameIsTrackedAgain) {
  for (const int hours : {1, -1}) {
    const FinishedExample run;
    const auto time = fs::last_write_time(run.request.input);
    fs::last_write_time(run.request.input, time + std::chrono::hours(hours));
    EXPECT_EQ(finished_run(run.request), FinishedRun::none) << hours;
    fs::last_write_time(run.request.input, time);
    EXPECT_EQ(finished_run(run.request), FinishedRun::complete);
    std::ofstream(run.request.input) << "another clip";
    fs::last_write_time(run.request.input, time);
    EXPECT_EQ(finished_run(run.request), FinishedRun::none) << "another size";
  }
}

// Overwriting an image changes neither the time of its folder nor a pattern.
TEST(FinishedRun, ImagesThatWereReplacedAreTrackedAgain) {
  for (const char* name : {"shots", "shots/*.png", "shots/%d.png"}) {
    FinishedExample run;
    fs::create_directories(run.folder.path() / "shots");
    const std::string second = run.folder.file("shots/2.png");
    std::ofstream(run.folder.file("shots/1.png")) << "an image";
    std::ofstream(second) << "an image";
    run.request.input = run.folder.file(name);
    run.write({{"request", request_json(run.request)}, {"interrupted", false}, {"files", {run.pose()}}});
    EXPECT_EQ(finished_run(run.request), FinishedRun::complete) << name;
    const auto time = fs::last_write_time(second);
    const auto time_of_folder = fs::last_write_time(run.folder.path() / "shots");
    std::ofstream(second) << "another image";
    fs::last_write_time(second, time);
    fs::last_write_time(run.folder.path() / "shots", time_of_folder);
    EXPECT_EQ(finished_run(run.request), FinishedRun::none) << name << ", another size";
    std::ofstream(second) << "an image";
    fs::last_write_time(second, time + std::chrono::hours(1));
    EXPECT_EQ(finished_run(run.request), FinishedRun::none) << name << ", another time";
    fs::last_write_time(second, time);
    EXPECT_EQ(finished_run(run.request), FinishedRun::complete) << name;
  }
}

TEST(FinishedRun, AStreamIsTrackedAgain) {
  FinishedExample run;
  run.request.input = "http://nas/clip?id=6";
  run.write({{"request", request_json(run.request)}, {"interrupted", false}, {"files", {run.pose()}}});
  EXPECT_EQ(finished_run(run.request), FinishedRun::none);
}

TEST(FinishedRun, NobodyTrackedIsNoSuccess) {
  const FinishedExample run;
  run.write({{"request", request_json(run.request)},
             {"interrupted", false},
             {"files", {run.pose()}},
             {"tracked", 0}});
  EXPECT_EQ(finished_run(run.request), FinishedRun::nobody_tracked);
}

TEST(FinishedRun, NamesNeedNotBeUtf8) {
  FinishedExample run;
  run.request.input = run.folder.file("caf\xe9.mp4");
  std::ofstream(run.request.input) << "a clip";
  std::ofstream(run.request.out / "report.json") << nlohmann::json{
      {"request", request_json(run.request)},
      {"interrupted", false},
      {"files", {run.pose()}}}.dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
  EXPECT_EQ(finished_run(run.request), FinishedRun::complete);
}

TEST(FinishedRun, SoIsWhatHasNewerLimitsOrNumbers) {
  FinishedExample run;
  const std::string numbers = run.folder.file("numbers.json");
  std::ofstream(numbers) << "{}";
  fs::last_write_time(numbers, fs::file_time_type::clock::now() - std::chrono::hours(1));
  for (std::string* setting : {&run.request.config.limits, &run.request.config.filter.model}) {
    const std::string before = std::exchange(*setting, numbers);
    run.write({{"request", request_json(run.request)}, {"interrupted", false}, {"files", {run.pose()}}});
    EXPECT_EQ(finished_run(run.request), FinishedRun::complete);
    fs::last_write_time(numbers, fs::file_time_type::clock::now() + std::chrono::hours(1));
    EXPECT_EQ(finished_run(run.request), FinishedRun::none);
    fs::last_write_time(numbers, fs::file_time_type::clock::now() - std::chrono::hours(1));
    *setting = before;
  }
}

TEST(FinishedRun, AnInputGivenByUrlIsAFileToo) {
  FinishedExample run;
  const std::string path = run.request.input;
  run.request.input = "file://" + path;
  run.write({{"request", request_json(run.request)}, {"interrupted", false}, {"files", {run.pose()}}});
  EXPECT_EQ(finished_run(run.request), FinishedRun::complete);
  fs::last_write_time(path, fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(finished_run(run.request), FinishedRun::none);
}

TEST(FinishedRun, AReportHoldsNoPasswords) {
  TrackRequest request;
  request.input = "http://me:secret@host/clip.mp4?token=secret";
  request.background = "http://me:secret@host/empty.mp4";
  EXPECT_EQ(request_json(request).dump().find("secret"), std::string::npos);
}

}  // namespace
}  // namespace telemime
