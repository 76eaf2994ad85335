// SPDX-License-Identifier: BSD-3-Clause
// make_samples DIR: writes small inputs for the program's tests, sound ones and bad ones. The sound
// ones show a wall 3 m ahead, a floor 1 m below and a square 2 m ahead, from known poses.
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>

#include "io/cloud_file.h"
#include "io/depth_file.h"
#include "io/intrinsics_file.h"
#include "io/photo.h"
#include "io/safetensors.h"
#include "io/trajectory.h"
#include "libps/geometry/lift.h"
#include "libps/rooms/room.h"
#include "tests/support/random_weights.h"
#include "tests/support/room_view.h"

namespace fs = std::filesystem;

namespace ps {
namespace {

constexpr int kWidth = 96, kHeight = 64;

/// Depth of the nearest surface along a ray from `from`, by the z of a direction with z = 1 in the
/// camera.
double cast(const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto meet = [&](double t, double half_side) {
    const Eigen::Vector3d hit = from + t * ray;
    if (t > 0 && std::abs(hit.x()) < half_side && std::abs(hit.y()) < half_side) {
      nearest = std::min(nearest, t);
    }
  };
  meet((2 - from.z()) / ray.z(), 0.4);
  meet((3 - from.z()) / ray.z(), 1e9);
  if (ray.y() > 0) nearest = std::min(nearest, (1 - from.y()) / ray.y());
  return nearest;
}

/// The square is orange, the floor green, the wall purple on the left and blue on the right; all
/// chequered.
cv::Vec3f color_at(const Eigen::Vector3d& point) {
  const auto cell = [](double x) { return static_cast<int>(std::floor(x * 5)); };
  const bool odd = ((cell(point.x()) + cell(point.y()) + cell(point.z())) & 1) != 0;
  const float shade = odd ? 0.4f : 0.2f;
  if (point.y() > 0.999) return {shade, 0.8f, 0.1f};
  if (point.z() < 2.01) return {0.9f, shade, 0.1f};
  return {point.x() < 0 ? 0.7f : 0.1f, shade, 0.8f};
}

View view_from(const Pose& world_from_cam) {
  View view;
  view.intrinsics = intrinsics_from_fov(kWidth, kHeight, 70);
  view.world_from_cam = world_from_cam;
  view.color.create(kHeight, kWidth);
  view.depth.create(kHeight, kWidth);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      const Eigen::Vector3d ray = world_from_cam.linear() * view.intrinsics.lift(u, v, 1);
      const double depth = cast(world_from_cam.translation(), ray);
      view.depth(v, u) = static_cast<float>(depth);
      view.color(v, u) = color_at(world_from_cam.translation() + depth * ray);
    }
  }
  return view;
}

Pose pose_of(int i) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(0.04 * (i - 3), Eigen::Vector3d::UnitY()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(0.05 * (i - 3), 0, 0);
  return pose;
}

/// Frames [first, last) of the walk as an RGB-D folder.
void write_walk(const fs::path& folder, int first, int last) {
  fs::create_directories(folder / "color");
  fs::create_directories(folder / "depth");
  std::vector<StampedPose> poses;
  for (int i = first; i < last; ++i) {
    const View view = view_from(pose_of(i));
    const std::string name = "0000" + std::to_string(i) + ".png";
    write_image(folder / "color" / name, view.color);
    write_depth(folder / "depth" / name, view.depth);
    poses.push_back({static_cast<double>(i), view.world_from_cam, "", {}});
    write_intrinsics(folder / "intrinsics.json", view.intrinsics);
  }
  write_trajectory(folder / "trajectory.txt", poses);
}

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string bytes_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_photos(const fs::path& dir) {
  const View view = view_from(Pose::Identity());
  write_image(dir / "photo.png", view.color);
  write_image(dir / "photo.jpg", view.color);
  write_depth(dir / "depth.png", view.depth);
  write_depth(dir / "half.png", view.depth(cv::Rect(0, 0, kWidth / 2, kHeight / 2)).clone());
  write_depth(dir / "square.png", view.depth(cv::Rect(0, 0, kHeight, kHeight)).clone());
  write_depth(dir / "tiny.png", Depth(1, 1, 2.0f));
  write_depth(dir / "zero.png", Depth::zeros(kHeight, kWidth));
  write_depth(dir / "depth_flat.png", Depth(kHeight, kWidth, 2.5f));
  write_intrinsics(dir / "lens.json", view.intrinsics);
  write_intrinsics(dir / "square_lens.json", intrinsics_from_fov(64, 64, 60));
}

