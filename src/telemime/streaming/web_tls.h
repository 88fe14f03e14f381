// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/ssl/context.hpp>
#include <filesystem>
#include <memory>

namespace telemime {

/// What a server of TLS (1.2 or newer) shows and proves: its certificate, with those in between behind it,
/// and its key without a password, both in PEM form. Throws Error(usage) that says which of them cannot be
/// used and why.
std::shared_ptr<boost::asio::ssl::context> web_tls(const std::filesystem::path& certificate,
                                                   const std::filesystem::path& key);

}  // namespace telemime
