// SPDX-License-Identifier: BSD-3-Clause
#include "libps/eval/view_scores.h"

#include <limits>

#include "libps/core/error.h"
#include "libps/eval/frechet.h"
#include "libps/eval/image_metrics.h"

namespace ps {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Gaussian gaussian_of(const std::vector<std::vector<float>>& samples) {
  Eigen::MatrixXd rows(samples.size(), samples.front().size());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const std::vector<float>& sample = samples[static_cast<std::size_t>(i)];
    rows.row(i) = Eigen::Map<const Eigen::RowVectorXf>(sample.data(), rows.cols()).cast<double>();
  }
  return fit_gaussian(rows);
}

}  // namespace

ViewScores view_scores(const Image& shown, const Image& truth, const Visibility& visibility,
                       const PerceptualDistance& perceptual) {
  ViewScores scores;
  scores.psnr = psnr(shown, truth);
  // To psnr() an empty mask means all pixels.
  const auto within = [&](const Mask& mask) {
    return mask.empty() ? kNaN : psnr(shown, truth, mask);
  };
  scores.psnr_visible = within(visibility.visible);
  scores.psnr_invisible = within(visibility.invisible);
  scores.ssim = ssim(shown, truth);
  scores.perceptual = perceptual ? perceptual(shown, truth) : kNaN;
  return scores;
}

void FrechetScores::add(const std::string& method, const Image& image) {
  std::vector<float> features = network_.features(image);
  for (const auto& [name, others] : features_) {
    if (others.front().size() == features.size()) continue;
    throw Error(network_.name,
                std::to_string(features.size()) + " features of one image, " +
                    std::to_string(others.front().size()) + " of another",
                "as many of each");
  }
  features_[method].push_back(std::move(features));
}

std::size_t FrechetScores::count(const std::string& method) const {
  const auto found = features_.find(method);
  return found == features_.end() ? 0 : found->second.size();
}

double FrechetScores::distance(const std::string& method) const {
  if (count(method) < 2 || count("") < 2) return kNaN;
  return frechet_distance(gaussian_of(features_.at(method)), gaussian_of(features_.at("")));
}

}  // namespace ps
