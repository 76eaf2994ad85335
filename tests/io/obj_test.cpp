// SPDX-License-Identifier: BSD-3-Clause
#include "io/obj.h"

#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>

#include "io/polygon.h"
#include "tests/io/support.h"

namespace ps {
namespace {

using rooms::Model;
using Files = std::map<std::string, std::string>;
using Corner = std::array<float, 3>;

Model parse(const std::string& text, const Files& files = {}, const ObjOptions& options = {}) {
  const auto open = [&](const std::string& file) -> std::optional<std::string> {
    const auto found = files.find(file);
    if (found == files.end()) return std::nullopt;
    return found->second;
  };
  return parse_obj(text, "a.obj", open, options);
}

std::string message(const std::string& text, const Files& files = {}) {
  return error_of([&] { parse(text, files); });
}

std::string png(const cv::Mat& bgr) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", bgr, bytes);
  return {bytes.begin(), bytes.end()};
}

/// Half the turn of a triangle of points in the plane z = 0.
double area(const Corner& a, const Corner& b, const Corner& c) {
  return ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2.0;
}

const std::string kSquare =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nmtllib a.mtl\n";
const std::string kTextured = "usemtl m\nf 1/1 2/2 3/3 4/4\n";

TEST(Obj, every_way_to_write_a_corner_means_the_same) {
  for (const char* face :
       {"f 1 2 3", "f -4 -3 -2", "f 1// 2//1 3//", "f 1/1 2/2 3/3", "f  1/1/1 -3/-3/9\t3/3/1 \r"}) {
    const Model model = parse("# by hand\n" + kSquare + "s off\ng x\nvn 0 0 1\n" + face + "\n");
    ASSERT_EQ(model.triangles.size(), 1u) << face;
    const std::vector<Corner> expected = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(model.positions[model.triangles[0].corners[i]], expected[i]) << face;
    }
    EXPECT_TRUE(model.uvs.empty()) << "without a picture there is no need for them";
  }
}

TEST(Obj, corners_are_shared_where_position_and_uv_are) {
  const Files files{{"a.mtl", "newmtl m\nmap_Kd p.png\n"}, {"p.png", png(cv::Mat3b(2, 2))}};
  const Model model =
      parse(kSquare + "usemtl m\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 1/2 3/3 4/4\n", files);
  EXPECT_EQ(model.positions.size(), 5u);
  EXPECT_EQ(model.uvs.size(), 5u);
  EXPECT_EQ(model.triangles[0].corners[0], model.triangles[1].corners[0]);
  EXPECT_EQ(model.positions[0], model.positions[4]);
  EXPECT_EQ(model.uvs[4], (std::array<float, 2>{1, 0}));
}

std::vector<std::array<std::size_t, 3>> triangles_of(const std::vector<Corner>& polygon) {
  std::vector<std::array<std::size_t, 3>> triangles = {{7, 7, 7}};  // what was there goes
  triangulate(polygon, triangles);
  return triangles;
}

TEST(Obj, a_concave_polygon_is_covered_exactly_once) {
  // A star: fans from its inner corners would lie outside it.
  std::vector<Corner> star;
  double whole = 0;
  for (int i = 0; i < 14; ++i) {
    const double radius = i % 2 == 0 ? 0.3 : 1, angle = i * M_PI / 7;
    star.push_back({static_cast<float>(radius * std::cos(angle)),
                    static_cast<float>(radius * std::sin(angle)), 0});
  }
  for (std::size_t i = 0; i < star.size(); ++i) {
    whole += area({0, 0, 0}, star[i], star[(i + 1) % star.size()]);
  }
  for (const bool reversed : {false, true}) {
    if (reversed) std::reverse(star.begin(), star.end());
    const auto triangles = triangles_of(star);
    ASSERT_EQ(triangles.size(), star.size() - 2);
    double sum = 0, sum_of_sizes = 0;
    for (const auto& [a, b, c] : triangles) {
      sum += area(star[a], star[b], star[c]);
      sum_of_sizes += std::abs(area(star[a], star[b], star[c]));
    }
    EXPECT_NEAR(sum, reversed ? -whole : whole, 1e-6) << "they turn as the polygon does";
    EXPECT_NEAR(sum_of_sizes, whole, 1e-6);
  }
}

