// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "planecloud_slam/rosbags/command_line.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace {

namespace po = boost::program_options;
using testing::internal::CaptureStderr;
using testing::internal::CaptureStdout;
using testing::internal::GetCapturedStderr;
using testing::internal::GetCapturedStdout;

ToolDescription describe() {
  ToolDescription tool;
  tool.name = "peel";
  tool.summary = "Peels apples.";
  tool.synopsis = "APPLE [--thickness MM]";
  tool.flags.add_options()("thickness", po::value<double>()->default_value(1.0), "of the peel");
  tool.arguments = {"APPLE"};
  return tool;
}

int run(std::vector<const char*> arguments, const std::function<int(const ParsedFlags&)>& body) {
  arguments.insert(arguments.begin(), "peel");
  return runTool(describe(), static_cast<int>(arguments.size()), arguments.data(), body);
}

int succeed(const ParsedFlags&) { return 0; }

TEST(CommandLine, GivesTheFlagsAndArgumentsToTheBody) {
  const int status = run({"red", "--thickness", "2.5", "green"}, [](const ParsedFlags& flags) {
    EXPECT_EQ(flags["thickness"].as<double>(), 2.5);
    EXPECT_EQ(flags["APPLE"].as<std::vector<std::string>>(),
              (std::vector<std::string>{"red", "green"}));
    return 7;
  });
  EXPECT_EQ(status, 7);
}

TEST(CommandLine, HelpGoesToStandardOutputAndSucceeds) {
  CaptureStdout();
  EXPECT_EQ(run({"--help"}, succeed), 0);
  const std::string text = GetCapturedStdout();
  EXPECT_NE(text.find("Peels apples."), std::string::npos);
  EXPECT_NE(text.find("peel APPLE"), std::string::npos);
  EXPECT_NE(text.find("of the peel"), std::string::npos);
}

TEST(CommandLine, WrongUseIsTwoWithTheCauseOnStandardError) {
  const std::vector<std::pair<std::vector<const char*>, std::string>> cases = {
      {{}, "no APPLE given"},
      {{"red", "--colour"}, "--colour"},
      {{"red", "--thick", "1"}, "--thick"},  // no guessing: scripts outlive flags
      {{"red", "--thickness", "thin"}, "thickness"},
      {{"red", "--thickness"}, "thickness"},
  };
  for (const auto& [arguments, cause] : cases) {
    CaptureStderr();
    EXPECT_EQ(run(arguments, succeed), 2);
    const std::string text = GetCapturedStderr();
    EXPECT_NE(text.find(cause), std::string::npos) << text;
    EXPECT_NE(text.find("--help"), std::string::npos) << text;
  }
}

TEST(CommandLine, ExceptionsOfTheBodyBecomeExitStatuses) {
  CaptureStderr();
  EXPECT_EQ(run({"red"}, [](const ParsedFlags&) -> int { throw UsageError("sour"); }), 2);
  EXPECT_NE(GetCapturedStderr().find("peel: sour"), std::string::npos);
  CaptureStderr();
  EXPECT_EQ(run({"red"}, [](const ParsedFlags&) -> int { throw std::runtime_error("rotten"); }), 1);
  EXPECT_NE(GetCapturedStderr().find("peel: rotten"), std::string::npos);
}

TEST(CommandLine, ChecksRangesOfFlags) {
  EXPECT_NO_THROW(checkFlag("thickness", 1.0, 0.5, 5.0));
  EXPECT_THROW(checkFlag("thickness", 9.0, 0.5, 5.0), UsageError);
}

}  // namespace
}  // namespace planecloud
