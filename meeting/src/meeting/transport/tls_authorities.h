// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/types.h>

#include <filesystem>

namespace telemime::meeting {

/// Trusts the authorities whose certificates (PEM) are in `ca`, a file of at most 4 MB; empty: the system's.
/// Throws Error(usage) when there are none to be read.
void trust_authorities(SSL_CTX* context, const std::filesystem::path& ca);

}  // namespace telemime::meeting
