// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

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

}  // namespace telemime
