// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/send_queue.h"

#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "telemime/streaming/mirror.h"

namespace telemime {
namespace {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

constexpr milliseconds kForever = std::chrono::hours(1);

struct WaitingFrame {
  MotionFrame frame;
  double taken = 0.0;  ///< ms of the monotonic clock
};

class QueuedSender final : public Sender, private SendLoop {
 public:
  QueuedSender(const SendUrl& url, const MakeLink& make_link)
      : SendLoop([this] { return stopping_.load(); }, kForever),
        mirror_(option(url, "mirror", {"0", "1"}) == "1") {
    status_.url = url.text;
    status_.words = "connecting";
    link_ = make_link(*this);
    thread_ = std::thread([this] { run(); });
  }

  ~QueuedSender() override {
    stopping_ = true;
    wake_();
    thread_.join();
  }

  void begin(const StreamHeader& header) override {
    auto person = std::make_shared<const StreamHeader>(mirror_ ? mirrored(header) : header);
    {
      const std::lock_guard lock(mutex_);
      status_.dropped += static_cast<std::int64_t>(queue_.size());  // they show another person
      queue_.clear();
      person_ = std::move(person);
      person_is_new_ = true;
    }
    wake_();
  }

  void send(const MotionFrame& frame, double taken) override {
    {
      const std::lock_guard lock(mutex_);
      if (!person_) {
        return;
      }
      if (queue_.size() == kSendQueueFrames) {
        queue_.pop_front();
        ++status_.dropped;
      }
      queue_.push_back({frame, taken});
    }
    wake_();
  }

  SenderStatus status() const override {
    const std::lock_guard lock(mutex_);
    return status_;
  }

 private:
  // SendLoop
  void waiting(const std::string& words) override {
    const std::lock_guard lock(mutex_);
    if (status_.state == SenderState::connecting) {
      status_.words = words;
    }
  }

  void sending(const std::string& words) override {
    const std::lock_guard lock(mutex_);
    if (status_.state != SenderState::sending) {
      status_.receivers = 1;
    }
    status_.state = SenderState::sending;
    status_.words = words;
    if (!good_since_) {
      good_since_ = SteadyClock::now();
    }
  }

  void receivers(std::int64_t count) override {
    const std::lock_guard lock(mutex_);
    status_.receivers = count;
  }

  // The thread
  void run() {
    RetryPauses pauses;
    try {
      for (;;) {
        SteadyClock::duration worked{};
        try {
          link_->open();
          write_frames();
        } catch (const std::exception& e) {
          worked = failed(e.what());
        }
        link_->close();
        discard_handlers();
        wait([] { return false; }, pauses.next(worked));
      }
    } catch (const LoopStopped&) {
      link_->close();
    }
  }

  void write_frames() {
    std::shared_ptr<const StreamHeader> given;
    for (;;) {
      wait([&] { return has_work(given != nullptr); }, kForever);
      std::optional<WaitingFrame> next;
      std::shared_ptr<const StreamHeader> person;
      {
        const std::lock_guard lock(mutex_);
        if (person_ && (person_is_new_ || !given)) {
          person = person_;
          person_is_new_ = false;
        } else if (!queue_.empty()) {
          next = std::move(queue_.front());
          queue_.pop_front();
        }
      }
      if (person) {
        given = std::move(person);
        link_->person(given);
      } else if (next) {
        write(*given, *next);
      }
    }
  }

  bool has_work(bool person_given) const {
    const std::lock_guard lock(mutex_);
    return person_is_new_ || (person_ && !person_given) || !queue_.empty();
  }

  void write(const StreamHeader& person, const WaitingFrame& next) {
    bool arrived = false;
    try {
      arrived = link_->frame(mirror_ ? mirrored(next.frame, person.camera) : next.frame, next.taken);
    } catch (const std::exception&) {
      const std::lock_guard lock(mutex_);
      ++status_.dropped;
      throw;
    }
    const std::lock_guard lock(mutex_);
    status_.sent += arrived ? 1 : 0;
  }

  /// Returns for how long frames have arrived.
  SteadyClock::duration failed(const std::string& cause) {
    const std::lock_guard lock(mutex_);
    status_.state = SenderState::failed;
    status_.words = cause + "; trying again";
    status_.receivers = 0;
    const auto since = std::exchange(good_since_, std::nullopt);
    return since ? SteadyClock::now() - *since : SteadyClock::duration{};
  }

  const bool mirror_;
  const std::function<void()> wake_ = waker();
  mutable std::mutex mutex_;  ///< guards the five members below; all others belong to the thread
  SenderStatus status_;
  std::deque<WaitingFrame> queue_;
  std::shared_ptr<const StreamHeader> person_;
  bool person_is_new_ = false;
  std::optional<SteadyClock::time_point> good_since_;  ///< when frames began to arrive at the receiver
  std::unique_ptr<Link> link_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<Sender> make_queued_sender(const SendUrl& url, const MakeLink& make_link) {
  return std::make_unique<QueuedSender>(url, make_link);
}

}  // namespace telemime
