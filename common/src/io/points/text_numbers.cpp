// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>
namespace fresco::io {
namespace {
constexpr std::string_view blanks(" \t\v\f\0", 5);

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0'; }
bool isLineEnd(char c) { return c == '\n' || c == '\r'; }

[[noreturn]] void failNumber(std::string_view word)
{
  throw std::runtime_error(
      concat("'", word.substr(0, 40), "' is not a number", word.empty() ? " (data ends early)" : ""));
}

/// 0 or infinity for what no double holds, by the power of ten of its first digit.
double beyondRange(std::string_view word)
{
  const std::size_t exponent = std::min(word.find_first_of("eE"), word.size());
  const std::string_view digits = word.substr(0, exponent);
  const auto point = std::int64_t(std::min(digits.find('.'), digits.size())),
             first = std::int64_t(std::min(digits.find_first_of("123456789"), digits.size()));
  int power = 0;
  if (exponent + 1 < word.size()) {
    const std::size_t begin = exponent + (word[exponent + 1] == '+' ? 2 : 1);
    if (std::from_chars(word.data() + begin, word.data() + word.size(), power).ec == std::errc::result_out_of_range)
      power = word[exponent + 1] == '-' ? std::numeric_limits<int>::min() : std::numeric_limits<int>::max();
  }
  const double size = std::int64_t(power) + point - first > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  return word[0] == '-' ? -size : size;
}

/// What is not finite as the C library of Windows writes it: 1.#QNAN, -1.#IND, 1.#INF.
std::optional<double> windowsNumber(std::string_view word)
{
  const bool negative = word[0] == '-';
  const std::string_view plain = word.substr(negative || word[0] == '+' ? 1 : 0);
  if (plain.substr(0, 3) != "1.#")
    return {};
  const std::string_view kind = plain.substr(3, 3);
  if (kind == "INF")
    return (negative ? -1 : 1) * std::numeric_limits<double>::infinity();
  return kind == "QNA" || kind == "SNA" || kind == "IND" ? std::optional(std::numeric_limits<double>::quiet_NaN())
                                                         : std::nullopt;
}

/// A whole number that stands there with decimals, such as 128.0.
template <typename T>
std::optional<T> wholeNumber(std::string_view word)
{
  double value = 0;
  const auto [last, error] = std::from_chars(word.data(), word.data() + word.size(), value, std::chars_format::fixed);
  const bool fits = error == std::errc() && last == word.data() + word.size() && value == std::floor(value) &&
                    value >= double(std::numeric_limits<T>::min()) &&
                    value < std::ldexp(1.0, std::numeric_limits<T>::digits);
  return fits ? std::optional<T>(static_cast<T>(value)) : std::nullopt;
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
  while (atLineEnd() || *at_ == '#') {
    expect(!done(), "data ends early");
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
  const std::string_view rest = restOfLineInPlace();
  nextLine();
  return rest;
}

std::string_view TextScanner::restOfLineInPlace()
{
  const char* const begin = at_;
  while (at_ != end_ && !isLineEnd(*at_))
    ++at_;
  return trimmed({begin, static_cast<std::size_t>(at_ - begin)}, blanks);
}

template <typename T>
T parseNumber(std::string_view word)
{
  const bool plus = !word.empty() && word[0] == '+' && word.substr(0, 2) != "+-";
  const std::string_view digits = word.substr(plus ? 1 : 0);
  const char* const end = digits.data() + digits.size();
  T value{};
  const auto [last, error] = std::from_chars(digits.data(), end, value);
  if (error == std::errc() && last == end)
    return value;
  if (digits.empty())
    failNumber(word);
  if constexpr (std::is_floating_point_v<T>) {
    if (error == std::errc::result_out_of_range && last == end)
      return static_cast<T>(beyondRange(digits));
    if (const auto special = windowsNumber(word))
      return static_cast<T>(*special);
    if (const std::size_t comma = digits.find(','); comma < digits.size() - 1 && digits.find('.') == digits.npos) {
      std::string pointed(digits); // as programs write it in locales with decimal commas
      pointed[comma] = '.';
      if (const auto [at, failed] = std::from_chars(pointed.data(), pointed.data() + pointed.size(), value);
          failed == std::errc() && at == pointed.data() + pointed.size())
        return value;
    }
  } else {
    if (const auto whole = wholeNumber<T>(digits))
      return *whole;
    expect(error != std::errc::result_out_of_range || last != end, "'", word.substr(0, 40), "' is out of range");
  }
  failNumber(word);
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

std::string plainName(const std::string& column)
{
  constexpr std::string_view normal = "normal_";
  const bool is_normal = column == "normal_x" || column == "normal_y" || column == "normal_z";
  return is_normal ? "n" + column.substr(normal.size()) : singleWord(column);
}
} // namespace fresco::io
