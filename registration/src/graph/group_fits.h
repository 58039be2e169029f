// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <fresco/core/parallel.h>
#include <map>
#include <utility>
#include <vector>
namespace fresco::registration {
/// Places of all groups of scans in each other, found once for each pair of groups.
/// @tparam Fits list of places, each with T, the frame of one group from that of the other
template <typename Fits>
class GroupFits {
public:
  /// @param groups with an id that changes whenever their scans do
  /// @param find the places of a second group in a first one, whose id is lower; called from several threads
  template <typename Groups, typename Find>
  void findNew(const Groups& groups, int threads, const Find& find)
  {
    using Group = typename Groups::value_type;
    std::vector<std::pair<const Group*, const Group*>> fresh;
    for (auto i = groups.begin(); i != groups.end(); ++i)
      for (auto k = std::next(i); k != groups.end(); ++k) {
        const auto [first, second] = std::minmax(*i, *k, [](const Group& x, const Group& y) { return x.id < y.id; });
        if (fits_.find({first.id, second.id}) == fits_.end())
          fresh.push_back({&first, &second});
      }
    std::vector<Fits> found(fresh.size());
    parallelFor(
        fresh.size(), threads, [&](Index k) { found[k] = find(*fresh[k].first, *fresh[k].second); }, 1);
    for (std::size_t k = 0; k < fresh.size(); ++k)
      fits_[{fresh[k].first->id, fresh[k].second->id}] = std::move(found[k]);
  }

  /// Of the second in the first, by their ids.
  Fits of(Index first, Index second) const
  {
    Fits fits = fits_.at({std::min(first, second), std::max(first, second)});
    if (first > second)
      for (auto& fit : fits)
        fit.T = fit.T.inverse();
    return fits;
  }

private:
  std::map<std::pair<Index, Index>, Fits> fits_;
};
} // namespace fresco::registration
