// SPDX-License-Identifier: BSD-3-Clause
#include "io/texture/image_codecs.h"
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <vector>
namespace fresco::io {
namespace {
constexpr std::size_t room = 64 << 20; // bytes; registration takes about ten million
}

void prepareImageCodecs()
{
  static std::once_flag once;
  std::call_once(once, [] { // an exception leaves it to the next call
    std::vector<char>().reserve(room);
    std::vector<unsigned char> bytes;
    cv::imencode(".png", cv::Mat::zeros(1, 1, CV_8U), bytes);
  });
}
} // namespace fresco::io
