// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/json_field.h"
#include "telemime/core/testing_errors.h"

#include <gtest/gtest.h>

#include <functional>

namespace telemime {
namespace {

const JsonSource kSource{.name = "a.json", .kind = ErrorKind::config, .remedy = "Mend it.", .deepest = 3};

std::string refusal(const std::string& text, const std::function<void(const JsonField&)>& read) {
  return error_of(kSource.kind, [&] {
    const nlohmann::json json = parse_json(text, kSource);
    read(JsonField(json, kSource));
  });
}

TEST(JsonField, ReadsValuesThatFit) {
  const nlohmann::json json = parse_json(
      R"({"a": {"list": [1, 2.5, -3]}, "text": "t", "on": true, "three": 3.0, "big": 9223372036854775807})",
      kSource);
  const JsonField root(json, kSource);
  EXPECT_EQ(root["a"]["list"].numbers<3>(), (std::array<double, 3>{1.0, 2.5, -3.0}));
  EXPECT_EQ(root["a"]["list"].size(), 3U);
  EXPECT_EQ(root["a"]["list"][1].number(), 2.5);
  EXPECT_EQ(root["a"]["list"][1].number(2.5, 2.5), 2.5);
  EXPECT_EQ(root["a"]["list"][0].positive(), 1.0);
  EXPECT_EQ(root["text"].text(1), "t");
  EXPECT_NO_THROW(root["text"].equals("t"));
  EXPECT_TRUE(root["on"].boolean());
  EXPECT_EQ(root["three"].integer(0, 3), 3);
  EXPECT_EQ(root["big"].integer(0, INT64_MAX), INT64_MAX);
  EXPECT_TRUE(root.has("a"));
  EXPECT_FALSE(root.has("b"));
  EXPECT_FALSE(root["on"].has("a"));
}

TEST(JsonField, MayCountInvalidValuesAsMissing) {
  const auto a = [](const JsonField& root) {
    return root.optional("a", [](const JsonField& f) { return f.number(); });
  };
  EXPECT_EQ(read_if_valid(R"({"a": 2})", kSource, a).value(), 2.0);
  EXPECT_FALSE(read_if_valid(R"({"a": "2"})", kSource, a).value());
  EXPECT_FALSE(read_if_valid("{}", kSource, a).value());
  for (const char* const bad : {"", "{", "[[[[[]]]]]"}) {
    EXPECT_FALSE(read_if_valid(bad, kSource, a)) << bad;
  }
}

TEST(JsonField, NamesThePlaceOfWhatIsWrong) {
  const std::string text =
      R"({"a": {"b": [1, "x"]}, "text": "long", "zero": 0, "half": 0.5, "huge": 18446744073709551615})";
  const auto expect = [&](const std::string& message, const std::function<void(const JsonField&)>& read) {
    EXPECT_EQ(refusal(text, read), message + "\n  Mend it.");
  };
  expect("a.json: 'c' is missing", [](const JsonField& f) { f["c"]; });
  expect("a.json: 'text' must be a JSON object", [](const JsonField& f) { f["text"]["c"]; });
  expect("a.json: 'a': 'b' [1] must be a finite number", [](const JsonField& f) { f["a"]["b"][1].number(); });
  expect("a.json: 'a': 'b' is too short", [](const JsonField& f) { f["a"]["b"][2]; });
  expect("a.json: 'a': 'b' must have finite numbers", [](const JsonField& f) { f["a"]["b"].numbers<2>(); });
  expect("a.json: 'a': 'b' must be a list of 3 numbers",
         [](const JsonField& f) { f["a"]["b"].numbers<3>(); });
  expect("a.json: 'text' must be a list", [](const JsonField& f) { f["text"].size(); });
  expect("a.json: 'zero' must be greater than 0", [](const JsonField& f) { f["zero"].positive(); });
  expect("a.json: 'zero' must be a number in [0.5,1.0]",
         [](const JsonField& f) { f["zero"].number(0.5, 1.0); });
  expect("a.json: 'zero' must be true or false", [](const JsonField& f) { f["zero"].boolean(); });
  expect("a.json: 'zero' must be a text", [](const JsonField& f) { f["zero"].text(); });
  expect("a.json: 'text' must be a text of at most 3 bytes", [](const JsonField& f) { f["text"].text(3); });
  expect("a.json: 'text' must be \"t\"", [](const JsonField& f) { f["text"].equals("t"); });
  for (const char* key : {"half", "huge", "text"}) {
    expect(std::string("a.json: '") + key + "' must be a whole number in [0,9]",
           [key](const JsonField& f) { f[key].integer(0, 9); });
  }
}

TEST(JsonField, RefusesWhatIsNotJsonOrTooDeep) {
  const auto nothing = [](const JsonField&) {};
  EXPECT_EQ(refusal("{", nothing), "a.json is not JSON\n  Mend it.");
  EXPECT_EQ(parse_if_json("{", kSource), std::nullopt);
  EXPECT_EQ(refusal("[[[]]]", nothing), "");
  EXPECT_EQ(refusal(std::string(100000, '['), nothing),
            "a.json is nested more than 3 levels deep\n  Mend it.");
}

}  // namespace
}  // namespace telemime
