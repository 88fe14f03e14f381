// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "telemime/likelihood/backend.h"

namespace telemime {

/// Gives each batch to the faster of two back ends. Which one that is, is measured once for every image size
/// and every order of magnitude (of two) of the batch, with the first batch of its kind; that batch's scores
/// are `processor`'s. `seconds` is a clock. The two agree up to rounding, so results may differ from run to
/// run where both are about equally fast.
std::unique_ptr<Backend> make_auto_backend(std::unique_ptr<Backend> processor,
                                           std::unique_ptr<Backend> device, std::function<double()> seconds);

}  // namespace telemime
