// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/frame_study.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <string>

#include "libps/core/error.h"
#include "libps/core/parallel.h"
#include "libps/eval/statistics.h"
#include "libps/scene/lone_pixels.h"

namespace ps {
namespace {

constexpr std::size_t kLeastOverlap = 40;            ///< pixels; less is no pair
constexpr float kDarkest = .04f, kBrightest = .97f;  ///< beyond, sensors clip
constexpr double kWideTolerance = 0.25;              ///< share; scales may be this far apart
constexpr int kRounds = 4;                           ///< of evening out scales
constexpr double kExact = .02;  ///< spread of a pair's log ratios that is as good as none
constexpr double kEvener = .6;  ///< of the spread is left where scales were wrong
constexpr double kTolerancePerSpread = 2;  ///< of fusing, and at most:
constexpr double kMostTolerance = .15;
constexpr double kAgreeing = .05;  ///< share of a depth; lone_pixels.h
constexpr double kAnchor = 1e-3;   ///< of unknowns to 0, in pairs

/// A frame, reduced, and the least and greatest depth around each of its pixels.
struct Small {
  View view;
  Depth nearest, farthest;
  bool usable() const { return !view.depth.empty(); }
};

Small reduced(const View& view, int width, const std::string& where) {
  Small small;
  if (view.depth.empty()) return small;
  check(view, where);
  const double scale = std::min(1.0, static_cast<double>(width) / view.depth.cols);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(view.depth.cols * scale))),
                      std::max(1, static_cast<int>(std::lround(view.depth.rows * scale))));
  small.view.world_from_cam = view.world_from_cam;
  small.view.intrinsics = resized(view.intrinsics, size.width, size.height);
  cv::resize(view.color, small.view.color, size, 0, 0, cv::INTER_AREA);
  cv::resize(view.depth, small.view.depth, size, 0, 0, cv::INTER_NEAREST_EXACT);
  cv::patchNaNs(small.view.depth, 0);
  small.view.depth.setTo(0, small.view.depth < 0);
  small.view.depth.setTo(0, lone_pixels(small.view.depth, kAgreeing));
  const cv::Mat1b window(3, 3, 1);
  Depth known = small.view.depth.clone();
  cv::dilate(known, small.farthest, window);
  known.setTo(1e9f, known == 0);
  cv::erode(known, small.nearest, window);
  return small;
}

/// What the pixels of one frame say in another.
struct Pair {
  std::size_t a = 0, b = 0;
  std::size_t agree = 0, before = 0;    ///< pixels; before: the other frame sees through it
  std::vector<double> color[3], depth;  ///< log ratios, a over b
};

void compare(const Small& from, const Small& to, double scale_from, double scale_to,
             double tolerance, bool swapped, Pair* pair) {
  const Pose to_from_from = to.view.world_from_cam.inverse() * from.view.world_from_cam;
  const Depth& depth = from.view.depth;
  for (int y = 0; y < depth.rows; ++y) {
    for (int x = 0; x < depth.cols; ++x) {
      if (!(depth(y, x) > 0)) continue;
      const Eigen::Vector3d p =
          to_from_from * from.view.intrinsics.lift(x, y, depth(y, x) * scale_from);
      if (!(p.z() > 0)) continue;
      const Eigen::Vector2d at = to.view.intrinsics.project(p);
      if (!(at.x() > 0 && at.y() > 0 && at.x() < to.view.depth.cols - 1 &&
            at.y() < to.view.depth.rows - 1)) {
        continue;
      }
      const int u = static_cast<int>(std::lround(at.x())),
                v = static_cast<int>(std::lround(at.y()));
      const double there = to.view.depth(v, u) * scale_to;
      if (!(there > 0) || p.z() > to.farthest(v, u) * scale_to * (1 + tolerance)) continue;
      if (p.z() < to.nearest(v, u) * scale_to * (1 - tolerance)) {
        ++pair->before;
        continue;
      }
      ++pair->agree;
      const double sign = swapped ? -1 : 1;
      pair->depth.push_back(sign * std::log(p.z() / there));
      const cv::Vec3f ours = from.view.color(y, x), theirs = to.view.color(v, u);
      for (int c = 0; c < 3; ++c) {
        const bool told =
            std::min(ours[c], theirs[c]) > kDarkest && std::max(ours[c], theirs[c]) < kBrightest;
        if (told) pair->color[c].push_back(sign * std::log(ours[c] / theirs[c]));
      }
    }
  }
}

