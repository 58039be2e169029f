// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
namespace fresco::rendering {
/// While it lives, VTK's messages are collected instead of printed. VTK has one such place per process.
class VtkMessages {
public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  /// @throws std::runtime_error with the collected text if VTK reported an error or a warning
  void check() const;

private:
  class Collector;
  vtkSmartPointer<vtkOutputWindow> previous_;
  vtkSmartPointer<Collector> collector_;
};
} // namespace fresco::rendering
