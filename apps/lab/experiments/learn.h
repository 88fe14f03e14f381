// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "telemime/tracker/config.h"
#include "telemime/tracking/filter_model.h"

namespace telemime {

/// Estimates the parameters of data/filter.json from sequences with truth (folders as read_clip reads them),
/// each tracked with `config`. Of the end-effector space only the swivel angle is estimated: the wrist's
/// standard deviations are the thesis's. `progress` may be empty. Throws Error(input), Error(tracking).
FilterModel learn_filter_model(const std::vector<std::filesystem::path>& clips, const Config& config,
                               const std::function<void(const std::string&)>& progress);

}  // namespace telemime
