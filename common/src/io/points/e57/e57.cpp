// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/e57.h"
#include "io/points/e57/columns.h"
#include <algorithm>
#include <fresco/core/require.h>
namespace fresco::io {
namespace e57 {
namespace {
class Reader : public ScanReader {
public:
  explicit Reader(const std::string& path) : file_(path), content_(parseContent(file_))
  {
    for (const Scan& scan : content_.scans)
      scans_.push_back(scan.info);
    tellDamage(content_.errors, hasPoints());
  }

  PointTable open(Index scan) override
  {
    const Scan& chosen = content_.scans[scan];
    scan_ = scan;
    read_ = 0;
    columns_.emplace(chosen, largestColors(file_, chosen));
    records_.emplace(file_, chosen.records);
    const PointTable& layout = columns_->layout();
    // Fields of no bits cost nothing in the file.
    constexpr std::uint64_t least = std::uint64_t{1} << 26, per_byte = 64;
    if (chosen.records.count > std::max(least, per_byte * file_.size()) / layout.stride)
      throw std::runtime_error(concat("truncated: ", chosen.records.count, " points of ", layout.stride,
                                      " bytes do not fit into a file of ", file_.size()));
    return layout;
  }

  Index read(PointTable& table, Index begin, Index end) override
  {
    const std::size_t count = records_->next(std::min(end - begin, rows_per_window));
    columns_->store(*records_, count, table, begin);
    read_ += count;
    if (content_.is_doubtful && read_ == content_.scans[scan_].info.points)
      records_->requireEnd();
    return count;
  }

private:
  PagedFile file_;
  const Content content_;
  std::optional<Columns> columns_;
  std::optional<VectorReader> records_;
  Index scan_ = 0, read_ = 0; ///< that is read, and how many of its records
};
} // namespace
} // namespace e57

std::unique_ptr<ScanReader> openE57(const std::string& path) { return std::make_unique<e57::Reader>(path); }
} // namespace fresco::io
