// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/avatar_shelf.h"

#include <gtest/gtest.h>

#include <future>
#include <mutex>
#include <stdexcept>

namespace telemime {
namespace {

std::string name_of(std::size_t look) {
  return std::string(kAvatarLooks[look].name);
}

// What get() will give.
std::future<AvatarShelf::Bytes> ask(AvatarShelf& shelf, const std::string& look) {
  const auto promise = std::make_shared<std::promise<AvatarShelf::Bytes>>();
  EXPECT_TRUE(shelf.get(look, [promise](AvatarShelf::Bytes bytes) { promise->set_value(std::move(bytes)); }));
  return promise->get_future();
}

TEST(AvatarShelf, NobodyWaitsAndWhatIsAskedForIsMadeNext) {
  std::promise<void> go;
  std::promise<void> begun;
  std::vector<std::string> made;
  AvatarShelf shelf([&, gate = go.get_future().share()](const AvatarLook& look) {
    if (made.empty()) {
      begun.set_value();
    }
    gate.wait();
    made.emplace_back(look.name);
    return "file of " + made.back();
  });
  begun.get_future().wait();
  const std::size_t last = kAvatarLooks.size() - 1;
  auto first = ask(shelf, name_of(0));
  auto again = ask(shelf, name_of(0));
  auto asked = ask(shelf, name_of(last));  // returns although nothing can be made now
  EXPECT_FALSE(shelf.get("nobody", [](const AvatarShelf::Bytes&) { FAIL() << "there is no such look"; }));
  go.set_value();
  EXPECT_EQ(*first.get(), "file of " + name_of(0));
  EXPECT_EQ(*again.get(), "file of " + name_of(0));
  EXPECT_EQ(*asked.get(), "file of " + name_of(last));
  for (std::size_t i = 0; i < kAvatarLooks.size(); ++i) {
    EXPECT_EQ(*ask(shelf, name_of(i)).get(), "file of " + name_of(i));
  }
  EXPECT_EQ(*ask(shelf, name_of(1)).get(), "file of " + name_of(1)) << "what was made stays";
  ASSERT_EQ(made.size(), kAvatarLooks.size()) << "each once";
  EXPECT_EQ(made[1], name_of(last));
}

TEST(AvatarShelf, LightOnesAreMadeWhenSomebodyAsks) {
  std::mutex mutex;
  std::vector<double> made;
  AvatarShelf shelf([&](const AvatarLook& look) {
    const std::lock_guard lock(mutex);
    made.push_back(look.coarse);
    return std::string(look.name);
  });
  for (std::size_t look = 0; look < kAvatarLooks.size(); ++look) {
    EXPECT_EQ(*ask(shelf, name_of(look)).get(), name_of(look));
  }
  EXPECT_EQ(*ask(shelf, "robot-light").get(), "robot");  // after all the others are made
  EXPECT_FALSE(shelf.get("wizard-light", [](const AvatarShelf::Bytes&) {}));
  EXPECT_FALSE(shelf.get("-light", [](const AvatarShelf::Bytes&) {}));
  const std::lock_guard lock(mutex);
  EXPECT_EQ(made.size(), kAvatarLooks.size() + 1);
  EXPECT_EQ(made.back(), light(kAvatarLooks[0]).coarse);
}

TEST(AvatarShelf, WhatCannotBeMadeIsNull) {
  AvatarShelf shelf([](const AvatarLook& look) -> std::string {
    if (look.name == kAvatarLooks[1].name) {
      throw std::runtime_error("no needle");
    }
    return "file";
  });
  EXPECT_EQ(ask(shelf, name_of(1)).get(), nullptr);
  EXPECT_NE(ask(shelf, name_of(2)).get(), nullptr);
}

TEST(AvatarShelf, EndsWithoutMakingTheRestAndTellsWhoWaits) {
  std::promise<void> begun;
  std::promise<void> go;
  int calls = 0;
  std::future<AvatarShelf::Bytes> in_hand;
  std::future<AvatarShelf::Bytes> waiting;
  {
    AvatarShelf shelf([&, gate = go.get_future().share()](const AvatarLook&) {
      if (++calls == 1) {
        begun.set_value();
        gate.wait();
      }
      return std::string("file");
    });
    begun.get_future().wait();
    in_hand = ask(shelf, name_of(0));
    waiting = ask(shelf, name_of(3));
    shelf.stop();
    go.set_value();
  }
  EXPECT_EQ(*in_hand.get(), "file") << "it was begun";
  EXPECT_EQ(waiting.get(), nullptr);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace telemime