/// Photos and depths that are odd, and sound all the same.
void write_odd_photos(const fs::path& dir) {
  const View view = view_from(Pose::Identity());
  write_image(dir / "flat.png", Image(kHeight, kWidth, cv::Vec3f(0.4f, 0.5f, 0.6f)));
  Image noise(kHeight, kWidth);
  cv::theRNG().state = 1;
  cv::randu(noise, 0, 1);
  write_image(dir / "noise.png", noise);
  cv::Mat bytes, grey, alpha, deep;
  view.color.convertTo(bytes, CV_8U, 255);
  cv::cvtColor(bytes, grey, cv::COLOR_RGB2GRAY);
  cv::cvtColor(bytes, alpha, cv::COLOR_RGB2BGRA);
  view.color.convertTo(deep, CV_16U, 65535);
  cv::imwrite((dir / "grey.png").string(), grey);
  cv::imwrite((dir / "alpha.png").string(), alpha);
  cv::imwrite((dir / "deep.png").string(), deep);
  write_depth(dir / "depth_equal.png", Depth(kHeight, kWidth, 2.0f));
  write_depth(dir / "depth_near.png", Depth(kHeight, kWidth, 0.1f));
  Depth holes = view.depth.clone();
  for (int i = 0; i < static_cast<int>(holes.total()); ++i) {
    if (i % 10 != 0) holes(i / kWidth, i % kWidth) = 0;
  }
  write_depth(dir / "depth_holes.png", holes);
}

void write_clouds(const fs::path& dir) {
  Cloud cloud = lift(view_from(Pose::Identity()));
  for (std::size_t i = 0; i < cloud.size(); i += 2) {
    cloud[i].origin = static_cast<std::uint8_t>(Origin::outpainted);
  }
  write_cloud(dir / "mixed.ply", cloud);
  for (Point& point : cloud) point.origin = static_cast<std::uint8_t>(Origin::observed);
  write_cloud(dir / "seen.pcd", cloud);
  const std::string header = "ply\nformat ascii 1.0\nelement vertex ";
  const std::string fields = "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  write_text(dir / "empty.ply", header + "0" + fields);
  write_text(dir / "promise.ply", header + "1000000000" + fields + "0 0 1\n");
  write_text(dir / "no_color.ply", header + "2" + fields + "0 0 1\n0.5 0.5 2\n");
  write_text(dir / "nan.ply", header + "3" + fields + "0 0 1\nnan 0 1\n0 0 inf\n");
  write_text(dir / "nans.ply", header + "2" + fields + "nan 0 1\n0 0 inf\n");
}

/// The photo, changed where its decoder complains of it; a JPEG is decoded all the same.
void write_damaged(const fs::path& dir, const std::string& kind) {
  cv::Mat bytes;
  view_from(Pose::Identity()).color.convertTo(bytes, CV_8U, 255);
  if (kind == ".pgm") cv::cvtColor(bytes, bytes, cv::COLOR_RGB2GRAY);
  std::vector<unsigned char> file;
  cv::imencode(kind, bytes, file);
  if (kind == ".png") file[file.size() / 2] ^= 1;  // of compressed pixels
  if (kind == ".bmp") file[28] = 77;               // bits of a pixel
  if (kind[1] == 'p' && kind[3] == 'm') file.resize(file.size() / 2);
  if (kind == ".tiff") file[file.size() - 9] ^= 0xff;
  if (kind == ".webp") file[30] ^= 0xff;
  if (kind == ".jpg") file.erase(file.end() - 500, file.end() - 2);  // compressed pixels
  write_text(dir / ("damaged" + kind), {file.begin(), file.end()});
}

