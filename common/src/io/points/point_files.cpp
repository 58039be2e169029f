// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/parse_file.h"
#include "io/points/row_file.h"
#include "io/points/scan_reader.h"
#include <algorithm>
#include <filesystem>
#include <fresco/io/formats.h>
#include <fresco/io/point_files.h>
#include <fresco/io/point_io.h>
namespace fresco {
namespace {
struct Source {
  ScanPath path;
  std::optional<io::RowFile> rows; ///< nothing: read whole
};

struct Attributes {
  bool normals = true, colors = true, intensities = true, confidences = true;

  /// Gives a set room for `n` points with these attributes and no others; what has that size stays.
  void fit(PointSet& set, Index n) const
  {
    set.points.resize(3, n);
    set.normals.resize(3, normals ? n : 0);
    set.colors.resize(3, colors ? n : 0);
    set.intensities.resize(intensities ? n : 0);
    set.confidences.resize(confidences ? n : 0);
    set.viewpoints.resize(3, 0);
  }
};

/// What tableToPoints() makes of such columns.
Attributes attributesOf(io::PointTable layout)
{
  layout.data.clear();
  layout.allocate(1);
  const PointSet one = io::tableToPoints(layout, Eigen::Vector3d::Zero());
  return {one.hasNormals(), one.colors.cols() > 0, one.intensities.size() > 0, one.confidences.size() > 0};
}

bool isDouble(const io::PointTable& table)
{
  const auto xyz = findTriple(table, io::xyz_names);
  return xyz && std::any_of(xyz->begin(), xyz->end(),
                            [](const io::Column& column) { return column.type != io::Scalar::float32; });
}

io::CoordinateBounds merged(const io::CoordinateBounds& a, const io::CoordinateBounds& b)
{
  return {a.low.min(b.low), a.high.max(b.high), a.loss.max(b.loss)};
}

io::CoordinateBounds boundsOf(const Source& source)
{
  const auto ofTable = [](const io::PointTable& table) {
    return coordinateBounds(table, *findTriple(table, io::xyz_names));
  };
  if (!source.rows)
    return ofTable(io::readTable(source.path));
  return parallelReduce(
      source.rows->size(), 0, io::CoordinateBounds(),
      [&](Index begin, Index end) { return ofTable(source.rows->read(begin, end)); }, merged, io::rows_per_window);
}

class FileStream : public PointStream {
public:
  FileStream(const std::vector<ScanPath>& files, Index window, const WindowShare& share)
      : window_(window), share_(share)
  {
    bool wide = false;
    for (const ScanPath& path : files) {
      Source source{path, {}};
      if (path.scan < 0)
        source.rows = io::RowFile::open(path.file);
      wide = look(source) || wide;
      sources_.push_back(std::move(source));
    }
    if (wide)
      findOrigin();
  }

  void read(const std::function<void(const PointSet&)>& receive) const override
  {
    PointSet set;
    Index number = 0; // of the window among all
    for (const Source& source : sources_) {
      const Index count = source.rows ? source.rows->size() : 1;
      const Index windows = source.rows ? windowsOf(count) : 1;
      for (Index w = 0; w < windows; ++w) {
        if (number++ % share_.parts != share_.part)
          continue;
        io::namingFile(source.path.name(), [&] {
          if (source.rows)
            return readRows(*source.rows, count * w / windows, count * (w + 1) / windows, set);
          set = io::tableToPoints(io::readTable(source.path), origin_);
          attributes_.fit(set, set.size());
        });
        receive(set);
      }
    }
  }

  bool fitsWindow() const
  {
    Index rows = 0;
    for (const Source& source : sources_)
      rows += source.rows ? source.rows->size() : window_ + 1;
    return rows / share_.parts <= window_;
  }

private:
  /// Rows begin .. end - 1 of one file, read and converted in pieces.
  void readRows(const io::RowFile& file, Index begin, Index end, PointSet& set) const
  {
    set.origin = origin_;
    attributes_.fit(set, end - begin);
    const auto readPiece = [&](Index first, Index last) {
      PointSet piece = io::tableToPoints(file.read(begin + first, begin + last), origin_);
      attributes_.fit(piece, last - first);
      const auto copy = [&](const auto& from, auto& to) {
        std::copy_n(from.data(), from.size(), to.data() + from.size() / (last - first) * first);
      };
      copy(piece.points, set.points);
      copy(piece.normals, set.normals);
      copy(piece.colors, set.colors);
      copy(piece.intensities, set.intensities);
      copy(piece.confidences, set.confidences);
    };
    parallelRanges(end - begin, 0, readPiece, io::rows_per_window);
  }

