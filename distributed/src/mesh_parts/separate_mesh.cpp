// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_parts/separate_mesh.h"
#include <algorithm>
#include <fresco/io/packing.h>
namespace fresco::io {
namespace {
using Run = MeshPart::Run;

/// Which rank owns a vertex of the whole, and as which of its own.
class Owners {
public:
  struct Place {
    Run run;
    Index begin; ///< of the run among the owner's
    int rank;
    Index ownIndex(Index v) const { return begin + v - run.first; }
  };

  Owners(const std::vector<Run>& own, Exchange& ranks)
  {
    const std::vector<std::vector<Run>> all = gatherValues(ranks, own);
    for (int r = 0; r < ranks.size(); ++r) {
      Index begin = 0;
      for (const Run& run : all[r]) {
        if (run.count > 0)
          places_.push_back({run, begin, r});
        begin += run.count;
      }
    }
    std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) { return a.run.first < b.run.first; });
  }

  const Place& placeOf(Index v) const
  {
    return *std::partition_point(places_.begin(), places_.end(),
                                 [&](const Place& place) { return place.run.first + place.run.count <= v; });
  }

private:
  std::vector<Place> places_;
};

/// Vertices with attributes, as they travel.
struct Vertices {
  Points positions, normals;
  Colors colors;
  std::vector<Eigen::RowVectorXf> values; ///< by field, in the order of their names
};

template <typename Archive>
void fields(Archive& archive, Vertices& some)
{
  archive(some.positions, some.normals, some.colors, some.values);
}

template <typename Matrix>
Matrix columnsOf(const Matrix& all, const std::vector<Index>& chosen)
{
  if (all.cols() == 0)
    return all;
  Matrix some(all.rows(), chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i)
    some.col(i) = all.col(chosen[i]);
  return some;
}

Vertices verticesOf(const TriangleMesh& mesh, const std::vector<Index>& chosen)
{
  Vertices some = {
      columnsOf(mesh.vertices, chosen), columnsOf(mesh.normals, chosen), columnsOf(mesh.colors, chosen), {}};
  for (const auto& [name, values] : mesh.fields) {
    some.values.emplace_back(chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i)
      some.values.back()[i] = values[chosen[i]];
  }
  return some;
}

/// Behind each other; `matrixOf` one of them.
template <typename MatrixOf>
auto joined(const std::vector<Vertices>& parts, const MatrixOf& matrixOf)
{
  auto all = matrixOf(parts[0]); // for its type and rows
  Index columns = 0;
  for (const Vertices& part : parts)
    columns += matrixOf(part).cols();
  all.resize(all.rows(), columns);
  Index at = 0;
  for (const Vertices& part : parts) {
    const auto& some = matrixOf(part);
    all.middleCols(at, some.cols()) = some;
    at += some.cols();
  }
  return all;
}

/// Numbers one after the other, as runs.
class RunList {
public:
  void add(Index number)
  {
    if (!runs_.empty() && runs_.back().first + runs_.back().count == number)
      ++runs_.back().count;
    else
      runs_.push_back({number, 1});
  }
  std::vector<Run> take() { return std::move(runs_); }

private:
  std::vector<Run> runs_;
};

/// Collects a rank's vertices: first its own, then those of the other ranks, by rank.
class Separation {
public:
  Separation(const MeshPart& part, Exchange& ranks)
      : part_(part), ranks_(ranks), owners_(part.vertices, ranks), is_kept_(part.mesh.vertexCount(), 0),
        borrowed_(ranks.size()), begins_(ranks.size())
  {
    for (Index c = 0; c < part.mesh.faces.size(); ++c) {
      const Index v = part.mesh.faces.data()[c];
      const Owners::Place& place = owners_.placeOf(v);
      if (place.rank == ranks.rank())
        is_kept_[place.ownIndex(v)] = 1;
      else
        borrowed_[place.rank].push_back(v);
    }
    for (std::vector<Index>& numbers : borrowed_) {
      std::sort(numbers.begin(), numbers.end());
      numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    }
  }

