// SPDX-License-Identifier: BSD-3-Clause
#include <vtkBrush.h>
#include <vtkContext2D.h>
#include <vtkContextActor.h>
#include <vtkContextItem.h>
#include <vtkContextScene.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPen.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "apps/drawing.h"
#include "apps/window_picture.h"
#include "libps/core/error.h"

namespace ps::apps {
namespace {

constexpr int kFiner = 2;  ///< drawn so many times as large and shrunk: smooth edges

/// Cuts a line into dashes.
std::vector<std::vector<cv::Point2d>> dashes(const std::vector<cv::Point2d>& line, double on,
                                             double off) {
  std::vector<std::vector<cv::Point2d>> pieces;
  double along = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const cv::Point2d way = line[i] - line[i - 1];
    const double length = std::hypot(way.x, way.y);
    double at = 0;
    while (at < length) {
      const double phase = std::fmod(along + at, on + off);
      const double next =
          std::min(length, at + (phase < on ? on - phase : on + off - phase) + 1e-6);
      if (phase < on) {
        pieces.push_back({line[i - 1] + way * (at / length), line[i - 1] + way * (next / length)});
      }
      at = next;
    }
    along += length;
  }
  return pieces;
}

/// Paints a drawing, `scale` times as large; VTK's y goes up.
class Painting : public vtkContextItem {
 public:
  static Painting* New();
  vtkTypeMacro(Painting, vtkContextItem);
  bool Paint(vtkContext2D* painter) override {
    for (const Drawing::Line& line : drawing->lines) paint(*painter, line);
    for (const Drawing::Dot& dot : drawing->dots) paint(*painter, dot);
    for (const Drawing::Text& text : drawing->texts) paint(*painter, text);
    return true;
  }
  const Drawing* drawing = nullptr;
  double scale = 1;

 private:
  cv::Point2f place(const cv::Point2d& at) const {
    return {static_cast<float>(at.x * scale), static_cast<float>((drawing->height - at.y) * scale)};
  }
  static void rgb(unsigned color, unsigned char* out) {
    for (int c = 0; c < 3; ++c) out[c] = static_cast<unsigned char>(color >> (16 - 8 * c));
  }

  void pen(vtkContext2D& painter, unsigned color, double width) const {
    unsigned char c[3];
    rgb(color, c);
    painter.GetPen()->SetColor(c[0], c[1], c[2]);
    painter.GetPen()->SetLineType(vtkPen::SOLID_LINE);
    painter.GetPen()->SetWidth(static_cast<float>(width * scale));
  }

  void paint(vtkContext2D& painter, const Drawing::Line& line) const {
    pen(painter, line.color, line.width);
    std::vector<std::vector<cv::Point2d>> pieces = {line.points};
    if (line.dashed) pieces = dashes(line.points, 6, 4);
    for (const auto& piece : pieces) {
      std::vector<cv::Point2f> points;
      for (const cv::Point2d& p : piece) points.push_back(place(p));
      painter.DrawPoly(&points.front().x, static_cast<int>(points.size()));
    }
  }

  void paint(vtkContext2D& painter, const Drawing::Dot& dot) const {
    const cv::Point2f at = place(dot.at);
    unsigned char c[3];
    rgb(dot.color, c);
    painter.GetPen()->SetLineType(vtkPen::NO_PEN);
    painter.GetBrush()->SetColor(c[0], c[1], c[2]);
    painter.GetBrush()->SetOpacity(255);
    const auto outer = static_cast<float>((dot.radius + 1) * scale);
    const auto inner = dot.hollow ? static_cast<float>((dot.radius - 1) * scale) : 0.f;
    painter.DrawEllipseWedge(at.x, at.y, outer, outer, inner, inner, 0, 360);
  }

  void paint(vtkContext2D& painter, const Drawing::Text& text) const {
    vtkTextProperty* style = painter.GetTextProp();
    style->SetFontFamilyToArial();
    style->SetFontSize(static_cast<int>(std::lround(text.size * scale)));
    style->SetBold(text.bold);
    style->SetOrientation(text.upwards ? 90 : 0);
    unsigned char c[3];
    rgb(text.color, c);
    style->SetColor(c[0] / 255.0, c[1] / 255.0, c[2] / 255.0);
    style->SetJustification(static_cast<int>(text.align));  // left, centred, right, as Align
    style->SetVerticalJustificationToBottom();
    // VTK stands words on the lowest point of their letters: the "g" keeps all on one line.
    const double drop = 0.21 * text.size;
    const cv::Point2f at =
        place(text.at + (text.upwards ? cv::Point2d(drop, 0) : cv::Point2d(0, drop)));
    painter.DrawString(at.x, at.y, text.words.c_str());
  }
};
vtkStandardNewMacro(Painting);

}  // namespace

void pixelsynth_draw(const Drawing& drawing, double scale, Image* picture) {
  vtkObject::GlobalWarningDisplayOff();
  vtkNew<Painting> painting;
  painting->drawing = &drawing;
  painting->scale = scale * kFiner;
  vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(painting);
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1, 1, 1);
  renderer->AddActor(actor);
  vtkNew<vtkRenderWindow> window;
  window->SetMultiSamples(0);
  window->SetOffScreenRendering(1);
  window->SetSize(static_cast<int>(std::lround(drawing.width * painting->scale)),
                  static_cast<int>(std::lround(drawing.height * painting->scale)));
  window->AddRenderer(renderer);
  actor->GetScene()->SetRenderer(renderer);
  if (window->SupportsOpenGL() == 0) {
    throw Error("drawing", "the display has no OpenGL 3.2",
                "one that has, or xvfb with DISPLAY unset");
  }
  const Image fine = picture_of(*window);
  cv::resize(fine, *picture, {}, 1.0 / kFiner, 1.0 / kFiner, cv::INTER_AREA);
}

}  // namespace ps::apps
