// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/file_window.h"
#include "io/points/point_formats.h"
#include "io/points/text_numbers.h"
#include "io/points/text_table.h"
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fresco/core/poses.h>
#include <limits>
namespace fresco::io {
namespace {
/// Points of one station.
struct Block {
  std::uint64_t begin = 0, end = 0; ///< bytes in the file, without its header
  std::uint64_t line = 1;           ///< of its first point
  std::size_t words = 0;            ///< of each line: x y z [intensity] [r g b [nx ny nz]]
  Index rows = 0;                   ///< of an organised station; 0: a list
  double scale = 1;                 ///< of its matrix
  double full_color = 255;          ///< see fullColor()

  bool hasIntensity() const { return words == 4 || words == 7 || words == 10; }
  bool hasColors() const { return words >= 6; }
  bool hasNormals() const { return words >= 9; }
  std::size_t firstColor() const { return hasIntensity() ? 4 : 3; }
};

using Words = std::vector<std::string_view>;

bool isSingleWord(std::string_view line) { return line.find_first_of(" \t,;") == std::string_view::npos; }

/// Exactly `count` finite numbers.
std::vector<double> numbersOf(std::string_view line, std::size_t count)
{
  Words words;
  TableDialect().split(line, words);
  expect(words.size() == count, "wants ", count, " numbers");
  std::vector<double> numbers;
  for (const std::string_view word : words) {
    numbers.push_back(parseNumber<double>(word));
    expect(std::isfinite(numbers.back()), "a number is not finite");
  }
  return numbers;
}

/// The next line with anything in it. @throws std::runtime_error at the end of the file
std::string_view contentLine(LineReader& lines)
{
  std::string_view line;
  do
    expect(lines.next(line), "the file ends within the header of a station");
  while (line.empty());
  return line;
}

/// A line of a point has at least this many bytes: "0 0 0" and its end.
constexpr std::uint64_t least_line = 6;

Index checkedCount(std::uint64_t count, const LineReader& lines)
{
  expect(count <= (lines.remaining() + 1) / least_line, count, " points announced, but only ", lines.remaining(),
         " bytes are left in the file");
  return count;
}

Index countIn(std::string_view line, const LineReader& lines)
try {
  return checkedCount(parseNumber<std::uint64_t>(line), lines);
} catch (const std::runtime_error& error) {
  throw std::runtime_error(concat("line ", lines.line(), ": ", error.what()));
}

void checkWords(std::size_t words, const Block& block)
{
  expect(words == block.words, "wants ", block.words, " numbers");
  expect(words == 3 || words == 4 || words == 6 || words == 7 || words == 9 || words == 10,
         "a point has 3, 4, 6, 7, 9 or 10 numbers, not ", words);
}

/// use(line) for the lines of points up to a header or the end of the file, while it says so; errors name the line.
template <typename Use>
void forEachPoint(LineReader& lines, const Use& use)
{
  std::string_view line;
  while (lines.next(line)) {
    if (line.empty() || isComment(line))
      continue;
    if (isSingleWord(line)) {
      lines.unread();
      return;
    }
    try {
      if (!use(line))
        return;
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(concat("line ", lines.line(), ": ", error.what()));
    }
  }
}

/// Goes over the points of a block and fills in what it tells of their lines. @return how many
Index measurePoints(LineReader& lines, Block& block)
{
  Index count = 0;
  double largest = 0;
  Words words;
  block.begin = lines.offset();
  block.line = lines.line() + 1;
  forEachPoint(lines, [&](std::string_view line) {
    TableDialect().split(line, words);
    if (count++ == 0)
      block.words = words.size();
    checkWords(words.size(), block);
    for (std::size_t k = 0; k < 3 && block.hasColors(); ++k)
      if (const double value = parseNumber<double>(words[block.firstColor() + k]); std::isfinite(value))
        largest = std::max(largest, value);
    return true;
  });
  block.end = lines.offset();
  block.full_color = fullColor(Scalar::float64, largest);
  return count;
}

/// The transform in the last four lines of a PTX header, written transposed: the translation is the last row.
/// @param scale of the matrix
Eigen::Isometry3d poseOf(LineReader& lines, double& scale)
{
  Eigen::Matrix4d M;
  for (int row = 0; row < 4; ++row) {
    const std::vector<double> numbers = numbersOf(contentLine(lines), 4);
    M.row(row) = Eigen::RowVector4d::Map(numbers.data());
  }
  Eigen::Matrix3d R = M.topLeftCorner<3, 3>().transpose();
  constexpr double rounded = 1e-3; // numbers are written with 6 digits
  const double size = std::cbrt(R.determinant());
  if (size > 0 && std::abs(size - 1) > rounded) // units, as of millimetres in a file of metres
    R /= scale = size;
  expect(isRotation(R, rounded), "its matrix is no rotation");
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = R.isIdentity(0) ? R : Eigen::Quaterniond(R).normalized().toRotationMatrix();
  T.translation() = M.row(3).head<3>();
  return T;
}

/// What a pass over a file finds.
struct BlockIndex : ScanIndex {
  std::string file;
  std::uint64_t size = 0;
  std::filesystem::file_time_type time;
  std::vector<Block> blocks;
  std::vector<ScanInfo> scans;
  std::vector<std::string> remarks, errors; ///< to be told whenever the file is opened

