// SPDX-License-Identifier: BSD-3-Clause
#include "apps/page_head.h"

namespace ps::apps {

std::string page_head(const std::string& title, const std::string& style, bool scripts) {
  const std::string allowed = std::string("default-src 'none'; img-src data:; ") +
                              (scripts ? "script-src 'unsafe-inline'; " : "") +
                              "style-src 'unsafe-inline'";
  return R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content=")html" +
         allowed + "\">\n<title>" + title + "</title>\n<style>\n" + style +
         "</style>\n</head>\n<body>\n";
}

}  // namespace ps::apps
