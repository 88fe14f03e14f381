// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/crypto.h"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kSecretBytes = 24;

const unsigned char* data_of(std::string_view bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

using Digest = std::array<unsigned char, SHA256_DIGEST_LENGTH>;

Digest digest(std::string_view bytes) {
  Digest result{};
  ::SHA256(data_of(bytes), bytes.size(), result.data());
  return result;
}

}  // namespace

std::string random_bytes(std::size_t count) {
  std::string bytes(count, '\0');
  if (::RAND_bytes(reinterpret_cast<unsigned char*>(bytes.data()), static_cast<int>(count)) != 1) {
    throw Error(ErrorKind::output, "this computer has no random numbers for secrets");
  }
  return bytes;
}

std::string base64(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');
  ::EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), data_of(bytes),
                    static_cast<int>(bytes.size()));
  text.pop_back();  // OpenSSL's final zero
  return text;
}

std::string base64url(std::string_view bytes) {
  std::string text = base64(bytes);
  std::replace(text.begin(), text.end(), '+', '-');
  std::replace(text.begin(), text.end(), '/', '_');
  text.erase(std::min(text.find('='), text.size()));
  return text;
}

std::string random_secret() {
  return base64url(random_bytes(kSecretBytes));
}

std::string signature(std::string_view key, std::string_view text) {
  Digest result{};
  ::HMAC(::EVP_sha256(), key.data(), static_cast<int>(key.size()), data_of(text), text.size(), result.data(),
         nullptr);
  return base64url({reinterpret_cast<const char*>(result.data()), result.size()});
}

// Compares digests, which have the same length.
bool same_secret(std::string_view a, std::string_view b) {
  const Digest left = digest(a);
  const Digest right = digest(b);
  return ::CRYPTO_memcmp(left.data(), right.data(), left.size()) == 0;
}

}  // namespace telemime::meeting
