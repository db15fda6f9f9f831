// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/printable.h"
#include "plumbline/io/datasets/process_settings.h"
#include "plumbline/version.h"

#include "apps/commands.h"
#include "apps/shortage.h"
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iomanip>
#include <iostream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <unistd.h>

namespace plumbline {
namespace {

struct Command {
  std::string_view name;
  int (*run)(std::span<const std::string> arguments);
  std::string_view help;
};

constexpr std::array kCommands = {
    Command{"run", RunCommand, "track the camera through a sequence and map what it sees"},
    Command{"evaluate", EvaluateCommand, "errors of a trajectory against ground truth"},
#ifdef PLUMBLINE_WITH_LAB
    Command{"lines", LinesCommand, "errors of a run's lines against those of a known world"},
    Command{"consistency", ConsistencyCommand, "promised covariances of a run against the truth"},
    Command{"starts", StartsCommand, "try monocular starts at many frames, against ground truth"},
#endif
#ifdef PLUMBLINE_WITH_WORLDS
    Command{"synth", SynthCommand, "render a stereo sequence of an invented world"},
#endif
#ifdef PLUMBLINE_WITH_LAB
    Command{"experiment", ExperimentCommand, "make the tables and plots of an experiment"},
#endif
    Command{"info", InfoCommand, "what is at a path: format, sensors, frames, calibration"},
    Command{"map", MapCommand, "look into saved maps, export them, make one of two"},
    Command{"config", ConfigCommand, "all options with values and help, as a config file"},
};

// Commands that a build may lack, and the configuration needed for them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kOptional = {{
    {"lines", "-DPLUMBLINE_LAB=ON"},
    {"consistency", "-DPLUMBLINE_LAB=ON"},
    {"starts", "-DPLUMBLINE_LAB=ON"},
    {"synth", "-DPLUMBLINE_WORLDS=ON"},
    {"experiment", "-DPLUMBLINE_LAB=ON"},
}};

const Command& FindCommand(const std::string& name) {
  std::vector<std::string> names = {"help"};
  for (const Command& command : kCommands) {
    if (command.name == name) return command;
    names.emplace_back(command.name);
  }
  for (const auto& [optional, option] : kOptional) {
    if (optional != name) continue;
    throw InputError(name + " is not part of this build of plumbline; configure with " +
                     std::string(option));
  }
  const std::optional<std::string> nearest = NearestName(name, names);
  throw InputError("unknown command " + InQuotes(name) +
                   (nearest ? "; did you mean '" + *nearest + "'?" : "; see plumbline help"));
}

void PrintHelp(std::ostream& out) {
  out << "plumbline " PLUMBLINE_VERSION ": visual SLAM with points and straight lines\n\n"
      << "usage: plumbline COMMAND [arguments]\n\n";
  for (const Command& command : kCommands) {
    out << "  " << std::left << std::setw(12) << command.name << command.help << "\n";
  }
  out << "  " << std::setw(12) << "help"
      << "this text; `plumbline COMMAND --help` for a command\n";
}

int Dispatch(std::span<const std::string> arguments) {
  if (arguments.empty()) {
    PrintHelp(std::clog);
    return 2;
  }
  const std::string& name = arguments.front();
  if (name == "--version") {
    std::cout << "plumbline " PLUMBLINE_VERSION "\n";
    return 0;
  }
  if (name != "help" && name != "--help" && name != "-h") {
    return FindCommand(name).run(arguments.subspan(1));
  }
  if (arguments.size() == 1) {
    PrintHelp(std::cout);
    return 0;
  }
  const std::vector<std::string> help = {"--help"};
  return FindCommand(arguments[1]).run(help);
}

// Standard streams may be closed at the start (`>&-`). The first files opened would replace them,
// and output would go into these.
void OpenStandardStreams() {
  for (int descriptor = STDIN_FILENO; descriptor <= STDERR_FILENO; ++descriptor) {
    if (::fcntl(descriptor, F_GETFD) >= 0) continue;
    // the lowest free descriptor, if it works
    if (::open("/dev/null", O_RDWR) != descriptor) return;
  }
}

// Libraries that decode images and videos write messages to standard error ("libpng warning: ...",
// "moov atom not found"), without the name of the file and beside the program's message. Messages
// to `stderr` and std::cerr are dropped, unless the environment sets the level of OpenCV's log. The
// program itself writes to std::clog, which keeps the stream.
void DropMessagesOfLibraries() {
  std::clog.tie(&std::cout);
  // NOLINTNEXTLINE(concurrency-mt-unsafe): there is one thread yet
  if (std::getenv("OPENCV_LOG_LEVEL") != nullptr) return;
  std::cerr.rdbuf(nullptr);
  std::FILE* const nowhere = std::fopen("/dev/null", "w");
  if (nowhere != nullptr) stderr = nowhere;
}

}  // namespace
}  // namespace plumbline

int main(int argc, char** argv) {
  plumbline::OpenStandardStreams();
  plumbline::DropMessagesOfLibraries();
  plumbline::SetUpProcess();
  try {
    const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
    const int code = plumbline::Dispatch(arguments);
    if (!std::cout.flush()) throw plumbline::InputError("cannot write to standard output");
    return code;
  } catch (const plumbline::InputError& error) {
    std::clog << "plumbline: " << plumbline::Printable(error.what(), plumbline::kLongestMessage)
              << "\n";
    return 2;
  } catch (const std::exception& error) {
    if (const char* shortage = plumbline::ShortageOf(error)) {
      std::clog << "plumbline: " << shortage << "\n";
      return 2;
    }
    std::clog << "plumbline: internal error: "
              << plumbline::Printable(error.what(), plumbline::kLongestMessage) << "\n";
    return 1;
  }
}
