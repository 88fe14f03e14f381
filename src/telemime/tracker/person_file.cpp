// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/person_file.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "telemime/core/errors.h"
#include "telemime/image/image_calibration.h"
#include "telemime/outputs/file_output.h"

namespace telemime {
namespace {

using Json = nlohmann::json;

constexpr const char* kFormat = "telemime-calibration";

std::filesystem::path scene_of(std::filesystem::path file) {
  return file += ".scene.yml.gz";
}

Error bad(const std::filesystem::path& file, const std::string& why) {
  return {ErrorKind::config, "calibration file " + file.string() + ": " + why,
          "Create it again with `telemime calibrate`."};
}

double number(const Json& json, const char* key, double low, double high) {
  const double value = json.at(key).get<double>();
  if (!(value >= low && value <= high)) {
    throw std::out_of_range(std::string("'") + key + "' is out of range");
  }
  return value;
}

Json shape_json(const Shape& shape) {
  Json json = {{"stature_m", shape.stature}, {"sleeve", shape.sleeve}};
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    const SegmentScale& s = shape.segments[i];
    json["segments"][std::string(kSegmentNames[i])] = {
        {"length", s.length}, {"height", s.height}, {"width", s.width}};
  }
  return json;
}

Shape shape_from(const Json& json) {
  Shape shape;
  shape.stature = number(json, "stature_m", 0.5, 3.0);
  shape.sleeve = number(json, "sleeve", 0.0, 2.0);
  for (std::size_t i = 0; i < kSegmentCount; ++i) {
    const Json& s = json.at("segments").at(std::string(kSegmentNames[i]));
    shape.segments[i] = {number(s, "length", 0.2, 5.0), number(s, "height", 0.2, 5.0),
                         number(s, "width", 0.2, 5.0)};
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
                       {"distortion", c.distortion}}}};
  // The scene first: a calibration is only there when all of it is.
  save_calibration(p.image, scene_of(file));
  write_whole_file(file, json.dump(2) + "\n");
}

PersonFile parse_person(std::string_view text, const std::filesystem::path& name) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("format") || json["format"] != kFormat) {
    throw bad(name, "it is not a calibration of telemime");
  }
  PersonFile p;
  try {
    p.person.shape = shape_from(json.at("shape"));
    p.person.scale_from = json.at("scale_from").get<std::string>();
    p.person.height_given = json.at("height_given").get<bool>();
    p.person.refusal = json.at("refusal").get<std::string>();
    const Json& c = json.at("camera");
    p.camera.width = static_cast<int>(number(c, "width", 1, 32768));
    p.camera.height = static_cast<int>(number(c, "height", 1, 32768));
    p.camera.fx = number(c, "fx", 1e-3, 1e6);
    p.camera.fy = number(c, "fy", 1e-3, 1e6);
    p.camera.cx = number(c, "cx", -1e5, 1e5);
    p.camera.cy = number(c, "cy", -1e5, 1e5);
    const Json& distortion = c.at("distortion");
    if (distortion.size() != p.camera.distortion.size()) {
      throw std::out_of_range("'distortion' needs five numbers");
    }
    for (std::size_t i = 0; i < p.camera.distortion.size(); ++i) {
      p.camera.distortion[i] = distortion.at(i).get<double>();
    }
  } catch (const Json::exception& e) {
    throw bad(name, e.what());
  } catch (const std::out_of_range& e) {
    throw bad(name, e.what());
  }
  return p;
}

PersonFile load_person(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || std::filesystem::is_directory(file)) {
    throw bad(file, "it cannot be opened");
  }
  PersonFile p = parse_person(std::string(std::istreambuf_iterator<char>(in), {}), file);
  p.image = load_calibration(scene_of(file));
  return p;
}

}  // namespace telemime
