// SPDX-License-Identifier: BSD-3-Clause
#include "io/furniture.h"

#include <algorithm>

#include "tests/io/checkpoint_maker.h"

namespace ps {
namespace {

using rooms::Model;

/// Two triangles, from (1, 2, 3) to (2, 4, 6).
const char* const kBox =
    "mtllib box.mtl\nv 1 2 3\nv 2 2 3\nv 2 4 3\nv 1 2 6\nusemtl m\nf 1 2 3\nf 1 2 4\n";

std::string list(const std::string& models, const std::string& licence = "Public domain") {
  return "# hand made\n\nname=Test\nlicense=" + licence + "\n" + models;
}

/// Number `i`, named "Sofa i", 2 m wide, 0.5 m deep and 1 m high.
std::string sofa(int i, const std::string& more = "") {
  const std::string n = "#" + std::to_string(i) + "=";
  return "name" + n + "Sofa " + std::to_string(i) + "\ncategory" + n + "Living room\nmodel" + n +
         "/x/box/box.obj\nwidth" + n + "200\ndepth" + n + "50\nheight" + n + "100.0\ncreator" + n +
         "Ann\n" + more;
}

std::string catalogue(const std::string& list, const std::string& obj = kBox) {
  return maker::zip_of({{"PluginFurnitureCatalog.properties", list},
                        {"x/box/box.obj", obj},
                        {"x/box/box.mtl", "newmtl m\nKd 0.1 0.2 0.3\n"}},
                       true);
}

Furniture parse(const std::string& list) { return parse_furniture(catalogue(list), "a.sh3f"); }

TEST(Furniture, a_model_is_scaled_to_its_catalogue_and_stands_on_the_origin) {
  const Furniture all = parse(list(sofa(1, "elevation#1=42\n") + sofa(2, "doorOrWindow#2=true\n")));
  ASSERT_EQ(all.models.size(), 2u);
  const Model& model = all.models[0];
  EXPECT_EQ(model.name, "Sofa 1");
  EXPECT_EQ(model.category, "Living room");
  EXPECT_FLOAT_EQ(model.elevation, 0.42f);
  EXPECT_FALSE(model.door_or_window);
  EXPECT_TRUE(all.models[1].door_or_window);
  EXPECT_EQ(model.materials.at(0).color, (std::array<float, 3>{0.1f, 0.2f, 0.3f}));
  const std::vector<std::array<float, 3>> expected = {
      {-1, 0, -0.25f}, {1, 0, -0.25f}, {1, 1, -0.25f}, {-1, 0, 0.25f}};
  EXPECT_EQ(model.positions, expected);
}

TEST(Furniture, a_model_is_turned_before_it_is_scaled) {
  // z up becomes y up: what was up to the front, z = 6, is the top; what was on top is at the back.
  const Furniture all = parse(list(sofa(1, "modelRotation#1=1 0 0 0 0 1 0 -1 0\n")));
  ASSERT_EQ(all.models.size(), 1u);
  const std::vector<std::array<float, 3>> expected = {
      {-1, 0, 0.25f}, {1, 0, 0.25f}, {1, 0, -0.25f}, {-1, 1, 0.25f}};
  EXPECT_EQ(all.models[0].positions, expected);
}

TEST(Furniture, only_free_licences_are_taken_and_the_rest_is_named) {
  const Furniture all = parse(list(sofa(1) + sofa(2, "license#2=All rights reserved\n") +
                                       sofa(3, "license#3=CC-BY 4.0\ncreator#3=J\\u00f6 \xe9\n"),
                                   "CC0"));
  ASSERT_EQ(all.models.size(), 2u);
  ASSERT_EQ(all.left_out.size(), 1u);
  EXPECT_TRUE(has(all.left_out[0], "a.sh3f: 'Sofa 2' has no free licence: 'All rights reserved'"));
  ASSERT_EQ(all.credits.size(), 2u);
  EXPECT_EQ(all.credits[0].catalogue, "Test");
  EXPECT_EQ(all.credits[0].creator, "Ann");
  EXPECT_EQ(all.credits[0].licence, "CC0");
  EXPECT_EQ(all.credits[0].models, 1);
  EXPECT_EQ(all.credits[1].creator, "J\xc3\xb6 \xc3\xa9") << "Java's escapes and Latin-1";
  EXPECT_EQ(all.credits[1].licence, "CC-BY 4.0");
  EXPECT_TRUE(parse(list(sofa(1), "")).models.empty());
}

TEST(Furniture, licences_are_told_apart) {
  for (const char* free : {"Public domain", "CC0 1.0", "CC-0", "CC BY 3.0", "cc-by",
                           "Creative Commons Attribution 3.0 Unported license  \xc2\xa9 Someone"}) {
    EXPECT_TRUE(is_free_licence(free)) << free;
  }
  for (const char* other :
       {"", "Copyright Someone", "Creative Commons", "CC BY-NC 4.0", "CC-BY-ND", "CC BY-SA",
        "Creative Commons Attribution-NonCommercial 3.0", "Creative Commons Attribution-ShareAlike",
        "Creative Commons Attribution-NoDerivs", "not in the public domain"}) {
    EXPECT_FALSE(is_free_licence(other)) << other;
  }
}

TEST(Furniture, a_broken_model_is_left_out_and_the_others_stay) {
  const Furniture all =
      parse(list(sofa(1, "model#1=/gone.obj\n") + sofa(2, "width#2=wide\n") +
                 sofa(3, "height#3=-1\n") + sofa(4, "modelRotation#4=1 0\n") + sofa(5)));
  ASSERT_EQ(all.models.size(), 1u);
  EXPECT_EQ(all.models[0].name, "Sofa 5");
  ASSERT_EQ(all.left_out.size(), 4u);
  EXPECT_TRUE(has(all.left_out[0], "gone.obj"));
  EXPECT_TRUE(has(all.left_out[1], "width#2 is 'wide'; expected 1 number"));
  EXPECT_TRUE(has(all.left_out[2], "has no size"));
  EXPECT_TRUE(has(all.left_out[3], "modelRotation#4 is '1 0'; expected 9"));
}

TEST(Furniture, flat_models_stay_flat_and_finite) {
  const std::string flat = "v 0 5 0\nv 1 5 0\nv 1 5 1\nf 1 2 3\n";
  const Furniture all = parse_furniture(catalogue(list(sofa(1)), flat), "a.sh3f");
  ASSERT_EQ(all.models.size(), 1u);
  for (const auto& p : all.models[0].positions) EXPECT_EQ(p[1], 0);
  EXPECT_EQ(all.models[0].positions[2][2], 0.25f);
}

TEST(Furniture, what_is_no_catalogue_is_refused) {
  const auto message = [](const std::string& bytes) {
    return error_of([&] { parse_furniture(bytes, "a.sh3f"); });
  };
  EXPECT_TRUE(has(message("no archive"), "a.sh3f"));
  EXPECT_TRUE(has(message(maker::zip_of({{"a", "b"}})), "is missing"));
  EXPECT_TRUE(has(message(catalogue(list(""))), "names no model"));
  const Folder folder;
  EXPECT_TRUE(has(error_of([&] { read_furniture(folder.path()); }), "holds no catalogue"));
  EXPECT_TRUE(has(error_of([&] { read_furniture(folder / "gone.sh3f"); }), "gone.sh3f"));
}

TEST(Furniture, a_folder_gives_all_its_catalogues_in_order) {
  const Folder folder;
  put(folder / "b.sh3f", catalogue(list(sofa(1) + sofa(2))));
  put(folder / "a.sh3f", catalogue(list(sofa(1, "name#1=First\n"))));
  put(folder / "readme.txt", "not one");
  const Furniture all = read_furniture(folder.path());
  ASSERT_EQ(all.models.size(), 3u);
  EXPECT_EQ(all.models[0].name, "First");
  ASSERT_EQ(all.credits.size(), 1u);
  EXPECT_EQ(all.credits[0].models, 3);
  EXPECT_EQ(read_furniture(folder / "b.sh3f").models.size(), 2u);
}

TEST(Furniture, debian_s_package_is_read_almost_whole) {
  if (!std::filesystem::exists(kDebianFurniture)) {
    GTEST_SKIP() << "the package sweethome3d-furniture is not installed";
  }
  const Furniture all = read_furniture(kDebianFurniture);
  EXPECT_GT(all.models.size(), 700u);
  EXPECT_LT(all.left_out.size(), 60u);
  EXPECT_GT(all.credits.size(), 100u);
  int credited = 0;
  for (const FurnitureCredit& credit : all.credits) {
    EXPECT_FALSE(credit.creator.empty());
    credited += credit.models;
  }
  EXPECT_EQ(credited, static_cast<int>(all.models.size()));
  for (const Model& model : all.models) {
    float low = 1, high = 0;
    for (const auto& p : model.positions) {
      low = std::min(low, p[1]);
      high = std::max(high, p[1]);
    }
    EXPECT_NEAR(low, 0, 1e-4) << model.name;
    EXPECT_LT(high, 30) << model.name;
    for (const Model::Triangle& triangle : model.triangles) {
      for (const std::uint32_t corner : triangle.corners) {
        ASSERT_LT(corner, model.positions.size());
      }
      ASSERT_LT(triangle.material, model.materials.size());
    }
    for (const rooms::ModelMaterial& material : model.materials) {
      ASSERT_LT(material.texture, static_cast<int>(model.textures.size()));
    }
    EXPECT_TRUE(model.textures.empty() || model.uvs.size() == model.positions.size());
  }
}

}  // namespace
}  // namespace ps
