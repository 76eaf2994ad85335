// SPDX-License-Identifier: BSD-3-Clause
#include "io/text.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "libps/core/error.h"

namespace ps {
namespace {

bool blank(char c) { return c == ' ' || c == '\t'; }

}  // namespace

LineReader::LineReader(std::string_view text, std::string name)
    : rest_(text), name_(std::move(name)) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (rest_.substr(0, 3) == kByteOrderMark) rest_.remove_prefix(3);
}

bool LineReader::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++number_;
  return true;
}

bool LineReader::next_content(std::string_view& line) {
  while (next(line)) {
    std::string_view words = line;
    const std::string_view first = next_token(words);
    if (!first.empty() && first.front() != '#') return true;
  }
  return false;
}

std::string_view next_token(std::string_view& line) {
  std::size_t begin = 0;
  while (begin < line.size() && blank(line[begin])) ++begin;
  std::size_t end = begin;
  while (end < line.size() && !blank(line[end])) ++end;
  const std::string_view token = line.substr(begin, end - begin);
  line.remove_prefix(end);
  return token;
}

std::size_t count_tokens(std::string_view line) {
  std::size_t count = 0;
  while (!next_token(line).empty()) ++count;
  return count;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

double take_number(std::string_view& line, const LineReader& lines, const char* what) {
  const std::string_view token = next_token(line);
  const std::optional<double> value = to_number<double>(token);
  if (value) return *value;
  throw Error(lines.where(), token.empty() ? "the line ends too early" : in_quotes(token),
              std::string(what) + ", a number");
}

double take_finite(std::string_view& line, const LineReader& lines, const char* what) {
  const double value = take_number(line, lines, what);
  if (std::isfinite(value)) return value;
  throw Error(lines.where(), std::string(what) + " is not finite", "a finite number");
}

std::string in_quotes(std::string_view text, std::size_t most) {
  std::string out = "'" + std::string(text.substr(0, most)) + (text.size() > most ? "...'" : "'");
  std::replace_if(
      out.begin(), out.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
  return out;
}

void append_number(std::string& text, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, result.ptr);
}

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace ps
