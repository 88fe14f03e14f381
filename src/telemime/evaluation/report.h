// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "telemime/evaluation/evaluate.h"

namespace telemime {

/// All measures by name, lengths in mm (docs/evaluation.md). What could not be measured is null.
nlohmann::ordered_json evaluation_json(const Evaluation& evaluation);

/// The same for a person: aligned columns of text, ending in a line break.
std::string evaluation_table(const Evaluation& evaluation);

}  // namespace telemime
