// SPDX-License-Identifier: Apache-2.0
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lab/synth/render.h"

namespace telemime {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kSide = 3;           // samples of a pixel along each side
constexpr int kBand = 8;           // rows of pixels that one task draws
constexpr float kNearest = 0.05f;  // m: triangles nearer to the camera are left out
constexpr float kSolid = 0.6f;     // opacity from which on hair hides what is behind it
constexpr float kFar = std::numeric_limits<float>::max();

// The samples that a triangle covers, with the shares of its corners.
template <typename Each>
void each_sample(const std::array<Vector2f, 3>& corners, int width, int first_row, int end_row,
                 const Each& each) {
  const auto& [a, b, c] = corners;
  const float area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  if (std::abs(area) < 1e-9f) {
    return;
  }
  const auto first = [](float x, float y, float z, int at_least) {
    return std::max(at_least, static_cast<int>(std::ceil(std::min({x, y, z}))));
  };
  const auto last = [](float x, float y, float z, int at_most) {
    return std::min(at_most, static_cast<int>(std::floor(std::max({x, y, z}))));
  };
  const int left = first(a.x(), b.x(), c.x(), 0);
  const int right = last(a.x(), b.x(), c.x(), width - 1);
  const int bottom = last(a.y(), b.y(), c.y(), end_row - 1);
  for (int y = first(a.y(), b.y(), c.y(), first_row); y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const Vector2f p(static_cast<float>(x), static_cast<float>(y));
      const float of_b = ((p - a).x() * (c - a).y() - (p - a).y() * (c - a).x()) / area;
      const float of_c = ((b - a).x() * (p - a).y() - (b - a).y() * (p - a).x()) / area;
      const Vector3f shares(1.0f - of_b - of_c, of_b, of_c);
      if (shares.minCoeff() >= 0.0f) {
        each(x, y, shares);
      }
    }
  }
}

// Colour and opacity at a place of a texture, which repeats.
cv::Vec4f texture_at(const cv::Mat& texture, const Vector2f& uv) {
  const float x = uv.x() * static_cast<float>(texture.cols) - 0.5f;
  const float y = (1.0f - uv.y()) * static_cast<float>(texture.rows) - 0.5f;
  const float left = std::floor(x);
  const float top = std::floor(y);
  const auto texel = [&](float column, float row) {
    const auto wrapped = [](float at, int size) {
      const int i = static_cast<int>(at) % size;
      return i < 0 ? i + size : i;
    };
    return texture.at<cv::Vec4f>(wrapped(row, texture.rows), wrapped(column, texture.cols));
  };
  const float right_share = x - left;
  const float low_share = y - top;
  return (texel(left, top) * (1.0f - right_share) + texel(left + 1.0f, top) * right_share) *
             (1.0f - low_share) +
         (texel(left, top + 1.0f) * (1.0f - right_share) + texel(left + 1.0f, top + 1.0f) * right_share) *
             low_share;
}

Vector2f texel_of(const MeshPart& part, const MeshPart::Triangle& t, const Vector3f& shares) {
  Vector2f uv = Vector2f::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    uv += shares[static_cast<Eigen::Index>(k)] * part.texels[static_cast<std::size_t>(t.texel[k])];
  }
  return uv;
}

// What the key light sees: the distance along it of the first surface, on a square around the person.
class ShadowMap {
 public:
  ShadowMap(const MeshPerson& person, const PosedMesh& posed, const Vector3f& to_key) {
    axes_.row(2) = -to_key.transpose();
    axes_.row(0) = Vector3f::UnitY().cross(-to_key).normalized().transpose();
    axes_.row(1) = (-to_key).cross(Vector3f(axes_.row(0).transpose())).transpose();
    Vector3f low = Vector3f::Constant(kFar);
    Vector3f high = -low;
    for (const auto& part : posed.vertices) {
      for (const Vector3f& v : part) {
        low = low.cwiseMin(v);
        high = high.cwiseMax(v);
      }
    }
    middle_ = 0.5f * (low + high);
    scale_ = 0.5f * kSize / std::max(0.5f * (high - low).norm(), 1e-3f);
    first_ = cv::Mat(kSize, kSize, CV_32F, cv::Scalar(kFar));
    for (std::size_t p = 0; p < person.parts.size(); ++p) {
      for (const MeshPart::Triangle& t : person.parts[p].triangles) {
        std::array<Vector2f, 3> corners;
        Vector3f depth;
        for (std::size_t k = 0; k < 3; ++k) {
          const Vector3f at = place(posed.vertices[p][static_cast<std::size_t>(t.vertex[k])]);
          corners[k] = at.head<2>();
          depth[static_cast<Eigen::Index>(k)] = at.z();
        }
        const MeshPart& part = person.parts[p];
        each_sample(corners, kSize, 0, kSize, [&](int x, int y, const Vector3f& shares) {
          if (!part.transparent || texture_at(part.texture, texel_of(part, t, shares))[3] > kSolid) {
            auto& nearest = first_.at<float>(y, x);
            nearest = std::min(nearest, shares.dot(depth));
          }
        });
      }
    }
  }