  /// Of about the same size, and one for each rank at least.
  Index windowsOf(Index rows) const
  {
    const Index fewest = (rows + window_ - 1) / window_;
    return (fewest + share_.parts - 1) / share_.parts * share_.parts;
  }

  /// Joins the attributes of a file to those of the others. @return whether its coordinates are no floats
  bool look(const Source& source)
  {
    const io::PointTable table = source.rows ? source.rows->layout() : io::readTable(source.path);
    return io::namingFile(source.path.name(), [&] {
      const Attributes own = attributesOf(table);
      const bool first = sources_.empty();
      expect(first || own.normals == attributes_.normals,
             own.normals ? "the points have normals, unlike those of the files before" : "the points have no normals");
      attributes_ = {own.normals, attributes_.colors && own.colors, attributes_.intensities && own.intensities,
                     attributes_.confidences && own.confidences};
      return isDouble(table);
    });
  }

  void findOrigin()
  {
    io::CoordinateBounds bounds = boundsOf(sources_[0]);
    for (std::size_t i = 1; i < sources_.size(); ++i)
      bounds = merged(bounds, boundsOf(sources_[i]));
    if (bounds.exceedsFloat())
      origin_ = bounds.origin();
  }

  std::vector<Source> sources_;
  Index window_;
  WindowShare share_;
  Attributes attributes_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

/// None for a rank that no window is left for.
class KeptPoints : public PointStream {
public:
  explicit KeptPoints(PointSet set) : set_(std::move(set)) {}
  void read(const std::function<void(const PointSet&)>& receive) const override
  {
    if (set_.size() > 0)
      receive(set_);
  }

private:
  PointSet set_;
};

/// In a folder, text files are notes or poses, .stl files hold no normals, and hidden ones are of systems or unfinished.
bool isPointFile(const std::filesystem::path& path)
{
  const std::string ending = extension(path.string());
  return path.filename().string()[0] != '.' && isReadable(path.string(), FileKind::points) && ending != ".txt" &&
         ending != ".stl";
}
} // namespace

std::unique_ptr<PointStream> openPointFiles(const std::vector<ScanPath>& files, Index window, const WindowShare& share)
{
  require(!files.empty(), "points: no files");
  require(window >= 1, "points: a window of ", window);
  require(share.part >= 0 && share.part < share.parts, "points: part ", share.part, " of ", share.parts);
  if (files.size() == 1 && (files[0].scan >= 0 || !io::RowFile::open(files[0].file)))
    return std::make_unique<KeptPoints>(share.part > 0 ? PointSet() : readPoints(files[0]));
  auto stream = std::make_unique<FileStream>(files, window, share);
  if (!stream->fitsWindow())
    return stream;
  PointSet all;
  stream->read([&](const PointSet& part) { all.size() == 0 ? void(all = part) : appendPoints(all, part); });
  return std::make_unique<KeptPoints>(std::move(all));
}

std::vector<std::string> pointFilesIn(const std::vector<std::string>& words)
{
  std::vector<std::string> files;
  for (const std::string& word : words) {
    expect(std::filesystem::exists(word), word, ": no such file");
    if (!std::filesystem::is_directory(word)) {
      files.push_back(word);
      continue;
    }
    std::vector<std::string> inside;
    for (const auto& entry : std::filesystem::directory_iterator(word))
      if (entry.is_regular_file() && isPointFile(entry.path()))
        inside.push_back(entry.path().string());
    expect(!inside.empty(), word, ": no file of points in this folder");
    std::sort(inside.begin(), inside.end());
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return files;
}
} // namespace fresco
