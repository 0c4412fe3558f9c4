// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/plane_fit/option_values.h"

namespace planecloud {
namespace {

enum class Fruit { kApple, kPear };

std::string toString(Fruit fruit) { return fruit == Fruit::kApple ? "apple" : "pear"; }

void fromString(const std::string& text, Fruit& fruit) {
  if (text != "apple" && text != "pear")
    throw std::invalid_argument("fruit: must be apple or pear");
  fruit = text == "apple" ? Fruit::kApple : Fruit::kPear;
}

struct InnerOptions {
  double width = 0.1;
  int count = 3;
  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("width", self.width);
    visit("count", self.count);
  }
};

struct OuterOptions {
  bool on = true;
  std::string name = "robot";
  Fruit fruit = Fruit::kApple;
  InnerOptions inner;
  template <typename Self, typename Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("on", self.on);
    visit("name", self.name);
    visit("fruit", self.fruit);
    visitFields("inner/", self.inner, visit);
  }
};

std::string errorOf(const std::string& key, const std::string& text) {
  OptionValues values{{key, text}};
  OuterOptions options;
  try {
    takeOptions(values, options);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(OptionValues, ReadBackWhatTheyWrote) {
  OuterOptions written;
  written.on = false;
  written.name = "left arm";
  written.fruit = Fruit::kPear;
  written.inner = {1.0 / 3.0, -7};
  OptionValues values = dumpOptions(written);
  OuterOptions read;
  takeOptions(values, read);
  EXPECT_TRUE(values.empty());
  EXPECT_EQ(dumpOptions(read), dumpOptions(written));
  EXPECT_EQ(read.inner.width, written.inner.width);
}

TEST(OptionValues, WriteShortNumbersShort) {
  EXPECT_EQ(formatOption(0.1), "0.1");
  EXPECT_EQ(formatOption(64e6), "6.4e+07");
}

TEST(OptionValues, LeaveUnknownKeysBehind) {
  OptionValues values{{"inner/widht", "2"}, {"inner/count", "4"}};
  OuterOptions options;
  takeOptions(values, options);
  ASSERT_EQ(values.size(), 1U);
  EXPECT_EQ(nearestKey(values.begin()->first, dumpOptions(options)), "inner/width");
}

TEST(OptionValues, RefuseTextsOfAnotherType) {
  EXPECT_EQ(errorOf("inner/count", "3.5"), "inner/count = 3.5: must be a whole number");
  EXPECT_EQ(errorOf("inner/width", "wide"), "inner/width = wide: must be a number");
  EXPECT_EQ(errorOf("on", "1"), "on = 1: must be true or false");
  EXPECT_EQ(errorOf("fruit", "plum"), "fruit = plum: must be apple or pear");
}

}  // namespace
}  // namespace planecloud
