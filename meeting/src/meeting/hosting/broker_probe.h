// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace telemime::meeting {

enum class BrokerAnswer {
  accepted,  ///< it knows this account
  refused,   ///< it works, and does not know it
  silent,    ///< it does not work (yet)
};

/// Asks the broker at that socket of this computer (AF_UNIX) by connecting once. Takes a second at most.
BrokerAnswer ask_broker(const std::filesystem::path& socket, const std::string& user,
                        const std::string& password);

}  // namespace telemime::meeting
