// SPDX-License-Identifier: BSD-3-Clause
#include "networks/weights.h"
#include <cstring>
#include <stdexcept>
// Ends of the files in the object that CMakeLists.txt has made of each.
extern "C" const char fresco_candidate_score_begin[], fresco_candidate_score_end[];
extern "C" const char fresco_mixed_pixels_begin[], fresco_mixed_pixels_end[];
extern "C" const char fresco_second_stage_begin[], fresco_second_stage_end[];

namespace fresco::filters {
namespace {
std::string_view between(const char* begin, const char* end) { return {begin, std::size_t(end - begin)}; }

void check(bool ok)
{
  if (!ok)
    throw std::runtime_error("weights of a network: damaged data");
}
} // namespace

Weights::Weights(std::string_view data)
{
  constexpr std::string_view magic = "FRESCO\x1aW";
  std::uint32_t count = 0;
  const std::size_t head = magic.size() + sizeof count;
  check(data.size() >= head && data.substr(0, magic.size()) == magic);
  std::memcpy(&count, data.data() + magic.size(), sizeof count);
  check(count <= (data.size() - head) / sizeof(Matrix)); // never where bytes are in the other order
  matrices_.resize(count);
  std::memcpy(matrices_.data(), data.data() + head, count * sizeof(Matrix));
  values_ = data.data() + head + count * sizeof(Matrix);
  std::size_t size = head + count * sizeof(Matrix);
  for (const Matrix& matrix : matrices_)
    size += sizeof(float) * matrix.rows * matrix.columns;
  check(size == data.size());
}

const float* Weights::values(const std::string& name, Shape shape) const
{
  const char* at = values_;
  for (const Matrix& matrix : matrices_) {
    if (name.compare(0, name.size(), matrix.name, strnlen(matrix.name, sizeof matrix.name)) == 0 &&
        matrix.rows == shape.rows && matrix.columns == shape.columns)
      return reinterpret_cast<const float*>(at);
    at += sizeof(float) * matrix.rows * matrix.columns;
  }
  throw std::runtime_error("weights of a network: no " + name + " of " + std::to_string(shape.rows) + " x " +
                           std::to_string(shape.columns));
}

std::string_view candidateScoreData() { return between(fresco_candidate_score_begin, fresco_candidate_score_end); }
std::string_view mixedPixelData() { return between(fresco_mixed_pixels_begin, fresco_mixed_pixels_end); }
std::string_view secondStageData() { return between(fresco_second_stage_begin, fresco_second_stage_end); }
} // namespace fresco::filters
