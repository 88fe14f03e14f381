// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/jpeg.h"

#include <csetjmp>
#include <cstddef>
#include <cstdio>

extern "C" {
#include <jerror.h>
#include <jpeglib.h>
}

namespace telemime {
namespace {

constexpr std::int64_t kMostPixels = 1 << 26;

struct Complaints {
  jpeg_error_mgr base;  // the first: libjpeg knows only this
  std::jmp_buf way_out;
  bool damaged;
};

Complaints& of(j_common_ptr info) {
  return *reinterpret_cast<Complaints*>(info->err);
}

void give_up(j_common_ptr info) {
  std::longjmp(of(info).way_out, 1);
}

// Bytes too many between two markers are common and harmless.
void listen(j_common_ptr info, int level) {
  constexpr int kWarning = -1;
  if (level == kWarning && info->err->msg_code != JWRN_EXTRANEOUS_DATA) {
    of(info).damaged = true;
  }
}

// Outside of decode(), so that neither longjmp nor an exception of cv::Mat passes its destructor by.
struct Decompressor {
  Decompressor() {
    info.err = jpeg_std_error(&complaints.base);
    complaints.base.error_exit = give_up;
    complaints.base.emit_message = listen;
    jpeg_create_decompress(&info);
  }
  ~Decompressor() { jpeg_destroy_decompress(&info); }
  Decompressor(const Decompressor&) = delete;
  Decompressor& operator=(const Decompressor&) = delete;

  jpeg_decompress_struct info{};
  Complaints complaints{};
};

// No object with a destructor is made in here: longjmp would pass it by.
bool decode(jpeg_decompress_struct& info, Complaints& complaints, std::span<const std::uint8_t> bytes,
            cv::Mat& picture) {
  if (setjmp(complaints.way_out) != 0) {
    return false;
  }
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_read_header(&info, TRUE);
  if (static_cast<std::int64_t>(info.image_width) * info.image_height > kMostPixels) {
    return false;
  }
  info.out_color_space = JCS_EXT_BGR;
  jpeg_start_decompress(&info);
  picture.create(static_cast<int>(info.output_height), static_cast<int>(info.output_width), CV_8UC3);
  while (info.output_scanline < info.output_height && !complaints.damaged) {
    JSAMPROW row = picture.ptr(static_cast<int>(info.output_scanline));
    jpeg_read_scanlines(&info, &row, 1);
  }
  if (complaints.damaged) {
    return false;
  }
  jpeg_finish_decompress(&info);
  return !complaints.damaged;
}

}  // namespace

cv::Mat decode_jpeg(std::span<const std::uint8_t> bytes) {
  cv::Mat picture;
  Decompressor decompressor;
  const bool whole = decode(decompressor.info, decompressor.complaints, bytes, picture);
  return whole ? picture : cv::Mat();
}

}  // namespace telemime
