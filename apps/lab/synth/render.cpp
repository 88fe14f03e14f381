// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/render.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Eigen::Vector3f;

constexpr float kCareful =
    0.82f;  // the trunk's distance may exceed the true one by about a fifth where it slopes
constexpr int kMostSteps = 90;

struct BodyHit {
  const BodyPart* part = nullptr;
  Vector3f at{0.0f, 0.0f, 0.0f};
};

struct Shader {
  const Avatar& avatar;
  const Lighting& lights;
  Vector3f to_key;

  BodyHit trace(const Vector3f& direction, const PartSelection& parts) const {
    float t = parts.near;
    for (int step = 0; step < kMostSteps && t < parts.far; ++step) {
      const Vector3f p = t * direction;
      const BodySample s = sample_body(avatar, parts, p);
      if (s.distance < 0.0004f) {
        return {s.part, p};
      }
      t += kCareful * s.distance;
    }
    return {};
  }

  // Share of the key light that arrives, with a half shadow that widens with the distance of what casts it
  // (after Quilez, "Soft shadows in raymarched SDFs", 2010).
  float lit(const Vector3f& from, float start, float sharpness, float margin) const {
    const PartSelection parts = parts_along(avatar, from, to_key, margin);
    float light = 1.0f;
    float t = std::max(parts.near, start);
    for (int step = 0; step < 48 && t < parts.far && light > 0.01f; ++step) {
      const float d = sample_body(avatar, parts, from + t * to_key).distance;
      light = std::min(light, 0.5f + 0.5f * sharpness * d / t);
      t += std::max(kCareful * d, 0.006f);
    }
    light = std::max(light, 0.0f);
    return light * light * (3.0f - 2.0f * light);
  }

  float open_sky(const Vector3f& p, const Vector3f& normal) const {
    const PartSelection parts = parts_near(avatar, p, 0.13f);
    float shut = 0.0f;
    for (const float reach : {0.015f, 0.045f, 0.11f}) {
      const float d = std::min(sample_body(avatar, parts, p + reach * normal).distance, reach);
      shut += 0.34f * (1.0f - d / reach);
    }
    return 1.0f - 0.75f * std::min(shut, 1.0f);
  }

  Vector3f normal_at(const BodyHit& hit, const PartSelection& parts) const {
    constexpr float kEps = 0.0007f;
    Vector3f n = Vector3f::Zero();
    for (const Vector3f& e :
         {Vector3f(1, -1, -1), Vector3f(-1, -1, 1), Vector3f(-1, 1, -1), Vector3f(1, 1, 1)}) {
      n += e * sample_body(avatar, parts, hit.at + kEps * e).distance;
    }
    n.normalize();
    if (hit.part->surface == Surface::shirt || hit.part->surface == Surface::trousers) {
      // Folds: the gradient of a stretched noise that lives on the cloth.
      const Vector3f local = hit.part->rotation * (hit.at - hit.part->origin);
      const auto fold = [&](const Vector3f& q) {
        return value_noise({q.x() * 16.0f + 3.0f * q.y(), q.y() * 9.0f, q.z() * 16.0f},
                           avatar.look.texture + 7) +
               0.4f * value_noise(q * 38.0f, avatar.look.texture + 8);
      };
      const float here = fold(local);
      constexpr float kStep = 0.002f;
      const Vector3f slope(fold(local + Vector3f(kStep, 0, 0)) - here,
                           fold(local + Vector3f(0, kStep, 0)) - here,
                           fold(local + Vector3f(0, 0, kStep)) - here);
      n = (n - (0.0045f / kStep) * (hit.part->rotation.transpose() * slope)).normalized();
    }
    return n;
  }

  Vector3f shade(const BodyHit& hit, const Vector3f& direction, const PartSelection& parts) const {
    const Vector3f n = normal_at(hit, parts);
    const Vector3f colour = surface_colour(avatar, *hit.part, hit.at);
    const float shadow = n.dot(to_key) > -0.25f ? lit(hit.at + 0.004f * n, 0.012f, 9.0f, 0.02f) : 0.0f;
    return light_of(lights, {hit.at, n, direction, colour, shadow, open_sky(hit.at, n)}, hit.part->surface);
  }
};

