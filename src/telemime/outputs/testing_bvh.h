// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "telemime/outputs/bvh/skeleton.h"
#include "telemime/outputs/numbers.h"

/// Reads the BVH files that the encoder writes. Readers of others are in tests/readers.
namespace telemime::testing_bvh {

/// Positions and rotations, each along x, y and z in this order.
inline constexpr std::array<std::string_view, 6> kChannels = {"Xposition", "Yposition", "Zposition",
                                                              "Xrotation", "Yrotation", "Zrotation"};

struct BvhFile {
  std::vector<BvhJoint> joints;  ///< parents before their children, one root
  /// Of each joint, by place in kChannels; rotations multiply in this order, leftmost first.
  std::vector<std::vector<std::size_t>> channels;
  double frame_time = 0.04;                 ///< s
  std::vector<std::vector<double>> frames;  ///< (frames x channels), cm and degrees
};

/// Checks that the file has the number of frames that it states, and every frame a value for each channel.
inline BvhFile parse_bvh(const std::string& text) {
  std::istringstream in(text);
  BvhFile file;
  std::vector<int> open;
  bool in_end_site = false;
  std::size_t channels = 0;
  for (std::string word; in >> word && word != "MOTION";) {
    if (word == "ROOT" || word == "JOINT") {
      BvhJoint joint;
      in >> joint.name;
      joint.parent = open.empty() ? -1 : open.back();
      open.push_back(static_cast<int>(file.joints.size()));
      file.joints.push_back(joint);
      file.channels.emplace_back();
    } else if (word == "OFFSET") {
      Eigen::Vector3d offset;
      in >> offset.x() >> offset.y() >> offset.z();
      if (in_end_site) {
        file.joints.back().end_site = offset;
      } else {
        file.joints.back().offset = offset;
      }
    } else if (word == "CHANNELS") {
      std::size_t count = 0;
      in >> count;
      channels += count;
      for (std::string name; count > 0 && in >> name; --count) {
        const auto* const found = std::find(kChannels.begin(), kChannels.end(), name);
        EXPECT_NE(found, kChannels.end()) << name;
        file.channels.back().push_back(static_cast<std::size_t>(found - kChannels.begin()));
      }
    } else if (word == "End") {
      in_end_site = true;
    } else if (word == "}" && in_end_site) {
      in_end_site = false;
    } else if (word == "}") {
      open.pop_back();
    }
  }
  std::size_t stated = 0;
  std::string word;
  in >> word >> stated >> word >> word >> file.frame_time;
  EXPECT_FALSE(in.fail()) << "the file ends before its frames";
  for (std::string line; std::getline(in >> std::ws, line);) {
    std::istringstream numbers(line);
    file.frames.emplace_back(std::istream_iterator<double>(numbers), std::istream_iterator<double>());
    EXPECT_EQ(file.frames.back().size(), channels);
  }
  EXPECT_EQ(file.frames.size(), stated);
  return file;
}

/// Where every joint stands in one frame: world_from_joint, cm.
inline std::vector<Eigen::Isometry3d> bvh_world(const BvhFile& file, std::size_t frame) {
  std::vector<Eigen::Isometry3d> world;
  auto value = file.frames.at(frame).begin();
  for (std::size_t j = 0; j < file.joints.size(); ++j) {
    const BvhJoint& joint = file.joints[j];
    Eigen::Isometry3d local(Eigen::Translation3d(joint.offset));
    for (const std::size_t channel : file.channels[j]) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(channel % 3));
      if (channel < 3) {
        local.pretranslate(*value++ * axis);
      } else {
        local.rotate(Eigen::AngleAxisd(*value++ / kDegreesPerRadian, axis));
      }
    }
    world.push_back(joint.parent < 0 ? local : world[static_cast<std::size_t>(joint.parent)] * local);
  }
  return world;
}

}  // namespace telemime::testing_bvh
