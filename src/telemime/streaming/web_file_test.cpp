// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "telemime/core/scratch_folder.h"
#include "telemime/streaming/testing_web.h"
#include "telemime/streaming/testing_web_socket.h"

namespace telemime {
namespace {

using Kind = WebRange::Kind;

void expect_range(const std::string& header, std::uint64_t size, Kind kind, std::uint64_t first,
                  std::uint64_t count) {
  const WebRange range = web_range(header, size);
  EXPECT_EQ(range.kind, kind) << header;
  EXPECT_EQ(range.first, first) << header;
  EXPECT_EQ(range.size, count) << header;
}

TEST(WebRange, FollowsRfc9110) {
  expect_range("bytes=0-499", 10000, Kind::part, 0, 500);  // the examples of section 14.1.2
  expect_range("bytes=500-999", 10000, Kind::part, 500, 500);
  expect_range("bytes=-500", 10000, Kind::part, 9500, 500);
  expect_range("bytes=9500-", 10000, Kind::part, 9500, 500);
  expect_range("bytes=0-0", 10000, Kind::part, 0, 1);
  expect_range("BYTES = 5-5 ", 10000, Kind::part, 5, 1);
  expect_range("bytes=9999-20000", 10000, Kind::part, 9999, 1);
  expect_range("bytes=-20000", 10000, Kind::part, 0, 10000);
  expect_range("bytes=0-99999999999999999999999", 10000, Kind::part, 0, 10000);
}

TEST(WebRange, WhatIsNotThereIsNothing) {
  expect_range("bytes=10000-", 10000, Kind::nothing, 0, 0);
  expect_range("bytes=99999999999999999999999-", 10000, Kind::nothing, 0, 0);
  expect_range("bytes=-0", 10000, Kind::nothing, 0, 0);
  expect_range("bytes=0-", 0, Kind::nothing, 0, 0);
  expect_range("bytes=-5", 0, Kind::nothing, 0, 0);
}

TEST(WebRange, WhatIsOddMeansAll) {
  for (const char* odd : {"", "bytes", "bytes=", "bytes=-", "bytes=5", "bytes=7-3", "bytes=a-b", "bytes=1-x",
                          "bytes=x-1", "bytes=+1-2", "bytes=--1", "bytes=0x1-2", "bytes=1- 2", "lines=1-2",
                          "bytes=0-1,5-6", "=1-2", "bytes=1-2-3"}) {
    expect_range(odd, 100, Kind::whole, 0, 100);
  }
}

class Download : public ::testing::Test {
 protected:
  // A server of one file, at any path.
  static WebHandlers of(const std::string& file) {
    WebHandlers handlers;
    handlers.get = [file](const std::string&) {
      WebContent content;
      content.type = "application/octet-stream";
      content.file_name = "motion.bin";
      content.file = file;
      return std::optional(content);
    };
    return handlers;
  }
  std::string write(const std::string& bytes) const {
    std::ofstream(folder_.file("f"), std::ios::binary) << bytes;
    return folder_.file("f");
  }

