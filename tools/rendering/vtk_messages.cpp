// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/vtk_messages.h"
#include <stdexcept>
namespace fresco::rendering {
class VtkMessages::Collector : public vtkOutputWindow {
public:
  static Collector* New()
  {
    auto* const made = new Collector;
    made->InitializeObjectBase();
    return made;
  }
  void DisplayText(const char* text) override { collected += text; }
  void DisplayErrorText(const char* text) override { collected += text; }
  void DisplayWarningText(const char* text) override { collected += text; }
  void DisplayGenericWarningText(const char* text) override { collected += text; }
  void DisplayDebugText(const char*) override {}
  std::string collected;

protected:
  Collector() = default;
};

VtkMessages::VtkMessages()
    : previous_(vtkOutputWindow::GetInstance()), collector_(vtkSmartPointer<Collector>::Take(Collector::New()))
{
  vtkOutputWindow::SetInstance(collector_);
}

VtkMessages::~VtkMessages() { vtkOutputWindow::SetInstance(previous_); }

void VtkMessages::check() const
{
  if (!collector_->collected.empty())
    throw std::runtime_error("VTK: " + collector_->collected);
}
} // namespace fresco::rendering
