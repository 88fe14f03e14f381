// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_files.h"

#include <gtest/gtest.h>

#include <string>

namespace telemime {
namespace {

TEST(PageFiles, ThereIsAPage) {
  const std::optional<WebContent> page = page_file("/");
  ASSERT_TRUE(page);
  EXPECT_EQ(page->type, "text/html; charset=utf-8");
  EXPECT_FALSE(page->immutable);
  EXPECT_NE(page->bytes->find("<!doctype html>"), std::string::npos) << *page->bytes;
  EXPECT_NE(page->bytes->find("</html>"), std::string::npos);
  EXPECT_EQ(*page_file("/index.html")->bytes, *page->bytes);
}

TEST(PageFiles, EveryFileIsThereUnderItsPathAlone) {
  for (const PageFile& file : page_table()) {
    ASSERT_TRUE(file.path.starts_with('/'));
    EXPECT_EQ(*page_file(file.path)->bytes, file.bytes) << file.path;
    EXPECT_FALSE(page_file(file.path.substr(1)));
    EXPECT_FALSE(page_file(std::string(file.path) + "/"));
  }
  EXPECT_FALSE(page_file(""));
  EXPECT_FALSE(page_file("/none"));
}

TEST(PageFiles, OnlyTheAvatarsPageReadsOtherServers) {
  for (const PageFile& file : page_table()) {
    EXPECT_EQ(page_file(file.path)->connects.empty(), file.path != "/avatar.html") << file.path;
  }
  if (page_table().size() > 1) {  // built with the pages
    EXPECT_EQ(*page_file("/avatar")->bytes, *page_file("/avatar.html")->bytes);
  }
  const AvatarFolder none({});
  EXPECT_FALSE(room_file("/avatar", none)) << "meetings have no tracker to show";
  EXPECT_FALSE(room_file("/avatar.html", none));
}

TEST(PageFiles, ThePageNamesOnlyFilesThatAreThere) {
  int named = 0;
  for (const char* const name : {"/", "/avatar", "/meeting.html"}) {
    const std::optional<WebContent> file = page_file(name);
    if (!file) {
      continue;  // built without the pages (TELEMIME_WEB): there is one, and it names none
    }
    const std::string& page = *file->bytes;
    for (const std::string attribute : {"src=\"", "href=\""}) {
      for (std::size_t at = page.find(attribute); at != std::string::npos;
           at = page.find(attribute, at + 1)) {
        const std::size_t start = at + attribute.size();
        const std::string path = page.substr(start, page.find('"', start) - start);
        if (path.find(':') == std::string::npos && !path.starts_with('#')) {  // no data: or other site
          EXPECT_TRUE(page_file(path)) << name << " names " << path;
          ++named;
        }
      }
    }
  }
  EXPECT_TRUE(named >= 3 || page_table().size() == 1) << named;
}

TEST(PageFiles, HashedNamesAreKnown) {
  EXPECT_TRUE(has_hash("/assets/live-DZaG1Uvn.js"));
  EXPECT_TRUE(has_hash("/assets/three.module-DThU01PR.js"));
  EXPECT_FALSE(has_hash("/live-DZaG1Uvn.js"));
  EXPECT_FALSE(has_hash("/assets/live.js"));
  EXPECT_FALSE(has_hash("/assets/-DZaG1Uvn.js"));
  EXPECT_FALSE(has_hash("/assets/live-DZaG1Uvn"));
  EXPECT_FALSE(has_hash("/index.html"));
}

}  // namespace
}  // namespace telemime
