// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "telemime/body/arm_parts.h"

namespace telemime {
namespace {

// An ellipse across the bone: position along the bone, centre in z, half axes in x and z. Metres at 1.70 m,
// or for limbs: y as a fraction of the bone (0 at the joint, -1 at the next).
struct Ring {
  double y, centre_z, radius_x, radius_z;
};

constexpr double kDesignStature = 1.70;

constexpr std::array<Ring, 11> kChest = {{{-0.170, 0.060, 0.120, 0.080},
                                          {-0.120, 0.060, 0.164, 0.110},
                                          {-0.020, 0.060, 0.158, 0.105},
                                          {0.080, 0.055, 0.146, 0.098},
                                          {0.200, 0.050, 0.150, 0.105},
                                          {0.320, 0.040, 0.164, 0.112},
                                          {0.420, 0.030, 0.174, 0.100},
                                          {0.490, 0.020, 0.178, 0.075},
                                          {0.530, 0.012, 0.150, 0.066},
                                          {0.560, 0.008, 0.092, 0.058},
                                          {0.588, 0.010, 0.055, 0.050}}};

// The head as it is seen, with hair: an average crown is 0.225 m above the chin (Gordon et al., 1988
// Anthropometric Survey of U.S. Army Personnel), and hair stands some 15 mm above it.
constexpr std::array<Ring, 9> kHead = {{{-0.030, 0.010, 0.058, 0.054},
                                        {0.010, 0.022, 0.056, 0.054},
                                        {0.032, 0.045, 0.058, 0.078},
                                        {0.065, 0.055, 0.070, 0.094},
                                        {0.120, 0.056, 0.080, 0.104},
                                        {0.180, 0.050, 0.082, 0.104},
                                        {0.230, 0.046, 0.068, 0.090},
                                        {0.258, 0.044, 0.044, 0.060},
                                        {0.271, 0.042, 0.014, 0.022}}};

// Limbs: y is in fractions of the bone.
constexpr std::array<Ring, 8> kUpperArm = {{{0.17, 0.0, 0.030, 0.030},
                                            {0.09, 0.0, 0.046, 0.048},
                                            {-0.05, 0.0, 0.054, 0.056},
                                            {-0.25, 0.0, 0.050, 0.054},
                                            {-0.55, 0.0, 0.045, 0.048},
                                            {-0.85, 0.0, 0.040, 0.042},
                                            {-1.00, 0.0, 0.038, 0.040},
                                            {-1.08, 0.0, 0.026, 0.028}}};
constexpr std::array<Ring, 8> kForearm = {{{0.11, 0.0, 0.022, 0.022},
                                           {0.04, 0.0, 0.037, 0.037},
                                           {-0.15, 0.0, 0.043, 0.043},
                                           {-0.35, 0.0, 0.041, 0.041},
                                           {-0.60, 0.0, 0.034, 0.034},
                                           {-0.85, 0.0, 0.026, 0.029},
                                           {-1.00, 0.0, 0.023, 0.028},
                                           {-1.04, 0.0, 0.016, 0.020}}};
// The hand: y in fractions of wrist to middle knuckle; the (half bent) fingers reach 1.75 of it. At rest the
// palm faces inward, so the hand is thin in x and broad in z.
constexpr std::array<Ring, 7> kHand = {{{0.10, 0.0, 0.014, 0.018},
                                        {0.00, 0.0, 0.020, 0.028},
                                        {-0.40, 0.006, 0.022, 0.040},
                                        {-0.95, 0.006, 0.019, 0.044},
                                        {-1.30, 0.002, 0.016, 0.040},
                                        {-1.58, 0.0, 0.012, 0.030},
                                        {-1.75, 0.0, 0.006, 0.014}}};

struct Stack {
  std::vector<Ring> rings;            // from top (largest y) to bottom, metres
  std::vector<SurfaceClass> between;  // class of the strip below ring i
  int sides = 8;
};

Ring interpolate(const Ring& a, const Ring& b, double y) {
  const double t = (y - a.y) / (b.y - a.y);
  return {y, std::lerp(a.centre_z, b.centre_z, t), std::lerp(a.radius_x, b.radius_x, t),
          std::lerp(a.radius_z, b.radius_z, t)};
}

// Splits a limb's stack at the sleeve's end: clothes above, skin below.
void dress(Stack& stack, double sleeve_y) {
  std::vector<Ring> rings;
  for (std::size_t i = 0; i < stack.rings.size(); ++i) {
    if (i > 0 && stack.rings[i - 1].y > sleeve_y && stack.rings[i].y < sleeve_y) {
      rings.push_back(interpolate(stack.rings[i - 1], stack.rings[i], sleeve_y));
    }
    rings.push_back(stack.rings[i]);
  }
  stack.rings = std::move(rings);
  stack.between.clear();
  for (std::size_t i = 0; i + 1 < stack.rings.size(); ++i) {
    const double middle = 0.5 * (stack.rings[i].y + stack.rings[i + 1].y);
    stack.between.push_back(middle > sleeve_y ? SurfaceClass::clothes : SurfaceClass::arms);
  }
}

Stack make_stack(std::span<const Ring> rings, double y_scale, double across, const SegmentScale& scale,
                 int sides, SurfaceClass surface) {
  Stack stack;
  stack.sides = sides;
  for (const Ring& ring : rings) {
    stack.rings.push_back({ring.y * y_scale, ring.centre_z * across * scale.height,
                           ring.radius_x * across * scale.width, ring.radius_z * across * scale.height});
  }
  if (stack.rings.front().y < stack.rings.back().y) {
    std::reverse(stack.rings.begin(), stack.rings.end());
  }
  stack.between.assign(stack.rings.size() - 1, surface);
  return stack;
}

class MeshBuilder {
 public:
  void add(Segment segment, const Stack& stack) {
    const auto s = static_cast<std::size_t>(segment);
    mesh_.vertex_range[s].begin = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.triangle_range[s].begin = static_cast<std::uint32_t>(mesh_.triangles.size());
    mesh_.edge_range[s].begin = static_cast<std::uint32_t>(mesh_.edges.size());

    const auto n = static_cast<std::uint32_t>(stack.sides);
    const auto first = mesh_.vertex_range[s].begin;
    for (const Ring& ring : stack.rings) {
      for (std::uint32_t j = 0; j < n; ++j) {
        const double a = 2.0 * std::numbers::pi * j / n;
        mesh_.vertices.emplace_back(static_cast<float>(ring.radius_x * std::cos(a)),
                                    static_cast<float>(ring.y),
                                    static_cast<float>(ring.centre_z + ring.radius_z * std::sin(a)));
      }
    }
    const std::uint32_t top = cap(stack.rings.front());
    const std::uint32_t bottom = cap(stack.rings.back());
    const auto rings = static_cast<std::uint32_t>(stack.rings.size());
    const auto vertex = [&](std::uint32_t ring, std::uint32_t j) { return first + ring * n + j % n; };
    for (std::uint32_t j = 0; j < n; ++j) {
      triangle(top, vertex(0, j + 1), vertex(0, j), stack.between.front());
      for (std::uint32_t r = 0; r + 1 < rings; ++r) {
        triangle(vertex(r, j), vertex(r, j + 1), vertex(r + 1, j), stack.between[r]);
        triangle(vertex(r, j + 1), vertex(r + 1, j + 1), vertex(r + 1, j), stack.between[r]);
      }
      triangle(bottom, vertex(rings - 1, j), vertex(rings - 1, j + 1), stack.between.back());
    }
    connect(mesh_.triangle_range[s].begin);
    mesh_.stacks[s] = {rings, n, {stack.between.front()}};
    mesh_.stacks[s].surface.insert(mesh_.stacks[s].surface.end(), stack.between.begin(), stack.between.end());
    mesh_.stacks[s].surface.push_back(stack.between.back());
    mesh_.vertex_range[s].end = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.triangle_range[s].end = static_cast<std::uint32_t>(mesh_.triangles.size());
    mesh_.edge_range[s].end = static_cast<std::uint32_t>(mesh_.edges.size());
  }