  // Share of the light that arrives at a point; `blur` (m) is the radius over which it changes.
  float lit(const Vector3f& at, float blur) const {
    const Vector3f p = place(at);
    const float step = 0.5f * blur * scale_;
    float sum = 0.0f;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const int x = static_cast<int>(std::lround(p.x() + static_cast<float>(dx) * step));
        const int y = static_cast<int>(std::lround(p.y() + static_cast<float>(dy) * step));
        const bool outside = x < 0 || y < 0 || x >= kSize || y >= kSize;
        sum += outside || p.z() - kSlack <= first_.at<float>(y, x) ? 1.0f : 0.0f;
      }
    }
    return sum / 25.0f;
  }

 private:
  static constexpr int kSize = 1024;
  static constexpr float kSlack = 0.004f;  // m: a surface does not cover itself

  Vector3f place(const Vector3f& at) const {
    const Vector3f p = axes_ * (at - middle_);
    return {0.5f * kSize + scale_ * p.x(), 0.5f * kSize + scale_ * p.y(), p.z()};
  }

  Eigen::Matrix3f axes_;
  Vector3f middle_;
  float scale_ = 1.0f;  // samples per m
  cv::Mat first_;
};

std::vector<Vector3f> normals_of(const MeshPart& part, const std::vector<Vector3f>& vertices) {
  std::vector<Vector3f> normals(vertices.size(), Vector3f::Zero());
  for (const MeshPart::Triangle& t : part.triangles) {
    const Vector3f& a = vertices[static_cast<std::size_t>(t.vertex[0])];
    const Vector3f n = (vertices[static_cast<std::size_t>(t.vertex[1])] - a)
                           .cross(vertices[static_cast<std::size_t>(t.vertex[2])] - a);
    for (const int v : t.vertex) {
      normals[static_cast<std::size_t>(v)] += n;
    }
  }
  return normals;
}

// Some rows of pixels, at kSide x kSide samples a pixel.
struct Band {
  int first_row;  // of samples, in the whole image
  int rows;       // of samples
  int width;      // in samples
  std::vector<Vector3f> light;
  std::vector<float> depth;
  std::vector<Surface> surface;

  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y - first_row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

struct Scenery {
  const PosedMesh& posed;
  const Lighting& lighting;
  const ShadowMap& shadows;
  std::vector<std::vector<Vector3f>> normals;    // of each part
  std::vector<std::vector<Vector3f>> projected;  // of each part: sample, 1 / distance

  void draw(const MeshPart& part, std::size_t p, Band& band) const {
    for (const MeshPart::Triangle& t : part.triangles) {
      std::array<Vector2f, 3> corners;
      std::array<std::size_t, 3> v{};
      Vector3f inverse;
      for (std::size_t k = 0; k < 3; ++k) {
        v[k] = static_cast<std::size_t>(t.vertex[k]);
        corners[k] = projected[p][v[k]].head<2>();
        inverse[static_cast<Eigen::Index>(k)] = projected[p][v[k]].z();
      }
      if (inverse.minCoeff() <= 0.0f || inverse.maxCoeff() > 1.0f / kNearest) {
        continue;
      }
      each_sample(corners, band.width, band.first_row, band.first_row + band.rows,
                  [&](int x, int y, const Vector3f& shares) {
                    const float z = 1.0f / shares.dot(inverse);
                    const std::size_t here = band.at(x, y);
                    if (z < band.depth[here]) {
                      // The shares in space, not in the image.
                      add(part, t, p, v, z * shares.cwiseProduct(inverse), z, here, band);
                    }
                  });
    }
  }

