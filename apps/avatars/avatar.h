// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "telemime/body/shape.h"

namespace telemime {

/// 0xRRGGBB, sRGB.
using Colour = std::uint32_t;

enum class AvatarHair { none, cropped, bob, bun };
enum class TopStyle { tee, hoodie, jacket, shell };

/// How an avatar looks; its proportions come from the person.
struct AvatarLook {
  std::string_view name;
  std::string_view summary;
  AvatarHair hair_style = AvatarHair::cropped;
  TopStyle top_style = TopStyle::tee;
  double sleeve = 0.5;  ///< end of the sleeve: 0 shoulder, 1 elbow, 2 wrist
  Colour skin = 0;
  Colour hair = 0;
  Colour eyes = 0;
  Colour top = 0;
  Colour trim = 0;  ///< what the top is set off with
  Colour trousers = 0;
  Colour shoes = 0;
  /// How far surfaces may be simplified, as a part of the grid's cell: with more than the default, what lies
  /// in thin layers begins to show through.
  double coarse = 0.07;
};

/// The same with less than half of the triangles: where each costs much, as without a graphics card.
inline AvatarLook light(AvatarLook look) {
  look.coarse = 0.17;
  return look;
}

inline constexpr std::array<AvatarLook, 5> kAvatarLooks = {{
    {"plain", "T-shirt, short hair", AvatarHair::cropped, TopStyle::tee, 0.52, 0xD9A581, 0x3B2A20, 0x4A6B4F,
     0x3E7CB1, 0xF2F2F0, 0x39424E, 0xE9E6E0},
    {"casual", "hooded jumper, bob", AvatarHair::bob, TopStyle::hoodie, 1.93, 0xF0C6A5, 0x7A3E22, 0x3C6E91,
     0xE2A33A, 0xFFF4DC, 0x47637F, 0xF4F1EA},
    {"office", "jacket and tie, short hair", AvatarHair::cropped, TopStyle::jacket, 1.92, 0x8D5A3C, 0x17120F,
     0x4B2E1C, 0x2F3B52, 0xF5F5F2, 0x2B3447, 0x33241B},
    {"summer", "sleeveless top, bun", AvatarHair::bun, TopStyle::tee, 0.24, 0xB97A56, 0x251813, 0x5A3A22,
     0xD8574E, 0xFBE3D6, 0xEDE3D0, 0xB0714A},
    {"robot", "white shells over a dark frame", AvatarHair::none, TopStyle::shell, 2.0, 0x2C3138, 0xEDF0F2,
     0x63E6E2, 0xEDF0F2, 0xF08A3C, 0xEDF0F2, 0x3A4149},
}};

/// By name. Throws Error(usage) that lists the names.
const AvatarLook& avatar_look(std::string_view name);

/// A person with these proportions as a VRM 1.0 file (binary glTF with VRMC_vrm): skinned surfaces in the
/// T-pose of humanoid.h, the expressions of VRM 1.0 and eyes that look (expressions, too). Both sides get the
/// mean of the shape's sides; its sleeve is not used, the look has its own. The same arguments give the same
/// bytes. Throws Error(usage) for a stature that is not between 0.5 and 2.5 m, or a scale not between 0.4
/// and 2.5.
std::string make_avatar(const Shape& shape, const AvatarLook& look);

}  // namespace telemime
