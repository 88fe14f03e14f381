// SPDX-License-Identifier: Apache-2.0
#include "fuzz_target.h"
#include "telemime/tracker/person_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = [](std::string_view text) {
    const telemime::PersonFile person = telemime::parse_person(text, "fuzz");
    telemime::make_model(person.person.shape);
  };
  return telemime::fuzz_one(data, size, read, telemime::ErrorKind::config);
}
