// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <stdexcept>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkStringOutputWindow.h>
namespace fresco::rendering {
/// While it lives, VTK's messages are collected instead of printed. VTK has one such place per process.
class VtkMessages {
public:
  VtkMessages() : previous_(vtkOutputWindow::GetInstance()) { vtkOutputWindow::SetInstance(collected_); }
  ~VtkMessages() { vtkOutputWindow::SetInstance(previous_); }
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  /// @throws std::runtime_error with the collected text if VTK reported an error or a warning
  void check() const
  {
    if (const std::string text = collected_->GetOutput(); !text.empty())
      throw std::runtime_error("VTK: " + text);
  }

private:
  vtkSmartPointer<vtkOutputWindow> previous_;
  vtkNew<vtkStringOutputWindow> collected_;
};
} // namespace fresco::rendering