/// Pairs of frames near each other in the stream, and of others evenly spread.
std::vector<Pair> plan_pairs(const std::vector<Small>& frames, int partners) {
  const std::size_t n = frames.size();
  std::vector<std::size_t> steps;
  const auto half = static_cast<std::size_t>(std::max(1, partners / 2));
  for (std::size_t i = 1; i <= half && i < n; ++i) {
    steps.push_back(i <= half / 2 ? i : half / 2 + (i - half / 2) * (n - half / 2) / (half + 1));
  }
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t last = 0;
    for (const std::size_t step : steps) {
      if (step <= last || i + step >= n) continue;
      last = step;
      if (!frames[i].usable() || !frames[i + step].usable()) continue;
      pairs.emplace_back();
      pairs.back().a = i;
      pairs.back().b = i + step;
    }
  }
  return pairs;
}

void hold_against_each_other(const std::vector<Small>& frames, const std::vector<FrameWord>& words,
                             double tolerance, std::vector<Pair>* pairs) {
  parallel_for(pairs->size(), [&](std::size_t i) {
    Pair fresh;
    fresh.a = (*pairs)[i].a;
    fresh.b = (*pairs)[i].b;
    const Small &a = frames[fresh.a], &b = frames[fresh.b];
    compare(a, b, words[fresh.a].scale, words[fresh.b].scale, tolerance, false, &fresh);
    compare(b, a, words[fresh.b].scale, words[fresh.a].scale, tolerance, true, &fresh);
    (*pairs)[i] = std::move(fresh);
  });
}

/// What a pair says of one ratio, and how much it is to be believed.
struct Word {
  double ratio = 0, weight = 0;
};

Word word_of(std::vector<double> ratios) {
  if (ratios.size() < kLeastOverlap) return {};
  const double middle = median(ratios);
  for (double& ratio : ratios) ratio = std::abs(ratio - middle);
  return {middle, 1 / std::pow(median(std::move(ratios)) + kExact, 2)};
}

/// The x of least squares of x_a - x_b = the pairs' median ratio; they average to 0.
Eigen::VectorXd evened(std::size_t count, const std::vector<Pair>& pairs,
                       const std::function<const std::vector<double>&(const Pair&)>& ratios) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(i, i, kAnchor);
  for (const Pair& pair : pairs) {
    const Word word = word_of(ratios(pair));
    const auto a = static_cast<Eigen::Index>(pair.a), b = static_cast<Eigen::Index>(pair.b);
    entries.emplace_back(a, a, word.weight);
    entries.emplace_back(b, b, word.weight);
    entries.emplace_back(a, b, -word.weight);
    entries.emplace_back(b, a, -word.weight);
    right[a] += word.weight * word.ratio;
    right[b] -= word.weight * word.ratio;
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(matrix).solve(right);
}

/// Each frame's middle share of what a pair contradicts, without pairs of refused frames.
void weigh(const std::vector<Pair>& pairs, std::vector<FrameWord>* words) {
  std::vector<std::vector<double>> shares(words->size());
  for (const Pair& pair : pairs) {
    const std::size_t seen = pair.agree + pair.before;
    if (seen < kLeastOverlap) continue;
    const double share = static_cast<double>(pair.before) / static_cast<double>(seen);
    if (!(*words)[pair.b].refused) shares[pair.a].push_back(share);
    if (!(*words)[pair.a].refused) shares[pair.b].push_back(share);
  }
  for (std::size_t i = 0; i < words->size(); ++i) {
    (*words)[i].contradicted = shares[i].empty() ? 0 : median(std::move(shares[i]));
  }
}

/// Refuses the worst frame, then the worst of what is left, and so on; none at all if that comes to
/// half of them, as nobody can tell then which half is right: returns
/// false.
bool refuse(const std::vector<Pair>& pairs, const FrameStudyOptions& options,
            std::vector<FrameWord>* words) {
  weigh(pairs, words);
  for (std::size_t refused = 0; options.refuse && 2 * refused < words->size(); ++refused) {
    std::vector<double> usual;
    FrameWord* worst = nullptr;
    for (FrameWord& word : *words) {
      if (word.refused) continue;
      usual.push_back(word.contradicted);
      if (worst == nullptr || word.contradicted > worst->contradicted) worst = &word;
    }
    if (worst == nullptr) return true;
    const double most = std::max(options.contradicted, 3 * median(std::move(usual)));
    if (worst->contradicted <= most) return true;
    worst->refused = true;
    weigh(pairs, words);
  }
  for (FrameWord& word : *words) word.refused = false;
  return !options.refuse || words->empty();
}

