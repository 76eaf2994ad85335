// SPDX-License-Identifier: BSD-3-Clause
#include "apps/output.h"

#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <set>
#include <system_error>

#include "io/atomic_file.h"
#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

/// @param shown  what the path is called in messages
void check_parent(const fs::path& path, const fs::path& shown) {
  const auto parent_of = [](const fs::path& p) {
    return p.has_parent_path() ? p.parent_path() : fs::path(".");
  };
  const std::string folder = "the folder " + parent_of(shown).string();
  std::error_code ignored;
  if (!fs::is_directory(parent_of(path), ignored)) {
    throw Error(shown.string(), folder + " does not exist", "a path in an existing folder");
  }
  if (access(parent_of(path).c_str(), W_OK | X_OK) != 0) {
    throw Error(shown.string(), folder + " cannot be written");
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

/// Runs `task`; failures of the file system become ps::WriteError.
/// @param shown  what a path is called in the message
template <class Task, class Shown>
auto on_files(Task task, Shown shown) try {
  return task();
} catch (const fs::filesystem_error& error) {
  throw WriteError(shown(error.path1()), error.code().message());
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

/// Files cannot be renamed into such a folder from beside it.
bool is_mount_point(const fs::path& folder) {
  struct stat inside = {}, outside = {};
  return stat(folder.c_str(), &inside) == 0 && S_ISDIR(inside.st_mode) &&
         stat(folder.parent_path().c_str(), &outside) == 0 && inside.st_dev != outside.st_dev;
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& target) : given_(target) {
  std::error_code ignored;
  if (fs::exists(target / "color", ignored) && fs::exists(target / "depth", ignored)) {
    throw Error(target.string(), "holds RGB-D frames, whose trajectory would be replaced",
                "another output folder");
  }
  if (!given_.has_filename()) given_ = given_.parent_path();  // OUT/ is OUT
  if (given_.empty()) {
    throw CLI::ValidationError("output", "the folder's name is empty; expected a folder");
  }
  const auto given = [this](const fs::path&) { return given_.string(); };
  on_files(
      [this] {
        if (fs::is_symlink(given_) && !fs::exists(given_)) {
          throw Error(given_.string(),
                      "is a link to " + fs::read_symlink(given_).string() + ", which is not there",
                      "a folder, or a path where nothing is yet");
        }
        if (fs::exists(given_) && !fs::is_directory(given_)) {
          throw Error(given_.string(), "is a file", "a folder, or a path where nothing is yet");
        }
        const fs::path whole = fs::absolute(given_).lexically_normal();
        target_ = whole.has_filename() ? whole : whole.parent_path();
        if (!target_.has_filename()) {
          throw Error(given_.string(), "is the root of all folders", "a folder in it");
        }
      },
      given);
  check_parent(target_, given_);
  const bool inside = is_mount_point(target_);
  const fs::path parent = inside ? target_ : target_.parent_path();
  const std::string name = inside ? "" : target_.filename().string();
  on_files([&] { partial_.emplace(parent, name); }, given);
}

std::string OutputFolder::shown(const fs::path& path) const {
  for (const fs::path& place : {partial_->path(), target_}) {
    const fs::path rest = path.lexically_relative(place);
    if (rest == ".") return given_.string();
    if (!rest.empty() && *rest.begin() != "..") return (given_ / rest).string();
  }
  return path.empty() ? given_.string() : path.string();
}

void OutputFolder::write(const std::string& name,
                         const std::function<void(const fs::path&)>& task) {
  const fs::path file = partial_->path() / name;
  on_files([&] { fs::create_directories(file.parent_path()); },
           [this](const fs::path& path) { return shown(path); });
  try {
    task(file);
  } catch (const WriteError& error) {
    if (error.file() != file.string()) throw;
    throw WriteError(shown(file), error.why());
  } catch (const Error& error) {
    const std::string message = error.what(), where = file.string() + ": ";
    if (message.rfind(where, 0) != 0) throw;
    throw Error(shown(file), message.substr(where.size()));
  }
}

void OutputFolder::clears(const std::vector<std::string>& names) {
  stale_.insert(stale_.end(), names.begin(), names.end());
}

void OutputFolder::check_places(const std::vector<std::string>& names) const {
  std::error_code ignored;
  for (const std::string& name : names) {
    const fs::path file = given_ / name, folder = file.parent_path();
    if (fs::is_directory(file, ignored)) throw Error(file.string(), "is a folder", "a file");
    if (fs::exists(folder, ignored) && !fs::is_directory(folder, ignored)) {
      throw Error(folder.string(), "is a file", "a folder");
    }
  }
}

void OutputFolder::clear_stale() const {
  for (const std::string& name : stale_) {
    const fs::path place = given_ / name, folder = place.parent_path();
    const bool series = name.find('#') != std::string::npos;
    std::vector<fs::path> found;
    if (!series) found = {place};
    if (series && fs::is_directory(folder)) {
      for (const auto& entry : fs::directory_iterator(folder)) {
        if (series_of(entry.path()) == place.filename()) found.push_back(entry.path());
      }
    }
    for (const fs::path& file : found) {
      const bool written = fs::exists(partial_->path() / file.lexically_relative(given_));
      if (!written && fs::is_regular_file(file)) fs::remove(file);
    }
    if (folder != given_ && fs::is_directory(folder) && fs::is_empty(folder)) fs::remove(folder);
  }
}

void OutputFolder::commit() {
  on_files(
      [this] {
        if (fs::is_directory(target_)) {
          check_merge(partial_->path(), given_);
          clear_stale();
          merge(partial_->path(), given_);
          fs::remove_all(partial_->path());
        } else {
          fs::rename(partial_->path(), target_);
        }
      },
      [this](const fs::path& path) { return shown(path); });
}

void check_output_file(const fs::path& path, const std::vector<std::string>& extensions) {
  std::string choices;
  for (const std::string& extension : extensions) {
    choices += (choices.empty() ? "" : " or ") + extension;
  }
  const auto match = std::find(extensions.begin(), extensions.end(), extension_of(path));
  if (!extensions.empty() && match == extensions.end()) {
    throw CLI::ValidationError(
        path.empty() ? "output" : path.string(),
        "is no kind of file that can be written here; expected a name ending in " + choices);
  }
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) throw Error(path.string(), "is a folder", "a file");
  check_parent(path, path);
}

void check_not_input(const fs::path& output, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    std::error_code ignored;
    if (fs::equivalent(output, input, ignored)) {
      throw Error(output.string(), "is " + input.string() + ", which is read", "another file");
    }
  }
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
