// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/budget.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "libps/core/error.h"
#include "libps/core/image.h"
#include "libps/eval/image_metrics.h"
#include "libps/scene/closed_splat.h"
#include "libps/scene/thinner.h"

namespace ps {
namespace {

constexpr std::size_t kPictures = 8;  ///< that a target of PSNR is judged by
constexpr int kHalvings = 3;          ///< of the distance within which all may merge

void check(const std::vector<PlannedView>& views, const BudgetOptions& o) {
  for (std::size_t i = 0; i < views.size(); ++i) {
    const std::string where = "planned view " + std::to_string(i);
    check(views[i].intrinsics, where);
    checked_pose(views[i].world_from_cam.matrix(), where);
  }
  const auto refuse = [](const char* option, double value, const char* expected) {
    throw Error(std::string("budget, ") + option, std::to_string(value), expected);
  };
  if (!(o.radius > 0 && o.radius <= 64)) refuse("radius", o.radius, "above 0, at most 64 pixels");
  if (!(o.pixels > 0 && o.pixels <= o.radius)) {
    refuse("pixels", o.pixels, "above 0, at most the splats' radius");
  }
  if (!(o.spacing > 0 && o.spacing <= 1)) refuse("spacing", o.spacing, "above 0, at most 1 radius");
  if (!(o.tolerance >= 0 && o.tolerance <= 1)) refuse("tolerance", o.tolerance, "0 to 1");
  if (!(o.psnr >= 0 && std::isfinite(o.psnr))) refuse("psnr", o.psnr, "dB, or 0 for no target");
}

/// Pictures of the whole cloud, for those of thinned ones to be held against.
class Pictures {
 public:
  Pictures(const Cloud& cloud, const std::vector<PlannedView>& views, float radius, Meter* meter)
      : meter_(meter) {
    options_.radius = radius;
    options_.renormalise = true;
    const std::size_t count = std::min(kPictures, views.size());
    for (std::size_t i = 0; i < count; ++i) {
      views_.push_back(views[(2 * i + 1) * views.size() / (2 * count)]);
      whole_.push_back(draw(cloud, views_.back()));
    }
  }

  /// @return dB, of the view where it is least; infinite where the whole cloud hits none
  double worst_psnr(const Cloud& cloud) const {
    double worst = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const Splat picture = draw(cloud, views_[i]);
      worst = std::fmin(worst, psnr(picture.color, whole_[i].color, whole_[i].hit));
    }
    return worst;
  }

 private:
  Splat draw(const Cloud& cloud, const PlannedView& view) const {
    meter_->add(0);
    return closed_splat(cloud, view.intrinsics, view.world_from_cam, options_);
  }

  Meter* const meter_;
  SplatOptions options_;
  std::vector<PlannedView> views_;
  std::vector<Splat> whole_;
};

Point point_of(const Sample& sample, const Cloud& cloud) {
  Point p = cloud[sample.point];
  if (sample.weight <= 1) return p;
  p.r = to_byte(sample.color.x() / 255);
  p.g = to_byte(sample.color.y() / 255);
  p.b = to_byte(sample.color.z() / 255);
  // Those that are spread unevenly need more than their share to cover all, but not beyond the end
  // of a surface.
  constexpr float kUneven = 1.5f, kBeyond = 2.4f;  // by trial: PSNR of thinned clouds
  const float to_end = sample.clear + sample.footprint / 2;
  const float most = std::min(kBeyond * sample.spread, to_end);
  p.footprint = std::max(sample.footprint, std::min(kUneven * std::sqrt(sample.area), most));
  return p;
}

/// @param others  numbers of points that stay as they are
Cloud cloud_of(const Cloud& cloud, const std::vector<Sample>& samples,
               const std::vector<std::uint32_t>& others) {
  std::vector<std::pair<std::uint32_t, const Sample*>> order;
  order.reserve(samples.size() + others.size());
  for (const Sample& sample : samples) order.emplace_back(sample.point, &sample);
  for (const std::uint32_t point : others) order.emplace_back(point, nullptr);
  std::sort(order.begin(), order.end());
  Cloud result;
  result.reserve(order.size());
  for (const auto& [point, sample] : order) {
    result.push_back(sample ? point_of(*sample, cloud) : cloud[point]);
  }
  return result;
}

/// Finds thinned clouds whose pictures are near enough to those of the whole.
class Search {
 public:
  /// @param seen    samples that may be merged
  /// @param others  numbers of points that stay as they are
  Search(const Cloud& cloud, const std::vector<Sample>& seen,
         const std::vector<std::uint32_t>& others, const BudgetOptions& options,
         BudgetReport* report, Meter* meter)
      : cloud_(cloud),
        seen_(seen),
        others_(others),
        options_(options),
        report_(*report),
        meter_(meter) {}