void write_bad_files(const fs::path& dir) {
  write_text(dir / "nothing.jpg", "");
  write_text(dir / "truncated.jpg", bytes_of(dir / "photo.jpg").substr(0, 400));
  write_text(dir / "truncated.png", bytes_of(dir / "photo.png").substr(0, 200));
  for (const char* kind : {".png", ".bmp", ".ppm", ".pgm", ".tiff", ".webp", ".jpg"}) {
    write_damaged(dir, kind);
  }
  write_text(dir / "text.png", "this is no picture\n");
  write_text(dir / "nan.txt", "0 nan 0 0 0 0 0 1\n");
  write_text(dir / "twice.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n");
  write_text(dir / "zero_quaternion.txt", "0 0 0 0 0 0 0 0\n");
  write_text(dir / "mirror.log", "0 0 1\n-1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
  write_text(dir / "broken.safetensors", "\x40");
}

void write_tensors(const fs::path& dir) {
  TensorMap tensors;
  tensors["points"] = FileTensor::of(std::vector<float>{0.5f, 0.5f, 1, 0, 0, 2}, {2, 3});
  tensors["features"] = FileTensor::of(std::vector<float>{1, -1, 0, 0.5f, 0, 0}, {3, 2});
  write_safetensors(dir / "two.safetensors", tensors);
  const float nan = std::nanf("");
  tensors["features"] = FileTensor::of(std::vector<float>{1, -1, 0, nan, 0, 0}, {3, 2});
  tensors["nan.points"] = FileTensor::of(std::vector<float>{nan, 0.5f, 1, 0, 0, 2}, {2, 3});
  tensors["nan.features"] = FileTensor::of(std::vector<float>{1, -1, 0, 0.5f, 0, 0}, {3, 2});
  write_safetensors(dir / "nan.safetensors", tensors);
  tensors["features"] = FileTensor::of(std::vector<float>{1, 2}, {1, 2});
  write_safetensors(dir / "misfit.safetensors", tensors);
}

void write_weights(const fs::path& dir) {
  TensorMap tensors;
  const std::string prefix = "model.module.vqvae.";
  tensors[prefix + "a.weight"] = FileTensor::of(std::vector<float>{1, 2, 3, 4, 5, 1000}, {2, 3});
  tensors[prefix + "a.count"] = FileTensor::of(std::vector<std::int32_t>{7}, {});
  tensors["fc.bias"] = FileTensor::of(std::vector<float>{0.5f, -0.5f}, {2});
  write_safetensors(dir / "weights.safetensors", tensors, {{"made_by", "hand"}});
  tensors["fc.weight"] = FileTensor::of(std::vector<float>{1, std::nanf(""), 1e5f}, {3});
  write_safetensors(dir / "bad_weights.safetensors", tensors);
  tensors["vqvae.a.weight"] = tensors[prefix + "a.weight"];
  write_safetensors(dir / "twice.safetensors", tensors);
  // What a pickle of os.system("touch ran") looks like, as a checkpoint of torch begins.
  write_text(dir / "hostile.pth",
             std::string("\x80\2\x8a\x0a\x6c\xfc\x9c\x46\xf9\x20\x6a\xa8\x50\x19.") +
                 "\x80\2M\xe9\3.\x80\2}.\x80\2cos\nsystem\nU\x09touch ran\x85R.");
}

/// Two views of one room, and where the second is seen from the first's camera.
void write_pair(const fs::path& dir) {
  const rooms::Room room(3);
  rooms::CameraOptions options;
  options.width = 480;
  options.height = 360;
  options.min_fov = 60;
  options.max_fov = 75;
  rooms::Camera camera = rooms::random_camera(room, 3, options);
  const View first = room_view(room, camera);
  Pose first_from_second = Pose::Identity();
  first_from_second.linear() = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).matrix();
  first_from_second.translation() = Eigen::Vector3d(0.2, -0.05, 0.1);
  const Pose pose = first.world_from_cam * first_from_second;
  for (int i = 0; i < 12; ++i) {
    camera.world_from_cam[static_cast<std::size_t>(i)] = static_cast<float>(pose(i / 4, i % 4));
  }
  const View second = room_view(room, camera);
  fs::create_directories(dir / "pair");
  write_image(dir / "pair" / "first.png", first.color);
  write_image(dir / "pair" / "second.png", second.color);
  write_depth(dir / "pair" / "first_depth.png", first.depth);
  write_depth(dir / "pair" / "second_depth.png", second.depth);
  write_intrinsics(dir / "pair" / "lens.json", first.intrinsics);
  write_trajectory(dir / "pair" / "pose.txt", {{0, first_from_second, "", {}}});
}

/// Two frames of the walk as 7-Scenes has them.
void write_seven_scenes(const fs::path& dir) {
  fs::create_directories(dir / "seven" / "seq-01");
  for (const int i : {0, 1}) {
    const View view = view_from(pose_of(6 * i));
    const std::string frame = "frame-00000" + std::to_string(i);
    const auto file = [&](const char* kind) { return dir / "seven" / "seq-01" / (frame + kind); };
    const cv::Rect part(8, 2, 80, 60);  // 4:3, as the sensor's
    write_image(file(".color.png"), view.color(part).clone());
    write_depth(file(".depth.png"), view.depth(part).clone());
    std::ostringstream pose;
    pose << view.world_from_cam.matrix() << "\n";
    write_text(file(".pose.txt"), pose.str());
  }
}

