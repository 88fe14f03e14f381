// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "telemime/core/errors.h"

namespace telemime {

/// The message of the Error of this kind that `action` throws; "" when it throws none. Another kind fails the
/// test. Not installed.
template <class Action>
std::string error_of(ErrorKind kind, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), kind) << error.what();
    return error.what();
  }
  return {};
}

/// Errors in the tests of all modules. Not installed.
namespace testing_errors {

/// The same; the test also fails when nothing is thrown.
template <class Action>
std::string message_of(ErrorKind kind, const Action& action) {
  const std::string message = error_of(kind, action);
  EXPECT_NE(message, "") << "nothing was thrown";
  return message;
}

/// That message contains this.
inline bool names(const std::string& message, const std::string& what) {
  return message.find(what) != std::string::npos;
}

/// check_settings() refuses the defaults with each of these changes, by the name of the setting.
template <typename Settings>
void expect_refused(const std::vector<std::pair<std::string, std::function<void(Settings&)>>>& faults) {
  for (const auto& [name, spoil] : faults) {
    SCOPED_TRACE(name);
    Settings settings;
    spoil(settings);
    const std::string message = message_of(ErrorKind::config, [&] { check_settings(settings); });
    EXPECT_TRUE(names(message, name)) << message;
  }
}

}  // namespace testing_errors
}  // namespace telemime
