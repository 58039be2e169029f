// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
#include <fresco/deliverables/core/plan_drawing.h>
namespace fresco::python {
namespace {
const char* const any_model = "Union[TriangleMesh, TexturedMesh, PointSet]";

py::object plan(const Call& call)
{
  const auto options = call.options<PlanOptions>();
  const auto draw = [&](const auto& model) {
    return call.run([&](const Progress& progress) { return drawPlan(model, options, progress); });
  };
  if (py::isinstance(call["model"], recordClass<PointSet>()))
    return draw(*lendPoints(call, "model"));
  if (py::isinstance(call["model"], recordClass<TexturedMesh>()))
    return draw(call.lend<TexturedMesh>("model")->mesh);
  return draw(*lendMesh(call, "model"));
}

py::object ortho(const Call& call)
{
  const auto plan = call.lend<FloorPlan>("plan");
  const auto pixel = call.value<double>("pixel");
  const auto draw = [&](const auto& model) {
    return call.run([&](const Progress&) { return orthophoto(model, *plan, pixel); });
  };
  if (py::isinstance(call["model"], recordClass<PointSet>()))
    return draw(*lendPoints(call, "model"));
  return draw(*call.lend<TexturedMesh>("model"));
}

/// A function of a plan alone.
template <typename Draw>
void addDrawing(const py::module_& module, const char* name, const char* core, const Draw& draw)
{
  addFunction(module, {name, core, {{"plan", "FloorPlan"}}, "str", "", false}, [draw](const Call& call) {
    const auto plan = call.lend<FloorPlan>("plan");
    return call.run([&](const Progress&) { return draw(*plan); });
  });
}
} // namespace

void addPlans(const py::module_& module)
{
  addRecord<PlanOpening>(module);
  addRecord<PlanWall>(module);
  addRecord<PlanRoom>(module);
  addRecord<FloorPlan>(module);
  addRecord<ScaledPicture>(module);
  addFunction<PlanOptions>(module, {"draw_plan", "drawPlan", {{"model", any_model}}, "FloorPlan"}, plan);
  addDrawing(module, "plan_svg", "planSvg", [](const FloorPlan& plan) { return planSvg(plan); });
  addDrawing(module, "plan_dxf", "planDxf", planDxf);
  addDrawing(module, "plan_json", "planJson", planJson);
  addDrawing(module, "plan_csv", "planCsv", planCsv);
  addFunction(module,
              {"plan_picture", "planPicture", {{"plan", "FloorPlan"}, {"pixel", "float"}}, "ScaledPicture", "", false},
              [](const Call& call) {
                const auto plan = call.lend<FloorPlan>("plan");
                const auto pixel = call.value<double>("pixel");
                return call.run([&](const Progress&) { return planPicture(*plan, pixel); });
              });
  addFunction(module,
              {"orthophoto",
               "orthophoto",
               {{"model", "Union[TexturedMesh, PointSet]"}, {"plan", "FloorPlan"}, {"pixel", "float"}},
               "ScaledPicture",
               "",
               false},
              ortho);
}
} // namespace fresco::python
