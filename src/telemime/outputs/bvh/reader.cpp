// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>

#include "telemime/core/errors.h"
#include "telemime/outputs/bvh/bvh.h"
#include "telemime/outputs/numbers.h"
#include "telemime/outputs/readers/words.h"

namespace telemime {
namespace {

constexpr std::array<std::string_view, 6> kChannelNames = {"Xposition", "Yposition", "Zposition",
                                                           "Xrotation", "Yrotation", "Zrotation"};
constexpr std::size_t kMostChannels = 6;

class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  BvhFile run() {
    next_line("HIERARCHY");
    require(words_.size() == 1 && words_[0] == "HIERARCHY", "HIERARCHY was expected");
    hierarchy();
    motion();
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorKind::input, name_ + ", line " + std::to_string(line_) + ": " + what,
                "is it a BVH file?");
  }

  void require(bool condition, const std::string& what) const {
    if (!condition) {
      fail(what);
    }
  }

  /// The next line that is not blank into words_; false at the end of the text.
  bool advance() {
    while (!text_.empty()) {
      words_ = split_words(take_line(text_));
      ++line_;
      if (!words_.empty()) {
        return true;
      }
    }
    return false;
  }

  void next_line(const std::string& expected) { require(advance(), "the file ends before " + expected); }

  double number(std::string_view word) const {
    const auto value = to_number<double>(word);
    require(value && std::isfinite(*value), "\"" + std::string(word.substr(0, 40)) + "\" is not a number");
    return *value;
  }

  Eigen::Vector3d offset() const {
    require(words_.size() == 4 && words_[0] == "OFFSET", "OFFSET x y z was expected");
    return {number(words_[1]), number(words_[2]), number(words_[3])};
  }

  void open_joint(int parent) {
    require(words_.size() >= 2, "a joint needs a name");
    BvhJoint joint;
    joint.name = std::string(words_[1]);
    joint.parent = parent;
    next_line("{");
    require(words_.size() == 1 && words_[0] == "{", "{ was expected");
    next_line("OFFSET");
    joint.offset = offset();
    next_line("CHANNELS");
    require(words_.size() >= 2 && words_[0] == "CHANNELS", "CHANNELS was expected");
    const auto count = to_number<std::size_t>(words_[1]);
    require(count && *count <= kMostChannels && words_.size() == *count + 2,
            "the number of channels does not agree with their names");
    for (std::size_t w = 2; w < words_.size(); ++w) {
      const auto* const found = std::find(kChannelNames.begin(), kChannelNames.end(), words_[w]);
      require(found != kChannelNames.end(), "unknown channel " + std::string(words_[w].substr(0, 40)));
      joint.channels.push_back(static_cast<BvhChannel>(found - kChannelNames.begin()));
    }
    channels_ += joint.channels.size();
    file_.joints.push_back(std::move(joint));
  }

  void end_site(int joint) {
    next_line("{");
    require(words_[0] == "{", "{ was expected");
    next_line("OFFSET");
    file_.joints[static_cast<std::size_t>(joint)].end_site = offset();
    next_line("}");
    require(words_[0] == "}", "} was expected");
  }

  void hierarchy() {
    next_line("ROOT");
    require(words_[0] == "ROOT", "ROOT was expected");
    open_joint(-1);
    std::vector<int> open = {0};
    while (!open.empty()) {
      next_line("the end of the hierarchy");
      if (words_[0] == "JOINT") {
        open_joint(open.back());
        open.push_back(static_cast<int>(file_.joints.size()) - 1);
      } else if (words_[0] == "End") {
        end_site(open.back());
      } else if (words_[0] == "}") {
        open.pop_back();
      } else {
        fail("JOINT, End Site or } was expected");
      }
    }
  }

  void motion() {
    next_line("MOTION");
    require(words_[0] == "MOTION", "MOTION was expected (files with several roots are not read)");
    next_line("Frames:");
    require(words_.size() == 2 && words_[0] == "Frames:", "Frames: and their number were expected");
    const auto stated = to_number<std::int64_t>(words_[1]);
    require(stated && *stated >= 0, "the number of frames is not a number");
    next_line("Frame Time:");
    require(words_.size() == 3 && words_[0] == "Frame" && words_[1] == "Time:", "Frame Time: was expected");
    file_.frame_time = number(words_[2]);
    require(file_.frame_time > 0.0, "the frame time must be greater than 0");
    while (advance()) {
      const bool last = text_.find_first_not_of(" \t\r\n") == std::string_view::npos;
      if (words_.size() < channels_ && last) {
        file_.complaint = name_ + ", line " + std::to_string(line_) + " is cut off; that frame was left out";
        return;
      }
      require(words_.size() == channels_,
              std::to_string(channels_) + " values were expected, not " + std::to_string(words_.size()));
      std::vector<double> values;
      for (const std::string_view word : words_) {
        values.push_back(number(word));
      }
      file_.frames.push_back(std::move(values));
    }
    if (file_.frames.size() != static_cast<std::size_t>(*stated)) {
      file_.complaint = name_ + " states " + std::to_string(*stated) + " frames but has " +
                        std::to_string(file_.frames.size());
    }
  }

  std::string_view text_;
  std::string name_;
  BvhFile file_;
  std::vector<std::string_view> words_;
  std::size_t line_ = 0;
  std::size_t channels_ = 0;
};

}  // namespace

BvhFile parse_bvh(std::string_view text, const std::string& name) {
  return Parser(text, name).run();
}

std::vector<Eigen::Isometry3d> bvh_world(const BvhFile& file, std::size_t frame) {
  std::vector<Eigen::Isometry3d> world;
  auto value = file.frames.at(frame).begin();
  for (const BvhJoint& joint : file.joints) {
    Eigen::Vector3d place = joint.offset;
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    for (const BvhChannel channel : joint.channels) {
      const double amount = *value++;
      const auto axis = static_cast<Eigen::Index>(channel) % 3;
      if (channel <= BvhChannel::z_position) {
        place[axis] += amount;
      } else {
        turn *= Eigen::AngleAxisd(amount / kDegreesPerRadian, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
      }
    }
    Eigen::Isometry3d local = Eigen::Isometry3d::Identity();
    local.linear() = turn;
    local.translation() = place;
    world.push_back(joint.parent < 0 ? local : world[static_cast<std::size_t>(joint.parent)] * local);
  }
  return world;
}

}  // namespace telemime
