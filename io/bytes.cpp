// SPDX-License-Identifier: BSD-3-Clause
#include "io/bytes.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace ps {

InputFile::InputFile(const std::filesystem::path& path) : name_(path.string()) {
  // O_NONBLOCK: opening a named pipe must not wait for a writer.
  descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (descriptor_ < 0 || fstat(descriptor_, &status) != 0) {
    const std::string reason = std::generic_category().message(errno);
    if (descriptor_ >= 0) close(descriptor_);
    throw Error(name_, "cannot be read (" + reason + ")", "a readable file");
  }
  if (!S_ISREG(status.st_mode)) {
    close(descriptor_);
    throw Error(name_, S_ISDIR(status.st_mode) ? "is a folder" : "is a pipe or a device", "a file");
  }
  size_ = static_cast<std::size_t>(status.st_size);
}

InputFile::~InputFile() { close(descriptor_); }

void InputFile::read(std::size_t offset, void* to, std::size_t bytes) const {
  std::size_t done = 0;
  while (done < bytes) {
    const ssize_t got = pread(descriptor_, static_cast<char*>(to) + done, bytes - done,
                              static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw Error(name_, "reading failed: " + std::generic_category().message(errno));
    if (got == 0) throw Error(name_, "became shorter while it was read");
    done += static_cast<std::size_t>(got);
  }
}

void* InputFile::map() const {
  if (size_ == 0) return nullptr;
  void* const data = mmap(nullptr, size_, PROT_READ, MAP_SHARED, descriptor_, 0);
  if (data != MAP_FAILED) return data;
  throw Error(name_, "cannot be mapped: " + std::generic_category().message(errno));
}

FileBytes::FileBytes(const std::filesystem::path& path) {
  const InputFile file(path);
  if (file.size() == 0) throw Error(path.string(), "is empty", "a file with content");
  size_ = file.size();
  data_.reset(new char[size_]);  // not set to zero first: files may be large
  file.read(0, data_.get(), size_);
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  return text;
}

}  // namespace ps
