// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "poisson/octree/bytes.h"
#include "poisson/octree/splat.h"
#include <algorithm>
namespace fresco::poisson {
/// Splats the own samples of each rank at a shared depth: the field is that of all samples on all ranks. The samples of
/// a brick are added up in their order as on one rank: a brick that lies on several ranks goes from rank to rank along
/// the Z-order curve, and its sums with it.
template <int reach>
class SharedSplat {
public:
  SharedSplat(const BrickLevel& level, const SampleRanges& own_samples, Exchange& exchange, int threads)
      : level_(level), samples_(own_samples), exchange_(exchange), threads_(threads)
  {
    const auto isEmpty = [&](int b) { return samples_[b].empty(); };
    const int n = level.size();
    while (first_ < n && isEmpty(first_))
      ++first_;
    for (last_ = first_ < n ? n - 1 : first_; last_ > first_ && isEmpty(last_);)
      --last_;
    findNeighbors(n);
  }

  /// As splatBricks().
  template <typename Splat>
  void addTo(NodeField& field, const Splat& splat)
  {
    const int count = first_ < level_.size() ? last_ - first_ + 1 : 0;
    std::vector<Block> blocks(count);
    const auto fill = [&](Index i) {
      if (!samples_[first_ + i].empty())
        splat(blocks[i], first_ + i);
    };
    for (Block& block : blocks)
      block.clear();
    if (count > 1)
      parallelFor(count - 1, threads_, [&](Index i) { fill(i + 1); });
    if (count > 1)
      pass(upper_, blocks.back(), lower_, blocks.front());
    else if (count == 1)
      pass(-1, blocks.front(), lower_, blocks.front());
    if (count > 0)
      fill(0);
    if (count == 1)
      pass(upper_, blocks.front(), -1, blocks.front());
    addAll(gatherBlocks(blocks), field);
  }

private:
  using Block = SplatBlock<reach>;
  struct Numbered {
    int brick;
    Block block;
  };

  /// The ranks before and behind with samples of the first and of the last own brick, if any.
  void findNeighbors(int bricks)
  {
    const int own[2] = {first_, last_};
    const Array<int> ends = gatherAll(exchange_, own, 2);
    const auto has = [&](int r) { return ends[2 * r] < bricks; };
    if (!has(exchange_.rank()))
      return;
    int r = exchange_.rank() - 1;
    while (r >= 0 && !has(r))
      --r;
    if (r >= 0 && ends[2 * r + 1] == first_)
      lower_ = r;
    for (r = exchange_.rank() + 1; r < exchange_.size() && !has(r);)
      ++r;
    if (r < exchange_.size() && ends[2 * r] == last_)
      upper_ = r;
  }

  void pass(int to, const Block& sent, int from, Block& received)
  {
    std::vector<Exchange::Send> send;
    std::vector<Exchange::Receive> receive;
    if (to >= 0)
      send.push_back({to, &sent, sizeof(Block)});
    if (from >= 0)
      receive.push_back({from, &received, sizeof(Block)});
    exchange_.swap(send, receive);
  }

  /// All but the sums that went on to the next rank.
  Array<Numbered> gatherBlocks(const std::vector<Block>& blocks)
  {
    Bytes message;
    for (std::size_t i = 0; i + (upper_ >= 0 ? 1 : 0) < blocks.size(); ++i)
      if (!samples_[first_ + i].empty() && !blocks[i].isZero())
        append(message, Numbered{first_ + static_cast<int>(i), blocks[i]});
    Array<Numbered> all;
    for (const Bytes& part : exchange_.gatherAll(std::move(message)))
      appendTo(all, part);
    return all;
  }

  void addAll(const Array<Numbered>& blocks, NodeField& field)
  {
    const auto isBefore = [](const Numbered& block, int brick) { return block.brick < brick; };
    for (const std::vector<BrickRun>& runs : level_.colors)
      parallelFor(runs.size(), threads_, [&](Index r) {
        auto at = std::lower_bound(blocks.begin(), blocks.end(), runs[r].begin, isBefore);
        for (; at != blocks.end() && at->brick < runs[r].end; ++at)
          at->block.addTo(level_, at->brick, field);
      });
  }

  const BrickLevel& level_;
  const SampleRanges& samples_;
  Exchange& exchange_;
  int threads_;
  int first_ = 0, last_ = 0; ///< bricks with own samples; the number of bricks if there are none
  int lower_ = -1, upper_ = -1;
};
} // namespace fresco::poisson
