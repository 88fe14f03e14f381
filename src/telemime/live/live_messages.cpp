// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_messages.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/outputs/all.h"

namespace telemime {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kWidest = 480;  // px
constexpr int kQuality = 75;

// Replaces invalid UTF-8, which file names and system messages may contain.
std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

double tenths(double value) {
  return std::round(10.0 * value) / 10.0;
}

std::string_view to_string(LivePhase phase) {
  constexpr std::array<std::string_view, 8> kNames = {"opening",  "empty_room", "background", "person",
                                                      "tracking", "lost",       "stopped",    "ended"};
  return kNames[static_cast<std::size_t>(phase)];
}

std::string_view to_string(SenderState state) {
  constexpr std::array<std::string_view, 4> kNames = {"connecting", "sending", "failed", "off"};
  return kNames[static_cast<std::size_t>(state)];
}

Json recorded(const Recording& r) {
  Json files = Json::array();
  for (const RecordedFile& file : r.files) {
    files.push_back({{"name", file.name}, {"bytes", file.bytes}});
  }
  return {{"number", r.number}, {"seconds", tenths(r.seconds)}, {"frames", r.frames}, {"files", files}};
}

}  // namespace

std::string hello_message(const std::string& version, const std::string& input, bool live,
                          const Camera& camera, const std::vector<std::string>& looks, SenderKinds kinds) {
  Json formats = Json::array();
  for (const OutputFormat& format : kOutputFormats) {
    formats.push_back(format.name);
  }
  Json senders = Json::array();
  for (const SenderKind& kind : kinds) {
    senders.push_back({{"scheme", kind.scheme}, {"example", kind.example}, {"summary", kind.summary}});
  }
  return dump({{"type", "hello"},
               {"protocol", 1},
               {"version", version},
               {"input", input},
               {"live", live},
               {"camera",
                {{"width", camera.width},
                 {"height", camera.height},
                 {"fx", camera.fx},
                 {"fy", camera.fy},
                 {"cx", camera.cx},
                 {"cy", camera.cy}}},
               {"looks", looks},
               {"formats", formats},
               {"senders", senders}});
}

std::string status_message(const LiveStatus& status) {
  const LiveRates& rates = status.state.rates;
  Json outputs = Json::array();
  for (const SenderStatus& s : status.outputs) {
    outputs.push_back({{"url", s.url},
                       {"state", to_string(s.state)},
                       {"words", s.words},
                       {"sent", s.sent},
                       {"dropped", s.dropped},
                       {"receivers", s.receivers}});
  }
  Json recordings = Json::array();
  for (const Recording& r : status.recordings) {
    recordings.push_back(recorded(r));
  }
  Json message = {{"type", "status"},
                  {"phase", to_string(status.state.phase)},
                  {"words", status.state.words},
                  {"room_empty", status.state.room_empty},
                  {"fps", {{"input", tenths(rates.input)}, {"tracked", tenths(rates.tracked)}}},
                  {"dropped", rates.dropped},
                  {"ms",
                   {{"wait", tenths(rates.ms.wait)},
                    {"networks", tenths(rates.ms.networks)},
                    {"features", tenths(rates.ms.features)},
                    {"queue", tenths(rates.ms.queue)},
                    {"search", tenths(rates.ms.search)},
                    {"total", tenths(rates.ms.total)}}},
                  {"latency", nullptr},
                  {"cpu", std::round(100.0 * status.cpu) / 100.0},
                  {"outputs", outputs},
                  {"recording", nullptr},
                  {"recordings", recordings}};
  if (status.latency) {
    message["latency"] = {{"median", tenths(status.latency->median)}, {"p95", tenths(status.latency->p95)}};
  }
  if (status.recording) {
    message["recording"] = {{"seconds", tenths(status.recording->seconds)},
                            {"frames", status.recording->frames}};
  }
  return dump(message);
}

std::string words_message(MessageLevel level, const std::string& words) {
  const char* const name = level == MessageLevel::info      ? "info"
                           : level == MessageLevel::warning ? "warning"
                                                            : "error";
  return dump({{"type", "message"}, {"level", name}, {"words", words}});
}

std::string pong_message(std::int64_t id, double stamp) {
  return dump({{"type", "pong"}, {"id", id}, {"stamp", stamp}});
}

std::string picture_message(const cv::Mat& image, std::int64_t frame, double stamp) {
  static_assert(std::endian::native == std::endian::little, "the header is copied as it lies in memory");
  cv::Mat small = image;
  if (image.cols > kWidest) {
    const int height = std::max(1, image.rows * kWidest / image.cols);
    cv::resize(image, small, {kWidest, height}, 0.0, 0.0, cv::INTER_AREA);
  }
  std::vector<unsigned char> jpeg;
  cv::imencode(".jpg", small, jpeg, {cv::IMWRITE_JPEG_QUALITY, kQuality});
  std::string message(16, '\0');
  const auto number = static_cast<std::uint32_t>(frame);
  message[0] = 1;
  std::memcpy(message.data() + 4, &number, sizeof number);
  std::memcpy(message.data() + 8, &stamp, sizeof stamp);
  message.append(reinterpret_cast<const char*>(jpeg.data()), jpeg.size());
  return message;
}

}  // namespace telemime