TEST(Obj, polygons_that_are_none_give_triangles_all_the_same) {
  for (const std::size_t corners : {3u, 4u, 100u, 256u, 257u, 5000u}) {
    EXPECT_EQ(triangles_of(std::vector<Corner>(corners, Corner{1, 2, 3})).size(), corners - 2);
  }
  EXPECT_EQ(triangles_of({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size(), 2u) << "a bow tie";
}

TEST(Obj, materials_come_from_the_library_and_default_where_there_is_none) {
  const std::string library =
      "Kd 9 9 9\nnewmtl two words\nKd 0.2 0.4 7\nd 0.25\nnewmtl thin\nTr 0.75\nillum 2\n";
  const Model model = parse(kSquare +
                                "f 1 2 3\nusemtl two words\nf 1 2 3\nusemtl thin\nf 1 2 3\n"
                                "usemtl unknown\nf 1 2 3\n",
                            {{"a.mtl", library}});
  const auto material = [&](std::size_t i) { return model.materials[model.triangles[i].material]; };
  const rooms::ModelMaterial none;
  EXPECT_EQ(material(0).color, none.color);
  EXPECT_EQ(material(1).color, (std::array<float, 3>{0.2f, 0.4f, 1.f}));
  EXPECT_EQ(material(1).opacity, 0.25f);
  EXPECT_EQ(material(2).opacity, 0.25f);
  EXPECT_EQ(material(3).color, none.color);
  EXPECT_EQ(parse(kSquare + kTextured).materials.at(0).color, none.color) << "no library at all";
}

TEST(Obj, a_picture_is_shrunk_keeps_its_aspect_and_its_first_row_is_on_top) {
  cv::Mat3b picture(600, 1200, cv::Vec3b(10, 20, 250));
  picture.rowRange(300, 600) = cv::Vec3b(200, 100, 0);
  const Files files{{"a.mtl", "newmtl m\nKd 0.2 0.4 0.1\nmap_Kd -s 1 1 1 t\\p.png\n"},
                    {"t/p.png", png(picture)}};
  const Model model = parse(kSquare + kTextured, files);
  ASSERT_EQ(model.textures.size(), 1u);
  const rooms::Texture& texture = model.textures[0];
  EXPECT_EQ(texture.width, 256);
  EXPECT_EQ(texture.height, 128);
  ASSERT_EQ(texture.rgb.size(), 256u * 128 * 3);
  EXPECT_EQ((std::vector<int>{texture.rgb[0], texture.rgb[1], texture.rgb[2]}),
            (std::vector<int>{250, 20, 10}));
  EXPECT_EQ(texture.rgb.back(), 200);
  EXPECT_EQ(model.materials[0].color, (std::array<float, 3>{0.5f, 1, 0.25f})) << "a tint";
  EXPECT_EQ(model.uvs.size(), model.positions.size());
}

TEST(Obj, a_picture_that_is_not_there_leaves_the_colour) {
  const Model model =
      parse(kSquare + kTextured, {{"a.mtl", "newmtl m\nKd 0.2 0.4 0.1\nmap_Kd C:\\gone.png\n"}});
  EXPECT_EQ(model.materials.at(0).texture, -1);
  EXPECT_EQ(model.materials.at(0).color, (std::array<float, 3>{0.2f, 0.4f, 0.1f}));
}

TEST(Obj, triangles_where_the_picture_is_transparent_are_left_out) {
  cv::Mat4b picture(8, 8, cv::Vec4b(0, 0, 0, 255));
  picture.rowRange(0, 4) = cv::Vec4b(0, 0, 0, 0);  // the upper half, v above 0.5
  const Files files{{"a.mtl", "newmtl m\nmap_Kd p.png\n"}, {"p.png", png(picture)}};
  const std::string uvs = "vt 0 0.1\nvt 1 0.1\nvt 1 0.4\nvt 0 -5.4\nvt 1 -5.4\nvt 1 -5.1\n";
  const Model model = parse(kSquare + uvs + "usemtl m\nf 1/5 2/6 3/7\nf 1/8 2/9 4/10\n", files);
  ASSERT_EQ(model.triangles.size(), 1u);
  EXPECT_EQ(model.positions[model.triangles[0].corners[2]], (Corner{1, 1, 0}));
  EXPECT_TRUE(has(message(kSquare + uvs + "usemtl m\nf 1/8 2/9 4/10\n", files), "transparent"));
}

TEST(Obj, what_is_wrong_is_said_with_the_line) {
  EXPECT_TRUE(has(message(""), "a.obj: has no triangles"));
  EXPECT_TRUE(has(message("v 1 2 3\nl 1 1\nf 1 1\n"), "has no triangles"));
  EXPECT_TRUE(has(message("v 1 x 3\n"), "a.obj:1: 'x'"));
  EXPECT_TRUE(has(message("v 1 2\n"), "ends too early"));
  EXPECT_TRUE(has(message("v nan 2 3\n"), "not finite"));
  EXPECT_TRUE(has(message("v 1e99 2 3\n"), "too large"));
  for (const char* corner :
       {"0", "5", "-5", "x", "1.5", "99999999999999999999", "1/9", "1/x", "/1"}) {
    EXPECT_TRUE(has(message(kSquare + "f 1 2 " + corner + "\n"), "a.obj:10: a face's corner"));
  }
  EXPECT_TRUE(has(message(kSquare + kTextured, {{"a.mtl", "newmtl m\nKd red\n"}}), "a.mtl:2"));
  const Files broken{{"a.mtl", "newmtl m\nmap_Kd p.png\n"}, {"p.png", "no picture"}};
  EXPECT_TRUE(has(message(kSquare + kTextured, broken), "p.png"));
}

TEST(Obj, more_triangles_than_allowed_are_refused) {
  ObjOptions options;
  options.most_triangles = 3;
  EXPECT_EQ(parse(kSquare + "f 1 2 3 4\nf 1 2 3\n", {}, options).triangles.size(), 3u);
  EXPECT_TRUE(has(error_of([&] { parse(kSquare + "f 1 2 3 4\nf 1 2 3 4\n", {}, options); }),
                  "more than 3 triangles"));
}

}  // namespace
}  // namespace ps
