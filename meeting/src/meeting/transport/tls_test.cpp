// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/tls.h"

#include <gtest/gtest.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <openssl/x509_vfy.h>
#include <sys/stat.h>

#include <fstream>
#include <memory>
#include <string>

#include "meeting/protocol/testing.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting {
namespace {

/// A self-signed certificate in PEM form.
std::string authority(const std::string& name) {
  const std::unique_ptr<EVP_PKEY, void (*)(EVP_PKEY*)> key(EVP_EC_gen("P-256"), EVP_PKEY_free);
  const std::unique_ptr<X509, void (*)(X509*)> made(X509_new(), X509_free);
  X509_set_pubkey(made.get(), key.get());
  X509_gmtime_adj(X509_getm_notBefore(made.get()), 0);
  X509_gmtime_adj(X509_getm_notAfter(made.get()), 3600);
  X509_NAME* const subject = X509_get_subject_name(made.get());
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  X509_set_issuer_name(made.get(), subject);
  X509_sign(made.get(), key.get(), EVP_sha256());
  const std::unique_ptr<BIO, int (*)(BIO*)> text(BIO_new(BIO_s_mem()), BIO_free);
  PEM_write_bio_X509(text.get(), made.get());
  char* bytes = nullptr;
  const long size = BIO_get_mem_data(text.get(), &bytes);
  return {bytes, static_cast<std::size_t>(size)};
}

class Certificates : public ::testing::Test {
 protected:
  std::string file(const std::string& content) const {
    std::string path = folder_.file("ca.pem");
    std::ofstream(path, std::ios::binary) << content;
    return path;
  }
  int trusted() const {
    return sk_X509_OBJECT_num(X509_STORE_get0_objects(SSL_CTX_get_cert_store(tls_.get())));
  }
  std::string refusal(const std::string& path) const {
    return error_of([&] { trust_authorities(tls_.get(), path); }, ErrorKind::usage);
  }
  ScratchFolder folder_;
  std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> tls_{SSL_CTX_new(TLS_client_method()), SSL_CTX_free};
};

TEST_F(Certificates, AllInAFileAreTrusted) {
  trust_authorities(tls_.get(), file("Of our own:\n" + authority("one") + "and\n" + authority("two")));
  EXPECT_EQ(trusted(), 2);
}

TEST_F(Certificates, FilesWithoutAnyAreRejected) {
  const std::string good = authority("one");
  std::string broken = authority("two");
  broken.replace(broken.size() / 2, 8, "!!!!!!!!");
  for (const std::string& content : {std::string(), std::string("no certificate"), broken, good + broken}) {
    const std::string text = refusal(file(content));
    EXPECT_NE(text.find("ca.pem"), std::string::npos) << content;
  }
}

// A page may name any path of this computer, and reading some would block forever.
TEST_F(Certificates, SpecialFilesAreRejectedAtOnce) {
  const std::string pipe = folder_.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, folder_.path().string(), std::string("/dev/zero")}) {
    EXPECT_NE(refusal(path).find("it is not a regular file"), std::string::npos) << path;
  }
  EXPECT_NE(refusal(folder_.file("none")).find("No such file"), std::string::npos);
  EXPECT_NE(refusal(file(std::string(5U << 20, '\n'))).find("too long"), std::string::npos);
  EXPECT_EQ(trusted(), 0);
}

}  // namespace
}  // namespace telemime::meeting
