// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/files/remarks.h"
#include <algorithm>
#include <fresco/core/point_table.h>
#include <fresco/io/scan_file.h>
#include <memory>
#include <string>
#include <vector>
namespace fresco::io {
/// Where the scans of a file are, for formats that tell it only to who has read all of the file.
struct ScanIndex {
  virtual ~ScanIndex() = default;
};

/// The scans of a file, read in windows of rows. Errors come without the path.
class ScanReader {
public:
  ScanReader() = default;
  virtual ~ScanReader() = default;
  ScanReader(const ScanReader&) = delete;
  ScanReader& operator=(const ScanReader&) = delete;

  const std::vector<ScanInfo>& scans() const { return scans_; }
  virtual std::shared_ptr<const ScanIndex> index() const { return {}; }

  /// Goes to the begin of a scan. @return its columns, without rows. Coordinates are in the frame of the scan, float64
  /// unless the file itself has float32.
  /// @throws std::runtime_error if the file cannot hold what it announces
  virtual PointTable open(Index scan) = 0;

  /// Fills rows `begin` .. `end` - 1 at most of a table with these columns. @return rows filled; 0 = the end
  virtual Index read(PointTable& table, Index begin, Index end) = 0;

protected:
  bool hasPoints() const
  {
    return std::any_of(scans_.begin(), scans_.end(), [](const ScanInfo& info) { return info.points > 0; });
  }

  std::vector<ScanInfo> scans_; ///< those that cannot be read have no points
};

/// Remarks on the parts of a file that cannot be read. @throws std::runtime_error with the first unless there are others
void tellDamage(const std::vector<std::string>& errors, bool others);

/// use(); what cannot be read of `what` goes to `errors`, to be told later, and does not cost the rest.
/// @return whether it could be read
template <typename Use>
bool attempt(const std::string& what, std::vector<std::string>& errors, const Use& use)
try {
  use();
  return true;
} catch (const std::runtime_error& error) {
  errors.push_back(what + ": " + error.what());
  return false;
}

/// One scan in its own frame, or the whole file. @throws std::runtime_error "PATH: reason"
PointTable readTable(const ScanPath& path);

/// Columns that say where in an organised scan a point belongs; an organised table does not have them.
inline constexpr const char* row_column = "row";
inline constexpr const char* column_column = "column";

/// How many rows readers of large files handle in one go: some megabytes.
inline constexpr Index rows_per_window = Index{1} << 16;

/// One scan in its own frame; organised where the file says so.
PointTable readScanTable(ScanReader& reader, Index scan);

/// All scans in the frame of the file, with the columns that all of them have; vp_x vp_y vp_z where there are several
/// and each knows its sensor.
PointTable readMergedTable(ScanReader& reader);

/// Puts the values of columns "row" and "column" to use: the table becomes organised and what is missing NaN, unless
/// two rows have the same place or most places are empty.
void organise(PointTable& table);
} // namespace fresco::io
