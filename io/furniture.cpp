// SPDX-License-Identifier: BSD-3-Clause
#include "io/furniture.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "io/bytes.h"
#include "io/text.h"
#include "io/zip_archive.h"
#include "libps/core/parallel.h"

namespace ps {
namespace {

using Properties = std::map<std::string, std::string>;

constexpr const char* kList = "PluginFurnitureCatalog.properties";
constexpr std::size_t kMostBytes = std::size_t{64} << 20;  // of one file, unpacked
constexpr std::size_t kMostModels = 100000;
constexpr std::array<double, 9> kUpright = {1, 0, 0, 0, 1, 0, 0, 0, 1};

void append_utf8(std::string& text, unsigned code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += {static_cast<char>(0xC0 | code >> 6), static_cast<char>(0x80 | (code & 0x3F))};
  } else {
    text += {static_cast<char>(0xE0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3F)),
             static_cast<char>(0x80 | (code & 0x3F))};
  }
}

/// @return Latin-1 with Java's \uXXXX as UTF-8
std::string unescaped(std::string_view raw) {
  std::string text;
  for (std::size_t i = 0; i < raw.size(); ++i) {
    unsigned code = static_cast<unsigned char>(raw[i]);
    if (code == '\\' && i + 1 < raw.size()) {
      code = static_cast<unsigned char>(raw[++i]);
      const std::string_view digits = raw.substr(i + 1, 4);
      const char* const end = digits.data() + digits.size();
      if (code == 'u' && std::from_chars(digits.data(), end, code, 16).ptr == end) i += 4;
    }
    append_utf8(text, code);
  }
  return text;
}

/// Java's java.util.Properties, as far as catalogues use it: one `key=value` a line.
Properties parse_properties(std::string_view text) {
  Properties properties;
  LineReader lines(text, kList);
  for (std::string_view line; lines.next_content(line);) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    properties[std::string(trimmed(line.substr(0, equals)))] =
        unescaped(trimmed(line.substr(equals + 1)));
  }
  return properties;
}

/// One model's lines of a catalogue, `key#number`.
class Entry {
 public:
  Entry(const Properties& properties, std::size_t number)
      : properties_(properties), suffix_("#" + std::to_string(number)) {}

  /// @return empty when the catalogue does not say
  std::string text(const std::string& key) const {
    const auto found = properties_.find(key + suffix_);
    return found == properties_.end() ? "" : found->second;
  }

  /// Throws ps::Error when the catalogue does not give `n` finite numbers.
  template <std::size_t n>
  std::array<double, n> numbers(const std::string& key) const {
    std::array<double, n> values;
    const std::string all = text(key);
    std::string_view rest = all;
    for (double& value : values) {
      const auto read = to_number<double>(next_token(rest));
      if (!read || !std::isfinite(*read)) {
        throw Error(kList, key + suffix_ + " is " + in_quotes(all),
                    std::to_string(n) + (n == 1 ? " number" : " numbers"));
      }
      value = *read;
    }
    return values;
  }

  /// @return a length in metres; catalogues hold centimetres
  double metres(const std::string& key) const { return numbers<1>(key)[0] / 100; }

 private:
  const Properties& properties_;
  std::string suffix_;
};

/// Turns a model, then makes it `size` metres large, its base centred on the origin.
/// @param turn  rows of a matrix, which turns column vectors
void place(rooms::Model& model, const std::array<double, 9>& turn,
           const std::array<double, 3>& size) {
  constexpr float kMost = std::numeric_limits<float>::max();
  std::array<float, 3> least = {kMost, kMost, kMost}, most = {-kMost, -kMost, -kMost};
  for (auto& p : model.positions) {
    std::array<float, 3> turned;
    for (std::size_t row = 0; row < 3; ++row) {
      const double* r = &turn[3 * row];
      turned[row] = static_cast<float>(r[0] * p[0] + r[1] * p[1] + r[2] * p[2]);
      least[row] = std::min(least[row], turned[row]);
      most[row] = std::max(most[row], turned[row]);
    }
    p = turned;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double extent = static_cast<double>(most[axis]) - least[axis];
    const double scale = extent > 0 ? size[axis] / extent : 0;
    const double base = axis == 1 ? least[axis] : least[axis] + extent / 2;
    for (auto& p : model.positions) p[axis] = static_cast<float>((p[axis] - base) * scale);
  }
}

/// @return `file` beside the archive's entry `beside`; both without a leading slash
std::string beside(const std::string& entry, const std::string& file) {
  return (std::filesystem::path(entry).parent_path() / file).lexically_normal().string();
}

