// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/send_queue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <future>
#include <mutex>

#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/resolve.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime {
namespace {

using testing_receivers::comes_true;
using testing_receivers::ends_at_once;
using testing_receivers::kTaken;

constexpr std::chrono::milliseconds kLong = std::chrono::minutes(10);

/// What the links of a test do, and what they saw.
struct Script {
  std::function<void(SendLoop&)> open = [](SendLoop& loop) { loop.sending(); };
  std::function<void(SendLoop&, const MotionFrame&)> frame = [](SendLoop&, const MotionFrame&) {};
  std::atomic<int> opened = 0;
  std::atomic<int> closed = 0;
  std::atomic<int> persons = 0;

  std::vector<std::int64_t> frames() {
    const std::lock_guard lock(mutex);
    return seen;
  }
  std::mutex mutex;
  std::vector<std::int64_t> seen;
};

class ScriptedLink final : public Link {
 public:
  ScriptedLink(SendLoop& loop, Script& script) : loop_(loop), script_(script) {}
  void open() override {
    ++script_.opened;
    script_.open(loop_);
  }
  void person(const std::shared_ptr<const StreamHeader>& /*person*/) override { ++script_.persons; }
  bool frame(const MotionFrame& frame, double /*taken*/) override {
    {
      const std::lock_guard lock(script_.mutex);
      script_.seen.push_back(frame.frame);
    }
    script_.frame(loop_, frame);
    return true;
  }
  void close() noexcept override { ++script_.closed; }

 private:
  SendLoop& loop_;
  Script& script_;
};

class SendQueue : public ::testing::Test {
 protected:
  void start() {
    sender_ = make_queued_sender(parse_url("test://host", "test://host"), [this](SendLoop& loop) {
      return std::make_unique<ScriptedLink>(loop, script_);
    });
  }
  void send(std::int64_t number) const {
    MotionFrame frame;
    frame.frame = number;
    sender_->send(frame, kTaken);
  }
  bool failed(const std::string& words) const {
    return comes_true(
        [&] { return sender_->status().state == SenderState::failed && sender_->status().words == words; });
  }

