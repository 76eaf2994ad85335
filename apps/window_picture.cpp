// SPDX-License-Identifier: BSD-3-Clause
#include "apps/window_picture.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkWindowToImageFilter.h>

namespace ps::apps {

Image picture_of(vtkRenderWindow& window) {
  window.Render();
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(&window);
  grab->ReadFrontBufferOff();
  grab->Update();
  vtkImageData* grabbed = grab->GetOutput();
  const int* size = grabbed->GetDimensions();
  const cv::Mat3b bytes(size[1], size[0], static_cast<cv::Vec3b*>(grabbed->GetScalarPointer()));
  Image picture;
  bytes.convertTo(picture, CV_32F, 1 / 255.0);
  cv::flip(picture, picture, 0);  // VTK's rows go upwards
  return picture;
}

}  // namespace ps::apps
