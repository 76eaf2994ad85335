// SPDX-License-Identifier: BSD-3-Clause
#include "libps/scene/frame_study.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "libps/core/error.h"
#include "libps/eval/statistics.h"
#include "libps/scene/frame_pairs.h"
#include "libps/scene/lone_pixels.h"

namespace ps {
namespace {

constexpr double kWideTolerance = 0.25;    ///< share; scales may be this far apart
constexpr int kRounds = 4;                 ///< of evening out scales
constexpr double kEvener = .6;             ///< of the spread is left where scales were wrong
constexpr double kTolerancePerSpread = 2;  ///< of fusing, and at most:
constexpr double kMostTolerance = .15;
constexpr double kAnchor = 1e-3;  ///< of unknowns to 0, in pairs

/// Who is listened to when a frame is judged.
struct Jury {
  double pair;   ///< which of a frame's pairs speaks for it, the best first
  double usual;  ///< which frame is the usual one, the best first
};
/// First those of frames lost each for itself, as a good one still has so many good partners where
/// nearly half of the frames are lost; then frames lost together, which agree with their
/// neighbours.
constexpr Jury kJuries[] = {{.4, .3}, {.5, .5}};

/// @return the value with such a share of the others before it, in rising order; NaN of none
double at_share(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto place = values.begin() + std::lround(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// The x of least squares of x_a - x_b = the pairs' median ratio; they average to 0.
Eigen::VectorXd evened(std::size_t count, const std::vector<FramePair>& pairs,
                       const std::function<MiddleRatio(const FramePair&)>& said) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) entries.emplace_back(i, i, kAnchor);
  for (const FramePair& pair : pairs) {
    const MiddleRatio word = said(pair);
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

/// The share of what a pair contradicts, of the pair that speaks for each frame, without pairs of
/// refused frames; NaN without a pair.
std::vector<double> contradictions(const std::vector<FramePair>& pairs,
                                   const std::vector<FrameWord>& words, const Jury& jury) {
  std::vector<std::vector<double>> shares(words.size());
  for (const FramePair& pair : pairs) {
    const std::size_t seen = pair.agree + pair.before;
    if (seen < kLeastOverlap) continue;
    const double share = static_cast<double>(pair.before) / static_cast<double>(seen);
    if (!words[pair.b].refused) shares[pair.a].push_back(share);
    if (!words[pair.a].refused) shares[pair.b].push_back(share);
  }
  std::vector<double> spoken;
  for (std::vector<double>& some : shares) spoken.push_back(at_share(std::move(some), jury.pair));
  return spoken;
}

/// @return the frame to be refused next, or as many as there are frames: none
std::size_t worst_of(const std::vector<double>& shares, const std::vector<FrameWord>& words,
                     double contradicted, const Jury& jury) {
  std::vector<double> usual;
  std::size_t worst = shares.size();
  for (std::size_t i = 0; i < shares.size(); ++i) {
    if (words[i].refused || std::isnan(shares[i])) continue;
    usual.push_back(shares[i]);
    if (worst == shares.size() || shares[i] > shares[worst]) worst = i;
  }
  if (usual.empty()) return shares.size();
  const double most = std::max(contradicted, 3 * at_share(std::move(usual), jury.usual));
  return shares[worst] > most ? worst : shares.size();
}

/// Each frame's share of what is contradicted, by the last jury.
void tell_contradictions(const std::vector<FramePair>& pairs, std::vector<FrameWord>* words) {
  const std::vector<double> shares = contradictions(pairs, *words, kJuries[1]);
  for (std::size_t i = 0; i < words->size(); ++i) {
    (*words)[i].contradicted = std::isnan(shares[i]) ? 0 : shares[i];
  }
}

/// Of frames with depth, those that no frame shares a surface with.
void tell_alone(const std::vector<SmallFrame>& frames, const std::vector<FramePair>& pairs,
                std::vector<FrameWord>* words) {
  for (std::size_t i = 0; i < frames.size(); ++i) (*words)[i].alone = frames[i].usable();
  for (const FramePair& pair : pairs) {
    if (pair.agree + pair.before < kLeastOverlap) continue;
    (*words)[pair.a].alone = (*words)[pair.b].alone = false;
  }
}

/// Refuses the worst frame, then the worst of what is left, and so on; none at all if that comes to
/// half of those with a pair, as nobody can tell then which half is right.
void refuse(const std::vector<FramePair>& pairs, const FrameStudyOptions& options,
            FrameStudy* study) {
  std::vector<FrameWord>& words = study->words;
  const auto refused = [&] {
    return std::count_if(words.begin(), words.end(), [](const FrameWord& w) { return w.refused; });
  };
  const std::vector<double> all = contradictions(pairs, words, kJuries[0]);
  const auto held = std::count_if(all.begin(), all.end(), [](double x) { return !std::isnan(x); });
  study->gave_up = false;
  for (const Jury& jury : kJuries) {
    while (options.refuse && !study->gave_up) {
      const std::size_t worst =
          worst_of(contradictions(pairs, words, jury), words, options.contradicted, jury);
      if (worst == words.size()) break;
      words[worst].refused = true;
      study->gave_up = 2 * refused() >= held;
    }
  }
  if (study->gave_up) {
    for (FrameWord& word : words) word.refused = false;
  }
  tell_contradictions(pairs, &words);
}

void even_colors(const std::vector<FramePair>& pairs, std::vector<FrameWord>* words) {
  for (int c = 0; c < 3; ++c) {
    const Eigen::VectorXd logs =
        evened(words->size(), pairs, [c](const FramePair& p) { return p.color[c]; });
    for (std::size_t i = 0; i < words->size(); ++i) {
      (*words)[i].gain[c] = static_cast<float>(std::exp(-logs[static_cast<Eigen::Index>(i)]));
    }
  }
}

double spread_of(const std::vector<FramePair>& pairs) {
  std::vector<double> spreads;
  for (const FramePair& pair : pairs) {
    if (pair.overlaps()) spreads.push_back(pair.apart);
  }
  return spreads.empty() ? 0 : median(std::move(spreads));
}

/// Evens out scales where that is what is wrong with the frames.
void even_scales(const std::vector<SmallFrame>& frames, std::vector<FramePair>* pairs,
                 FrameStudy* study) {
  FrameStudy evener = *study;
  std::vector<FramePair> fresh = *pairs;
  for (int round = 0; round < kRounds; ++round) {
    const Eigen::VectorXd logs =
        evened(frames.size(), fresh, [](const FramePair& p) { return p.depth; });
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

/// @return whether even the frames that are left contradict each other too much, as their words
/// have it, for anything that they say to be worth heeding
bool at_odds(const std::vector<SmallFrame>& frames, const FrameStudyOptions& options,
             std::vector<FramePair> pairs, const FrameStudy& study) {
  hold_against_each_other(frames, study.words, options.tolerance, &pairs);
  std::vector<double> shares = contradictions(pairs, study.words, kJuries[0]);
  shares.erase(std::remove_if(shares.begin(), shares.end(), [](double x) { return std::isnan(x); }),
               shares.end());
  return at_share(std::move(shares), .5) > options.contradicted;
}

/// Judges frames again that perhaps are in camps which differ in scale alone, as if that were
/// evened out. Scales stay as they are: they are found when it is known which frames stay.
void judge_by_even_scales(const std::vector<SmallFrame>& frames, const FrameStudyOptions& options,
                          std::vector<FramePair> pairs, FrameStudy* study) {
  FrameStudy evened = *study;
  hold_against_each_other(frames, evened.words, kWideTolerance, &pairs);
  evened.spread = spread_of(pairs);
  even_scales(frames, &pairs, &evened);
  hold_against_each_other(frames, evened.words, options.tolerance, &pairs);
  refuse(pairs, options, &evened);
  for (FrameWord& word : evened.words) word.scale = 1;
  evened.spread = 0;
  if (!evened.gave_up) *study = std::move(evened);
}

/// A study that gave up: it says how much the frames contradict each other, and advises nothing.
FrameStudy without_advice(const std::vector<SmallFrame>& frames, const FrameStudyOptions& options,
                          std::vector<FramePair> pairs) {
  FrameStudy silent;
  silent.gave_up = true;
  silent.words.resize(frames.size());
  hold_against_each_other(frames, silent.words, options.tolerance, &pairs);
  tell_contradictions(pairs, &silent.words);
  tell_alone(frames, pairs, &silent.words);
  return silent;
}

}  // namespace

FrameStudy study_frames(const ViewSource& source, const FrameStudyOptions& options) {
  const bool sound = options.width >= 8 && options.partners >= 2 && options.tolerance > 0 &&
                     options.contradicted >= 0;
  if (!sound) throw Error("frame study", "an option is out of range", "a width of 8 or more");
  if (source.count > 0 && !source.load) throw Error("frame study", "the source cannot load");
  std::vector<SmallFrame> frames(source.count);
  for (std::size_t i = 0; i < source.count; ++i) {
    frames[i] = reduced_frame(source.load(i), options.width, "frame " + std::to_string(i));
  }
  FrameStudy study;
  study.words.resize(source.count);
  const std::vector<FramePair> planned = plan_pairs(frames, options.partners);
  std::vector<FramePair> pairs = planned;
  hold_against_each_other(frames, study.words, options.tolerance, &pairs);
  tell_alone(frames, pairs, &study.words);
  refuse(pairs, options, &study);
  if (study.gave_up && options.scales) judge_by_even_scales(frames, options, pairs, &study);
  if (study.gave_up) return without_advice(frames, options, planned);
  const auto out = [&](const FramePair& p) {
    return study.words[p.a].refused || study.words[p.b].refused;
  };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), out), pairs.end());
  hold_against_each_other(frames, study.words, kWideTolerance, &pairs);
  study.spread = spread_of(pairs);
  if (options.scales) even_scales(frames, &pairs, &study);
  if (options.refuse && at_odds(frames, options, pairs, study)) {
    return without_advice(frames, options, planned);
  }
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
            if (cv::countNonZero(view.depth > 0) == 0) return View();
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
