// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/person_file.h"

#include <algorithm>

#include "telemime/core/files.h"
#include "telemime/core/json_field.h"
#include "telemime/image/image_calibration.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

constexpr const char* kFormat = "telemime-calibration";

std::filesystem::path scene_of(std::filesystem::path file) {
  return file += ".scene.yml.gz";
}

Json shape_json(const Shape& shape) {
  Json json = {{"stature_m", shape.stature}, {"sleeve", shape.sleeve}, {"shoulders", shape.shoulders}};
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    const SegmentScale& s = shape.segments[i];
    json["segments"][std::string(kSegmentNames[i])] = {
        {"length", s.length}, {"height", s.height}, {"width", s.width}};
  }
  return json;
}

Shape shape_from(const JsonField& json) {
  Shape shape;
  shape.stature = json["stature_m"].number(0.5, 3.0);
  shape.sleeve = json["sleeve"].number(0.0, 2.0);
  shape.shoulders = json.has("shoulders") ? json["shoulders"].number(0.2, 5.0) : 1.0;
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    const JsonField s = json["segments"][kSegmentNames[i]];
    shape.segments[i] = {s["length"].number(0.2, 5.0), s["height"].number(0.2, 5.0),
                         s["width"].number(0.2, 5.0)};
  }
  return shape;
}

}  // namespace

void save_person(const PersonFile& p, const std::filesystem::path& file) {
  const Camera& c = p.camera;
  const Json json = {{"format", kFormat},
                     {"version", 1},
                     {"shape", shape_json(p.person.shape)},
                     {"scale_from", p.person.scale_from},
                     {"height_given", p.person.height_given},
                     {"refusal", p.person.refusal},
                     {"F", p.person.score.region()},
                     {"camera",
                      {{"width", c.width},
                       {"height", c.height},
                       {"fx", c.fx},
                       {"fy", c.fy},
                       {"cx", c.cx},
                       {"cy", c.cy},
                       {"distortion", c.distortion}}},
                     {"lens", {{"fisheye", p.lens.fisheye}, {"coefficients", p.lens.coefficients}}}};
  // The scene first: a calibration is only there when all of it is.
  save_calibration(p.image, scene_of(file));
  write_whole_file(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

PersonFile parse_person(std::string_view text, const std::filesystem::path& name) {
  const JsonSource source{"calibration file " + name.string(), ErrorKind::config,
                          "Create it again with `telemime calibrate`."};
  const auto json = parse_json(text, source);
  const JsonField root(json, source);
  root["format"].equals(kFormat);
  PersonFile p;
  p.person.shape = shape_from(root["shape"]);
  p.person.scale_from = root["scale_from"].text();
  p.person.height_given = root["height_given"].boolean();
  p.person.refusal = root["refusal"].text();
  p.camera = read_camera(root["camera"]);
  p.lens.camera = p.camera;
  if (root.has("lens")) {
    const JsonField lens = root["lens"];
    p.lens.fisheye = lens["fisheye"].boolean();
    constexpr std::size_t kMost = 12;
    for (std::size_t i = 0; i < std::min(kMost, lens["coefficients"].size()); ++i) {
      p.lens.coefficients.push_back(lens["coefficients"][i].number());
    }
  }
  return p;
}

PersonFile load_person(const std::filesystem::path& file) {
  PersonFile p = parse_person(read_text_file(file, ErrorKind::config), file);
  p.image = load_calibration(scene_of(file));
  return p;
}

}  // namespace telemime