/// Two frames of the walk as TUM RGB-D has them, and as RealEstate10K.
void write_data_sets(const fs::path& dir) {
  fs::create_directories(dir / "tum");
  fs::create_directories(dir / "estate" / "frames");
  std::string list = "https://pixelsynth.invalid/clip\n", colors, depths, poses;
  for (const int i : {1, 2}) {
    const View view = view_from(pose_of(3));
    const std::string stamp = std::to_string(i);
    const cv::Rect part(8, 2, 80, 60);  // 4:3, as the sensor's
    write_image(dir / "tum" / ("c" + stamp + ".png"), view.color(part).clone());
    write_image(dir / "estate" / "frames" / (stamp + ".png"), view.color);
    write_depth(dir / "tum" / ("d" + stamp + ".png"), view.depth(part).clone(), 5000);
    colors += stamp + " c" + stamp + ".png\n";
    depths += stamp + ".01 d" + stamp + ".png\n";
    poses += stamp + ".005 0 0 0 0 0 0 1\n";
    list += stamp + " 0.7 1.05 0.5 0.5 0 0 1 0 0 0 0 1 0 0 0 0 1 0\n";
  }
  write_text(dir / "tum" / "rgb.txt", colors);
  write_text(dir / "tum" / "depth.txt", depths);
  write_text(dir / "tum" / "groundtruth.txt", poses);
  write_text(dir / "estate" / "clip.txt", list);
}

/// Pictures of two methods: red ones and green ones, striped.
void write_methods(const fs::path& dir) {
  for (const char* method : {"red", "green"}) {
    fs::create_directories(dir / method);
    for (int i = 0; i < 6; ++i) {
      Image picture(48, 64);
      for (int k = 0; k < 48 * 64; ++k) {
        const float level = 0.5f + 0.1f * static_cast<float>(k % 64 / 16 + i) / 9;
        const bool red = method[0] == 'r';
        picture(k / 64, k % 64) = {red ? level : 0.1f, red ? 0.1f : level, 0.1f};
      }
      write_image(dir / method / ("p" + std::to_string(i) + ".png"), picture);
    }
  }
}

/// A depth network by chance, as trained to this and that scale.
void write_depth_networks(const fs::path& dir) {
  TensorMap tensors;
  for (auto& [name, tensor] : read_safetensors(PS_DATA_DIR "/golden/weights.safetensors")) {
    if (name.rfind("pts_regressor.", 0) == 0) tensors[name] = std::move(tensor);
  }
  const auto write = [&](const char* name, const Metadata& metadata) {
    write_safetensors(dir / name, tensors, metadata);
  };
  write("depth.safetensors", {{"min_z", "0.5"}, {"max_z", "10"}, {"canonical_focal", "1"}});
  write("far.safetensors", {{"min_z", "100"}, {"max_z", "1000"}});
  write("no_scale.safetensors", {});
  write("bad_scale.safetensors", {{"min_z", "near"}, {"max_z", "10"}});
  write("turned_scale.safetensors", {{"min_z", "10"}, {"max_z", "1"}});
}

void add_tensors(const nn::Weights& weights, const std::string& wrapper, TensorMap& tensors) {
  for (const auto& [name, tensor] : weights.tensors()) {
    tensors[wrapper + name] = FileTensor::of(tensor.values, tensor.shape);
  }
}

/// All networks by chance in one file, as the published checkpoint has them: under its wrappers,
/// with its two depths, with a tensor that nothing needs, and without a classifier.
void write_published(const fs::path& dir) {
  const std::string wrapper = "model.module.";
  TensorMap tensors;
  add_tensors(models::random_depth_net(4), wrapper, tensors);
  add_tensors(models::random_autoencoder(16, 8, 8, 24), wrapper, tensors);
  add_tensors(models::random_pixel_cnn(11, 24), wrapper, tensors);
  add_tensors(models::random_refiner(8), wrapper, tensors);
  add_tensors(models::random_discriminator(8), "netD.netD.", tensors);
  tensors[wrapper + "min_z"] = FileTensor::of(std::vector<float>{0.5f}, {1});
  tensors[wrapper + "max_z"] = FileTensor::of(std::vector<float>{10}, {1});
  tensors[wrapper + "pts_transformer.xyzs"] = FileTensor::of(std::vector<float>(12), {1, 4, 3});
  write_safetensors(dir / "published.safetensors", tensors);
}

