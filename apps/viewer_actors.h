// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtkActor.h>
#include <vtkSmartPointer.h>

#include <vector>

#include "apps/point_colors.h"

namespace ps::apps {

/// @brief The cloud's points, without colours yet.
vtkSmartPointer<vtkActor> make_points(const Cloud& cloud);

/// @param colors  one for each point of make_points()
void set_colors(vtkActor& points, const std::vector<Rgb>& colors);

/// @brief A wire pyramid for each pose and a line through their centres.
/// @param length  metres from a pyramid's tip to its base
/// @param eye  where one looks from; a pyramid whose tip is within two lengths would hide the scene
/// and is left out
vtkSmartPointer<vtkActor> make_frusta(const std::vector<Pose>& poses, const Intrinsics& lens,
                                      double length, const Eigen::Vector3d& eye);

}  // namespace ps::apps
