// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/bytes.h"
#include "poisson/octree/octree.h"
#include "poisson/samples/samples.h"
namespace fresco::poisson {
/// Samples of other ranks in bricks of the first divided depth that touch own atoms: what lies in the ghosts of this and
/// all deeper depths. They go before and behind the own ones in the same sorted arrays. Does nothing where the octree
/// is not divided.
class SampleGhosts {
public:
  /// @param codes of the finest cells of the own samples, sorted
  SampleGhosts(const Octree& tree, const Array<std::uint64_t>& codes, int threads);

  /// Adds the ghosts' values. @param values by own sample
  template <typename T>
  void addTo(Array<T>& values) const
  {
    if (!partition_)
      return;
    std::vector<Bytes> to(runs_.size());
    for (std::size_t r = 0; r < runs_.size(); ++r)
      for (const SampleRun& run : runs_[r])
        append(to[r], values.data() + *run.begin(), *run.end() - *run.begin());
    std::vector<Bytes> from = partition_->exchange().deliver(std::move(to));
    Array<T> all;
    for (int r = 0; r < partition_->ranks(); ++r)
      if (r == partition_->rank())
        all.insert(all.end(), values.begin(), values.end());
      else
        appendTo(all, from[r]);
    values.swap(all);
  }
  /// Takes the ghosts' values from their owners. @param codes of own samples and ghosts
  template <typename T>
  void renew(const Array<std::uint64_t>& codes, Array<T>& values) const
  {
    if (!partition_)
      return;
    const auto [begin, end] = partition_->ownRange(finest_, codes);
    values = Array<T>(values.begin() + begin, values.begin() + end);
    addTo(values);
  }
  void addTo(SampleLevel& finest) const
  {
    addTo(finest.codes);
    addTo(finest.samples);
  }

private:
  const Partition* partition_ = nullptr;
  int finest_ = 0;
  std::vector<std::vector<SampleRun>> runs_; ///< by rank: the own samples that are ghosts there
};

/// One depth coarser. From the deepest level that only shared depths use on, all ranks get the samples of all.
SampleLevel coarsen(const SampleLevel& fine, const Octree& tree, int threads,
                    const Array<Eigen::Vector3f>* normals = nullptr);
} // namespace fresco::poisson
