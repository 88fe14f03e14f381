// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "telemime/outputs/encoder.h"
#include "telemime/outputs/encoders/bap.h"
#include "telemime/outputs/encoders/bvh.h"
#include "telemime/outputs/encoders/csv.h"
#include "telemime/outputs/encoders/glb.h"
#include "telemime/outputs/encoders/jsonl.h"
#include "telemime/outputs/encoders/trc.h"
#include "telemime/outputs/encoders/vrma.h"

namespace telemime {

/// Options of the output files.
struct OutputOptions {
  std::string bap_profile = "iso";  ///< bap/profile.h
};

/// One file format that a run can write.
struct OutputFormat {
  std::string_view name;       ///< as in `--formats`
  std::string_view file_name;  ///< in the folder of the results
  std::string_view summary;
  std::unique_ptr<Encoder> (*make)(const OutputOptions&);
};

/// All formats. A new format is an encoder and a line here.
inline constexpr std::array<OutputFormat, 7> kOutputFormats = {{
    {"jsonl", "pose.jsonl", "everything, one JSON object a frame",
     [](const OutputOptions&) { return make_jsonl_encoder(); }},
    {"csv", "pose.csv", "a table for spreadsheets", [](const OutputOptions&) { return make_csv_encoder(); }},
    {"bvh", "motion.bvh", "skeleton animation for Blender and others",
     [](const OutputOptions&) { return make_bvh_encoder(); }},
    {"bap", "motion.bap", "MPEG-4 body animation parameters",
     [](const OutputOptions& options) { return make_bap_encoder(options.bap_profile); }},
    {"glb", "motion.glb", "skeleton animation with a mannequin, for Blender, three.js and game engines",
     [](const OutputOptions&) { return make_glb_encoder(); }},
    {"vrma", "motion.vrma", "animation for any VRM avatar",
     [](const OutputOptions&) { return make_vrma_encoder(); }},
    {"trc", "motion.trc", "joints as markers, for OpenSim",
     [](const OutputOptions&) { return make_trc_encoder(); }},
}};

/// The format of this name. Throws Error(usage) that lists the names.
const OutputFormat& output_format(std::string_view name);

}  // namespace telemime
