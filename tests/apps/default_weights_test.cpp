// SPDX-License-Identifier: BSD-3-Clause
#include "apps/default_weights.h"

#include <gtest/gtest.h>

#include "apps/part.h"
#include "libps/core/error.h"

namespace ps::apps {
namespace {

/// What default_weights() says of weights that are in neither place; empty when it says nothing.
std::string complaint(const std::string& name) {
  try {
    default_weights(name);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(DefaultWeights, missing_name_both_places_and_the_option) {
  const std::string installed = program_folder() / "no/weights/absent.safetensors";
  EXPECT_EQ(
      complaint("absent.safetensors"),
      "absent.safetensors: these weights, which come with the program, are missing; expected " +
          installed + " or " PS_DATA_DIR "/weights/absent.safetensors, or --weights FILE");
  EXPECT_FALSE(find_default_weights("absent.safetensors"));
}

TEST(DefaultWeights, of_an_installed_program_come_before_those_of_its_source) {
  namespace fs = std::filesystem;
  EXPECT_EQ(default_weights("depth.safetensors"),
            fs::path(PS_DATA_DIR "/weights/depth.safetensors"));
  const fs::path folder = program_folder() / "no";
  fs::create_directories(folder / "weights");
  fs::copy_file(PS_DATA_DIR "/weights/depth.safetensors", folder / "weights/depth.safetensors",
                fs::copy_options::overwrite_existing);
  EXPECT_EQ(default_weights("depth.safetensors"), folder / "weights/depth.safetensors");
  fs::remove_all(folder);
}

}  // namespace
}  // namespace ps::apps
