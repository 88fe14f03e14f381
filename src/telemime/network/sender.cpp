// SPDX-License-Identifier: Apache-2.0
#include "telemime/network/sender.h"

#include "telemime/core/errors.h"
#include "telemime/network/all.h"

namespace telemime {

std::unique_ptr<Sender> make_sender(const std::string& url) {
  const SendUrl parts = parse_url(url, kSenderKinds.front().example);
  std::string examples;
  for (const SenderKind& kind : kSenderKinds) {
    if (kind.scheme == parts.scheme) {
      return kind.make(parse_url(url, kind.example));
    }
    examples += (examples.empty() ? "" : ", ") + std::string(kind.example);
  }
  throw Error(ErrorKind::usage, "there is no output \"" + parts.scheme + "\" over the network",
              "Use one of " + examples + ".");
}

}  // namespace telemime