  /// @param announced points, nothing where the file does not say
  void add(LineReader& lines, Block block, ScanInfo info, std::optional<Index> announced)
  {
    info.points = measurePoints(lines, block);
    const std::string counts = concat(announced.value_or(0), " points announced, ", info.points, " there (line ",
                                      block.line + info.points, ")");
    const bool has_more = announced && *announced < info.points;
    expect(!announced || *announced == info.points || (has_more && block.rows == 0), counts);
    if (has_more)
      remarks.push_back(counts);
    blocks.push_back(block);
    scans.push_back(std::move(info));
  }
};

void skipPoints(LineReader& lines)
{
  std::string_view line;
  while (lines.next(line))
    if (!line.empty() && isSingleWord(line)) {
      lines.unread();
      return;
    }
}

/// Adds the block that begins in the next line.
using ReadBlock = void (*)(LineReader& lines, BlockIndex& found);

/// @param name of a block, for errors
std::shared_ptr<const BlockIndex> findBlocks(const std::string& path, const RandomAccessFile& file, const char* name,
                                             ReadBlock read)
{
  const auto found = std::make_shared<BlockIndex>();
  found->file = path;
  found->size = file.size();
  found->time = std::filesystem::last_write_time(path);
  LineReader lines(file);
  std::string_view line;
  while (lines.next(line)) {
    if (line.empty())
      continue;
    lines.unread();
    if (!attempt(concat(name, ' ', found->scans.size() + 1), found->errors, [&] { read(lines, *found); })) {
      found->blocks.emplace_back();
      found->scans.emplace_back();
      skipPoints(lines);
    }
  }
  return found;
}

/// What PTX and PTS have in common: blocks of lines, found by a first pass over the file. A block that cannot be read
/// has no points and is remarked, unless none can.
class TextReader : public ScanReader {
public:
  TextReader(const ScanPath& path, const char* block_name, ReadBlock read_block)
      : file_(path.file), index_(std::dynamic_pointer_cast<const BlockIndex>(path.index))
  {
    if (!index_ || index_->file != path.file || index_->size != file_.size() ||
        index_->time != std::filesystem::last_write_time(path.file))
      index_ = findBlocks(path.file, file_, block_name, read_block);
    scans_ = index_->scans;
    for (const std::string& text : index_->remarks)
      remark(text);
    tellDamage(index_->errors, hasPoints());
    expect(!scans_.empty(), "no ", block_name);
  }

  std::shared_ptr<const ScanIndex> index() const override { return index_; }

