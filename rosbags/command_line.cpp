// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/command_line.h"

#include <boost/program_options/parsers.hpp>
#include <boost/program_options/positional_options.hpp>
#include <boost/program_options/value_semantic.hpp>
#include <iostream>

#include "planecloud_slam/plane_fit/option_fields.h"
#include "planecloud_slam/rosbags/usage_error.h"

namespace planecloud {
namespace po = boost::program_options;
namespace {

void printHelp(const ToolDescription& tool, const po::options_description& flags) {
  std::cout << tool.summary << "\n\nUsage: " << tool.name << ' ' << tool.synopsis << "\n\n"
            << flags;
  if (!tool.notes.empty()) std::cout << '\n' << tool.notes << '\n';
}

ParsedFlags parse(const ToolDescription& tool, const po::options_description& visible, int argc,
                  const char* const* argv) {
  po::options_description all;
  all.add(visible);
  po::positional_options_description positions;
  for (std::size_t i = 0; i < tool.arguments.size(); ++i) {
    const std::string& name = tool.arguments[i];
    const bool last = i + 1 == tool.arguments.size();
    if (last) {
      all.add_options()(name.c_str(), po::value<std::vector<std::string>>());
    } else {
      all.add_options()(name.c_str(), po::value<std::string>());
    }
    positions.add(name.c_str(), last ? -1 : 1);
  }
  const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  ParsedFlags parsed;
  po::store(
      po::command_line_parser(argc, argv).options(all).positional(positions).style(style).run(),
      parsed);
  if (parsed.count("help") != 0) return parsed;
  po::notify(parsed);
  for (const std::string& name : tool.arguments) {
    if (parsed.count(name) == 0) throw UsageError("no " + name + " given");
  }
  return parsed;
}

int wrongUse(const ToolDescription& tool, const std::string& cause) {
  std::cerr << tool.name << ": " << cause << "\nUsage: " << tool.name << ' ' << tool.synopsis
            << "\n`" << tool.name << " --help` explains each flag.\n";
  return 2;
}

}  // namespace

int runTool(const ToolDescription& tool, int argc, const char* const* argv,
            const std::function<int(const ParsedFlags&)>& body) {
  po::options_description visible("Flags");
  visible.add_options()("help,h", "show this text");
  for (const auto& flag : tool.flags.options()) visible.add(flag);
  try {
    const ParsedFlags parsed = parse(tool, visible, argc, argv);
    if (parsed.count("help") != 0) {
      printHelp(tool, visible);
      return 0;
    }
    return body(parsed);
  } catch (const po::error& error) {
    return wrongUse(tool, error.what());
  } catch (const UsageError& error) {
    return wrongUse(tool, error.what());
  } catch (const std::exception& error) {
    std::cerr << tool.name << ": " << error.what() << '\n';
    return 1;
  }
}

void checkFlag(const std::string& flag, double value, double low, double high) {
  try {
    checkRange("--" + flag, value, low, high);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

}  // namespace planecloud