/// A PixelCNN that continues one autoencoder's codes, another autoencoder of as many, and a
/// PixelCNN of more.
void write_mixed_codes(const fs::path& dir) {
  fs::create_directories(dir / "mixed");
  const auto write = [&](const char* name, const nn::Weights& weights, const Metadata& words) {
    TensorMap tensors;
    add_tensors(weights, "", tensors);
    write_safetensors(dir / "mixed" / name, tensors, words);
  };
  fs::copy_file(dir / "depth.safetensors", dir / "mixed" / "depth.safetensors");
  nn::Weights autoencoder = models::random_autoencoder(16, 8, 8, 24);
  write("vqvae.safetensors", autoencoder, {});
  std::map<std::string, nn::WeightTensor> others = autoencoder.tensors();
  std::vector<float>& embed = others.at("vqvae.quantize_t.embed").values;
  std::rotate(embed.begin(), embed.begin() + 1, embed.end());
  write("other.safetensors", {"other", others}, {});
  write("pixelcnn.safetensors", models::random_pixel_cnn(11, 24), {});
  write("more_codes.safetensors", models::random_pixel_cnn(11, 30), {});
  write("refine.safetensors", models::random_refiner(8), {});
}

/// A narrow LPIPS by chance.
void write_lpips(const fs::path& dir) {
  TensorMap tensors;
  add_tensors(models::random_lpips(8), "", tensors);
  write_safetensors(dir / "lpips.safetensors", tensors);
}

/// An EXIF block: IFD0 has the orientation and points to a directory with FocalLengthIn35mmFilm.
std::string exif_of(char orientation, char focal_length) {
  using namespace std::string_literals;
  return "Exif\0\0MM\0*\0\0\0\x08\0\x02\x01\x12\0\x03\0\0\0\x01\0"s + orientation +
         "\0\0\x87\x69\0\x04\0\0\0\x01\0\0\0\x26\0\0\0\0\0\x01\xa4\x05\0\x03\0\0\0\x01\0"s +
         focal_length + "\0\0\0\0\0\0"s;
}

/// Photos that say their focal length: one, one that cannot be, and one of a camera on its side.
void write_photos_with_exif(const fs::path& dir) {
  const std::string jpeg = bytes_of(dir / "photo.jpg");
  const auto write = [&](const char* name, const std::string& block) {
    const char length[] = {0, static_cast<char>(block.size() + 2)};
    write_text(dir / name,
               jpeg.substr(0, 2) + "\xff\xe1" + std::string(length, 2) + block + jpeg.substr(2));
  };
  write("exif.jpg", exif_of(1, 28));
  write("exif_odd.jpg", exif_of(1, 1));
  write("exif_turned.jpg", exif_of(6, 28));
}

/// The photo in other sizes.
void write_sized_photos(const fs::path& dir) {
  for (const cv::Size size : {cv::Size(16, 16), {3000, 500}, {20, 600}, {500, 2}}) {
    Image photo(size);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        photo(y, x) = {0.5f + 0.5f * std::sin(0.05f * static_cast<float>(x)), 0.3f,
                       0.5f + 0.5f * std::cos(0.03f * static_cast<float>(y))};
      }
    }
    const std::string name =
        "p" + std::to_string(size.width) + "x" + std::to_string(size.height) + ".png";
    write_image(dir / name, photo);
  }
}

}  // namespace
}  // namespace ps

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  const fs::path dir = argv[1];
  fs::remove_all(dir);
  fs::create_directories(dir / "no_depth" / "color");
  ps::write_walk(dir / "walk", 0, 7);
  ps::write_walk(dir / "part_a", 0, 4);
  ps::write_walk(dir / "part_b", 4, 7);
  ps::write_data_sets(dir);
  ps::write_seven_scenes(dir);
  ps::write_pair(dir);
  ps::write_methods(dir);
  ps::write_photos(dir);
  ps::write_odd_photos(dir);
  ps::write_clouds(dir);
  ps::write_bad_files(dir);
  ps::write_tensors(dir);
  ps::write_weights(dir);
  ps::write_depth_networks(dir);
  ps::write_published(dir);
  ps::write_mixed_codes(dir);
  ps::write_lpips(dir);
  ps::write_sized_photos(dir);
  ps::write_photos_with_exif(dir);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_samples: %s\n", error.what());
  return 1;
}