  PointTable open(Index scan) override
  {
    block_ = index_->blocks[scan];
    lines_ = std::make_unique<LineReader>(file_, block_.begin, block_.end, block_.line);
    point_ = 0;
    PointTable layout;
    const auto add = [&](NameTriple names, Scalar type) {
      for (const char* name : names)
        layout.addColumn(name, type);
    };
    add(xyz_names, Scalar::float64);
    if (block_.hasIntensity())
      layout.addColumn("intensity", Scalar::float32);
    if (block_.hasColors())
      add(color_names, Scalar::uint8);
    if (block_.hasNormals())
      add(normal_names, Scalar::float32);
    if (block_.rows > 0)
      for (const char* name : {row_column, column_column})
        layout.addColumn(name, Scalar::int32);
    columns_ = layout.columns;
    return layout;
  }

  Index read(PointTable& table, Index begin, Index end) override
  {
    Index at = begin;
    if (at < end)
      forEachPoint(*lines_, [&](std::string_view line) {
        storeLine(line, table.data.data() + at * table.stride);
        return ++at < end;
      });
    return at - begin;
  }

private:
  void storeLine(std::string_view line, std::uint8_t* row)
  {
    TableDialect().split(line, words_);
    checkWords(words_.size(), block_);
    values_.clear();
    for (std::size_t k = 0; k < words_.size(); ++k) {
      const double value = parseNumber<double>(words_[k]);
      const bool is_color = block_.hasColors() && k >= block_.firstColor() && k < block_.firstColor() + 3;
      values_.push_back(k < 3 ? value * block_.scale : is_color ? colorByte(value, block_.full_color) : value);
    }
    if (block_.rows > 0) {
      if (values_[0] == 0 && values_[1] == 0 && values_[2] == 0) // a beam that nothing returned
        std::fill_n(values_.begin(), 3, std::numeric_limits<double>::quiet_NaN());
      values_.push_back(double(point_ % block_.rows));
      values_.push_back(double(point_ / block_.rows));
    }
    for (std::size_t c = 0; c < values_.size(); ++c)
      storeValue(columns_[c].type, values_[c], row + columns_[c].offset);
    ++point_;
  }

  RandomAccessFile file_;
  std::shared_ptr<const BlockIndex> index_;
  Block block_; ///< that is read
  std::unique_ptr<LineReader> lines_;
  std::vector<Column> columns_; ///< of the table that open() gave
  Words words_;
  std::vector<double> values_;
  Index point_ = 0; ///< next one of the block
};

void readStation(LineReader& lines, BlockIndex& found)
{
  Block block;
  ScanInfo info;
  std::uint64_t columns = 0, rows = 0;
  try {
    columns = parseNumber<std::uint32_t>(contentLine(lines));
    rows = parseNumber<std::uint32_t>(contentLine(lines));
    const Eigen::Vector3d position = Eigen::Vector3d::Map(numbersOf(contentLine(lines), 3).data());
    for (int axis = 0; axis < 3; ++axis)
      numbersOf(contentLine(lines), 3); // the matrix says it again
    info.T_file_scan = poseOf(lines, block.scale);
    info.sensor = info.T_file_scan.inverse() * position;
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(concat("header, line ", lines.line(), ": ", error.what()));
  }
  info.has_pose = true;
  info.intensity_limits = Eigen::Array2d(0, 1);
  block.rows = rows;
  found.add(lines, block, std::move(info), checkedCount(columns * rows, lines));
}

/// A number of points or names of columns, which say nothing new, may come before the points.
void readPtsBlock(LineReader& lines, BlockIndex& found)
{
  std::optional<Index> announced;
  Words words;
  const std::string_view line = contentLine(lines);
  TableDialect().split(line, words);
  if (isSingleWord(line))
    announced = countIn(line, lines);
  else if (!isHeader(words))
    lines.unread();
  ScanInfo info;
  info.intensity_limits = Eigen::Array2d(-2048, 2047); // as Cyclone writes them
  found.add(lines, {}, info, announced);
}
} // namespace

std::unique_ptr<ScanReader> openPtx(const ScanPath& path)
{
  return std::make_unique<TextReader>(path, "station", readStation);
}

std::unique_ptr<ScanReader> openPts(const ScanPath& path)
{
  return std::make_unique<TextReader>(path, "block", readPtsBlock);
}
} // namespace fresco::io
