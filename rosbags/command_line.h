// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/program_options/options_description.hpp>
#include <boost/program_options/variables_map.hpp>
#include <functional>
#include <string>
#include <vector>

namespace planecloud {

/// What a tool says of itself and which flags it knows.
struct ToolDescription {
  std::string name;
  std::string summary;     ///< what it does, one or two lines
  std::string synopsis;    ///< arguments after the name, e.g. "INPUT [flags]"
  std::string notes = {};  ///< shown after the flags, may be empty
  boost::program_options::options_description flags = {};
  /// Names of the arguments without a flag, in order; the last one takes all that are left. They
  /// are read as `std::vector<std::string>` (last) or `std::string` (the others).
  std::vector<std::string> arguments = {};
};

using ParsedFlags = boost::program_options::variables_map;

/// Parses the command line and calls `body`. Returns the program's exit status: what `body`
/// returns, 0 after --help, 2 with the cause on stderr for wrong use (an unknown flag, a missing
/// argument, a UsageError), 1 with the cause on stderr for any other exception.
[[nodiscard]] int runTool(const ToolDescription& tool, int argc, const char* const* argv,
                          const std::function<int(const ParsedFlags&)>& body);

/// Throws UsageError `--flag = value: must be in [low, high]`.
void checkFlag(const std::string& flag, double value, double low, double high);

}  // namespace planecloud
