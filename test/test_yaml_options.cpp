// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "expect_error.h"
#include "planecloud_slam/rosbags/yaml_options.h"
#include "temporary_folder.h"

namespace planecloud {
namespace {

struct CupOptions {
  double volume = 0.25;
  int handles = 1;
  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("volume", self.volume);
    visit("handles", self.handles);
  }
};

struct TableOptions {
  bool round = false;
  std::string wood = "oak";
  CupOptions cup;
  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("round", self.round);
    visit("wood", self.wood);
    visitFields("cup/", self.cup, visit);
  }
  void check() const { checkRange("cup/volume", cup.volume, 0.0, 1.0); }
};

class YamlOptionsTest : public testing::Test {
 protected:
  [[nodiscard]] TableOptions load(const std::string& text) const {
    TableOptions options;
    loadYamlOptions(folder_.write("table.yaml", text), options);
    return options;
  }
  void expectRefused(const std::string& text, const std::vector<std::string>& parts) const {
    expectError<std::exception>([&] { (void)load(text); }, parts);
  }
  TemporaryFolder folder_;
};

TEST_F(YamlOptionsTest, SetsTheFieldsItNamesAndLeavesTheRest) {
  const TableOptions options = load("# a table\nround: true\ncup:\n  volume: 0.5\n");
  EXPECT_TRUE(options.round);
  EXPECT_EQ(options.wood, "oak");
  EXPECT_EQ(options.cup.volume, 0.5);
  EXPECT_EQ(options.cup.handles, 1);
  EXPECT_EQ(load("").wood, "oak");
}

TEST_F(YamlOptionsTest, AcceptsKeysWithSlashes) {
  EXPECT_EQ(load("cup/handles: 2\n").cup.handles, 2);
}

TEST_F(YamlOptionsTest, ReadsBackWhatItFormats) {
  TableOptions written;
  written.round = true;
  written.cup = {1.0 / 3.0, 3};
  const TableOptions read = load(formatYamlOptions(dumpOptions(written)));
  EXPECT_EQ(dumpOptions(read), dumpOptions(written));
}

TEST_F(YamlOptionsTest, NamesAnUnknownKeyAndTheNearestKnownOne) {
  expectRefused("cup:\n  handels: 2\n", {"table.yaml", "'cup/handels'", "'cup/handles'"});
}

TEST_F(YamlOptionsTest, NamesKeyValueAndRange) {
  expectRefused("cup: {volume: 3}\n", {"cup/volume = 3: must be in [0, 1]"});
  expectRefused("round: maybe\n", {"round = maybe: must be true or false"});
  expectRefused("cup: {handles: 1.5}\n", {"cup/handles = 1.5: must be a whole number"});
}

TEST_F(YamlOptionsTest, NamesTheLineOfWhatIsNotAMapOfValues) {
  expectRefused("round: true\ncup: [1, 2]\n", {"table.yaml:2", "cup"});
  expectRefused("round: true\ncup: {\n", {"table.yaml:"});
  expectRefused("just words\n", {"table.yaml", "key: value"});
  expectRefused("cup: {handles: 1}\ncup/handles: 2\n", {"table.yaml:2", "given twice"});
  TableOptions options;
  expectError<std::runtime_error>([&] { loadYamlOptions("/no/such.yaml", options); },
                                  {"/no/such.yaml"});
}

}  // namespace
}  // namespace planecloud
