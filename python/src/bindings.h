// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <nlohmann/json.hpp>

namespace telemime::python {

void bind_track(pybind11::module_& module);
void bind_tracker(pybind11::module_& module);
void bind_live(pybind11::module_& module);
void bind_evaluate(pybind11::module_& module);

/// JSON as objects of Python.
template <typename Json>
pybind11::object dictionary(const Json& json) {
  return pybind11::module_::import("json").attr("loads")(
      json.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace telemime::python
