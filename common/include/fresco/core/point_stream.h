// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/core/point_set.h>
#include <functional>
namespace fresco {
/// Points that are handed over in windows, as often as they are asked for: there may be more than memory holds.
class PointStream {
public:
  PointStream() = default;
  virtual ~PointStream() = default;
  PointStream(const PointStream&) = delete;
  PointStream& operator=(const PointStream&) = delete;

  /// Hands all points to `receive`, a window at a time. All windows have one origin and the same attributes.
  /// @throws std::runtime_error if the points cannot be read
  virtual void read(const std::function<void(const PointSet&)>& receive) const = 0;
};
} // namespace fresco
