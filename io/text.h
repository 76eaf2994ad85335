// SPDX-License-Identifier: BSD-3-Clause
// Internal to the io room: lines and words of text files.
#pragma once

#include <charconv>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace ps {

/// @brief Cuts text into lines and counts them; ends of line are LF or CR LF; a byte order mark is
/// skipped.
class LineReader {
 public:
  /// @param name  what the text is called in messages
  LineReader(std::string_view text, std::string name);

  /// @return false at the end of the text
  bool next(std::string_view& line);
  /// As next(), but passes over blank lines and lines that start with `#`.
  bool next_content(std::string_view& line);
  /// @return what next() has not returned yet
  std::string_view rest() const { return rest_; }
  /// @return "name:7" when next() has returned the seventh line
  std::string where() const { return name_ + ":" + std::to_string(number_); }

 private:
  std::string_view rest_;
  std::string name_;
  std::size_t number_ = 0;
};

/// @brief Takes the next word, between blanks, off the front of `line`; empty at its end.
std::string_view next_token(std::string_view& line);

std::size_t count_tokens(std::string_view line);

/// @return `text` without the blanks around it
std::string_view trimmed(std::string_view text);

/// @return the number that `token` is, whole; empty when it is none or out of range
template <class T>
std::optional<T> to_number(std::string_view token) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  T value{};
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// @brief Takes the next number off `line`. Throws ps::Error when there is none.
/// @param what  what the number is, for the message
double take_number(std::string_view& line, const LineReader& lines, const char* what);

/// @brief As take_number(), and throws when the number is not finite.
double take_finite(std::string_view& line, const LineReader& lines, const char* what);

/// @return `text` in quotes, cut to `most` characters, without control characters: for messages
std::string in_quotes(std::string_view text, std::size_t most = 40);

/// @brief Appends the shortest text that reads back as the same number.
void append_number(std::string& text, double value);

/// @return the extension in lower case, with its dot
std::string extension_of(const std::filesystem::path& path);

}  // namespace ps