  StreamHeader header_ = testing_motion::header();
  Script script_;
  std::unique_ptr<Sender> sender_;
};

TEST_F(SendQueue, FramesArriveInOrderBehindThePerson) {
  start();
  send(-1);  // nobody is known: not a frame of the stream
  sender_->begin(header_);
  for (int t = 0; t < 3; ++t) {
    send(t);
  }
  EXPECT_TRUE(comes_true([&] { return sender_->status().sent == 3; }));
  EXPECT_EQ(script_.frames(), (std::vector<std::int64_t>{0, 1, 2}));
  EXPECT_EQ(script_.persons, 1);
  EXPECT_EQ(sender_->status().dropped, 0);
  sender_->begin(header_);
  EXPECT_TRUE(comes_true([&] { return script_.persons == 2; }));
}

TEST_F(SendQueue, TheNewestFramesWaitForASlowReceiver) {
  std::atomic<bool> slow = true;
  script_.frame = [&](SendLoop& loop, const MotionFrame&) { loop.wait([&] { return !slow; }, kLong); };
  start();
  sender_->begin(header_);
  send(0);
  EXPECT_TRUE(comes_true([&] { return script_.frames().size() == 1; }));
  for (int t = 1; t <= 100; ++t) {
    send(t);
  }
  EXPECT_EQ(sender_->status().dropped, 100 - static_cast<std::int64_t>(kSendQueueFrames));
  slow = false;
  send(101);
  EXPECT_TRUE(comes_true([&] { return script_.frames().back() == 101; }));
  const auto seen = script_.frames();
  EXPECT_GE(seen.at(1), 97);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
}

TEST_F(SendQueue, FramesOfAnEarlierPersonAreDropped) {
  std::atomic<bool> slow = true;
  script_.frame = [&](SendLoop& loop, const MotionFrame&) { loop.wait([&] { return !slow; }, kLong); };
  start();
  sender_->begin(header_);
  send(0);
  EXPECT_TRUE(comes_true([&] { return script_.frames().size() == 1; }));
  send(1);
  send(2);
  sender_->begin(header_);
  EXPECT_EQ(sender_->status().dropped, 2);
  slow = false;
  send(3);
  EXPECT_TRUE(comes_true([&] { return script_.frames().size() == 2; }));
  EXPECT_EQ(script_.frames().back(), 3);
}

TEST_F(SendQueue, AFailureIsReportedAndTriedAgainWithThePerson) {
  std::atomic<int> failures = 3;
  script_.open = [&](SendLoop& loop) {
    if (failures-- > 0) {
      throw LinkBroken("out of order");
    }
    loop.sending();
  };
  start();
  sender_->begin(header_);
  EXPECT_TRUE(comes_true([&] { return sender_->status().state == SenderState::sending; }));
  EXPECT_EQ(script_.opened, 4);
  EXPECT_EQ(script_.closed, 3) << "also attempts that failed are closed";
  EXPECT_EQ(sender_->status().words, "");
  EXPECT_EQ(sender_->status().receivers, 1);
  EXPECT_TRUE(comes_true([&] { return script_.persons == 1; }));
}

TEST_F(SendQueue, AFrameThatCannotBeWrittenIsDropped) {
  script_.frame = [&](SendLoop&, const MotionFrame& frame) {
    if (frame.frame == 0) {
      throw std::runtime_error("any failure");
    }
  };
  start();
  sender_->begin(header_);
  send(0);
  EXPECT_TRUE(comes_true([&] { return sender_->status().dropped == 1 && script_.opened == 2; }));
  send(1);
  EXPECT_TRUE(comes_true([&] { return sender_->status().sent == 1; }));
  EXPECT_EQ(script_.persons, 2) << "the new connection is told who it is";
}

TEST_F(SendQueue, AHandlerMayBreakTheConnectionButNotTheNextOne) {
  script_.open = [&](SendLoop& loop) {
    if (script_.opened == 1) {
      for (int n = 0; n < 3; ++n) {
        boost::asio::post(loop.io(), [] { throw LinkBroken("cut off"); });
      }
    }
    loop.sending();
  };
  start();
  EXPECT_TRUE(comes_true([&] { return script_.opened == 2; }));
  sender_->begin(header_);
  send(0);
  EXPECT_TRUE(comes_true([&] { return sender_->status().sent == 1; }));
  EXPECT_EQ(script_.opened, 2);
}

TEST_F(SendQueue, EndsAtOnceWhileItPauses) {
  script_.open = [](SendLoop&) { throw LinkBroken("out of order"); };
  start();
  EXPECT_TRUE(comes_true([&] { return script_.opened == 5; }));  // the pause is most of a second by now
  EXPECT_TRUE(failed("out of order; trying again"));
  EXPECT_TRUE(ends_at_once(std::move(sender_)));
}

TEST_F(SendQueue, EndsAtOnceWhileItConnectsOrWrites) {
  script_.open = [](SendLoop& loop) { loop.wait([] { return false; }, kLong); };
  start();
  EXPECT_TRUE(comes_true([&] { return script_.opened == 1; }));
  EXPECT_TRUE(ends_at_once(std::move(sender_)));
  EXPECT_EQ(script_.closed, 1);

  script_.open = [](SendLoop& loop) { loop.sending(); };
  script_.frame = [](SendLoop& loop, const MotionFrame&) { loop.wait([] { return false; }, kLong); };
  start();
  sender_->begin(header_);
  send(0);
  EXPECT_TRUE(comes_true([&] { return script_.frames().size() == 1; }));
  EXPECT_TRUE(ends_at_once(std::move(sender_)));
}

TEST_F(SendQueue, EndsAtOnceWhileANameIsLookedUp) {
  std::promise<void> answer;
  std::promise<void> gone;
  script_.open = [&](SendLoop& loop) {
    const auto lookup = [answered = answer.get_future().share(), &gone](const std::string&) {
      answered.wait();
      gone.set_value_at_thread_exit();
      return std::vector<std::string>();
    };
    resolve(loop, "slow.example", lookup);
  };
  start();
  EXPECT_TRUE(comes_true([&] { return script_.opened == 1; }));
  EXPECT_TRUE(ends_at_once(std::move(sender_)));
  answer.set_value();  // the lookup ends by itself, and harms nobody
  gone.get_future().wait();
}

TEST_F(SendQueue, LookedUpNamesArriveAndUnknownOnesAreReported) {
  std::vector<std::string> found;
  script_.open = [&](SendLoop& loop) {
    if (script_.opened == 1) {
      resolve(loop, "one.example", [](const std::string& host) -> std::vector<std::string> {
        throw LinkBroken("unknown: " + host);
      });
    }
    if (script_.opened == 2) {
      resolve(loop, "two.example", [](const std::string&) { return std::vector<std::string>(); });
    }
    found = resolve(loop, "three.example", [](const std::string&) {
      return std::vector<std::string>{"10.0.0.1", "::1"};
    });
    loop.sending();
  };
  start();
  EXPECT_TRUE(comes_true([&] { return sender_->status().state == SenderState::sending; }));
  EXPECT_EQ(script_.opened, 3);
  EXPECT_EQ(found, (std::vector<std::string>{"10.0.0.1", "::1"}));
}

TEST(Lookup, PutsIpv4FirstAndReportsWhatIsUnknown) {
  EXPECT_EQ(system_lookup("localhost").at(0), "127.0.0.1");
  EXPECT_THROW(system_lookup("nowhere.invalid"), LinkBroken);
}

}  // namespace
}  // namespace telemime
