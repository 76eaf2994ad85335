// SPDX-License-Identifier: BSD-3-Clause
#include "apps/viewer.h"

#include <vtkAxesActor.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkCaptionActor2D.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

#include "apps/viewer_actors.h"
#include "apps/window_picture.h"
#include "libps/core/error.h"

namespace ps::apps {
namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

constexpr const char* kHelp =
    "1 2 3 4  colour by photo, depth, view, origin\n"
    "+ -      larger, smaller points\n"
    "c        cameras on, off\n"
    "a        axes on, off (x red, y green, z blue)\n"
    "r        back to the start\n"
    "?        this help on, off\n"
    "q        quit\n"
    "mouse    left turns, middle or shift moves,\n"
    "         wheel or right goes nearer and farther";

/// Everything in the window, and what keys do to it.
class Window {
 public:
  Window(const Cloud& cloud, const ViewerOptions& options, bool visible);
  vtkRenderWindow& render_window() { return *window_; }
  void press(char key);

 private:
  void add_corner_axes();
  void add_texts();
  void color(ColorBy by);
  void resize_points(double factor);
  void reset_camera();

  const Cloud& cloud_;
  ViewerOptions options_;
  double distance_;  ///< metres to the middle of what is seen at the start
  vtkSmartPointer<vtkActor> points_;
  vtkSmartPointer<vtkActor> frusta_;
  vtkNew<vtkAxesActor> axes_;
  vtkNew<vtkTextActor> help_;
  vtkNew<vtkTextActor> status_;
  vtkNew<vtkRenderer> renderer_;
  vtkNew<vtkRenderer> corner_;
  vtkNew<vtkRenderWindow> window_;
  vtkNew<vtkCallbackCommand> follow_;
};

Window::Window(const Cloud& cloud, const ViewerOptions& options, bool visible)
    : cloud_(cloud),
      options_(options),
      distance_(median_distance(cloud, options.start)),
      points_(make_points(cloud)),
      frusta_(make_frusta(options.trajectory, options.lens, 0.03 * distance_,
                          options.start.translation())) {
  renderer_->SetBackground(0.12, 0.13, 0.15);
  renderer_->AddActor(points_);
  renderer_->AddActor(frusta_);
  frusta_->SetVisibility(options_.cameras);
  window_->SetNumberOfLayers(2);
  window_->SetMultiSamples(0);
  window_->SetOffScreenRendering(!visible);
  window_->SetSize(options_.size.width, options_.size.height);
  window_->SetWindowName(options_.title.c_str());
  window_->AddRenderer(renderer_);
  add_corner_axes();
  add_texts();
  color(options_.color_by);
  resize_points(1);
  reset_camera();
}

/// The world's axes in the lower left corner, turned as the world is.
void Window::add_corner_axes() {
  corner_->SetLayer(1);
  corner_->SetViewport(0, 0, 0.2, 0.2);
  corner_->InteractiveOff();
  corner_->AddActor(axes_);
  axes_->SetVisibility(options_.axes);
  for (vtkCaptionActor2D* label : {axes_->GetXAxisCaptionActor2D(), axes_->GetYAxisCaptionActor2D(),
                                   axes_->GetZAxisCaptionActor2D()}) {
    label->GetTextActor()->SetTextScaleModeToNone();
    label->GetCaptionTextProperty()->SetFontSize(16);
    label->GetCaptionTextProperty()->SetShadow(0);
    label->GetCaptionTextProperty()->SetItalic(0);
  }
  axes_->SetXAxisLabelText("x");
  axes_->SetYAxisLabelText("y");
  axes_->SetZAxisLabelText("z");
  window_->AddRenderer(corner_);
  follow_->SetClientData(this);
  follow_->SetCallback([](vtkObject*, unsigned long, void* self, void*) {
    auto& window = *static_cast<Window*>(self);
    double toward[3];
    window.renderer_->GetActiveCamera()->GetDirectionOfProjection(toward);
    vtkCamera* camera = window.corner_->GetActiveCamera();
    constexpr double kAway = 5;
    camera->SetFocalPoint(0, 0, 0);
    camera->SetPosition(-kAway * toward[0], -kAway * toward[1], -kAway * toward[2]);
    camera->SetViewUp(window.renderer_->GetActiveCamera()->GetViewUp());
    window.corner_->ResetCameraClippingRange();
  });
  renderer_->AddObserver(vtkCommand::StartEvent, follow_);
}

void Window::add_texts() {
  for (vtkTextActor* text : {help_.Get(), status_.Get()}) {
    text->GetTextProperty()->SetFontFamilyToCourier();
    text->GetTextProperty()->SetFontSize(15);
    text->GetTextProperty()->SetColor(1, 1, 1);
    text->GetTextProperty()->SetBackgroundColor(0, 0, 0);
    text->GetTextProperty()->SetBackgroundOpacity(0.6);
    text->GetPositionCoordinate()->SetCoordinateSystemToNormalizedDisplay();
    renderer_->AddActor2D(text);
  }
  help_->SetInput(kHelp);
  help_->GetTextProperty()->SetVerticalJustificationToTop();
  help_->SetPosition(0.02, 0.98);
  help_->VisibilityOff();
  status_->GetTextProperty()->SetJustificationToRight();
  status_->SetPosition(0.98, 0.02);
  status_->SetVisibility(window_->GetOffScreenRendering() == 0);
}

void Window::color(ColorBy by) {
  options_.color_by = by;
  set_colors(*points_, point_colors(cloud_, by, options_.start));
  const std::string name = color_names()[static_cast<std::size_t>(by)];
  status_->SetInput(
      (std::to_string(cloud_.size()) + " points, colour: " + name + "   ? help").c_str());
}

void Window::resize_points(double factor) {
  options_.point_size = std::clamp(options_.point_size * factor, 1.0, 32.0);
  points_->GetProperty()->SetPointSize(static_cast<float>(options_.point_size));
}

/// Looks as the start pose does; its y axis points down on the screen.
void Window::reset_camera() {
  const Eigen::Vector3d eye = options_.start.translation();
  const Eigen::Vector3d focus = options_.start * Eigen::Vector3d(0, 0, distance_);
  const Eigen::Vector3d up = -options_.start.linear().col(1);
  vtkCamera* camera = renderer_->GetActiveCamera();
  camera->SetPosition(eye.data());
  camera->SetFocalPoint(focus.data());
  camera->SetViewUp(up.data());
  camera->SetViewAngle(2 * kDegrees * std::atan(options_.lens.height / 2.0 / options_.lens.fy));
  renderer_->ResetCameraClippingRange();
}

void Window::press(char key) {
  if (key >= '1' && key <= '4') color(static_cast<ColorBy>(key - '1'));
  if (key == '+' || key == '=') resize_points(1.25);
  if (key == '-') resize_points(0.8);
  if (key == 'c') frusta_->SetVisibility(!frusta_->GetVisibility());
  if (key == 'a') axes_->SetVisibility(!axes_->GetVisibility());
  if (key == 'r') reset_camera();
  if (key == '?' || key == 'h') help_->SetVisibility(!help_->GetVisibility());
  window_->Render();
}

/// Turns the scene with the mouse; hands keys to the window.
class Style : public vtkInteractorStyleTrackballCamera {
 public:
  static Style* New();
  vtkTypeMacro(Style, vtkInteractorStyleTrackballCamera);
  void OnChar() override {}  // VTK's own keys: exit, stereo, wireframe, ...
  void OnKeyPress() override {
    const char key = Interactor->GetKeyCode();
    if (key == 'q' || key == 27) {
      Interactor->TerminateApp();
    } else {
      window->press(key);
    }
  }
  Window* window = nullptr;
};
vtkStandardNewMacro(Style);

void check_ready(const Cloud& cloud, vtkRenderWindow& window) {
  if (cloud.empty()) throw Error("view", "the cloud is empty", "at least one point");
  if (window.SupportsOpenGL() == 0) {
    throw Error("view", "the display has no OpenGL 3.2",
                "one that has, or xvfb with DISPLAY unset");
  }
}

}  // namespace

void pixelsynth_show(const Cloud& cloud, const ViewerOptions& options) {
  vtkObject::GlobalWarningDisplayOff();
  Window window(cloud, options, true);
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(&window.render_window());
  check_ready(cloud, window.render_window());
  vtkNew<Style> style;
  style->window = &window;
  interactor->SetInteractorStyle(style);
  window.render_window().Render();
  interactor->Start();
}

void pixelsynth_snapshot(const Cloud& cloud, const ViewerOptions& options, Image* picture) {
  vtkObject::GlobalWarningDisplayOff();
  Window window(cloud, options, false);
  check_ready(cloud, window.render_window());
  *picture = picture_of(window.render_window());
}

}  // namespace ps::apps
