// SPDX-License-Identifier: Apache-2.0
#include "telemime/network/vmc.h"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <optional>
#include <string>

#include "telemime/core/errors.h"
#include "telemime/network/person_motion.h"
#include "telemime/network/resolve.h"
#include "telemime/network/send_queue.h"
#include "telemime/network/tcp.h"
#include "telemime/network/vmc_messages.h"

namespace telemime {
namespace {

namespace asio = boost::asio;

class VmcLink final : public Link {
 public:
  VmcLink(SendLoop& loop, const SendUrl& url, const VmcOptions& options)
      : loop_(loop),
        host_(url.host),
        port_(url.port.value_or(kMarionettePort)),
        options_(options),
        socket_(loop.io()) {}

  void open() override {
    // IPv4 where the host has it: the avatar programs listen there.
    const asio::ip::udp::endpoint endpoint(asio::ip::make_address(resolve(loop_, host_).front()), port_);
    frames_ = 0;
    boost::system::error_code error;
    socket_.open(endpoint.protocol(), error);
    if (!error) {
      socket_.connect(endpoint, error);  // or the system would not tell us of refusals
    }
    if (error) {
      throw LinkBroken(in_words(error));
    }
    socket_.non_blocking(true);
    read_on();
    loop_.waiting("waits for a person to follow");
  }

  void person(const std::shared_ptr<const StreamHeader>& person) override {
    if (person_ != person) {
      motion_.emplace(person->body);
      person_ = person;
    }
  }

  bool frame(const MotionFrame& raw, double /*taken*/) override {
    const MotionFrame frame = motion_->clean(raw);
    const auto motion = (*motion_)(frame);
    for (const std::string& datagram :
         vmc_datagrams(motion_->skeleton(), motion ? &*motion : nullptr, frame.time, options_)) {
      boost::system::error_code error;
      socket_.send(asio::buffer(datagram), 0, error);
      if (error) {
        throw LinkBroken(in_words(error));
      }
    }
    // A refusal comes back after the frame: the one behind it would have heard of it.
    if (++frames_ == 2) {
      loop_.sending();
    }
    return true;
  }

  void close() noexcept override {
    boost::system::error_code ignored;
    socket_.close(ignored);
  }

 private:
  /// Nothing is expected; what matters is the refusal.
  void read_on() {
    socket_.async_receive(asio::buffer(rubbish_),
                          [this](const boost::system::error_code& error, std::size_t /*count*/) {
                            if (error == asio::error::operation_aborted) {
                              return;
                            }
                            if (error && error != asio::error::message_size) {
                              throw LinkBroken(in_words(error));
                            }
                            read_on();
                          });
  }

  SendLoop& loop_;
  const std::string host_;
  const std::uint16_t port_;
  const VmcOptions options_;
  std::optional<PersonMotion> motion_;
  std::shared_ptr<const StreamHeader> person_;  ///< whose motion_ is
  std::int64_t frames_ = 0;                     ///< of this attempt
  asio::ip::udp::socket socket_;
  std::array<char, 512> rubbish_{};
};

}  // namespace

std::unique_ptr<Sender> make_vmc_sender(const SendUrl& url) {
  check_options(url, {"bundle", "positions", "root", "mirror"});
  require_host(url);
  if (url.port == 0 || url.path.size() > 1) {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" does not name a port of a computer",
                "Write it like vmc://localhost:39539.");
  }
  VmcOptions options;
  options.bundles = option(url, "bundle", {"1", "0"}) == "1";
  options.all_positions = option(url, "positions", {"all", "hips"}) == "all";
  options.root_moves = option(url, "root", {"still", "moves"}) == "moves";
  return make_queued_sender(url,
                            [&](SendLoop& loop) { return std::make_unique<VmcLink>(loop, url, options); });
}

}  // namespace telemime
