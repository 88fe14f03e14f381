// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "lab/synth/avatar.h"
#include "lab/synth/mesh_person.h"
#include "telemime/core/camera.h"
#include "telemime/core/random.h"

namespace telemime {

/// The background of the scene: one wall parallel to the image, with a window, shelves of books and posters.
struct Backdrop {
  double distance = 2.4;  ///< of the wall from the camera, m
  cv::Mat albedo;         ///< (height x width) CV_32FC3, what the wall reflects per pixel, linear light, BGR
};

/// Draws a background for this camera. It avoids the hues of skin; `shirt_index` (of Look) keeps its second
/// colour apart from the shirt's. The distance lies in [2.2, 2.6) m.
Backdrop make_backdrop(const Camera& camera, int shirt_index, Random& random);

/// The lights: a soft window-like key light from the upper left behind the camera, light from all sides, and
/// a warm lamp at the right that may come on.
struct Lighting {
  Eigen::Vector3f to_key{-0.46f, -0.42f, -0.78f};  ///< camera frame, toward the light; any length
  float key = 0.84f;
  float ambient = 0.46f;
  float lamp = 0.0f;                           ///< 0 off ... 1 on
  Eigen::Vector3f lamp_at{1.1f, -0.7f, 0.7f};  ///< camera frame, m
};

/// A point of a surface that the camera sees, in the camera's frame.
struct SurfacePoint {
  Eigen::Vector3f at;         ///< m
  Eigen::Vector3f normal;     ///< length 1
  Eigen::Vector3f direction;  ///< from the camera to the point, length 1
  Eigen::Vector3f colour;     ///< of the surface, linear light
  float lit = 1.0f;           ///< share of the key light that arrives
  float open = 1.0f;          ///< share of the room's light that arrives
};

/// The light that the point sends to the camera, linear light.
Eigen::Vector3f light_of(const Lighting& lights, const SurfacePoint& point, Surface surface);

/// The light that falls on the wall at a point (camera frame, m) at which this share of the key light
/// arrives.
Eigen::Vector3f light_on_wall(const Lighting& lights, const Eigen::Vector3f& at, float lit);

/// The ray of a place in the image (px), camera frame, z = 1.
Eigen::Vector3f ray_of(const Camera& camera, float u, float v);

/// Error(usage) unless the backdrop was drawn for the size of the camera.
void check_size(const Camera& camera, const Backdrop& backdrop);

/// A picture without sensor noise.
struct RenderedImage {
  cv::Mat light;     ///< (height x width) CV_32FC3, linear light, BGR, 1 is white
  cv::Mat surfaces;  ///< (height x width) CV_8UC1, Surface at the pixel's centre
};

/// Renders the person (nullptr: none) in front of the backdrop by sphere tracing, with soft shadows on the
/// body and on the wall, ambient occlusion, and four rays per pixel along edges. The backdrop's albedo must
/// have the camera's size, else Error(usage). Runs on the calling thread's oneTBB arena; the result does not
/// depend on its size.
RenderedImage render_scene(const Camera& camera, const Backdrop& backdrop, const Avatar* avatar,
                           const Lighting& lighting);

/// The same for a person of meshes, by a depth buffer with nine samples a pixel and a shadow map.
RenderedImage render_mesh_scene(const Camera& camera, const Backdrop& backdrop, const MeshPerson& person,
                                const PosedMesh& posed, const Lighting& lighting);

}  // namespace telemime
