// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/tls_authorities.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <openssl/x509_vfy.h>

#include <memory>
#include <stdexcept>
#include <string>

#include "meeting/transport/files.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kLongestFile = 4U << 20;  // bytes; the system's own has 0.2 MB

/// How many certificates were added; none when one of them is broken.
int add_all(X509_STORE* store, const std::string& pem) {
  const std::unique_ptr<BIO, int (*)(BIO*)> text(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())),
                                                 BIO_free);
  int added = 0;
  while (text) {
    // Reads "TRUSTED CERTIFICATE", too, as OpenSSL does for files.
    const std::unique_ptr<X509, void (*)(X509*)> certificate(
        PEM_read_bio_X509_AUX(text.get(), nullptr, nullptr, nullptr), X509_free);
    if (!certificate) {
      return ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE ? added : 0;
    }
    added += X509_STORE_add_cert(store, certificate.get());
  }
  return added;
}

}  // namespace

void trust_authorities(SSL_CTX* context, const std::filesystem::path& ca) {
  if (ca.empty()) {
    SSL_CTX_set_default_verify_paths(context);
  } else {
    std::string why;
    try {
      if (add_all(SSL_CTX_get_cert_store(context), read_small_file(ca, kLongestFile).content) == 0) {
        why = "it has none, or a broken one";
      }
    } catch (const std::runtime_error& e) {
      why = e.what();
    }
    if (!why.empty()) {
      ERR_clear_error();
      throw Error(ErrorKind::usage, "there are no certificates to be read in " + ca.string() + ": " + why,
                  "ca=FILE names a file of certificates in PEM form.");
    }
  }
  ERR_clear_error();
}

}  // namespace telemime::meeting
