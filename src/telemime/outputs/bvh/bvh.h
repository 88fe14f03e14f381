// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace telemime {

/// Positions and rotations, each along x, y and z in this order.
enum class BvhChannel { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

/// One joint of a BVH hierarchy. Lengths in the file's unit, at rest all joint frames are parallel.
struct BvhJoint {
  std::string name;
  int parent = -1;  ///< index of the parent, smaller than the own; -1 for the root
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the parent
  std::vector<BvhChannel> channels;                  ///< rotations multiply in this order, leftmost first
  std::optional<Eigen::Vector3d> end_site;           ///< end of a joint without children
};

/// The content of a BVH file.
struct BvhFile {
  std::vector<BvhJoint> joints;             ///< parents before their children, one root
  double frame_time = 0.04;                 ///< s
  std::vector<std::vector<double>> frames;  ///< (frames x channels), file's unit and degrees
  std::string complaint;  ///< words about a cut end or a wrong count of frames; empty when there are none
};

/// Reads the text of a BVH file. A last frame that is cut off is left out and reported; so is a stated number
/// of frames that is not the number found. Throws Error(input) that names `name` and the line for anything
/// else.
BvhFile parse_bvh(std::string_view text, const std::string& name);

/// Where every joint stands in one frame: world_from_joint, file's unit.
std::vector<Eigen::Isometry3d> bvh_world(const BvhFile& file, std::size_t frame);

}  // namespace telemime
