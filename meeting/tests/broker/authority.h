// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>

#include "broker.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting::test_support {

/// A certificate authority, by the command openssl.
class Authority {
 public:
  Authority() {
    run({TELEMIME_OPENSSL, "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1",
         "-nodes", "-days", "2", "-subj", "/CN=Test", "-keyout", file("ca.key"), "-out", file("ca.pem")});
  }
  std::string file(const std::string& name) const { return folder_.file(name); }
  /// A certificate for `names` ("DNS:localhost,IP:127.0.0.1"), and its key, as NAME.pem and NAME.key.
  void certify(const std::string& name, const std::string& names, const std::string& days = "2") const {
    std::ofstream(file(name + ".ext")) << "subjectAltName=" << names << '\n';
    run({TELEMIME_OPENSSL, "req", "-new", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1",
         "-nodes", "-subj", "/CN=broker", "-keyout", file(name + ".key"), "-out", file(name + ".csr")});
    run({TELEMIME_OPENSSL, "x509", "-req", "-in", file(name + ".csr"), "-CA", file("ca.pem"), "-CAkey",
         file("ca.key"), "-CAcreateserial", "-days", days, "-extfile", file(name + ".ext"), "-out",
         file(name + ".pem")});
  }

 private:
  ScratchFolder folder_;
};

}  // namespace telemime::meeting::test_support
