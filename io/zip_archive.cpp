// SPDX-License-Identifier: BSD-3-Clause
#include "io/zip_archive.h"

#include <zip.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "io/text.h"
#include "libps/core/error.h"

namespace ps {
namespace {

constexpr std::size_t kAtOnce = std::size_t{1} << 20, kGlance = 4096;
constexpr std::size_t kMostAhead = std::size_t{8} << 20;  // room made for what is promised alone

/// @return libzip's words for a failure
std::string reason(zip_error_t* error) {
  std::string text = zip_error_strerror(error);
  zip_error_fini(error);
  return text;
}

zip_t* open(std::string_view bytes, const std::string& name) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const source = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  zip_t* const archive =
      source == nullptr ? nullptr : zip_open_from_source(source, ZIP_RDONLY, &error);
  if (archive != nullptr) return archive;
  if (source != nullptr) zip_source_free(source);
  throw Error(name, "cannot be unpacked: " + reason(&error), "a whole zip archive");
}

struct CloseEntry {
  void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};
using EntryFile = std::unique_ptr<zip_file_t, CloseEntry>;

}  // namespace

ZipArchive::ZipArchive(std::string_view bytes, std::string name)
    : bytes_(bytes), name_(std::move(name)), archive_(open(bytes_, name_)) {
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const auto index = static_cast<zip_uint64_t>(i);
    const char* const entry = zip_get_name(archive_.get(), index, ZIP_FL_ENC_RAW);
    if (entry != nullptr && !entries_.emplace(entry, index).second) {
      throw Error(name_, "the archive names an entry twice: " + in_quotes(entry), "it once");
    }
  }
}

void ZipArchive::Close::operator()(zip* archive) const { zip_discard(archive); }

std::string ZipArchive::read(const std::string& entry, std::size_t most) const {
  const std::string where = name_ + ", entry " + in_quotes(entry);
  const auto found = entries_.find(entry);
  zip_stat_t status;
  if (found == entries_.end() || zip_stat_index(archive_.get(), found->second, 0, &status) != 0) {
    throw Error(where, "is missing");
  }
  if (status.comp_method != ZIP_CM_STORE && status.comp_method != ZIP_CM_DEFLATE) {
    throw Error(where, "is packed in a way that is not read", "a stored or deflated one");
  }
  const std::string too_long = "is longer than " + std::to_string(most) + " bytes";
  if (status.size > most) throw Error(where, too_long, "a smaller one");
  const EntryFile file(zip_fopen_index(archive_.get(), found->second, 0));
  if (!file) throw Error(where, std::string("cannot be read: ") + zip_strerror(archive_.get()));
  std::string content;
  content.reserve(std::min<std::size_t>(status.size, kMostAhead) + kGlance);
  for (;;) {
    const std::size_t before = content.size();
    // As much as the archive promises, then a look at whether there is more.
    const std::size_t left = before < status.size ? status.size - before : kGlance;
    content.resize(before + std::min({kAtOnce, left, most - before + 1}));
    const zip_int64_t got = zip_fread(file.get(), &content[before], content.size() - before);
    if (got < 0) throw Error(where, "is damaged: " + std::string(zip_file_strerror(file.get())));
    content.resize(before + static_cast<std::size_t>(got));
    if (got == 0) return content;
    if (content.size() > most) throw Error(where, too_long, "a smaller one");
  }
}

}  // namespace ps
