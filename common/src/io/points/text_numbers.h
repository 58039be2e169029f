// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/files/expect.h"
#include <charconv>
#include <fresco/core/export.h>
#include <fresco/io/file.h>
#include <string>
#include <string_view>
#include <type_traits>
namespace fresco::io {
/// Without the characters of `what` at both ends.
inline std::string_view trimmed(std::string_view text, std::string_view what = " \t\r\n")
{
  const std::size_t begin = text.find_first_not_of(what);
  return begin == text.npos ? std::string_view() : text.substr(begin, text.find_last_not_of(what) - begin + 1);
}

/// Words and numbers of a text, read without copies. Lines end with LF, CR LF or CR.
class FRESCO_EXPORT TextScanner {
public:
  explicit TextScanner(std::string_view text) : at_(text.data()), end_(text.data() + text.size()) {}

  bool done() const { return at_ == end_; }
  std::size_t line() const { return line_; } ///< from 1
  std::string_view rest() const { return {at_, remaining()}; }
  std::size_t remaining() const { return static_cast<std::size_t>(end_ - at_); }

  /// Skips blanks; true at the end of the line or text.
  bool atLineEnd();
  /// Next word of the line, empty at its end.
  std::string_view word();
  /// Next word, on whatever line; '#' at the begin of a word begins a comment. @throws std::runtime_error at the end of the text
  std::string_view wordAcrossLines();
  /// Rest of the line without blanks at its ends; goes on to the next line.
  std::string_view restOfLine();
  std::string_view restOfLineInPlace(); ///< the same, but stays before the end of the line
  void nextLine();
  /// The next `count` bytes as they are. @throws std::runtime_error if there are fewer
  std::string_view bytes(std::size_t count)
  {
    expect(count <= remaining(), "truncated: ", count, " bytes expected, ", remaining(), " left");
    at_ += count;
    return {at_ - count, count};
  }

private:
  const char* at_;
  const char* end_;
  std::size_t line_ = 1;
};

/// Whole word as a number, in any locale; "nan", "inf", what Windows writes for them ("1.#QNAN"), decimal commas and a leading + are
/// accepted, too large values become infinite; whole numbers may have decimals: "128.0".
/// @throws std::runtime_error naming the word
template <typename T>
FRESCO_EXPORT T parseNumber(std::string_view word);

/// The same with a message of the caller's. @throws std::runtime_error with all `parts` joined
template <typename T, typename... Parts>
T parseNumberOr(std::string_view word, const Parts&... parts)
try {
  return parseNumber<T>(word);
} catch (const std::runtime_error&) {
  throw std::runtime_error(concat(parts...));
}

/// The shortest text that is read back as the same value, in any locale.
template <typename T>
std::string numberText(T value)
{
  char text[64];
  return {text, std::to_chars(text, text + sizeof(text), value).ptr};
}

/// Words and numbers one after the other, numbers by numberText(): what files are made of, where messages have concat().
template <typename... Parts>
std::string textOf(const Parts&... parts)
{
  std::string text;
  const auto add = [&](const auto& part) {
    using Part = std::decay_t<decltype(part)>;
    if constexpr (std::is_arithmetic_v<Part> && !std::is_same_v<Part, char>)
      text += numberText(part);
    else
      text += part;
  };
  (add(parts), ...);
  return text;
}

/// `name` as one word: blanks and control characters become '_'.
std::string singleWord(std::string name);

/// The same of a column as other programs call it: nx ny nz are the normals.
std::string plainName(const std::string& column);

} // namespace fresco::io
