// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace ps::apps {

/// @brief The head of a web page that asks nothing of the network: its browser is told to load
/// nothing but pictures within the page.
/// @param title    as HTML
/// @param style    CSS
/// @param scripts  whether those within the page may run
/// @return HTML up to and with <body>
std::string page_head(const std::string& title, const std::string& style, bool scripts);

}  // namespace ps::apps
