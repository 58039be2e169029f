// SPDX-License-Identifier: BSD-3-Clause
#include "poisson/octree/ghosts.h"
namespace fresco::poisson {
namespace {
BrickRun rangeOf(const Ghosts::List& list, int color)
{
  return color < 0 ? BrickRun{0, list.first.back()} : BrickRun{list.first[color], list.first[color + 1]};
}
} // namespace

void Ghosts::swap(std::size_t bytes, const std::function<void(int brick, std::byte* message)>& pack,
                  const std::function<void(int brick, const std::byte* message)>& unpack, int color) const
{
  if (!isDivided())
    return;
  std::vector<Exchange::Bytes> out(peers.size()), in(peers.size());
  std::vector<Exchange::Send> send;
  std::vector<Exchange::Receive> receive;
  for (std::size_t p = 0; p < peers.size(); ++p) {
    const BrickRun sent = rangeOf(peers[p].send, color), received = rangeOf(peers[p].receive, color);
    out[p].resize((sent.end - sent.begin) * bytes);
    in[p].resize((received.end - received.begin) * bytes);
    for (int i = sent.begin; i < sent.end; ++i)
      pack(peers[p].send.bricks[i], out[p].data() + (i - sent.begin) * bytes);
    if (!out[p].empty())
      send.push_back({peers[p].rank, out[p].data(), out[p].size()});
    if (!in[p].empty())
      receive.push_back({peers[p].rank, in[p].data(), in[p].size()});
  }
  exchange->swap(send, receive);
  for (std::size_t p = 0; p < peers.size(); ++p) {
    const BrickRun received = rangeOf(peers[p].receive, color);
    for (int i = received.begin; i < received.end; ++i)
      unpack(peers[p].receive.bricks[i], in[p].data() + (i - received.begin) * bytes);
  }
}
} // namespace fresco::poisson
