// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/all.h"

#include <algorithm>

#include "telemime/core/errors.h"
#include "telemime/likelihood/simd/simd_backend.h"

namespace telemime {
namespace {

std::string nothing_missing() {
  return {};
}

}  // namespace

const std::array<BackendKind, kBackendCount> kBackends = {{
    {"simd", "vector instructions of the processor",
     [](const BackendOptions& options) {
       return make_simd_backend({options.threads, {}, SimdStage::count});
     },
     nothing_missing},
    {"scalar", "the definition: one exact z-buffered mesh after the other",
     [](const BackendOptions&) { return make_scalar_backend(); }, nothing_missing},
    {"parts", "the definition, drawing again only what moved",
     [](const BackendOptions&) { return make_part_backend(); }, nothing_missing},
}};

std::unique_ptr<Backend> make_backend(std::string_view name, const BackendOptions& options) {
  const auto kind = std::find_if(kBackends.begin(), kBackends.end(),
                                 [&](const BackendKind& candidate) { return candidate.name == name; });
  if (kind == kBackends.end()) {
    std::string names;
    for (const BackendKind& candidate : kBackends) {
      names += (names.empty() ? "" : ", ") + std::string(candidate.name);
    }
    throw Error(ErrorKind::usage, "there is no back end " + std::string(name), "Give one of: " + names + ".");
  }
  const std::string missing = kind->missing();
  if (!missing.empty()) {
    throw Error(ErrorKind::usage, "the back end " + std::string(name) + " cannot be used here: " + missing,
                "Give another one, or none: simd runs everywhere.");
  }
  return kind->make(options);
}

}  // namespace telemime
