// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <initializer_list>
#include <string_view>

#include "lab/synth/mesh_person.h"

namespace telemime {
namespace {

std::string joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) {
    text += part;
  }
  return text;
}

template <std::size_t N>
std::string pick(Random& random, const std::array<const char*, N>& names) {
  return names[random.below(static_cast<std::uint32_t>(N))];
}

}  // namespace

MeshLook random_mesh_look(bool long_sleeves, Random& random) {
  const bool woman = random.uniform() < 0.5;
  const std::string sex = woman ? "female" : "male";
  const std::string origin = pick(random, std::array{"african", "asian", "caucasian"});
  const std::string age = pick(random, std::array{"young", "young", "middleage", "old"});
  MeshLook look;
  // Between two ages and two builds.
  const float old = age == "old" ? 0.8f : age == "middleage" ? 0.5f : 0.0f;
  const auto build = static_cast<float>(random.uniform(-0.5, 0.6));
  const std::string muscle = pick(random, std::array{"minmuscle", "averagemuscle", "maxmuscle"});
  for (const auto& [years, share] : {std::pair{"young", 1.0f - old}, std::pair{"old", old}}) {
    if (share == 0.0f) {
      continue;
    }
    look.targets.emplace_back(joined({"macrodetails/", origin, "-", sex, "-", years}), share);
    const std::string universal = joined({"macrodetails/universal-", sex, "-", years, "-", muscle});
    look.targets.emplace_back(universal + "-averageweight", share * (1.0f - std::abs(build)));
    look.targets.emplace_back(universal + (build < 0.0f ? "-minweight" : "-maxweight"),
                              share * std::abs(build));
  }
  look.tall = joined({"macrodetails/height/", sex, "-young-", muscle, "-averageweight-maxheight"});
  look.stature = static_cast<float>(woman ? random.normal(1.62, 0.06) : random.normal(1.74, 0.07));
  const auto share_of_stature = [&](double share) {
    return look.stature * static_cast<float>(share * random.normal(1.0, 0.03));
  };
  look.upper_arm = share_of_stature(woman ? 0.1586 : 0.1618);
  look.forearm = share_of_stature(woman ? 0.1523 : 0.1545);
  look.hand = share_of_stature(woman ? 0.0450 : 0.0495);
  look.skin = age + "_" + origin + "_" + sex;
  if (long_sleeves) {
    look.clothes =
        woman ? "female_elegantsuit01"
              : pick(random, std::array{"male_casualsuit01", "male_casualsuit02", "male_casualsuit03",
                                        "male_casualsuit05", "male_elegantsuit01"});
  } else {
    look.clothes =
        woman ? pick(random, std::array{"female_casualsuit01", "female_casualsuit02"})
              : pick(random, std::array{"male_casualsuit04", "male_casualsuit06", "male_worksuit01"});
  }
  look.hair = woman ? pick(random, std::array{"bob02", "long01", "ponytail01", "Braid01"})
                    : pick(random, std::array{"short01", "short02", "short04", "afro01"});
  look.eyes = pick(random, std::array{"brown", "brownlight", "blue", "green", "grey"});
  return look;
}

}  // namespace telemime