template <typename Row>
void rows(int count, const Row& row) {
  tbb::parallel_for(tbb::blocked_range<int>(0, count, 2), [&](const tbb::blocked_range<int>& range) {
    for (int y = range.begin(); y < range.end(); ++y) {
      row(y);
    }
  });
}

// Key light on the wall: soft, so a coarse grid is enough.
cv::Mat wall_shadow(const Camera& camera, float wall, const Shader* shader) {
  const cv::Size size(camera.width, camera.height);
  if (shader == nullptr) {
    return {size, CV_32F, cv::Scalar(1.0)};
  }
  const int w = std::min(camera.width, 160);
  const int h = std::max(camera.height * w / camera.width, 2);
  const Camera coarse = camera.scaled_to(w, h);
  cv::Mat shadow(h, w, CV_32F);
  rows(h, [&](int y) {
    for (int x = 0; x < w; ++x) {
      const Vector3f p = wall * ray_of(coarse, static_cast<float>(x), static_cast<float>(y));
      shadow.at<float>(y, x) = shader->lit(p, 0.2f, 12.0f, 0.10f);
    }
  });
  cv::Mat fine;
  cv::resize(shadow, fine, size, 0, 0, cv::INTER_LINEAR);
  return fine;
}

}  // namespace

Vector3f light_of(const Lighting& lights, const SurfacePoint& point, Surface surface) {
  const Vector3f& n = point.normal;
  const Vector3f to_key = lights.to_key.normalized();
  const bool skin = surface == Surface::head || surface == Surface::arm;
  // Skin lets light through: the terminator wraps round, most in red.
  const Vector3f wrap = skin ? Vector3f(0.26f, 0.13f, 0.09f) : Vector3f(0.06f, 0.06f, 0.06f);
  const Vector3f diffuse =
      ((Vector3f::Constant(n.dot(to_key)) + wrap).cwiseQuotient(Vector3f::Ones() + wrap)).cwiseMax(0.0f);
  const float sky = 0.60f - 0.40f * n.y();
  const float from_room = std::max(-n.dot(point.direction), 0.0f);
  Vector3f light = lights.key * point.lit * diffuse;
  light += Vector3f::Constant(lights.ambient * point.open * (0.70f * sky + 0.42f * from_room));
  if (lights.lamp > 0.0f) {
    const Vector3f to = lights.lamp_at - point.at;
    const float near =
        lights.lamp * (0.30f + 0.70f * std::max(n.dot(to.normalized()), 0.0f)) / (0.4f + to.squaredNorm());
    light += near * Vector3f(0.92f, 0.76f, 0.50f);
  }
  const Vector3f half = (to_key - point.direction).normalized();
  const float shine = surface == Surface::hair ? 0.10f : skin ? 0.045f : 0.006f;
  const float gloss = shine * point.lit * std::pow(std::max(n.dot(half), 0.0f), 26.0f);
  return point.colour.cwiseProduct(light) + Vector3f::Constant(gloss);
}

Vector3f light_on_wall(const Lighting& lights, const Vector3f& at, float lit) {
  // The key light comes from the left: the wall is a little brighter there.
  const float falloff = 1.0f - 0.10f * at.x() - 0.05f * at.y();
  Vector3f light =
      Vector3f::Constant(lights.ambient * 0.78f + lights.key * 0.68f * falloff * (0.30f + 0.70f * lit));
  if (lights.lamp > 0.0f) {
    const float distance2 = (lights.lamp_at - at).squaredNorm();
    light += lights.lamp * (1.0f / (0.9f + 0.8f * distance2)) * Vector3f(1.26f, 1.04f, 0.68f);
  }
  return light;
}

