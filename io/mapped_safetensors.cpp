// SPDX-License-Identifier: BSD-3-Clause
#include "io/mapped_safetensors.h"

#include <sys/mman.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "io/bytes.h"
#include "io/safetensors_header.h"
#include "io/text.h"

namespace ps {

MappedSafetensors::MappedSafetensors(const std::filesystem::path& path) {
  const std::string name = path.string();
  guarded(name, [&] {
    const InputFile file(path);
    const auto read = [&](std::size_t at, void* to, std::size_t n) { file.read(at, to, n); };
    const SafetensorsHeader header = read_safetensors_header(file.size(), read, name);
    auto entries = safetensors_entries(header, file.size(), name);
    for (const SafetensorsEntry& entry : entries) {
      if (entry.begin % element_bytes(entry.dtype).value_or(1) == 0) continue;
      throw Error(name, "tensor " + in_quotes(entry.name, kLongestShown) + " is not aligned",
                  "data that begin at a multiple of an element's size");
    }
    size_ = file.size();
    data_ = file.map();
    for (SafetensorsEntry& entry : entries) {
      tensors_[entry.name] = {std::move(entry.dtype), std::move(entry.shape),
                              static_cast<const std::byte*>(data_) + entry.begin};
    }
  });
}

MappedSafetensors::~MappedSafetensors() {
  if (data_ != nullptr) munmap(data_, size_);
}

MappedSafetensors::MappedSafetensors(MappedSafetensors&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)),
      size_(other.size_),
      tensors_(std::move(other.tensors_)) {}

}  // namespace ps