  ScratchFolder folder_;
};

TEST_F(Download, IsTheFileByteForByte) {
  std::string bytes(1'000'003, ' ');
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = static_cast<char>(i * 2654435761U >> 24);
  }
  const WebServer server(any_port(), of(write(bytes)));
  RawClient client(server.port());
  for (int twice = 0; twice < 2; ++twice) {  // on one connection
    client.send(request_text(server.port(), "/"));
    const WebReply reply = client.reply();
    EXPECT_EQ(reply.status, 200);
    EXPECT_TRUE(reply.body == bytes);
    EXPECT_EQ(reply.header("Content-Disposition"), "attachment; filename=\"motion.bin\"");
    EXPECT_EQ(reply.header("Accept-Ranges"), "bytes");
  }
  const WebReply head = ask(server.port(), "/", "Range: bytes=5-6\r\n", "HEAD");
  EXPECT_EQ(head.status, 200) << "ranges are for GET alone";
  EXPECT_EQ(head.header("Content-Length"), "1000003");
}

TEST_F(Download, OfAnEmptyFileIsEmpty) {
  const WebServer server(any_port(), of(write("")));
  RawClient client(server.port());
  client.send(request_text(server.port(), "/") + request_text(server.port(), "/"));
  EXPECT_EQ(client.reply().header("Content-Length"), "0");
  EXPECT_EQ(client.reply().status, 200);
}

TEST_F(Download, PartsOfItMayBeAskedFor) {
  const WebServer server(any_port(), of(write("0123456789")));
  const std::uint16_t port = server.port();
  const WebReply part = ask(port, "/", "Range: bytes=2-4\r\n");
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(part.body, "234");
  EXPECT_EQ(part.header("Content-Range"), "bytes 2-4/10");
  EXPECT_EQ(ask(port, "/", "Range: bytes=-3\r\n").body, "789");
  const WebReply none = ask(port, "/", "Range: bytes=10-\r\n");
  EXPECT_EQ(none.status, 416);
  EXPECT_EQ(none.header("Content-Range"), "bytes */10");
  EXPECT_EQ(ask(port, "/", "Range: bytes=1-2,4-5\r\n").body, "0123456789");
  EXPECT_EQ(ask(port, "/", "Range: bytes=1-2\r\nRange: bytes=4-5\r\n").body, "0123456789");
  const std::string tag = part.header("ETag");
  EXPECT_EQ(ask(port, "/", "Range: bytes=8-\r\nIf-Range: " + tag + "\r\n").body, "89");
  EXPECT_EQ(ask(port, "/", "Range: bytes=8-\r\nIf-Range: \"another\"\r\n").body, "0123456789")
      << "what was begun with another file is not gone on with";
}

TEST_F(Download, WhatIsNoPlainFileIsNotThere) {
  const std::string pipe = folder_.file("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& odd : {pipe, folder_.path().string(), folder_.file("nothing")}) {
    const WebServer server(any_port(), of(odd));
    EXPECT_EQ(ask(server.port(), "/").status, 404) << odd;
  }
}

TEST_F(Download, AFileThatIsCutShortEndsTheConnection) {
  const std::string file = write("");
  std::filesystem::resize_file(file, 64'000'000);
  const WebServer server(any_port(), of(file));
  RawClient client(server.port(), "127.0.0.1", 4096);
  client.send(request_text(server.port(), "/"));
  ASSERT_TRUE(client.fill(1000));
  std::filesystem::resize_file(file, 1000);
  EXPECT_LT(client.rest().size(), 64'000'000U) << "and it is told apart from a whole one by its length";
}

// 1 GB that stands nowhere: the file has no blocks.
TEST_F(Download, ABigFileIsNeverInMemoryAndOthersAreServedMeanwhile) {
  constexpr std::uint64_t kSize = 1'000'000'000;
  const std::string file = write("");
  std::filesystem::resize_file(file, kSize);
  const WebServer server(any_port(), of(file));
  rusage before{};
  ::getrusage(RUSAGE_SELF, &before);

  RawClient never_reads(server.port(), "127.0.0.1", 4096);
  never_reads.send(request_text(server.port(), "/"));
  RawClient reads(server.port());
  reads.send(request_text(server.port(), "/"));
  ASSERT_TRUE(reads.fill(1));
  SocketClient page(server.port());
  page.send_frame(SocketClient::ping, "still here");
  EXPECT_EQ(page.frame()->payload, "still here") << "while two downloads are under way";

  const std::size_t head = reads.take(0).size();
  std::uint64_t count = head;
  while (count < kSize && reads.fill(1)) {
    count += reads.take(1 << 20).size();
  }
  EXPECT_GE(count, kSize);
  rusage after{};
  ::getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 500'000) << "kB";
}

TEST(WebTopics, WhatNobodyGetsIsNotWanted) {
  WebServer server(any_port(), {});
  EXPECT_FALSE(server.wanted(0));
  EXPECT_FALSE(server.wanted(1));
  {
    SocketClient one(server.port());
    SocketClient two(server.port());
    ASSERT_TRUE(comes_true([&] { return server.clients() == 2; }));
    EXPECT_TRUE(server.wanted(1));
    server.set_topic(1, 1, false);
    server.set_topic(2, 2, false);
    server.set_topic(1, 0, false);
    server.set_topic(77, 3, false);
    ASSERT_TRUE(comes_true([&] { return server.clients() == 2 && server.wanted(1) && server.wanted(2); }))
        << "one of the two gets it";
    server.set_topic(2, 1, false);
    EXPECT_TRUE(comes_true([&] { return !server.wanted(1); }));
    EXPECT_TRUE(server.wanted(0) && server.wanted(2) && server.wanted(3));
    server.set_topic(1, 1, true);
    EXPECT_TRUE(comes_true([&] { return server.wanted(1); }));
  }
  EXPECT_TRUE(comes_true([&] { return !server.wanted(2); })) << "who is gone wants nothing";
}

}  // namespace
}  // namespace telemime
