// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/look.h"

#include <array>

namespace telemime {
namespace {

using Rgb = std::array<float, 3>;

template <std::size_t N>
std::size_t pick(Random& random, const std::array<Rgb, N>& table) {
  return random.below(static_cast<std::uint32_t>(table.size()));
}

Eigen::Vector3f linear(const Rgb& c) {
  return linear_colour(c[0], c[1], c[2]);
}

constexpr std::array<Rgb, 5> kSkins = {
    {{226, 178, 150}, {216, 164, 134}, {198, 146, 114}, {170, 118, 88}, {128, 86, 64}}};
constexpr std::array<Rgb, 5> kShirts = {
    {{34, 88, 178}, {22, 132, 142}, {36, 128, 72}, {104, 52, 150}, {48, 62, 128}}};
constexpr std::array<Rgb, 4> kHair = {{{30, 24, 22}, {58, 40, 28}, {84, 60, 40}, {22, 22, 26}}};
constexpr std::array<Rgb, 3> kTrousers = {{{38, 42, 54}, {44, 44, 46}, {34, 40, 66}}};
constexpr std::array<Rgb, 3> kEyes = {{{66, 46, 34}, {62, 78, 88}, {70, 74, 48}}};

}  // namespace

Eigen::Vector3f linear_colour(float red, float green, float blue) {
  const Eigen::Vector3f c = Eigen::Vector3f(red, green, blue) / 255.0f;
  return c.cwiseProduct(c);
}

Look random_look(Random& random) {
  Look look;
  const double height = random.uniform(0.95, 1.04);
  look.build = scaled_build(height, random.uniform(0.94, 1.08));
  look.skin = linear(kSkins[pick(random, kSkins)]);
  look.shirt_index = static_cast<int>(pick(random, kShirts));
  look.shirt = linear(kShirts[static_cast<std::size_t>(look.shirt_index)]);
  look.hair = linear(kHair[pick(random, kHair)]);
  look.trousers = linear(kTrousers[pick(random, kTrousers)]);
  look.eyes = linear(kEyes[pick(random, kEyes)]);
  look.style = static_cast<HairStyle>(random.below(3));
  look.bust = look.style == HairStyle::bob ? random.uniform(0.5, 1.0) : random.uniform(0.0, 0.25);
  look.face_width = static_cast<float>(random.uniform(0.96, 1.04));
  look.jaw = static_cast<float>(random.uniform(0.95, 1.05));
  look.sleeve = random.uniform(0.52, 0.66);
  look.texture = static_cast<std::uint32_t>(random.bits());
  return look;
}

}  // namespace telemime
