// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>

#include "planecloud_slam/icap/icap_options.h"
#include "planecloud_slam/plane_fit/option_values.h"

namespace planecloud {
namespace {

TEST(IcapOptions, HasDefaultsInRange) { EXPECT_NO_THROW(IcapOptions().check()); }

TEST(IcapOptions, NamesKeyValueAndRangeOfABadField) {
  IcapOptions options;
  options.planes.fine_tile = 1;
  try {
    options.check();
    FAIL() << "fine_tile = 1 must be refused";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "icap/fine_tile = 1: must be in [2, 64]");
  }
}

TEST(IcapOptions, ChecksEveryNumber) {
  // Out of any range, whatever the field.
  for (const auto& [key, text] : dumpOptions(IcapOptions(), "icap/")) {
    if (key == "icap/form") continue;
    OptionValues values{{key, "-1"}};
    IcapOptions options;
    if (text == "true" || text == "false") {
      EXPECT_THROW(takeOptions(values, options, "icap/"), std::invalid_argument) << key;
      continue;
    }
    takeOptions(values, options, "icap/");
    EXPECT_TRUE(values.empty()) << key;
    EXPECT_THROW(options.check(), std::invalid_argument) << key << " (default " << text << ")";
  }
}

TEST(IcapOptions, ReadsBackTheNamesOfTheForms) {
  for (const IcapForm form : {IcapForm::kPaper, IcapForm::kRobust}) {
    IcapForm read = IcapForm::kRobust;
    fromString(toString(form), read);
    EXPECT_EQ(read, form);
  }
  IcapForm form = IcapForm::kPaper;
  EXPECT_THROW(fromString("literal", form), std::invalid_argument);
}

}  // namespace
}  // namespace planecloud