rooms::Model read_model(const ZipArchive& archive, const Entry& entry, const ObjOptions& options) {
  std::string file = entry.text("model");
  if (file.substr(0, 1) == "/") file.erase(0, 1);
  const auto open = [&](const std::string& name) -> std::optional<std::string> {
    const std::string wanted = beside(file, name);
    if (!archive.has(wanted)) return std::nullopt;
    return archive.read(wanted, kMostBytes);
  };
  rooms::Model model = parse_obj(archive.read(file, kMostBytes), file, open, options);
  model.name = entry.text("name");
  model.category = entry.text("category");
  model.door_or_window = entry.text("doorOrWindow") == "true";
  if (!entry.text("elevation").empty()) {
    model.elevation = static_cast<float>(entry.metres("elevation"));
  }
  const std::array<double, 3> size = {entry.metres("width"), entry.metres("height"),
                                      entry.metres("depth")};
  if (*std::min_element(size.begin(), size.end()) <= 0) throw Error(file, "has no size");
  const bool turned = !entry.text("modelRotation").empty();
  place(model, turned ? entry.numbers<9>("modelRotation") : kUpright, size);
  return model;
}

/// A model, or why it is left out.
struct Taken {
  std::optional<rooms::Model> model;
  FurnitureCredit credit;
  std::string left_out;
};

Taken take(const ZipArchive& archive, const Properties& list, std::size_t number,
           const std::string& name, const ObjOptions& options) {
  const Entry entry(list, number);
  const auto of_all = [&](const std::string& key) {
    const auto found = list.find(key);
    return found == list.end() ? "" : found->second;
  };
  Taken taken;
  const std::string own = entry.text("license");
  taken.credit = {of_all("name"), entry.text("creator"), own.empty() ? of_all("license") : own, 1};
  if (!is_free_licence(taken.credit.licence)) {
    taken.left_out = name + ": " + in_quotes(entry.text("name")) +
                     " has no free licence: " + in_quotes(taken.credit.licence, 100);
    return taken;
  }
  try {
    taken.model = read_model(archive, entry, options);
  } catch (const Error& error) {
    taken.left_out = name + ": " + error.what();
  }
  return taken;
}

void append(Furniture& all, std::vector<Taken>& taken) {
  std::map<std::tuple<std::string, std::string, std::string>, int> credits;
  for (const FurnitureCredit& c : all.credits)
    credits[{c.catalogue, c.creator, c.licence}] = c.models;
  for (Taken& one : taken) {
    if (!one.model) {
      all.left_out.push_back(one.left_out);
      continue;
    }
    all.models.push_back(std::move(*one.model));
    ++credits[{one.credit.catalogue, one.credit.creator, one.credit.licence}];
  }
  all.credits.clear();
  for (const auto& [who, models] : credits) {
    all.credits.push_back({std::get<0>(who), std::get<1>(who), std::get<2>(who), models});
  }
}

void append_catalogue(Furniture& all, std::string_view bytes, const std::string& name,
                      const ObjOptions& options) {
  const ZipArchive archive(bytes, name);
  const Properties list = parse_properties(archive.read(kList, kMostBytes));
  std::size_t count = 0;
  while (count < kMostModels && !Entry(list, count + 1).text("model").empty()) ++count;
  if (count == 0) throw Error(name, std::string(kList) + " names no model", "model#1=...");
  std::vector<Taken> taken(count);
  parallel_chunks(count, 16, [&](std::size_t begin, std::size_t end) {
    const ZipArchive own(bytes, name);  // an archive is read by one thread
    for (std::size_t i = begin; i < end; ++i) taken[i] = take(own, list, i + 1, name, options);
  });
  append(all, taken);
}

}  // namespace

bool is_free_licence(std::string_view licence) {
  std::string text;  // in lower case, one blank for whatever stands between words
  for (const char c : licence) {
    const bool word = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (word) text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!word && !text.empty() && text.back() != ' ') text += ' ';
  }
  const auto says = [&](const char* part) { return text.find(part) != std::string::npos; };
  for (const char* more : {"commercial", "deriv", "share", "by nc", "by nd", "by sa", "not "}) {
    if (says(more)) return false;
  }
  return says("public domain") || says("cc0") || says("cc 0") || says("cc by") ||
         says("creative commons attribution");
}

Furniture parse_furniture(std::string_view bytes, const std::string& name,
                          const ObjOptions& options) {
  return guarded(name, [&] {
    Furniture all;
    append_catalogue(all, bytes, name, options);
    return all;
  });
}

Furniture read_furniture(const std::filesystem::path& path, const ObjOptions& options) {
  return guarded(path.string(), [&] {
    std::vector<std::filesystem::path> files = {path};
    if (std::filesystem::is_directory(path)) {
      files.clear();
      for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (extension_of(entry.path()) == ".sh3f") files.push_back(entry.path());
      }
      std::sort(files.begin(), files.end());
    }
    if (files.empty()) throw Error(path.string(), "holds no catalogue", "files called *.sh3f");
    Furniture all;
    for (const auto& file : files) {
      append_catalogue(all, FileBytes(file).view(), file.filename().string(), options);
    }
    return all;
  });
}

}  // namespace ps