  BodyMesh take() { return std::move(mesh_); }

 private:
  std::uint32_t cap(const Ring& ring) {
    mesh_.vertices.emplace_back(0.0F, static_cast<float>(ring.y), static_cast<float>(ring.centre_z));
    return static_cast<std::uint32_t>(mesh_.vertices.size() - 1);
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, SurfaceClass surface) {
    mesh_.triangles.push_back({{a, b, c}, surface});
  }

  // Edges of the triangles from `from` on: each belongs to two, which run along it in opposite directions.
  void connect(std::uint32_t from) {
    struct Half {
      std::uint32_t a, b, triangle;
    };
    std::vector<Half> open;
    for (auto t = from; t < mesh_.triangles.size(); ++t) {
      const auto& v = mesh_.triangles[t].vertex;
      for (std::size_t k = 0; k < 3; ++k) {
        const Half half = {v[k], v[(k + 1) % 3], t};
        const auto twin = std::find_if(open.rbegin(), open.rend(), [&](const Half& other) {
          return other.a == half.b && other.b == half.a;
        });
        if (twin != open.rend()) {
          mesh_.edges.push_back({{half.a, half.b}, {t, twin->triangle}});
          *twin = open.back();
          open.pop_back();
        } else {
          open.push_back(half);
        }
      }
    }
  }

  BodyMesh mesh_;
};

}  // namespace

BodyMesh make_mesh(const Body& body) {
  const Shape& shape = body.shape;
  const double across = shape.stature / kDesignStature;
  constexpr int kTrunkSides = 12;
  constexpr int kLimbSides = 8;
  MeshBuilder builder;
  const auto trunk = [&](Segment s, std::span<const Ring> rings, SurfaceClass surface) {
    builder.add(s, make_stack(rings, across * shape[s].length, across, shape[s], kTrunkSides, surface));
  };
  trunk(Segment::chest, kChest, SurfaceClass::clothes);
  trunk(Segment::head, kHead, SurfaceClass::head);
  for (const Side side : {Side::left, Side::right}) {
    const auto i = static_cast<std::size_t>(side);
    const ArmParts& arm = arm_parts(side);
    Stack upper_stack = make_stack(kUpperArm, body.upper_arm_length[i], across, shape[arm.upper_arm],
                                   kLimbSides, SurfaceClass::clothes);
    // A sleeve of a whole segment covers its rounded end, too.
    const auto end = [](double covered, double length) { return covered >= 1.0 ? -1e9 : -covered * length; };
    dress(upper_stack, shape.sleeve <= 0.0 ? 1e9 : end(shape.sleeve, body.upper_arm_length[i]));
    builder.add(arm.upper_arm, upper_stack);
    Stack fore_stack = make_stack(kForearm, body.forearm_length[i], across, shape[arm.forearm], kLimbSides,
                                  SurfaceClass::arms);
    dress(fore_stack, shape.sleeve <= 1.0 ? 1e9 : end(shape.sleeve - 1.0, body.forearm_length[i]));
    builder.add(arm.forearm, fore_stack);
    builder.add(arm.hand, make_stack(kHand, body.hand_length[i], across, shape[arm.hand], kLimbSides,
                                     SurfaceClass::arms));
  }
  return builder.take();
}

}  // namespace telemime
