// SPDX-License-Identifier: Apache-2.0
#include "live/scripted_source.h"

#include <chrono>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "support/quick_config.h"
#include "support/synthetic_clip.h"

namespace telemime::live_testing {
namespace {

const support::SyntheticClip& clip() {
  static const support::SyntheticClip the_clip = support::synthetic_clip(12, 6);
  return the_clip;
}

class SceneCamera final : public Source {
 public:
  explicit SceneCamera(std::shared_ptr<ScriptedScene> scene) : scene_(std::move(scene)) {
    info_.name = "scene";
    info_.width = scene_->first().image.cols;
    info_.height = scene_->first().image.rows;
    info_.live = true;
  }
  const SourceInfo& info() const override { return info_; }
  std::string complaint() const override { return "the cable is out"; }
  std::optional<Frame> next() override { return scene_->next(); }
  void stop() override { scene_->stop(); }

 private:
  std::shared_ptr<ScriptedScene> scene_;
  SourceInfo info_;
};

}  // namespace

void ScriptedScene::show(std::vector<Frame> frames) {
  {
    const std::lock_guard lock(mutex_);
    if (first_.image.empty()) {
      first_ = frames.front();
    }
    frames_ = std::move(frames);
    at_ = 0;
  }
  changed_.notify_all();
}

void ScriptedScene::end() {
  stop();
}

void ScriptedScene::stop() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
}

std::optional<Frame> ScriptedScene::next() {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, std::chrono::milliseconds(1), [this] { return ended_; });
  changed_.wait(lock, [this] { return ended_ || !frames_.empty(); });
  if (ended_) {
    return std::nullopt;
  }
  Frame frame = frames_[at_++ % frames_.size()];
  frame.index = count_++;
  frame.time = static_cast<double>(frame.index) / support::kClipFps;
  frame.taken = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  return frame;
}

std::unique_ptr<Source> camera_of(std::shared_ptr<ScriptedScene> scene) {
  return std::make_unique<SceneCamera>(std::move(scene));
}

std::shared_ptr<ScriptedScene> person_scene() {
  auto scene = std::make_shared<ScriptedScene>();
  scene->show(person());
  return scene;
}

TrackRequest quick_request(const ScratchFolder& folder) {
  TrackRequest request;
  request.background = folder.file("room");
  std::filesystem::create_directories(request.background);
  for (std::size_t i = 0; i < empty_room().size(); ++i) {
    cv::imwrite(request.background + "/" + std::to_string(1000 + i) + ".png", empty_room()[i].image);
  }
  request.config = support::quick_config();
  request.config.filter.particles = 300;
  return request;
}

const std::vector<Frame>& person() {
  return clip().person;
}

const std::vector<Frame>& empty_room() {
  return clip().background;
}

std::vector<Frame> person_repeated(int times) {
  std::vector<Frame> frames;
  for (int i = 0; i < times; ++i) {
    frames.insert(frames.end(), person().begin(), person().end());
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].index = static_cast<std::int64_t>(i);
    frames[i].time = static_cast<double>(i) / support::kClipFps;
  }
  return frames;
}

}  // namespace telemime::live_testing
