// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace ps {

/// @return a number for people, with so many significant digits at most, as printf's %g has it:
/// "0.25", "1e-07", "inf", "nan"
std::string in_digits(double value, int digits = 6);

/// @return "1 pair", "2 pairs"; with `many`, "1 axis", "2 axes"
std::string counted(std::size_t count, const std::string& one, const std::string& many = "");

}  // namespace ps