  Cloud run(const std::vector<PlannedView>& views) const {
    const Thinner thinner(seen_, options_, meter_);
    if (options_.psnr <= 0 && options_.points == 0) {
      report_.tolerance = options_.tolerance;
      return cloud_of(cloud_, thinner.at(std::min(255 * options_.tolerance, Thinner::kAllColors)),
                      others_);
    }
    const std::size_t most = options_.points - std::min(options_.points, others_.size());
    if (options_.psnr <= 0) return cloud_of(cloud_, thinner.down_to(most, &report_), others_);
    const Pictures pictures(cloud_, views, options_.radius, meter_);
    std::vector<Sample> samples = thinned_while_alike(thinner, pictures);
    if (options_.points > 0 && samples.size() > most) samples = thinner.down_to(most, &report_);
    Cloud result = cloud_of(cloud_, samples, others_);
    report_.psnr = pictures.worst_psnr(result);
    return result;
  }

 private:
  /// @return the thinnest that is alike, or what is seen as it is
  std::vector<Sample> thinned_while_alike(const Thinner& thinner, const Pictures& pictures) const {
    std::vector<Sample> best = thinner.at(0);
    if (alike(best, pictures)) {
      bisect(thinner, pictures, &best);
      return best;
    }
    // Even points half a pixel apart are needed; those nearer to each other may not be.
    BudgetOptions finer = options_;
    report_.tolerance = 0;
    for (int halving = 0; halving < kHalvings; ++halving) {
      report_.pixels = finer.pixels /= 2;
      best = Thinner(seen_, finer, meter_).at(0);
      if (alike(best, pictures)) return best;
    }
    report_.pixels = 0;
    return seen_;
  }

  /// Over whole tolerances, as colours differ by whole numbers; `best` is alike, at 0.
  void bisect(const Thinner& thinner, const Pictures& pictures, std::vector<Sample>* best) const {
    int low = 0, high = Surroundings::kApart;
    while (high - low > 1) {
      const int middle = (low + high) / 2;
      std::vector<Sample> samples = thinner.at(middle);
      const bool is_alike = alike(samples, pictures);
      (is_alike ? low : high) = middle;
      if (is_alike) *best = std::move(samples);
    }
    report_.tolerance = low / 255.0;
  }

  bool alike(const std::vector<Sample>& samples, const Pictures& pictures) const {
    return pictures.worst_psnr(cloud_of(cloud_, samples, others_)) >= options_.psnr;
  }

  const Cloud& cloud_;
  const std::vector<Sample>& seen_;
  const std::vector<std::uint32_t>& others_;
  const BudgetOptions& options_;
  BudgetReport& report_;
  Meter* const meter_;
};

}  // namespace

Cloud thinned(const Cloud& cloud, const std::vector<PlannedView>& views,
              const BudgetOptions& options, BudgetReport* report) {
  check(views, options);
  if (cloud.size() >= UINT32_MAX) throw Error("budget", "4294967295 points and more", "fewer");
  BudgetReport local;
  BudgetReport& told = report ? *report : local;
  told = {};
  told.pixels = options.pixels;
  std::vector<std::uint32_t> others;
  Meter meter(options.progress);
  const std::vector<Sample> seen = seen_samples(cloud, views, options.radius, &others, &meter);
  told.unseen = others.size();
  told.not_finite = cloud.size() - seen.size() - others.size();
  if (options.drop_unseen && !views.empty()) others.clear();
  const std::size_t finite = seen.size() + others.size();
  Cloud result = seen.empty() ? cloud_of(cloud, {}, others)
                              : Search(cloud, seen, others, options, &told, &meter).run(views);
  meter.stage(1, 1);
  meter.add(1);
  told.points = result.size();
  told.merged = finite - result.size();
  return result;
}

}  // namespace ps
