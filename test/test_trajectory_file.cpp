// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "expect_error.h"
#include "planecloud_slam/plane_fit/se3.h"
#include "planecloud_slam/rosbags/trajectory_file.h"
#include "temporary_folder.h"

namespace planecloud {
namespace {

TEST(TrajectoryFile, ReadsBackWhatItWrote) {
  Trajectory written;
  for (int i = 0; i < 20; ++i) {
    Vector6d xi;
    xi << i, -2.0 * i, 0.1, 0.15 * i, 0.3, -0.1 * i;
    written.push_back({1305031102.160407 + i, expSe3(xi)});
  }
  const TemporaryFolder folder;
  writeTrajectory(folder / "a.txt", written);
  const Trajectory read = readTrajectory(folder / "a.txt");
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_NEAR(read[i].stamp, written[i].stamp, 1e-6);
    // Written to the micrometre and to 1e-7 of a unit quaternion.
    EXPECT_LT(logSe3(read[i].pose.inverse() * written[i].pose).norm(), 3e-6);
  }
}

TEST(TrajectoryFile, SkipsCommentsAndEmptyLinesAndSortsByStamp) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("a.txt", "# stamp\n\n2 0 0 0 0 0 0 1\r\n  # more\n1 5 0 0 0 0 0 1\n");
  const Trajectory read = readTrajectory(path);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].stamp, 1.0);
  EXPECT_EQ(read[0].pose.translation().x(), 5.0);
}

TEST(TrajectoryFile, NamesTheLineThatIsWrong) {
  const TemporaryFolder folder;
  const auto error_of = [&](const std::string& line, const std::vector<std::string>& parts) {
    const std::string path = folder.write("a.txt", "# stamp\n1 0 0 0 0 0 0 1\n" + line + "\n");
    expectError<std::runtime_error>([&] { (void)readTrajectory(path); }, parts);
  };
  error_of("1 2 3", {"a.txt:3", "fewer than 8"});
  error_of("1 2 3 4 x 0 0 1", {"a.txt:3", "fewer than 8"});
  error_of("1 2 3 4 0 0 0 1 9", {"a.txt:3", "unexpected '9'"});
  error_of("1 2 3 4 0 0 0 2", {"a.txt:3", "norm 2"});
  error_of("1 2 3 4 0 0 0 0", {"a.txt:3", "norm 0"});
}

TEST(TrajectoryFile, SaysWhichFileIsMissing) {
  expectError<std::runtime_error>([] { (void)readTrajectory("/no/such/file"); }, {"/no/such/file"});
  expectError<std::runtime_error>([] { writeTrajectory("/no/such/file", {}); }, {"/no/such/file"});
}

}  // namespace
}  // namespace planecloud