void even_colors(const std::vector<Pair>& pairs, std::vector<FrameWord>* words) {
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd logs = evened(
        words->size(), pairs, [c](const Pair& p) -> const auto& { return p.color[c]; });
    for (std::size_t i = 0; i < words->size(); ++i) {
      (*words)[i].gain[c] = static_cast<float>(std::exp(-logs[static_cast<Eigen::Index>(i)]));
    }
  }
}

double spread_of(const std::vector<Pair>& pairs) {
  std::vector<double> spreads;
  for (const Pair& pair : pairs) {
    if (pair.depth.size() < kLeastOverlap) continue;
    std::vector<double> ratios = pair.depth;
    for (double& ratio : ratios) ratio = std::abs(ratio);
    spreads.push_back(median(std::move(ratios)));
  }
  return spreads.empty() ? 0 : median(std::move(spreads));
}

/// Evens out scales where that is what is wrong with the frames.
void even_scales(const std::vector<Small>& frames, std::vector<Pair>* pairs, FrameStudy* study) {
  FrameStudy evener = *study;
  std::vector<Pair> fresh = *pairs;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd logs = evened(
        frames.size(), fresh, [](const Pair& p) -> const auto& { return p.depth; });
    for (std::size_t i = 0; i < frames.size(); ++i) {
      evener.words[i].scale *= std::exp(-logs[static_cast<Eigen::Index>(i)]);
    }
    hold_against_each_other(frames, evener.words, kWideTolerance, &fresh);
  }
  evener.spread = spread_of(fresh);
  if (!(evener.spread < kEvener * study->spread)) return;
  *study = std::move(evener);
  *pairs = std::move(fresh);
}

}  // namespace

FrameStudy study_frames(const ViewSource& source, const FrameStudyOptions& options) {
  const bool sound = options.width >= 8 && options.partners >= 2 && options.tolerance > 0 &&
                     options.contradicted >= 0;
  if (!sound) throw Error("frame study", "an option is out of range", "a width of 8 or more");
  if (source.count > 0 && !source.load) throw Error("frame study", "the source cannot load");
  std::vector<Small> frames(source.count);
  for (std::size_t i = 0; i < source.count; ++i) {
    frames[i] = reduced(source.load(i), options.width, "frame " + std::to_string(i));
  }
  FrameStudy study;
  study.words.resize(source.count);
  std::vector<Pair> pairs = plan_pairs(frames, options.partners);
  hold_against_each_other(frames, study.words, options.tolerance, &pairs);
  if (!refuse(pairs, options, &study.words)) return study;
  const auto out = [&](const Pair& p) {
    return study.words[p.a].refused || study.words[p.b].refused;
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), out), pairs.end());
  hold_against_each_other(frames, study.words, kWideTolerance, &pairs);
  study.spread = spread_of(pairs);
  if (options.scales) even_scales(frames, &pairs, &study);
  if (options.gains) even_colors(pairs, &study.words);
  return study;
}

ViewSource heeding(const ViewSource& source, const FrameStudy& study) {
  const std::vector<FrameWord>& words = study.words;
  if (words.size() != source.count) {
    throw Error("frame study", std::to_string(words.size()) + " words",
                "one for each of " + std::to_string(source.count) + " frames");
  }
  return {source.count, [source, words](std::size_t i) {
            if (words[i].refused) return View();
            View view = source.load(i);
            if (view.depth.empty()) return view;
            // The source may keep what it gave.
            view.color = view.color.clone();
            view.depth = view.depth.clone();
            view.depth *= words[i].scale;
            view.depth.setTo(0, lone_pixels(view.depth, kAgreeing));
            for (cv::Vec3f& c : view.color) {
              for (int k = 0; k < 3; ++k) c[k] = std::clamp(c[k] * words[i].gain[k], 0.f, 1.f);
            }
            return view;
          }};
}

FuseOptions heeding(const FuseOptions& options, const FrameStudy& study) {
  FuseOptions heeded = options;
  double& tolerance = heeded.cloud.tolerance_relative;
  tolerance = std::max(tolerance, std::min(kMostTolerance, kTolerancePerSpread * study.spread));
  return heeded;
}

}  // namespace ps
