// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include "telemime/tracker/track_request.h"

namespace telemime::python {

/// Adds the class Request, which takes the options of a run as texts and numbers.
void bind_requests(pybind11::module_& module);

/// telemime::Error as the exception of Python that says the same: ValueError for what was asked, OSError for
/// files and cameras, RuntimeError for the rest.
void translate_errors();

}  // namespace telemime::python
