// SPDX-License-Identifier: BSD-3-Clause
#include "apps/output.h"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <system_error>

#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

void check_parent(const fs::path& path) {
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code ignored;
  if (!fs::is_directory(parent, ignored)) {
    throw Error(path.string(), "the folder " + parent.string() + " does not exist",
                "a path in an existing folder");
  }
  if (access(parent.c_str(), W_OK | X_OK) != 0) {
    throw Error(path.string(), "the folder " + parent.string() + " cannot be written");
  }
}

/// `frame_00012.png` -> `frame_#.png`; a name without a number of five digits or more -> "".
std::string series_of(const fs::path& file) {
  const std::string name = file.filename().string();
  const auto digit = [](unsigned char c) { return std::isdigit(c) != 0; };
  const auto first = std::find_if(name.begin(), name.end(), digit);
  const auto last = std::find_if_not(first, name.end(), digit);
  if (last - first < 5) return "";
  return std::string(name.begin(), first) + '#' + std::string(last, name.end());
}

/// Runs `task`; failures of the file system become ps::Error, naming `path`.
template <class Task>
auto on_files(const fs::path& path, Task task) try {
  return task();
} catch (const fs::filesystem_error& error) {
  const fs::path& culprit = error.path1().empty() ? path : error.path1();
  throw Error(culprit.string(), error.code().message());
}

/// Throws ps::Error where merge() would meet a file in place of a folder or the other way round, so
/// that nothing is moved then.
void check_merge(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path place = to / entry.path().filename();
    if (!fs::exists(place)) continue;
    if (entry.is_directory() != fs::is_directory(place)) {
      throw Error(place.string(), entry.is_directory() ? "is a file" : "is a folder",
                  entry.is_directory() ? "a folder" : "a file");
    }
    if (entry.is_directory()) check_merge(entry.path(), place);
  }
}

void merge(const fs::path& from, const fs::path& to) {
  std::set<std::string> series;
  for (const auto& entry : fs::directory_iterator(from)) series.insert(series_of(entry.path()));
  series.erase("");
  for (const auto& entry : fs::directory_iterator(to)) {
    const bool ours = entry.is_regular_file() && series.count(series_of(entry.path())) > 0;
    if (ours && !fs::exists(from / entry.path().filename())) fs::remove(entry.path());
  }
  for (const auto& entry : fs::directory_iterator(from)) {
    const fs::path place = to / entry.path().filename();
    if (entry.is_directory() && fs::is_directory(place)) {
      merge(entry.path(), place);
    } else {
      fs::rename(entry.path(), place);
    }
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& target) : target_(target) {
  std::error_code ignored;
  if (fs::exists(target / "color", ignored) && fs::exists(target / "depth", ignored)) {
    throw Error(target.string(), "holds RGB-D frames, whose trajectory would be replaced",
                "another output folder");
  }
  if (!target_.has_filename()) target_ = target_.parent_path();  // OUT/ is OUT
  if (target_.empty()) throw Error("output", "the folder's name is empty");
  on_files(target_, [this] {
    if (fs::exists(target_) && !fs::is_directory(target_)) {
      throw Error(target_.string(), "is a file", "a folder, or a path where nothing is yet");
    }
    const fs::path whole = fs::absolute(target_).lexically_normal();
    target_ = whole.has_filename() ? whole : whole.parent_path();
  });
  check_parent(target_);
  partial_ = target_;
  partial_ += ".partial-" + std::to_string(getpid());
  std::error_code failure;
  const bool made = fs::create_directory(partial_, failure);
  if (failure) throw Error(partial_.string(), failure.message());
  if (!made) throw Error(partial_.string(), "is there already, of a run that was ended; remove it");
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
}

fs::path OutputFolder::file(const std::string& name) {
  const fs::path path = partial_ / name;
  on_files(path, [&] { fs::create_directories(path.parent_path()); });
  return path;
}

void OutputFolder::commit() {
  on_files(target_, [this] {
    if (fs::is_directory(target_)) {
      check_merge(partial_, target_);
      merge(partial_, target_);
      fs::remove_all(partial_);
    } else {
      fs::rename(partial_, target_);
    }
  });
}

void check_output_file(const fs::path& path, const std::vector<std::string>& extensions) {
  std::string choices;
  for (const std::string& extension : extensions) {
    choices += (choices.empty() ? "" : " or ") + extension;
  }
  const auto match = std::find(extensions.begin(), extensions.end(), extension_of(path));
  if (!extensions.empty() && match == extensions.end()) {
    throw Error(path.string(), "is no kind of file that can be written here",
                "a name ending in " + choices);
  }
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw Error(path.string(), "is a folder", "a file");
  check_parent(path);
}

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

fs::path beside(const fs::path& path, const std::string& name) {
  return path.parent_path() / (path.stem().string() + "." + name);
}

}  // namespace ps::apps
