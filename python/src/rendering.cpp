// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.h"
#include "call.h"
#include <fresco/rendering/requested_view.h>
namespace fresco::python {
/// Names as in the tool.
template <>
struct Convert<Shading> : CheckedByFilling<Shading> {
  static py::object toPython(Shading shading) { return py::str(shadingNames()[static_cast<std::size_t>(shading)]); }
  static void fill(Shading& out, py::handle value, const std::string& name, Lender&)
  {
    const std::string given = toString(value, name);
    try {
      out = shadingByName(given);
    } catch (const std::invalid_argument& error) {
      throw py::value_error(name + ": " + error.what());
    }
  }
  static std::string annotation() { return literalText({shadingNames().begin(), shadingNames().end()}); }
};

namespace {
/// Names that requestedView() knows.
std::vector<std::string> allViews()
{
  std::vector<std::string> names = viewNames();
  names.insert(names.end(), {"inside", "above"});
  return names;
}

ViewRequest viewRequest(const Call& call)
{
  ViewRequest request;
  if (!py::isinstance(call["view"], recordClass<Viewpoint>()))
    request.view = call.value<std::string>("view");
  request.eye = call.value<std::optional<Eigen::Vector3d>>("eye");
  request.look = call.value<std::optional<Eigen::Vector3d>>("look");
  request.up = call.value<std::optional<Eigen::Vector3d>>("up");
  request.angle = call.value<std::optional<double>>("angle");
  return request;
}

/// render(options) with the view asked for, by one thread at a time.
template <typename Render>
py::object draw(const Call& call, const Subject& subject, const Render& render)
{
  auto options = call.options<PictureOptions>();
  const ViewRequest request = viewRequest(call);
  options.cull_back_faces |= request.view == "above";
  const bool placed = py::isinstance(call["view"], recordClass<Viewpoint>());
  if (placed)
    options.view = call.value<Viewpoint>("view");
  const Lent<std::optional<TriangleMesh>> room = call.lend<std::optional<TriangleMesh>>("room");
  return call.run([&](const Progress&) {
    if (!placed)
      options.view = requestedView(request, subject, *room ? &**room : nullptr, options);
    const std::lock_guard<std::mutex> lock(oneAtATime());
    return render(options);
  });
}

py::object drawMesh(const Call& call)
{
  const auto mesh = lendMesh(call, "model");
  if (call["reference"].is_none())
    return draw(call, {&*mesh, nullptr}, [&](const PictureOptions& options) { return renderPicture(*mesh, options); });
  const auto reference = lendMesh(call, "reference");
  return draw(call, {&*mesh, nullptr}, [&](const PictureOptions& options) {
    return renderErrorPicture(*mesh, vertexDistances(*mesh, *reference, options.threads), options);
  });
}

py::object snapshot(const Call& call)
{
  if (py::isinstance(call["model"], recordClass<PointSet>())) {
    const auto set = lendPoints(call, "model");
    return draw(call, {nullptr, &*set}, [&](const PictureOptions& options) { return renderPicture(*set, options); });
  }
  if (py::isinstance(call["model"], recordClass<TexturedMesh>())) {
    const auto model = call.lend<TexturedMesh>("model");
    return draw(call, {&model->mesh, nullptr},
                [&](const PictureOptions& options) { return renderPicture(*model, options); });
  }
  return drawMesh(call);
}
} // namespace

void addRendering(const py::module_& module)
{
  addRecord<Viewpoint>(module);
  const std::vector<Argument> arguments{{"model", "Union[TriangleMesh, TexturedMesh, PointSet]"},
                                        {"view", "Union[" + literalText(allViews()) + ", Viewpoint]", "'corner'"},
                                        {"eye", "Optional[ArrayLike]", "None"},
                                        {"look", "Optional[ArrayLike]", "None"},
                                        {"up", "Optional[ArrayLike]", "None"},
                                        {"angle", "Optional[float]", "None"},
                                        {"reference", "Optional[TriangleMesh]", "None"},
                                        {"room", "Optional[TriangleMesh]", "None"}};
  addFunction<PictureOptions>(
      module,
      {"snapshot", "renderPicture", arguments, "Bytes",
       "Returns (height, width, 3) uint8, (height, width, 4) with `transparent`. `view` is corner, front, back, left, "
       "right, top or bottom (the whole model), inside (a room, at eye height), above (a room without its ceiling), or "
       "a Viewpoint; `eye`, looking at `look`, replaces it; `up` and `angle` (degrees) go with all of these. With "
       "`reference` the picture shows the distance to it. `room` is the mesh that inside and above are chosen for. One "
       "picture is drawn at a time: a second thread waits.",
       false},
      snapshot);
}
} // namespace fresco::python
