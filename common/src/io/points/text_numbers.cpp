// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fresco/core/require.h>
#include <type_traits>
namespace fresco::io {
namespace {
bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0'; }
bool isLineEnd(char c) { return c == '\n' || c == '\r'; }

[[noreturn]] void failNumber(std::string_view word)
{
  throw std::runtime_error(
      concat("'", word.substr(0, 40), "' is not a number", word.empty() ? " (data ends early)" : ""));
}

template <typename T>
T outOfRange(std::string_view word)
{
  if constexpr (std::is_floating_point_v<T>)
    return static_cast<T>(std::strtod(std::string(word).c_str(), nullptr)); // 0 or infinity
  else
    throw std::runtime_error(concat("'", word.substr(0, 40), "' is out of range"));
}
} // namespace

bool TextScanner::atLineEnd()
{
  while (at_ != end_ && isBlank(*at_))
    ++at_;
  return at_ == end_ || isLineEnd(*at_);
}

std::string_view TextScanner::word()
{
  if (atLineEnd())
    return {};
  const char* begin = at_;
  while (at_ != end_ && !isBlank(*at_) && !isLineEnd(*at_))
    ++at_;
  return {begin, static_cast<std::size_t>(at_ - begin)};
}

std::string_view TextScanner::wordAcrossLines()
{
  while (atLineEnd()) {
    if (done())
      throw std::runtime_error("data ends early");
    nextLine();
  }
  return word();
}

void TextScanner::nextLine()
{
  while (at_ != end_ && !isLineEnd(*at_))
    ++at_;
  if (at_ == end_)
    return;
  const bool carriage_return = *at_++ == '\r';
  if (carriage_return && at_ != end_ && *at_ == '\n')
    ++at_;
  ++line_;
}

std::string_view TextScanner::restOfLine()
{
  const char* begin = at_;
  if (!atLineEnd())
    begin = at_;
  while (at_ != end_ && !isLineEnd(*at_))
    ++at_;
  const char* last = at_;
  while (begin != last && isBlank(*begin))
    ++begin;
  while (begin != last && isBlank(last[-1]))
    --last;
  nextLine();
  return {begin, static_cast<std::size_t>(last - begin)};
}

std::string_view TextScanner::bytes(std::size_t count)
{
  if (count > remaining())
    throw std::runtime_error(concat("truncated: ", count, " bytes expected, ", remaining(), " left"));
  const char* begin = at_;
  at_ += count;
  return {begin, count};
}

template <typename T>
T parseNumber(std::string_view word)
{
  const bool plus = !word.empty() && word[0] == '+' && word.substr(0, 2) != "+-";
  const char* begin = word.data() + (plus ? 1 : 0);
  const char* end = word.data() + word.size();
  T value{};
  const auto [last, error] = std::from_chars(begin, end, value);
  if (error == std::errc::result_out_of_range && last == end)
    return outOfRange<T>(word);
  if (error != std::errc() || last != end)
    failNumber(word);
  return value;
}

template std::int8_t parseNumber<std::int8_t>(std::string_view);
template std::uint8_t parseNumber<std::uint8_t>(std::string_view);
template std::int16_t parseNumber<std::int16_t>(std::string_view);
template std::uint16_t parseNumber<std::uint16_t>(std::string_view);
template std::int32_t parseNumber<std::int32_t>(std::string_view);
template std::uint32_t parseNumber<std::uint32_t>(std::string_view);
template std::int64_t parseNumber<std::int64_t>(std::string_view);
template std::uint64_t parseNumber<std::uint64_t>(std::string_view);
template float parseNumber<float>(std::string_view);
template double parseNumber<double>(std::string_view);

std::string singleWord(std::string name)
{
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return c <= ' ' || c == 0x7f; }, '_');
  return name.empty() ? "_" : name;
}

void TextWriter::flush()
{
  file_.write(buffer_, used_);
  used_ = 0;
}
} // namespace fresco::io