Vector3f ray_of(const Camera& camera, float u, float v) {
  return Vector3f(static_cast<float>((u - camera.cx) / camera.fx),
                  static_cast<float>((v - camera.cy) / camera.fy), 1.0f);
}

void check_size(const Camera& camera, const Backdrop& backdrop) {
  if (backdrop.albedo.size() != cv::Size(camera.width, camera.height)) {
    throw Error(ErrorKind::usage, "the backdrop was drawn for another image size",
                "call make_backdrop with this camera");
  }
}

RenderedImage render_scene(const Camera& camera, const Backdrop& backdrop, const Avatar* avatar,
                           const Lighting& lighting) {
  const cv::Size size(camera.width, camera.height);
  check_size(camera, backdrop);
  const Avatar nobody;
  const Shader shader{avatar != nullptr ? *avatar : nobody, lighting, lighting.to_key.normalized()};
  const auto wall = static_cast<float>(backdrop.distance);
  const cv::Mat shadow = wall_shadow(camera, wall, avatar != nullptr ? &shader : nullptr);

  RenderedImage result;
  result.light = cv::Mat(size, CV_32FC3);
  result.surfaces = cv::Mat(size, CV_8U);
  const auto wall_colour = [&](int x, int y) {
    const Vector3f light =
        light_on_wall(lighting, wall * ray_of(camera, static_cast<float>(x), static_cast<float>(y)),
                      shadow.at<float>(y, x));
    const auto& a = backdrop.albedo.at<cv::Vec3f>(y, x);
    return Vector3f(a[2] * light.x(), a[1] * light.y(), a[0] * light.z());
  };
  const auto shoot = [&](float u, float v, int x, int y, Surface* surface) -> Vector3f {
    const Vector3f direction = ray_of(camera, u, v).normalized();
    const PartSelection parts = parts_along(shader.avatar, Vector3f::Zero(), direction, 0.01f);
    const BodyHit hit = parts.count > 0 ? shader.trace(direction, parts) : BodyHit{};
    if (surface != nullptr) {
      *surface = hit.part != nullptr ? hit.part->surface : Surface::background;
    }
    return hit.part != nullptr ? shader.shade(hit, direction, parts) : wall_colour(x, y);
  };
  rows(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      Surface surface = Surface::background;
      const Vector3f c = shoot(static_cast<float>(x), static_cast<float>(y), x, y, &surface);
      result.light.at<cv::Vec3f>(y, x) = {c.z(), c.y(), c.x()};
      result.surfaces.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(surface);
    }
  });
  if (avatar == nullptr) {
    return result;
  }

  // More rays where a neighbour shows another surface or another brightness of the same.
  const cv::Mat first = result.light.clone();
  const auto differs = [&](int x, int y) {
    const std::uint8_t here = result.surfaces.at<std::uint8_t>(y, x);
    const float green = std::sqrt(first.at<cv::Vec3f>(y, x)[1]);
    for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const int u = std::clamp(x + dx, 0, size.width - 1);
      const int v = std::clamp(y + dy, 0, size.height - 1);
      const std::uint8_t there = result.surfaces.at<std::uint8_t>(v, u);
      if (there != here ||
          (here != 0 && std::abs(std::sqrt(first.at<cv::Vec3f>(v, u)[1]) - green) > 0.045f)) {
        return true;
      }
    }
    return false;
  };
  rows(size.height, [&](int y) {
    for (int x = 0; x < size.width; ++x) {
      if (!differs(x, y)) {
        continue;
      }
      Vector3f sum = Vector3f::Zero();
      for (const auto& [du, dv] :
           {std::pair{-0.125f, -0.375f}, {0.375f, -0.125f}, {0.125f, 0.375f}, {-0.375f, 0.125f}}) {
        sum += 0.25f *
               shoot(static_cast<float>(x) + du, static_cast<float>(y) + dv, x, y, nullptr).cwiseMin(1.2f);
      }
      result.light.at<cv::Vec3f>(y, x) = {sum.z(), sum.y(), sum.x()};
    }
  });
  return result;
}

}  // namespace telemime
