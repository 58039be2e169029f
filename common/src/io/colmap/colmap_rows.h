// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/points/text_numbers.h"
#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <fresco/io/file.h>
#include <string>
namespace fresco::io {
/// What names of the files of a COLMAP model in a folder end with, .txt or .bin; "" if there is none.
FRESCO_EXPORT std::string colmapKind(const std::string& folder);
/// The rows of a file of a COLMAP model. Its text (.txt) and binary kinds (.bin, little-endian) hold the same values in the
/// same order. Nothing is read beyond the end.
class ColmapRows {
public:
  explicit ColmapRows(const std::string& path)
      : path_(path), content_(readFile(path)), binary_(extension(path) == ".bin"), lines_(content_), words_({}),
        rows_(binary_ ? stored<std::uint64_t>() : 0)
  {}

  bool isBinary() const { return binary_; }

  /// Goes on to the next row; of text, to the next line that is no comment and, unless it may be, not empty.
  /// @return false at the end
  bool next(bool may_be_empty = false)
  {
    if (binary_)
      return rows_ > 0 && rows_-- > 0;
    while (!lines_.done()) {
      line_ = lines_.line();
      const std::string_view line = lines_.restOfLine();
      words_ = TextScanner(line);
      if (line.empty() ? may_be_empty : line[0] != '#')
        return true;
    }
    words_ = TextScanner({});
    return false;
  }

  /// @tparam Text,Binary as what it is read from either kind @param wanted what a line of text should hold
  template <typename Text, typename Binary = Text>
  Text number(const char* wanted)
  {
    if (binary_)
      return stored<Binary>();
    const std::string_view word = words_.word();
    return parseNumberOr<Text>(word, path_, ": line ", line_, ": wants ", wanted);
  }
  template <int count>
  Eigen::Matrix<double, count, 1> numbers(const char* wanted)
  {
    Eigen::Matrix<double, count, 1> values;
    for (double& value : values)
      value = number<double>(wanted);
    return values;
  }

  /// A word, or a name that ends its line.
  std::string word() { return std::string(words_.word()); }
  std::string name()
  {
    if (!binary_)
      return std::string(words_.restOfLine());
    const std::size_t begin = at_, end = content_.find('\0', at_);
    at_ = std::min(end, content_.size()) + 1;
    requireLeft(0, 1);
    return content_.substr(begin, end - begin);
  }

  /// Of a list that follows; 0 in text, where the rest of the line is the list.
  std::uint64_t listLength(std::size_t item_bytes)
  {
    const std::uint64_t count = binary_ ? stored<std::uint64_t>() : 0;
    requireLeft(count, item_bytes);
    return count;
  }
  template <typename Read>
  void forEachItem(std::uint64_t count, const Read& read)
  {
    for (std::uint64_t i = 0; binary_ ? i < count : !words_.atLineEnd(); ++i)
      read();
  }
  void skip(std::uint64_t bytes) { at_ += bytes; } ///< that listLength() has found to be there

  template <typename T>
  T stored() ///< of a binary file
  {
    requireLeft(1, sizeof(T));
    T value;
    std::memcpy(&value, content_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  std::string where() const { return binary_ ? path_ : concat(path_, ": line ", line_); }
  [[noreturn]] void fail(const std::string& reason) const { throw std::runtime_error(where() + ": " + reason); }

private:
  void requireLeft(std::uint64_t count, std::size_t item_bytes) const
  {
    if (at_ > content_.size() || count > (content_.size() - at_) / item_bytes)
      fail("the file is truncated");
  }

  const std::string path_, content_;
  const bool binary_;
  std::size_t at_ = 0; ///< in a binary file
  TextScanner lines_, words_;
  std::size_t line_ = 0;
  std::uint64_t rows_; ///< that are left in a binary file
};
} // namespace fresco::io
