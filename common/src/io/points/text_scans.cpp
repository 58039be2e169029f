// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/text_scans.h"
#include "io/points/file_window.h"
#include "io/points/text_numbers.h"
#include <algorithm>
#include <cmath>
#include <fresco/core/poses.h>
#include <fresco/core/require.h>
#include <limits>
#include <stdexcept>
namespace fresco::io {
namespace {
/// Points of one station.
struct Block {
  std::uint64_t offset = 0, line = 1; ///< of its first point
  std::size_t words = 0;              ///< of each line
  Index rows = 0;                     ///< of an organised station; 0: a list
};

constexpr std::size_t most_words = 7;

/// Words of a line, at most `most`. @return how many there are, most + 1 if more
std::size_t splitWords(std::string_view line, std::string_view* words, std::size_t most)
{
  std::size_t count = 0;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t", at);
    if (begin == std::string_view::npos)
      break;
    at = std::min(line.find_first_of(" \t", begin), line.size());
    if (count == most)
      return most + 1;
    words[count++] = line.substr(begin, at - begin);
  }
  return count;
}

bool isSingleWord(std::string_view line) { return line.find_first_of(" \t") == std::string_view::npos; }

/// Exactly `count` finite numbers.
std::vector<double> numbersOf(std::string_view line, std::size_t count)
{
  std::string_view words[most_words];
  if (splitWords(line, words, most_words) != count)
    throw std::runtime_error(concat("wants ", count, " numbers"));
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) {
    numbers.push_back(parseNumber<double>(words[i]));
    if (!std::isfinite(numbers.back()))
      throw std::runtime_error("a number is not finite");
  }
  return numbers;
}

/// The next line with anything in it. @throws std::runtime_error at the end of the file
std::string_view contentLine(LineReader& lines)
{
  std::string_view line;
  do
    if (!lines.next(line))
      throw std::runtime_error("the file ends within the header of a station");
  while (line.empty());
  return line;
}

/// A line of a point has at least this many bytes: "0 0 0" and its end.
constexpr std::uint64_t least_line = 6;

Index checkedCount(std::uint64_t count, const LineReader& lines)
{
  if (count > (lines.remaining() + 1) / least_line)
    throw std::runtime_error(
        concat(count, " points announced, but only ", lines.remaining(), " bytes are left in the file"));
  return count;
}

/// Goes over the lines of points up to a header or the end of the file. @return how many
Index skipPoints(LineReader& lines, Block& block)
{
  Index count = 0;
  std::string_view line, words[most_words];
  block.offset = lines.offset();
  block.line = lines.line() + 1;
  while (lines.next(line)) {
    if (line.empty())
      continue;
    if (isSingleWord(line)) {
      lines.unread();
      break;
    }
    if (count == 0)
      block.words = splitWords(line, words, most_words);
    ++count;
  }
  return count;
}

/// The transform in the last four lines of a PTX header, written transposed: the translation is the last row.
Eigen::Isometry3d poseOf(LineReader& lines)
{
  Eigen::Matrix4d M;
  for (int row = 0; row < 4; ++row) {
    const std::vector<double> numbers = numbersOf(contentLine(lines), 4);
    M.row(row) = Eigen::RowVector4d::Map(numbers.data());
  }
  const Eigen::Matrix3d R = M.topLeftCorner<3, 3>().transpose();
  constexpr double rounded = 1e-3; // numbers are written with 6 digits
  if (!isRotation(R, rounded))
    throw std::runtime_error("its matrix is no rotation");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R.isIdentity(0) ? R : Eigen::Quaterniond(R).normalized().toRotationMatrix();
  T.translation() = M.row(3).head<3>();
  return T;
}

std::uint8_t colorByte(std::string_view word)
{
  const auto value = parseNumber<double>(word);
  return value > 0 ? std::min(std::round(value), 255.0) : 0.0;
}

template <typename T>
std::uint8_t* store(std::uint8_t* at, T value)
{
  std::memcpy(at, &value, sizeof(T));
  return at + sizeof(T);
}

/// What PTX and PTS have in common: blocks of lines, found by a first pass over the file.
class TextReader : public ScanReader {
public:
  TextReader(const std::string& path, const char* block_name) : file_(path), block_name_(block_name) {}

  PointTable open(Index scan) override
  {
    block_ = blocks_[scan];
    lines_ = std::make_unique<LineReader>(file_, block_.offset, block_.line);
    point_ = 0;
    PointTable layout;
    for (const char* name : xyz_names)
      layout.addColumn(name, Scalar::float64);
    if (hasIntensity())
      layout.addColumn("intensity", Scalar::float32);
    if (hasColors())
      for (const char* name : color_names)
        layout.addColumn(name, Scalar::uint8);
    if (block_.rows > 0)
      for (const char* name : {row_column, column_column})
        layout.addColumn(name, Scalar::int32);
    return layout;
  }

