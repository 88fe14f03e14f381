// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/all.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/udp.hpp>
#include <chrono>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "telemime/core/errors.h"
#include "telemime/streaming/person_motion.h"
#include "telemime/streaming/resolve.h"
#include "telemime/streaming/send_queue.h"
#include "telemime/streaming/tcp.h"
#include "telemime/streaming/vmc_messages.h"

namespace telemime {
namespace {

namespace asio = boost::asio;
using SteadyClock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kLongestWait{5000};  // for a network that accepts no data
constexpr std::chrono::seconds kLongestSearch{5};        // for a computer's address: Linux asks three times

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
    options_.largest = endpoint.address().is_loopback() ? kVmcLargestLocalDatagram : kVmcLargestDatagram;
    frames_ = 0;
    told_ = false;
    believed_at_ = SteadyClock::now() + (unreachable_ ? kLongestSearch : std::chrono::seconds(0));
    boost::system::error_code error;
    socket_.open(endpoint.protocol(), error);
    if (!error) {
      socket_.connect(endpoint, error);  // otherwise the system does not report refusals
    }
    if (error) {
      throw LinkBroken(in_words(error));
    }
    socket_.non_blocking(true);
    tell_of_unreachable(endpoint.protocol() == asio::ip::udp::v4());
    read_on();
    loop_.waiting("waiting for a person to track");
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
    const auto datagrams = vmc_datagrams(motion_->skeleton(), motion ? &*motion : nullptr,
                                         face_to_show(frame.face), frame.time, options_);
    followed_ = motion.has_value();
    face_shown_ = frame.face.has_value();
    time_ = frame.time;
    for (const std::string& datagram : datagrams) {
      send(datagram);
    }
    // A refusal arrives after the frame that caused it: the next one is sent after it.
    if (++frames_ >= 2 && !told_ && SteadyClock::now() >= believed_at_) {
      loop_.sending();
      told_ = true;
      unreachable_ = false;
    }
    return true;
  }

  void close() noexcept override {
    boost::system::error_code ignored;
    try {
      say_farewell();
    } catch (const std::exception&) {  // out of memory: the message is optional
    }
    socket_.close(ignored);
  }

 private:
  /// Receivers keep the last face: when it is no longer seen, one at rest is sent.
  const FaceMotion* face_to_show(const std::optional<FaceMotion>& face) const {
    static const FaceMotion rest;
    return face ? &*face : face_shown_ ? &rest : nullptr;
  }

  /// The last message to a receiver says that nobody is tracked, and brings the face to rest.
  void say_farewell() {
    if (!(followed_ || face_shown_) || !socket_.is_open()) {
      return;
    }
    boost::system::error_code ignored;
    const auto datagrams =
        vmc_datagrams(motion_->skeleton(), nullptr, face_to_show(std::nullopt), time_, options_);
    followed_ = face_shown_ = false;
    for (const std::string& datagram : datagrams) {
      socket_.send(asio::buffer(datagram), 0, ignored);
    }
  }

  /// Otherwise only a refusal is noticed, and frames are sent forever to a computer that is off.
  void tell_of_unreachable(bool v4) {
    const int on = 1;
    ::setsockopt(socket_.native_handle(), v4 ? IPPROTO_IP : IPPROTO_IPV6, v4 ? IP_RECVERR : IPV6_RECVERR, &on,
                 sizeof on);
  }

  void send(const std::string& datagram) {
    boost::system::error_code error;
    while (socket_.send(asio::buffer(datagram), 0, error), error == asio::error::would_block) {
      // Nothing is sent at the moment: the receiver's address is being resolved, or a wireless network is
      // slow.
      const auto room = std::make_shared<Completion>();
      socket_.async_wait(asio::socket_base::wait_write, note<>(room));
      if (!loop_.wait([&room] { return room->done; }, kLongestWait)) {
        throw LinkBroken("the network does not accept data for that address");
      }
    }
    if (error && error != asio::error::no_buffer_space) {  // lost, as datagrams may be
      fail(error);
    }
  }

  [[noreturn]] void fail(const boost::system::error_code& error) {
    unreachable_ = error == asio::error::host_unreachable;
    throw LinkBroken(in_words(error));
  }

  /// No data is expected; only refusals matter.
  void read_on() {
    socket_.async_receive(asio::buffer(rubbish_),
                          [this](const boost::system::error_code& error, std::size_t /*count*/) {
                            if (error == asio::error::operation_aborted) {
                              return;
                            }
                            if (error && error != asio::error::message_size) {
                              fail(error);
                            }
                            read_on();
                          });
  }

  SendLoop& loop_;
  const std::string host_;
  const std::uint16_t port_;
  VmcOptions options_;
  std::optional<PersonMotion> motion_;
  std::shared_ptr<const StreamHeader> person_;  ///< of motion_
  bool followed_ = false;                       ///< the last frame showed a person
  bool face_shown_ = false;                     ///< and a face
  double time_ = 0.0;                           ///< of the last frame, s
  std::int64_t frames_ = 0;                     ///< since the last connection
  bool told_ = false;                           ///< the status says that frames arrive
  bool unreachable_ = false;                    ///< the computer was unreachable in the last attempt
  SteadyClock::time_point believed_at_;         ///< when frames without a refusal count as received
  asio::ip::udp::socket socket_;
  std::array<char, 512> rubbish_{};
};

}  // namespace

std::unique_ptr<Sender> make_vmc_sender(const SendUrl& url) {
  check_options(url, {"bundle", "positions", "root", "expressions", "mirror"});
  if (url.path.size() > 1) {
    throw Error(ErrorKind::usage, "the output \"" + url.text + "\" has a path, which is not allowed here",
                "Write it like vmc://localhost:39539.");
  }
  VmcOptions options;
  options.bundles = option(url, "bundle", {"1", "0"}) == "1";
  options.all_positions = option(url, "positions", {"all", "hips"}) == "all";
  options.root_moves = option(url, "root", {"still", "moves"}) == "moves";
  const std::string expressions = option(url, "expressions", {"vrm0", "vrm1", "arkit"});
  options.expressions = expressions == "arkit"  ? VmcExpressions::arkit
                        : expressions == "vrm1" ? VmcExpressions::vrm1
                                                : VmcExpressions::vrm0;
  return make_queued_sender(url,
                            [&](SendLoop& loop) { return std::make_unique<VmcLink>(loop, url, options); });
}

}  // namespace telemime
