// SPDX-License-Identifier: BSD-3-Clause
#include "apps/viewer_actors.h"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <numeric>

namespace ps::apps {
namespace {

/// @return the index of the pyramid's tip
vtkIdType add_pyramid(vtkPoints& points, vtkCellArray& lines, const Pose& pose,
                      const Intrinsics& lens, double length) {
  const auto insert = [&](const Eigen::Vector3d& in_cam) {
    const Eigen::Vector3d p = pose * in_cam;
    return points.InsertNextPoint(p.x(), p.y(), p.z());
  };
  const vtkIdType tip = insert(Eigen::Vector3d::Zero());
  const double right = lens.width - 0.5, bottom = lens.height - 0.5;
  vtkIdType base[4] = {
      insert(lens.lift(-0.5, -0.5, length)), insert(lens.lift(right, -0.5, length)),
      insert(lens.lift(right, bottom, length)), insert(lens.lift(-0.5, bottom, length))};
  for (int i = 0; i < 4; ++i) {
    const vtkIdType side[2] = {tip, base[i]}, edge[2] = {base[i], base[(i + 1) % 4]};
    lines.InsertNextCell(2, side);
    lines.InsertNextCell(2, edge);
  }
  return tip;
}

}  // namespace

vtkSmartPointer<vtkActor> make_points(const Cloud& cloud) {
  const auto count = static_cast<vtkIdType>(cloud.size());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(count);
  auto* xyz = static_cast<float*>(points->GetVoidPointer(0));
  for (const Point& point : cloud) xyz = std::copy_n(point.data, 3, xyz);

  // All points are one cell: a cell for each costs memory and time.
  std::vector<vtkIdType> indices(cloud.size());
  std::iota(indices.begin(), indices.end(), 0);
  vtkNew<vtkCellArray> cell;
  cell->InsertNextCell(count, indices.data());

  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(cell);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  return actor;
}

void set_colors(vtkActor& points, const std::vector<Rgb>& colors) {
  vtkNew<vtkUnsignedCharArray> scalars;
  scalars->SetNumberOfComponents(3);
  scalars->SetNumberOfTuples(static_cast<vtkIdType>(colors.size()));
  std::uint8_t* out = scalars->GetPointer(0);
  for (const Rgb& color : colors) out = std::copy(color.begin(), color.end(), out);
  auto* mapper = static_cast<vtkPolyDataMapper*>(points.GetMapper());
  mapper->GetInput()->GetPointData()->SetScalars(scalars);
}

vtkSmartPointer<vtkActor> make_frusta(const std::vector<Pose>& poses, const Intrinsics& lens,
                                      double length, const Eigen::Vector3d& eye) {
  constexpr std::size_t kMost = 200;
  const std::size_t step = poses.size() / kMost + 1;
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> lines;
  std::vector<vtkIdType> tips;
  for (std::size_t i = 0; i < poses.size(); i += step) {
    if ((poses[i].translation() - eye).norm() < 2 * length) continue;
    tips.push_back(add_pyramid(*points, *lines, poses[i], lens, length));
  }
  if (tips.size() > 1) lines->InsertNextCell(static_cast<vtkIdType>(tips.size()), tips.data());
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetLines(lines);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(1.0, 0.85, 0.1);
  actor->GetProperty()->SetLineWidth(1.5f);
  actor->GetProperty()->LightingOff();
  return actor;
}

}  // namespace ps::apps
