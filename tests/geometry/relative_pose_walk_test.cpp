#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include "io/rgbd_folder.h"
#include "libps/core/error.h"
#include "libps/geometry/lift.h"
#include "libps/geometry/overlap.h"
#include "libps/geometry/photo_matches.h"
#include "libps/geometry/pose_fit.h"
#include "libps/geometry/relative_pose.h"
#include "tests/support/pose_pairs.h"

namespace ps {
namespace {

double quantile(std::vector<double> v, double q) {
  if (v.empty()) return NAN;
  std::sort(v.begin(), v.end());
  return v[std::min(v.size() - 1, static_cast<size_t>(q * v.size()))];
}

TEST(Measure, walk) {
  RgbdFolder folder = open_rgbd_folder(PS_SHARED_DIR "/rgbd/walk");
  const int step = std::getenv("STEP") ? atoi(std::getenv("STEP")) : 12;
  for (const int gap : {5, 10, 20}) {
    for (const double dev : {0.0, 0.1, 0.2}) {
      std::vector<double> rot, trans, rel, scale, spread, inl, found, base, logb;
      int refused = 0;
      for (size_t i = 0; i + gap < folder.frames.size(); i += step) {
        View a = load_frame(folder, folder.frames[i]);
        const View b = load_frame(folder, folder.frames[i + gap]);
        if (dev > 0) a.depth = guessed_depth(a.depth, dev, i);
        const double baseline = (a.world_from_cam.translation() - b.world_from_cam.translation()).norm();
        try {
          const SecondPose p = find_second_pose(a, b.color, b.intrinsics, b.depth);
          const PoseError e = pose_error(p.world_from_cam, b.world_from_cam);
          rot.push_back(e.degrees); trans.push_back(e.metres); rel.push_back(e.metres / baseline);
          scale.push_back(p.depth_scale); spread.push_back(p.depth_spread); inl.push_back(p.inliers); found.push_back(p.depth_error);base.push_back(baseline);
          if (std::getenv("VERBOSE")) printf("gap %d dev %.1f frame %zu: %zu/%zu rot %.2f trans %.3f base %.3f err %.2fpx derr %.3f scale %.3f spread %.3f\n", gap, dev, i, p.inliers, p.matches, e.degrees, e.metres, baseline, p.reprojection_error, p.depth_error, p.depth_scale, p.depth_spread);
        } catch (const Error& e) {
          ++refused;
          if (std::getenv("VERBOSE")) printf("gap %d dev %.1f frame %zu: base %.3f %s\n", gap, dev, i, baseline, e.what());
        }
      }
      printf("gap %2d dev %.1f: %zu ok %d refused, inliers %4.0f base %.2f | rot med %.2f p90 %.2f max %.2f | trans %.3f p90 %.3f max %.3f | rel %.2f p90 %.2f | derr %.3f scale %.3f spread %.3f\n", gap, dev, rot.size(), refused, quantile(inl, .5), quantile(base,.5), quantile(rot, .5), quantile(rot, .9), quantile(rot, 1), quantile(trans, .5), quantile(trans, .9), quantile(trans, 1), quantile(rel, .5), quantile(rel, .9), quantile(found, .5), quantile(scale, .5), quantile(spread, .5));
      fflush(stdout);
    }
  }
}

TEST(Measure, matches) {
  RgbdFolder folder = open_rgbd_folder(PS_SHARED_DIR "/rgbd/walk");
  const int step = std::getenv("STEP") ? atoi(std::getenv("STEP")) : 12;
  for (const int gap : {5, 10, 20}) {
    double all = 0, withd = 0, good = 0, pairs = 0, overlapping = 0; int enough = 0;
    for (size_t i = 0; i + gap < folder.frames.size(); i += step) {
      const View a = load_frame(folder, folder.frames[i]);
      const View b = load_frame(folder, folder.frames[i + gap]);
      const Mask usable = liftable(a.depth, a.intrinsics);
      const Mask usable_b = liftable(b.depth, b.intrinsics);
      const Pose b_from_a = b.world_from_cam.inverse() * a.world_from_cam;
      int inside = 0, total = 0;
      for (int y = 0; y < 360; y += 4) for (int x = 0; x < 540; x += 4) {
        if (!usable(y, x)) continue;
        ++total;
        const Eigen::Vector3d p = b_from_a * a.intrinsics.lift(x, y, a.depth(y, x));
        if (p.z() <= 0) continue;
        const Eigen::Vector2d q = b.intrinsics.project(p);
        const double d = surface_depth(b.depth, usable_b, q.x(), q.y());
        inside += d > 0 && std::abs(std::log(p.z() / d)) < 0.05;
      }
      const double share = double(inside) / std::max(total, 1);
      if (share < 0.2) continue;
      ++pairs; overlapping += share;
      int here = 0;
      for (const PixelMatch& m : match_photos(a.color, b.color)) {
        ++all;
        const double d = surface_depth(a.depth, usable, m.first.x(), m.first.y());
        if (d <= 0) continue;
        ++withd;
        const Eigen::Vector3d p = b_from_a * a.intrinsics.lift(m.first.x(), m.first.y(), d);
        here += p.z() > 0 && (b.intrinsics.project(p) - m.second).norm() < 8;
      }
      good += here;
      enough += here >= 25;
    }
    printf("gap %2d: %3.0f pairs, overlap %.2f: matches %.1f with depth %.1f good %.1f; enough in %d\n", gap, pairs, overlapping / pairs, all / pairs, withd / pairs, good / pairs, enough);
    fflush(stdout);
  }
}

TEST(Measure, starts) {
  RgbdFolder folder = open_rgbd_folder(PS_SHARED_DIR "/rgbd/walk");
  const double dev = std::getenv("DEV") ? atof(std::getenv("DEV")) : 0.2;
  const double first_error = std::getenv("FIRST") ? atof(std::getenv("FIRST")) : 0.15;
  std::map<int, std::vector<double>> sums[11], starts[11], sumi[11];
  for (const int gap : {5, 10}) for (size_t i = 0; i + gap < folder.frames.size(); i += 12) {
    View a = load_frame(folder, folder.frames[i]);
    const View b = load_frame(folder, folder.frames[i + gap]);
    if (dev > 0) a.depth = guessed_depth(a.depth, dev, i);
    const Mask usable = liftable(a.depth, a.intrinsics);
    std::vector<Sighting> list;
    std::vector<double> depths;
    for (const PixelMatch& m : match_photos(a.color, b.color)) {
      const double d = surface_depth(a.depth, usable, m.first.x(), m.first.y());
      if (d > 0) depths.push_back(d);
      list.push_back({a.intrinsics.lift(m.first.x(), m.first.y(), d > 0 ? d : 1), m.second, d > 0});
    }
    if (list.size() < 30) continue;
    for (auto& s : list) if (!s.depth_known) s.point_in_first *= quantile(depths, .5);
    const Pose truth = b.world_from_cam.inverse() * a.world_from_cam;
    std::vector<double> er;
    printf("gap %d frame %zu base %.2f n %zu |", gap, i, truth.translation().norm(), list.size());
    for (int k = 0; k < 3; ++k) {
      Pose start = truth;
      bool ok = true;
      if (k == 0) ok = start_from_points(list, b.intrinsics, 8, &start);
      if (k == 1) ok = start_from_directions(list, b.intrinsics, 2, &start);
      const PoseFit fit = fit_pose(list, b.intrinsics, start, std::getenv("PIX") ? atof(std::getenv("PIX")) : 1, first_error);
      const PoseError s = pose_error(start, truth), e = pose_error(fit.second_from_first, truth);
      sums[gap][k].push_back(e.degrees); starts[gap][k].push_back(s.degrees);
      sumi[gap][k].push_back(fit.inliers); er.push_back(fit.cost); printf(" c %.1f", fit.cost);
      printf(" %s%s start %.1f %.2f fit %4.1f %.2f inl %zu derr %.2f sig %.2f %.2f |", k == 0 ? "P" : k == 1 ? "E" : "T", ok ? "" : "!", s.degrees, s.metres, e.degrees, e.metres, fit.inliers, fit.depth_error, fit.rotation_sigma*57.3, fit.translation_sigma);
    }
    printf("\n");
    for (int k = 0; k < 2; ++k) { const int j = std::min_element(er.begin(), er.begin() + 2 + k) - er.begin(); sums[gap][3 + k].push_back(sums[gap][j].back()); starts[gap][3 + k].push_back(j); sumi[gap][3+k].push_back(sumi[gap][j].back()); }
  }
  for (int gap : {5, 10}) for (int k = 0; k < 5; ++k) printf("SUM gap %d %d: start %.2f %.2f %.2f fit %.2f %.2f %.2f inl %.0f\n", gap, k, quantile(starts[gap][k], .5), quantile(starts[gap][k], .8), quantile(starts[gap][k], .9), quantile(sums[gap][k], .5), quantile(sums[gap][k], .8), quantile(sums[gap][k], .9), quantile(sumi[gap][k], .5));
}

}  // namespace
}  // namespace ps
