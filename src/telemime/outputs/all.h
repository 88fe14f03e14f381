// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// pose.jsonl: one JSON object per line, the first describes the stream (docs/formats.md). Millimetres,
/// degrees, camera frame.
std::unique_ptr<Encoder> make_jsonl_encoder();

/// pose.csv: one line per frame for spreadsheets, after a line with the names of the columns
/// (docs/formats.md). Millimetres, degrees, camera frame.
std::unique_ptr<Encoder> make_csv_encoder();

/// motion.bvh: Biovision hierarchy, y up, facing +z, centimetres, T-pose at rest (bvh/skeleton.h).
std::unique_ptr<Encoder> make_bvh_encoder();

/// motion.bap: the 20 angles as body animation parameters of MPEG-4, for the player that the profile names
/// (bap/profile.h). Throws Error(usage) for an unknown profile.
std::unique_ptr<Encoder> make_bap_encoder(std::string_view profile);

/// motion.glb: glTF 2.0 animation of a mannequin, metres, y up. motion.vrma: the bones only, named for VRM
/// (VRMC_vrm_animation 1.0). Both are the skeleton of humanoid.h in its T-pose and an animation of it, as a
/// binary glTF file.
///
/// A track of glTF must be contiguous, so keys cannot be appended one by one. Until `end`, all keys are
/// appended again whenever their number has doubled, and the patch makes the head of the file refer to them.
/// The file of a run that is killed is therefore valid and has at least half of the motion. Unused parts make
/// the file two to three times as large; the keys stay in memory, 0.9 kB each with fingers and face.
std::unique_ptr<Encoder> make_glb_encoder();
std::unique_ptr<Encoder> make_vrma_encoder();

/// motion.trc: the joints as markers for OpenSim and others in OpenSim's layout: a tab after each cell, mm, y
/// up (a joint at x, y, z of the camera frame is at x, -y, -z). The cells of a lost frame are empty.
std::unique_ptr<Encoder> make_trc_encoder();

/// Options of the output files.
struct OutputOptions {
  std::string bap_profile = "iso";  ///< bap/profile.h
  bool fingers = true;              ///< of tracked hands, in bvh, bap, glb, vrma and trc
};

/// One file format that a run can write.
struct OutputFormat {
  std::string_view name;       ///< as in `--formats`
  std::string_view file_name;  ///< in the folder of the results
  std::string_view summary;
  std::unique_ptr<Encoder> (*make)(const OutputOptions&);
  bool own_times = false;  ///< each frame has its time; files of the others need a constant rate
};

/// All formats. A new format is an encoder and a line here.
inline constexpr std::array<OutputFormat, 7> kOutputFormats = {{
    {"jsonl", "pose.jsonl", "everything, one JSON object per frame",
     [](const OutputOptions&) { return make_jsonl_encoder(); }, true},
    {"csv", "pose.csv", "a table for spreadsheets", [](const OutputOptions&) { return make_csv_encoder(); },
     true},
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
