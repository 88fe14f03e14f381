// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/all.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "telemime/outputs/all.h"
#include "telemime/outputs/testing_bap.h"
#include "telemime/outputs/testing_motion.h"
#include "telemime/streaming/send_queue.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime {
namespace {

using testing_receivers::comes_true;
using testing_receivers::ends_at_once;
using testing_receivers::kTaken;
using testing_receivers::TcpListener;
using testing_receivers::TcpPeer;

/// The next two lines, mask and values.
testing_bap::BapFrame next_frame(TcpPeer& receiver) {
  const std::string mask = receiver.line().value_or("");
  const std::string values = receiver.line().value_or("");
  return testing_bap::parse_bap("3.1 motion.bap 25 0\n" + mask + "\n" + values + "\n").frames.at(0);
}

std::string url_of(std::uint16_t port, const std::string& options = "") {
  return "bap+tcp://127.0.0.1:" + std::to_string(port) + options;
}

class BapTcp : public ::testing::Test {
 protected:
  StreamHeader header_ = testing_motion::header();
  std::vector<MotionFrame> frames_ = testing_motion::gesture(header_, 40);
};

TEST_F(BapTcp, StreamsWhatTheFileHoldsForEveryProfile) {
  for (const char* const profile : {"iso", "greta", "vreng-3.1", "vreng-3.2"}) {
    TcpListener listener;
    const auto sender = make_sender(url_of(listener.port(), "?profile=" + std::string(profile)));
    TcpPeer receiver = listener.accept();
    sender->begin(header_);
    const auto encoder = make_bap_encoder(profile);
    const std::string head = encoder->begin(header_);
    EXPECT_EQ(receiver.line().value_or("") + "\n", head);
    EXPECT_EQ(testing_bap::parse_bap(head).stated_frames, 0) << "an endless stream";
    for (const MotionFrame& frame : frames_) {
      sender->send(frame, kTaken);
      const std::string mask = receiver.line().value_or("");
      const std::string values = receiver.line().value_or("");
      ASSERT_EQ(mask + "\n" + values + "\n", encoder->frame(frame)) << profile;
    }
  }
}

// The meaning of the numbers, by the tables of the format alone.
TEST_F(BapTcp, AReceiverReadsTheAngles) {
  TcpListener listener;
  const auto sender = make_sender(url_of(listener.port()));
  TcpPeer receiver = listener.accept();
  sender->begin(header_);
  Pose pose;
  pose[Angle::l_shoulder_flexion] = -1.0;
  pose[Angle::r_elbow_flexion] = -0.5;
  sender->send(testing_motion::frame_of(header_.body, header_.camera, pose, 7, header_.fps), kTaken);
  EXPECT_EQ(receiver.line().value_or("").substr(0, 4), "3.1 ");
  const testing_bap::BapFrame frame = next_frame(receiver);
  EXPECT_EQ(frame.mask_length, 186U);
  EXPECT_EQ(frame.number, 7);
  EXPECT_EQ(frame.values.size(), 20U);
  EXPECT_EQ(frame.values.at(32), 100000);  // l_shoulder_flexion: forward is positive, 1e-5 rad
  EXPECT_EQ(frame.values.at(39), 50000);   // r_elbow_flexion
  EXPECT_EQ(frame.values.at(33), 0);
}

TEST_F(BapTcp, MirroredOnRequest) {
  TcpListener listener;
  const auto sender = make_sender(url_of(listener.port(), "?mirror=1"));
  TcpPeer receiver = listener.accept();
  sender->begin(header_);
  Pose pose;
  pose[Angle::l_shoulder_flexion] = -1.0;
  sender->send(testing_motion::frame_of(header_.body, header_.camera, pose, 0, header_.fps), kTaken);
  receiver.line();
  const testing_bap::BapFrame frame = next_frame(receiver);
  EXPECT_EQ(frame.values.at(33), 100000);
  EXPECT_EQ(frame.values.at(32), 0);
}

TEST_F(BapTcp, AReceiverThatComesLaterIsFound) {
  const std::uint16_t port = testing_receivers::free_port();
  const auto sender = make_sender(url_of(port));
  sender->begin(header_);
  EXPECT_TRUE(comes_true([&] {
    sender->send(frames_[0], kTaken);
    return sender->status().state == SenderState::failed;
  }));
  EXPECT_EQ(sender->status().words, "no program is listening there; trying again");
  TcpListener listener(port);
  TcpPeer receiver = listener.accept();
  EXPECT_EQ(receiver.line().value_or("").substr(0, 4), "3.1 ");
  EXPECT_TRUE(comes_true([&] { return sender->status().state == SenderState::sending; }));
}

TEST_F(BapTcp, AReceiverThatClosesGetsTheHeaderAgainWhenItIsBack) {
  TcpListener listener;
  const auto sender = make_sender(url_of(listener.port()));
  sender->begin(header_);
  for (int time = 0; time < 3; ++time) {
    TcpPeer receiver = listener.accept();
    sender->send(frames_[0], kTaken);
    EXPECT_EQ(receiver.line().value_or("").substr(0, 4), "3.1 ");
    EXPECT_EQ(next_frame(receiver).mask_length, 186U) << "connection " << time;
    if (time == 1) {
      receiver.reset();
    } else {
      receiver.close();
    }
    EXPECT_TRUE(comes_true([&] {
      sender->send(frames_[1], kTaken);
      return listener.somebody_waits();
    }));
  }
}

TEST_F(BapTcp, AReceiverMayCloseItsOwnDirection) {
  TcpListener listener;
  const auto sender = make_sender(url_of(listener.port()));
  sender->begin(header_);
  TcpPeer receiver = listener.accept();
  receiver.shut_own_direction();
  sender->send(frames_[0], kTaken);
  EXPECT_TRUE(receiver.line().has_value());
  for (int t = 0; t < 10; ++t) {
    EXPECT_TRUE(receiver.line().has_value() && receiver.line().has_value());
    sender->send(frames_[1], kTaken);
  }
  EXPECT_EQ(sender->status().state, SenderState::sending);
}

TEST_F(BapTcp, AReceiverThatNeverReadsLosesFramesAlone) {
  TcpListener listener(0, 4096);
  auto sender = make_sender(url_of(listener.port()));
  const TcpPeer receiver = listener.accept();
  sender->begin(header_);
  std::int64_t given = 0;
  EXPECT_TRUE(comes_true([&] {
    sender->send(frames_[0], kTaken);
    ++given;
    return sender->status().words == "it reads too slowly; frames are dropped";
  }));
  const SenderStatus status = sender->status();
  EXPECT_GT(status.dropped, 0);
  // Every frame was sent, was dropped, or is one of the few that wait: nothing piles up.
  EXPECT_LE(given - status.sent - status.dropped, static_cast<std::int64_t>(kSendQueueFrames) + 1);
  EXPECT_TRUE(ends_at_once(std::move(sender)));
}

class SlowBapTcp : public BapTcp {};

TEST_F(SlowBapTcp, AReceiverThatNeverReadsIsGivenUp) {
  TcpListener listener(0, 4096);
  const auto sender = make_sender(url_of(listener.port()));
  const TcpPeer receiver = listener.accept();
  sender->begin(header_);
  EXPECT_TRUE(comes_true([&] {
    sender->send(frames_[0], kTaken);
    return listener.somebody_waits();
  })) << "it is left, and tried again";
  TcpPeer again = listener.accept();
  EXPECT_EQ(again.line().value_or("").substr(0, 4), "3.1 ");
}

TEST_F(BapTcp, EndsAtOnceInEveryState) {
  EXPECT_TRUE(ends_at_once(make_sender(url_of(testing_receivers::free_port()))));
  // Where one waits already and there is room for no other, a connection is never answered.
  const TcpListener full(0, 0, 0);
  const TcpPeer first = TcpPeer::to(full.port());
  auto connecting = make_sender(url_of(full.port()));
  EXPECT_EQ(connecting->status().state, SenderState::connecting);
  EXPECT_TRUE(ends_at_once(std::move(connecting)));
  auto retrying = make_sender(url_of(testing_receivers::free_port()));
  EXPECT_TRUE(comes_true([&] { return retrying->status().state == SenderState::failed; }));
  EXPECT_TRUE(ends_at_once(std::move(retrying)));
  TcpListener quiet;
  auto idle = make_sender(url_of(quiet.port()));
  const TcpPeer peer = quiet.accept();
  EXPECT_TRUE(comes_true([&] { return idle->status().state == SenderState::sending; }));
  EXPECT_TRUE(ends_at_once(std::move(idle)));
}

}  // namespace
}  // namespace telemime
