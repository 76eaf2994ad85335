// SPDX-License-Identifier: BSD-3-Clause
#include "apps/scene_work.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>

#include "io/atomic_file.h"
#include "io/bytes.h"
#include "io/safetensors.h"
#include "libps/core/error.h"

namespace fs = std::filesystem;

namespace ps::apps {
namespace {

/// FNV-1a, 64 bits.
std::uint64_t hash_of(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 1099511628211u;
  return hash;
}

/// Whatever the result depends on, as text; how it is computed and where it goes does not count.
std::string key_of(Json settings, const std::vector<fs::path>& inputs) {
  settings.erase("threads");
  for (const char* name : {"resume", "output"}) settings["options"].erase(name);
  for (const fs::path& input : inputs) {
    settings["inputs"][input.string()] = hash_of(FileBytes(input).view());
  }
  return settings.dump(2, ' ', false, Json::error_handler_t::replace);
}

template <class Pixel>
FileTensor tensor_of(const cv::Mat_<Pixel>& image, const char* dtype, std::size_t channels) {
  FileTensor tensor{
      dtype,
      {static_cast<std::size_t>(image.rows), static_cast<std::size_t>(image.cols), channels},
      {}};
  tensor.bytes.resize(image.total() * sizeof(Pixel));
  std::memcpy(tensor.bytes.data(), image.data, tensor.bytes.size());
  return tensor;
}

template <class Pixel>
cv::Mat_<Pixel> image_of(const TensorMap& tensors, const std::string& name,
                         const std::string& where) {
  const auto found = tensors.find(name);
  if (found == tensors.end() || found->second.shape.size() != 3 ||
      found->second.bytes.size() !=
          found->second.shape[0] * found->second.shape[1] * sizeof(Pixel)) {
    throw Error(where, "holds no " + name + " that could be gone on with",
                "a run without --resume");
  }
  const FileTensor& tensor = found->second;
  cv::Mat_<Pixel> image(static_cast<int>(tensor.shape[0]), static_cast<int>(tensor.shape[1]));
  std::memcpy(image.data, tensor.bytes.data(), tensor.bytes.size());
  return image;
}

void remove_folder(const fs::path& folder) {
  std::error_code failed;
  fs::remove_all(folder, failed);
  if (failed) throw Error(folder.string(), "cannot be removed: " + failed.message());
}

}  // namespace

SceneWork::SceneWork(const fs::path& output, const Json& settings,
                     const std::vector<fs::path>& inputs, bool resume) {
  const std::string key = key_of(settings, inputs);
  folder_ = fs::absolute(output).lexically_normal();
  if (!folder_.has_filename()) folder_ = folder_.parent_path();
  folder_ += ".work";
  const fs::path key_file = folder_ / "made-from.json";
  std::error_code ignored;
  const bool there = fs::exists(key_file, ignored);
  if (there && resume && FileBytes(key_file).view() != key) {
    throw Error(folder_.string(), "is of a run with other settings, inputs or weights",
                "the same command, or one without --resume");
  }
  if (!there && fs::exists(folder_, ignored) && !fs::is_empty(folder_, ignored)) {
    throw Error(folder_.string(), "is there, and is not of a scene", "another --output");
  }
  if (!there || !resume) {
    remove_folder(folder_);
    std::error_code failed;
    fs::create_directory(folder_, failed);
    if (failed) throw Error(folder_.string(), failed.message(), "a folder that can be made");
    AtomicFile file(key_file);
    file.write(key);
    file.commit();
  }
}

SceneWork::~SceneWork() {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    if (entry.path().extension() == ".safetensors") return;
  }
  fs::remove_all(folder_, ignored);
}

fs::path SceneWork::file(std::size_t number) const {
  return folder_ / (std::to_string(number) + ".safetensors");
}

bool SceneWork::load(std::size_t number, SupportView& support, Json& report) const {
  const fs::path path = file(number);
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return false;
  const TensorMap tensors = read_safetensors(path);
  support.view.color = image_of<cv::Vec3f>(tensors, "color", path.string());
  support.view.depth = image_of<float>(tensors, "depth", path.string());
  support.pixels = image_of<std::uint8_t>(tensors, "pixels", path.string());
  report = Json::parse(read_safetensors_metadata(path)["report"], nullptr, false);
  if (!report.is_object()) throw Error(path.string(), "holds no report", "a run without --resume");
  return true;
}

void SceneWork::save(std::size_t number, const SupportView& support, const Json& report) {
  write_safetensors(file(number),
                    {{"color", tensor_of(support.view.color, "F32", 3)},
                     {"depth", tensor_of(support.view.depth, "F32", 1)},
                     {"pixels", tensor_of(support.pixels, "U8", 1)}},
                    {{"report", report.dump()}});
}

void SceneWork::finish() { remove_folder(folder_); }

}  // namespace ps::apps