  Index read(PointTable& table, Index begin, Index end) override
  {
    std::string_view line;
    Index at = begin;
    while (at < end && lines_->next(line)) {
      if (line.empty())
        continue;
      if (isSingleWord(line)) { // the next station
        lines_->unread();
        break;
      }
      storeLine(line, table.cell(at++, table.columns[0]));
    }
    return at - begin;
  }

protected:
  /// @param announced points, nothing where the file does not say
  void addBlock(LineReader& lines, Block block, ScanInfo info, std::optional<Index> announced)
  {
    const Index count = skipPoints(lines, block);
    const auto fail = [&](const auto&... reason) {
      throw std::runtime_error(concat(block_name_, ' ', blocks_.size() + 1, ": ", reason...));
    };
    if (announced && *announced != count)
      fail(*announced, " points announced, ", count, " there (line ", block.line + count, ")");
    if (count > 0 && block.words != 3 && block.words != 4 && block.words != 6 && block.words != 7)
      fail("line ", block.line, ": a point has 3, 4, 6 or 7 numbers, not ", block.words);
    info.points = count;
    blocks_.push_back(block);
    scans_.push_back(std::move(info));
  }

  RandomAccessFile file_;

private:
  bool hasIntensity() const { return block_.words == 4 || block_.words == 7; }
  bool hasColors() const { return block_.words >= 6; }

  void storeLine(std::string_view line, std::uint8_t* row)
  try {
    std::string_view words[most_words];
    if (splitWords(line, words, most_words) != block_.words)
      throw std::runtime_error(concat("wants ", block_.words, " numbers"));
    Eigen::Vector3d p(parseNumber<double>(words[0]), parseNumber<double>(words[1]), parseNumber<double>(words[2]));
    if (block_.rows > 0 && p.isZero(0)) // a beam that nothing returned
      p.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (const double value : p)
      row = store(row, value);
    if (hasIntensity())
      row = store(row, parseNumber<float>(words[3]));
    for (std::size_t channel = 0; hasColors() && channel < 3; ++channel)
      row = store(row, colorByte(words[block_.words - 3 + channel]));
    if (block_.rows > 0) {
      row = store<std::int32_t>(row, point_ % block_.rows);
      store<std::int32_t>(row, point_ / block_.rows);
    }
    ++point_;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(concat("line ", lines_->line(), ": ", error.what()));
  }

  const char* block_name_;
  std::vector<Block> blocks_;
  Block block_;
  std::unique_ptr<LineReader> lines_;
  Index point_ = 0; ///< next one of the block
};

class PtxReader : public TextReader {
public:
  explicit PtxReader(const std::string& path) : TextReader(path, "station")
  {
    LineReader lines(file_);
    std::string_view line;
    while (lines.next(line))
      if (!line.empty()) {
        lines.unread();
        addStation(lines);
      }
    if (scans_.empty())
      throw std::runtime_error("no station");
  }

private:
  void addStation(LineReader& lines)
  {
    Block block;
    ScanInfo info;
    std::uint64_t columns = 0, rows = 0;
    Eigen::Vector3d position;
    try {
      columns = parseNumber<std::uint32_t>(contentLine(lines));
      rows = parseNumber<std::uint32_t>(contentLine(lines));
      position = Eigen::Vector3d::Map(numbersOf(contentLine(lines), 3).data());
      for (int axis = 0; axis < 3; ++axis)
        numbersOf(contentLine(lines), 3); // the matrix says it again
      info.T_file_scan = poseOf(lines);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(
          concat("station ", scans_.size() + 1, ": header, line ", lines.line(), ": ", error.what()));
    }
    info.has_pose = true;
    info.sensor = info.T_file_scan.inverse() * position;
    info.intensity_limits = Eigen::Array2d(0, 1);
    block.rows = rows;
    addBlock(lines, block, std::move(info), checkedCount(columns * rows, lines));
  }
};

class PtsReader : public TextReader {
public:
  explicit PtsReader(const std::string& path) : TextReader(path, "block")
  {
    LineReader lines(file_);
    std::string_view line;
    while (lines.next(line)) {
      if (line.empty())
        continue;
      std::optional<Index> announced;
      if (isSingleWord(line))
        announced = countIn(line, lines);
      else if (scans_.empty())
        lines.unread();
      ScanInfo info;
      info.intensity_limits = Eigen::Array2d(-2048, 2047); // as Cyclone writes them
      addBlock(lines, {}, info, announced);
    }
    if (scans_.empty())
      throw std::runtime_error("no points");
  }

private:
  static Index countIn(std::string_view line, const LineReader& lines)
  try {
    return checkedCount(parseNumber<std::uint64_t>(line), lines);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(concat("line ", lines.line(), ": ", error.what()));
  }
};
} // namespace

std::unique_ptr<ScanReader> openPtx(const std::string& path) { return std::make_unique<PtxReader>(path); }
std::unique_ptr<ScanReader> openPts(const std::string& path) { return std::make_unique<PtsReader>(path); }
} // namespace fresco::io
