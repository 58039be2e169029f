// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/ranks/whole_mesh.h"
#include "poisson/octree/bytes.h"
#include <algorithm>
namespace fresco::poisson {
namespace {
using PartRuns = std::vector<VolumetricPart::Run>;

/// Runs of all ranks, by rank, with which rank 0 takes what they hold.
class ToFirst {
public:
  ToFirst(Exchange& exchange, const PartRuns& own, Index count) : exchange_(exchange), count_(count)
  {
    Exchange::Bytes message;
    append(message, own.data(), own.size());
    for (const Exchange::Bytes& theirs : exchange.gatherAll(std::move(message))) {
      runs_.emplace_back();
      appendTo(runs_.back(), theirs);
    }
  }

  /// `values` becomes on rank 0 the columns of all ranks, on the others none.
  template <typename Matrix>
  void gather(Matrix& values) const
  {
    using Scalar = typename Matrix::Scalar;
    const std::size_t bytes = sizeof(Scalar) * values.rows();
    if (exchange_.rank() > 0) {
      forPieces(exchange_.rank(), [&](Index own, Index, Index count) {
        exchange_.swap({{0, values.data() + own * values.rows(), count * bytes}}, {});
      });
      values.resize(values.rows(), 0);
      return;
    }
    Matrix whole(values.rows(), count_);
    forPieces(0, [&](Index own, Index first, Index count) {
      whole.middleCols(first, count) = values.middleCols(own, count);
    });
    values.resize(values.rows(), 0);
    for (int r = 1; r < exchange_.size(); ++r)
      forPieces(r, [&](Index, Index first, Index count) {
        exchange_.swap({}, {{r, whole.data() + first * whole.rows(), count * bytes}});
      });
    values.swap(whole);
  }

private:
  /// visit(first there, first in the whole, count) for pieces of a rank's runs.
  template <typename Visit>
  void forPieces(int rank, const Visit& visit) const
  {
    constexpr Index at_most = Index(1) << 19;
    Index there = 0;
    for (const VolumetricPart::Run& run : runs_[rank])
      for (Index done = 0; done < run.count; done += at_most) {
        const Index count = std::min(at_most, run.count - done);
        visit(there, run.first + done, count);
        there += count;
      }
  }

  Exchange& exchange_;
  Index count_;
  std::vector<PartRuns> runs_;
};
} // namespace

void gatherMesh(Exchange& exchange, VolumetricPart& part)
{
  TriangleMesh& mesh = part.result.mesh;
  const ToFirst vertices(exchange, part.vertices, part.vertex_count);
  vertices.gather(mesh.vertices);
  if (sumOfAll(exchange, mesh.colors.cols()) > 0)
    vertices.gather(mesh.colors);
  for (auto& [name, values] : mesh.fields) {
    Eigen::RowVectorXf row = values.transpose();
    values.resize(0);
    vertices.gather(row);
    values = row.transpose();
  }
  ToFirst(exchange, part.faces, part.face_count).gather(mesh.faces);
  part.vertices.clear();
  part.faces.clear();
}
} // namespace fresco::poisson