  SeparateMesh make()
  {
    const std::vector<std::vector<Index>> lent = swapValues(ownIndices());
    keepUnused(lent);
    std::vector<Vertices> sent;
    for (const std::vector<Index>& chosen : lent)
      sent.push_back(verticesOf(part_.mesh, chosen));
    std::vector<Vertices> parts = swapValues(std::move(sent));
    std::vector<Index> kept;
    for (std::size_t v = 0; v < is_kept_.size(); ++v)
      if (is_kept_[v])
        kept.push_back(static_cast<Index>(v));
    parts.insert(parts.begin(), verticesOf(part_.mesh, kept));
    SeparateMesh separate;
    separate.vertices = number(kept);
    TriangleMesh& mesh = separate.mesh;
    mesh.origin = part_.mesh.origin;
    mesh.vertices = joined(parts, [](const Vertices& some) -> const Points& { return some.positions; });
    mesh.normals = joined(parts, [](const Vertices& some) -> const Points& { return some.normals; });
    mesh.colors = joined(parts, [](const Vertices& some) -> const Colors& { return some.colors; });
    std::size_t i = 0;
    for (const auto& field : part_.mesh.fields) {
      mesh.fields[field.first] =
          joined(parts, [&](const Vertices& some) -> const Eigen::RowVectorXf& { return some.values[i]; }).transpose();
      ++i;
    }
    parts.clear();
    addFaces(mesh);
    return separate;
  }

private:
  /// What each other rank shall lend, as its own vertices.
  std::vector<std::vector<Index>> ownIndices() const
  {
    std::vector<std::vector<Index>> wanted = borrowed_;
    for (std::vector<Index>& numbers : wanted)
      for (Index& number : numbers)
        number = owners_.placeOf(number).ownIndex(number);
    return wanted;
  }

  void keepUnused(const std::vector<std::vector<Index>>& lent)
  {
    std::vector<char> is_lent(is_kept_.size(), 0);
    for (const std::vector<Index>& chosen : lent)
      for (const Index v : chosen)
        is_lent[v] = 1;
    for (std::size_t v = 0; v < is_kept_.size(); ++v)
      is_kept_[v] |= is_lent[v] ? 0 : 1;
  }

  /// @param kept own vertices. @return numbers in the whole of all vertices of the part
  std::vector<Run> number(const std::vector<Index>& kept)
  {
    RunList numbers;
    local_.assign(is_kept_.size(), -1);
    Index begin = 0, at = 0;
    for (const Run& run : part_.vertices) {
      for (; at < Index(kept.size()) && kept[at] < begin + run.count; ++at) {
        numbers.add(run.first + kept[at] - begin);
        local_[kept[at]] = static_cast<int>(at);
      }
      begin += run.count;
    }
    for (std::size_t r = 0; r < borrowed_.size(); ++r) {
      begins_[r] = at;
      at += borrowed_[r].size();
      for (const Index v : borrowed_[r])
        numbers.add(v);
    }
    return numbers.take();
  }

  void addFaces(TriangleMesh& mesh) const
  {
    mesh.faces.resize(3, part_.mesh.faceCount());
    for (Index c = 0; c < mesh.faces.size(); ++c) {
      const Index v = part_.mesh.faces.data()[c];
      const Owners::Place& place = owners_.placeOf(v);
      const std::vector<Index>& theirs = borrowed_[place.rank];
      mesh.faces.data()[c] =
          place.rank == ranks_.rank()
              ? local_[place.ownIndex(v)]
              : static_cast<int>(begins_[place.rank] +
                                 (std::lower_bound(theirs.begin(), theirs.end(), v) - theirs.begin()));
    }
  }

  /// What each rank gets, by rank. @return what came from each
  template <typename Value>
  std::vector<Value> swapValues(std::vector<Value> to) const
  {
    std::vector<Exchange::Bytes> messages;
    for (Value& value : to) {
      Packer packer;
      packer(value);
      messages.push_back(packer.take());
    }
    to.clear();
    std::vector<Value> from;
    for (const Exchange::Bytes& message : ranks_.deliver(std::move(messages))) {
      Unpacker unpacker(message);
      unpacker(from.emplace_back());
    }
    return from;
  }

  const MeshPart& part_;
  Exchange& ranks_;
  Owners owners_;
  std::vector<char> is_kept_;                ///< by own vertex
  std::vector<std::vector<Index>> borrowed_; ///< numbers in the whole, by owner
  std::vector<Index> begins_;                ///< where those begin in the part
  std::vector<int> local_;                   ///< by own vertex: its place in the part
};
} // namespace

SeparateMesh separateMesh(const MeshPart& part, Exchange& ranks) { return Separation(part, ranks).make(); }
} // namespace fresco::io
