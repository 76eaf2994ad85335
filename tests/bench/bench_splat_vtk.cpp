// SPDX-License-Identifier: BSD-3-Clause
// VTK's own point rendering, off screen: plain points as wide as a splat (what pcl::visualization
// draws), and vtkPointGaussianMapper, its soft splat. Both need an X display (xvfb-run); without a
// GPU, Mesa's llvmpipe draws, on all cores. The cloud is uploaded before the clock starts; a round
// is one Render() and reading the pixels back. Neither orders its points, so blending is not by
// depth.
#include <benchmark/benchmark.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPointGaussianMapper.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <cmath>
#include <cstdlib>

#include "splat_case.h"

namespace ps::bench {
namespace {

vtkSmartPointer<vtkPolyData> poly_data(const Cloud& cloud) {
  const auto count = static_cast<vtkIdType>(cloud.size());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(count);
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(count);
  vtkNew<vtkCellArray> vertices;
  for (vtkIdType i = 0; i < count; ++i) {
    const Point& p = cloud[i];
    points->SetPoint(i, p.x, p.y, p.z);
    colors->SetTuple3(i, p.r, p.g, p.b);
    vertices->InsertNextCell(1, &i);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetVerts(vertices);
  data->GetPointData()->SetScalars(colors);
  return data;
}

void aim(vtkCamera& camera, const SplatCase& given) {
  const Eigen::Vector3d position = given.world_from_cam.translation();
  const Eigen::Vector3d focus = given.world_from_cam * Eigen::Vector3d(0, 0, 1);
  const Eigen::Vector3d up = given.world_from_cam.linear() * Eigen::Vector3d(0, -1, 0);
  camera.SetPosition(position.data());
  camera.SetFocalPoint(focus.data());
  camera.SetViewUp(up.data());
  camera.SetViewAngle(2 * std::atan(given.intrinsics.height / 2.0 / given.intrinsics.fy) * 180 /
                      M_PI);
  camera.SetClippingRange(0.05, 20);
}

void render(benchmark::State& state, const SplatCase& given, vtkMapper& mapper,
            bool translucent = false) {
  vtkNew<vtkActor> actor;
  actor->SetForceTranslucent(translucent);
  actor->SetMapper(&mapper);
  actor->GetProperty()->SetPointSize(static_cast<float>(2 * given.radius + 1));
  actor->GetProperty()->SetLighting(false);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  aim(*renderer->GetActiveCamera(), given);
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  const int width = given.intrinsics.width, height = given.intrinsics.height;
  window->SetSize(width, height);
  window->AddRenderer(renderer);

  vtkNew<vtkUnsignedCharArray> pixels;
  const auto draw = [&] {
    window->Render();
    window->GetRGBACharPixelData(0, 0, width - 1, height - 1, 0, pixels);
  };
  draw();
  for (auto _ : state) draw();

  double covered = 0;
  for (vtkIdType i = 0; i < pixels->GetNumberOfTuples(); ++i) {
    const double* rgba = pixels->GetTuple4(i);
    covered += rgba[0] + rgba[1] + rgba[2] > 0 ? 1 : 0;
  }
  report(state, given, covered);
}

bool without_display(benchmark::State& state) {
  if (std::getenv("DISPLAY") != nullptr) return false;
  state.SkipWithError("VTK needs an X display: run under xvfb-run -a");
  return true;
}

void vtk_points(benchmark::State& state) {
  if (without_display(state)) return;
  const SplatCase& given = splat_case(state);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(poly_data(*given.cloud));
  render(state, given, *mapper);
}
BENCHMARK(vtk_points)->Apply(peer_cases);

void vtk_point_gaussian(benchmark::State& state) {
  if (without_display(state)) return;
  const SplatCase& given = splat_case(state);
  vtkNew<vtkPointGaussianMapper> mapper;
  mapper->SetInputData(poly_data(*given.cloud));
  // A splat reaches three of these: `radius` pixels at the room's middle, three metres away.
  mapper->SetScaleFactor(3.0 * given.radius / given.intrinsics.fx / 3);
  mapper->EmissiveOff();
  render(state, given, *mapper, true);
}
BENCHMARK(vtk_point_gaussian)->Apply(peer_cases);

}  // namespace
}  // namespace ps::bench
