// SPDX-License-Identifier: Apache-2.0
// Passwords of outputs are sent to the broker, and neither shown nor saved.
#include <gtest/gtest.h>

#include <fstream>

#include "meeting/protocol/testing.h"
#include "meeting/transport/senders.h"
#include "telemime/core/errors.h"
#include "telemime/core/files.h"
#include "telemime/core/scratch_folder.h"
#include "telemime/live/saved_outputs.h"
#include "telemime/live/sender_list.h"

namespace telemime {
namespace {

const std::string kUrl = "mqtt://studio.p01:secret@127.0.0.1:9/home/studio";
const std::string kShown = "mqtt://studio.p01@127.0.0.1:9/home/studio";

TEST(OutputPasswords, AreUsedButNotShown) {
  SenderList list(meeting::kAllSenderKinds);
  list.add(kUrl);
  EXPECT_EQ(list.status().at(0).url, kShown);
  EXPECT_EQ(meeting::error_of([&] { list.add(kUrl); }), kShown + " is already in the list");
  ASSERT_TRUE(list.switch_off(kShown)) << "a page names it as it was shown";
  EXPECT_EQ(list.status().at(0).url, kShown);
  EXPECT_EQ(list.status().at(0).state, SenderState::off);
  EXPECT_NO_THROW(list.add(kShown)) << "the password is known from before";
  EXPECT_NE(list.status().at(0).state, SenderState::off);
  EXPECT_TRUE(list.remove(kShown));
  EXPECT_THROW(list.add(kShown), Error) << "and forgotten with the output";
}

TEST(OutputPasswords, SecretsOfLinksArePasswords) {
  const std::string link = "http://127.0.0.1:9/room?name=Ana#k=secret";
  const std::string shown = "http://127.0.0.1:9/room?name=Ana";
  const ScratchFolder folder;
  SenderList list(meeting::kAllSenderKinds);
  SavedOutputs saved(folder.path() / "live.json", list, nullptr);
  list.add(link);
  saved.keep(link);
  saved.save();
  EXPECT_EQ(list.status().at(0).url, shown);
  const std::string text = read_text_file(folder.path() / "live.json");
  EXPECT_NE(text.find(shown), std::string::npos) << text;
  EXPECT_EQ(text.find("secret"), std::string::npos) << text;
  ASSERT_TRUE(list.switch_off(shown));
  EXPECT_NO_THROW(list.add(shown)) << "known from before";
  ASSERT_TRUE(list.remove(shown));
  EXPECT_TRUE(meeting::contains(meeting::error_of([&] { list.add(shown); }), "Secrets are not stored"));
}

TEST(OutputPasswords, AreNotSaved) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "live.json";
  {
    SenderList list(meeting::kAllSenderKinds);
    SavedOutputs saved(file, list, nullptr);
    saved.keep(kUrl);
    saved.save();
  }
  const std::string text = read_text_file(file);
  EXPECT_NE(text.find(kShown), std::string::npos) << text;
  EXPECT_EQ(text.find("secret"), std::string::npos) << text;

  std::string reported;
  SenderList list(meeting::kAllSenderKinds);
  SavedOutputs saved(file, list,
                     [&reported](MessageLevel, const std::string& words) { reported += words + "\n"; });
  saved.offer(/*resume=*/true);
  EXPECT_NE(reported.find("Passwords are not stored"), std::string::npos) << reported;
  ASSERT_EQ(list.status().size(), 1U);
  EXPECT_EQ(list.status()[0].state, SenderState::off);
  EXPECT_NO_THROW(list.add(kUrl));
  EXPECT_EQ(list.status().size(), 1U) << "the same output, now with its password";
}

TEST(OutputPasswords, InAnEditedFileAreNotShown) {
  const ScratchFolder folder;
  const std::filesystem::path file = folder.path() / "live.json";
  std::ofstream(file) << R"({"version":1,"outputs":[")" << kUrl << R"("]})";
  std::string reported;
  SenderList list(meeting::kAllSenderKinds);
  SavedOutputs saved(file, list,
                     [&reported](MessageLevel, const std::string& words) { reported += words + "\n"; });
  saved.offer(/*resume=*/true);
  EXPECT_NE(reported.find("sending again to an output of an earlier run: " + kShown), std::string::npos)
      << reported;
  EXPECT_EQ(reported.find("secret"), std::string::npos) << reported;
}

}  // namespace
}  // namespace telemime
