// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/person_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime {
namespace {

class PersonFileTest : public ::testing::Test {
 protected:
  static PersonFile person() {
    PersonFile p;
    p.person.shape.stature = 1.81;
    p.person.shape.sleeve = 0.7;
    p.person.shape.shoulders = 0.9;
    p.person.shape[Segment::l_forearm] = {0.93, 1.1, 1.2};
    p.person.scale_from = "the height given";
    p.person.refusal = "the left arm leaves the picture";
    p.camera = camera_from_field_of_view(320, 240, 70.0);
    p.camera.distortion = {0.1, -0.05, 0.001, 0.002, 0.01};
    return p;
  }

  nlohmann::json written() {
    save_person(person(), file_);
    std::ifstream in(file_);
    return nlohmann::json::parse(in);
  }

  ScratchFolder folder_;
  std::filesystem::path file_ = folder_.file("person.json");
};

TEST_F(PersonFileTest, ComesBackAsItWas) {
  save_person(person(), file_);
  const PersonFile back = load_person(file_);
  const PersonFile before = person();
  EXPECT_EQ(back.person.shape.stature, before.person.shape.stature);
  EXPECT_EQ(back.person.shape.sleeve, before.person.shape.sleeve);
  EXPECT_EQ(back.person.shape.shoulders, before.person.shape.shoulders);
  EXPECT_EQ(back.person.shape[Segment::l_forearm].width, 1.2);
  EXPECT_EQ(back.person.scale_from, before.person.scale_from);
  EXPECT_EQ(back.person.refusal, before.person.refusal);
  EXPECT_EQ(back.camera.fx, before.camera.fx);
  EXPECT_EQ(back.camera.distortion, before.camera.distortion);
}

TEST_F(PersonFileTest, RefusesWhatIsMissingWrongOrOutOfRange) {
  const nlohmann::json good = written();
  EXPECT_NO_THROW(parse_person(good.dump(), "p"));
  const auto refused = [&](const std::string& pointer, const nlohmann::json& value) {
    nlohmann::json spoiled = good;
    spoiled[nlohmann::json::json_pointer(pointer)] = value;
    EXPECT_THROW(parse_person(spoiled.dump(), "p"), Error) << pointer << " " << value;
  };
  refused("/format", 3);
  refused("/format", "other");
  refused("/shape", "tall");
  refused("/shape/stature_m", 17);
  refused("/shape/segments/l_hand/length", nullptr);
  refused("/camera/width", 0);
  refused("/camera/fx", -1);
  refused("/camera/distortion", nlohmann::json::array({1, 2}));
  refused("/camera/distortion", "none");
  refused("/scale_from", 1);
  EXPECT_THROW(parse_person("", "p"), Error);
  EXPECT_THROW(parse_person("[1]", "p"), Error);
  EXPECT_THROW(load_person(folder_.path()), Error) << "a folder";
  EXPECT_THROW(load_person(folder_.file("none.json")), Error);
}

TEST_F(PersonFileTest, ShouldersMayBeMissing) {
  nlohmann::json older = written();
  ASSERT_EQ(older["shape"].erase("shoulders"), 1U);
  EXPECT_EQ(parse_person(older.dump(), "p").person.shape.shoulders, 1.0);
  older["shape"]["shoulders"] = -1.0;
  EXPECT_THROW(parse_person(older.dump(), "p"), Error);
}

TEST_F(PersonFileTest, WithoutItsSceneItIsRefused) {
  save_person(person(), file_);
  std::filesystem::remove(file_.string() + ".scene.yml.gz");
  EXPECT_THROW(load_person(file_), Error);
}

}  // namespace
}  // namespace telemime
