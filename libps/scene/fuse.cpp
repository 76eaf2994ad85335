// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/fuse.h"

#include <future>
#include <string>
#include <system_error>

#include "libps/core/clock.h"
#include "libps/core/error.h"

namespace ps {

Cloud fuse(const ViewSource& source, const FuseOptions& options, FuseReport* report,
           const std::function<bool(std::size_t, std::size_t)>& progress) {
  if (source.count > 0 && !source.load) throw Error("fuse", "the source cannot load", "a load()");
  if (source.count > UINT16_MAX + std::size_t{1}) {
    throw Error("fuse", std::to_string(source.count) + " views", "at most 65536");
  }
  FuseReport local;
  FuseReport& sum = report ? *report : local;
  sum = {};
  SceneCloud scene(options.cloud);
  std::future<View> next;
  // The next view is loaded while this one is added.
  const auto start_loading = [&](std::size_t i) {
    try {
      if (i < source.count) next = std::async(std::launch::async, source.load, i);
    } catch (const std::system_error& error) {
      throw Error("fuse", std::string("no thread to load views: ") + error.what());
    }
  };
  start_loading(0);
  for (std::size_t i = 0; i < source.count; ++i) {
    const auto before_load = now();
    const View view = next.get();
    start_loading(i + 1);
    sum.load_seconds += seconds_since(before_load);
    if (view.depth.empty()) {
      ++sum.empty;
    } else {
      const auto before_add = now();
      sum.pixels += scene.add(view, static_cast<std::uint16_t>(i));
      sum.add_seconds += seconds_since(before_add);
      ++sum.views;
    }
    if (progress && !progress(i + 1, source.count)) throw Error("fuse", "stopped");
  }
  if (options.remove_contradicted) sum.contradicted = scene.remove_contradicted();
  sum.points = scene.size();
  return scene.cloud();
}

}  // namespace ps
