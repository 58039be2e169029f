// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <fresco/core/require.h>
#include <fresco/rendering/indoor_view.h>
#include <fresco/rendering/requested_view.h>
namespace fresco::rendering {
namespace {
double aspectOf(const PictureOptions& options) { return static_cast<double>(options.width) / options.height; }

Eigen::Vector3d middle(const Subject& subject)
{
  const Points& points = subject.points ? subject.points->points : subject.mesh->vertices;
  Eigen::AlignedBox3d box;
  for (const Index i : finiteColumns(points))
    box.extend(points.col(i).cast<double>());
  require(!box.isEmpty(), "the model has no finite point");
  return (subject.points ? subject.points->origin : subject.mesh->origin) + box.center();
}

Viewpoint wholeModelView(const ViewRequest& request, const Subject& subject, const PictureOptions& options)
{
  Framing framing;
  framing.up = request.up.value_or(framing.up);
  framing.direction = viewDirection(request.view, framing.up);
  framing.angle = request.angle.value_or(framing.angle);
  framing.aspect = aspectOf(options);
  return subject.points ? frameView(*subject.points, framing) : frameView(*subject.mesh, framing);
}

Viewpoint indoorView(const ViewRequest& request, const TriangleMesh* room, const PictureOptions& picture)
{
  require(room, "view ", request.view, " needs a mesh with faces; room names one");
  IndoorOptions options;
  options.up = request.up;
  options.threads = picture.threads;
  options.aspect = aspectOf(picture);
  Viewpoint view;
  if (request.view == "above") {
    view = aboveView(*room, options);
  } else {
    const std::optional<Viewpoint> inside = insideView(*room, options);
    require(inside.has_value(), "no free space found inside the model: give eye and look");
    view = *inside;
  }
  view.angle = request.angle.value_or(view.angle);
  return view;
}
} // namespace

Viewpoint requestedView(const ViewRequest& request, const Subject& subject, const TriangleMesh* room,
                        const PictureOptions& options)
{
  if (!request.eye && (request.view == "inside" || request.view == "above"))
    return indoorView(request, room ? room : subject.mesh, options);
  if (!request.eye)
    return wholeModelView(request, subject, options);
  Viewpoint view;
  view.eye = *request.eye;
  view.look = request.look ? *request.look : middle(subject);
  view.up = request.up.value_or(view.up);
  view.angle = request.angle.value_or(view.angle);
  return view;
}
} // namespace fresco::rendering