  void add(const MeshPart& part, const MeshPart::Triangle& t, std::size_t p,
           const std::array<std::size_t, 3>& v, const Vector3f& shares, float z, std::size_t here,
           Band& band) const {
    SurfacePoint point{Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero(), Vector3f::Zero()};
    for (std::size_t k = 0; k < 3; ++k) {
      const float share = shares[static_cast<Eigen::Index>(k)];
      point.normal += share * normals[p][v[k]];
      point.at += share * posed.vertices[p][v[k]];
    }
    const cv::Vec4f colour = texture_at(part.texture, texel_of(part, t, shares));
    const float opacity = part.transparent ? colour[3] : 1.0f;
    if (opacity < 0.1f) {
      return;
    }
    point.colour = {colour[2], colour[1], colour[0]};
    point.direction = point.at.normalized();
    point.normal.normalize();
    // Thin surfaces, as hair and collars, are seen from behind, too.
    if (point.normal.dot(point.direction) > 0.0f) {
      point.normal = -point.normal;
    }
    point.lit = shadows.lit(point.at + 0.006f * point.normal, 0.008f);
    const Vector3f light = light_of(lighting, point, t.surface);
    band.light[here] = (1.0f - opacity) * band.light[here] + opacity * light;
    if (opacity > kSolid) {
      band.depth[here] = z;
      band.surface[here] = t.surface;
    }
  }
};

}  // namespace

RenderedImage render_mesh_scene(const Camera& camera, const Backdrop& backdrop, const MeshPerson& person,
                                const PosedMesh& posed, const Lighting& lighting) {
  check_size(camera, backdrop);
  const ShadowMap shadows(person, posed, lighting.to_key.normalized());
  Scenery scenery{posed, lighting, shadows, {}, {}};
  for (std::size_t p = 0; p < person.parts.size(); ++p) {
    scenery.normals.push_back(normals_of(person.parts[p], posed.vertices[p]));
    std::vector<Vector3f>& projected = scenery.projected.emplace_back();
    for (const Vector3f& at : posed.vertices[p]) {
      if (at.z() <= 0.0f) {
        projected.emplace_back(0.0f, 0.0f, -1.0f);
        continue;
      }
      const Eigen::Vector2d pixel = camera.project(at.cast<double>());
      // The middle sample of a pixel is at its centre.
      const auto sample = [](double u) { return static_cast<float>((u + 0.5) * kSide - 0.5); };
      projected.emplace_back(sample(pixel.x()), sample(pixel.y()), 1.0f / at.z());
    }
  }

  RenderedImage result;
  result.light = cv::Mat(camera.height, camera.width, CV_32FC3);
  result.surfaces = cv::Mat(camera.height, camera.width, CV_8U);
  const auto wall = static_cast<float>(backdrop.distance);
  const int bands = (camera.height + kBand - 1) / kBand;
  tbb::parallel_for(0, bands, [&](int index) {
    const int top = index * kBand;
    const int rows = std::min(kBand, camera.height - top);
    Band band{top * kSide, rows * kSide, camera.width * kSide, {}, {}, {}};
    const auto samples = static_cast<std::size_t>(band.rows) * static_cast<std::size_t>(band.width);
    band.light.resize(samples);
    band.depth.assign(samples, kFar);
    band.surface.assign(samples, Surface::background);
    const auto samples_of = [&](int x, int y, const auto& each) {
      for (int dy = 0; dy < kSide; ++dy) {
        for (int dx = 0; dx < kSide; ++dx) {
          each(band.at(x * kSide + dx, y * kSide + dy));
        }
      }
    };
    for (int y = top; y < top + rows; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        const Vector3f at = wall * ray_of(camera, static_cast<float>(x), static_cast<float>(y));
        const Vector3f light = light_on_wall(lighting, at, shadows.lit(at, 0.06f));
        const auto& albedo = backdrop.albedo.at<cv::Vec3f>(y, x);
        const Vector3f seen = Vector3f(albedo[2], albedo[1], albedo[0]).cwiseProduct(light);
        samples_of(x, y, [&](std::size_t i) { band.light[i] = seen; });
      }
    }
    for (const bool transparent : {false, true}) {
      for (std::size_t p = 0; p < person.parts.size(); ++p) {
        if (person.parts[p].transparent == transparent) {
          scenery.draw(person.parts[p], p, band);
        }
      }
    }
    for (int y = top; y < top + rows; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        Vector3f sum = Vector3f::Zero();
        samples_of(x, y, [&](std::size_t i) { sum += band.light[i].cwiseMin(1.2f); });
        sum /= static_cast<float>(kSide * kSide);
        result.light.at<cv::Vec3f>(y, x) = {sum.z(), sum.y(), sum.x()};
        result.surfaces.at<std::uint8_t>(y, x) =
            static_cast<std::uint8_t>(band.surface[band.at(x * kSide + kSide / 2, y * kSide + kSide / 2)]);
      }
    }
  });
  return result;
}

}  // namespace telemime
