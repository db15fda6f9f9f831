// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/report/run_folder.h"
#include "worlds/world_catalog.h"
#include "worlds/write_sequence.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include "apps/progress.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <span>
#include <string>
#include <thread>

namespace plumbline {
namespace {

CommandSyntax SynthSyntax() {
  return {
      "synth",
      "Renders a sequence of an invented world with exact ground truth: poses, depth, 3D lines, "
      "inertial samples. WORLD is the name of a built-in world or a file FILE.yaml of your own.",
      {"[WORLD]"},
      {{"--out", "DIR", "folder to write, made where it does not exist"},
       {"--format", "euroc|tum", "stereo as a EuRoC folder or RGB-D as a TUM folder (euroc)"},
       {"--set", "KEY=VALUE", "set an option of the world; may be repeated"},
       {"--list", "", "list the worlds and the options (with WORLD: its own default values)"}}};
}

void List(const std::string& name) {
  SynthOptions options;
  if (name.empty()) {
    std::cout << "worlds:\n";
    for (const WorldEntry& world : Worlds()) {
      std::cout << "  " << std::left << std::setw(18) << world.name << world.help << '\n';
    }
  } else {
    const WorldSource world = OpenWorld(name);
    std::cout << world.name << ": " << world.help << '\n';
    if (!world.purpose.empty()) std::cout << "Purpose: " << world.purpose << ".\n";
    options = world.defaults;
    const World made = world.make(options.seed);
    const double seconds = made.path.duration / options.speed;
    std::cout << "The whole path takes " << std::fixed << std::setprecision(1) << seconds << " s, "
              << std::llround(std::floor(seconds * options.rate_hz)) << " frames"
              << (made.second_path ? "; there is a second one" : "") << ".\n";
  }
  std::cout << "\noptions (--set KEY=VALUE) with their default values:\n"
            << OptionTable(options).Dump();
}

}  // namespace

int SynthCommand(std::span<const std::string> arguments) {
  const CommandLine line(SynthSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(SynthSyntax());
    return 0;
  }
  const std::string& name = line.Positional(0);
  if (line.Has("--list")) {
    List(name);
    return 0;
  }
  if (name.empty()) {
    throw InputError("synth: expected the name of a world; plumbline synth --list shows them");
  }
  const WorldSource world = OpenWorld(name);
  SynthOptions options = world.defaults;
  OptionTable table(options);
  for (const std::string& setting : line.Values("--set")) table.Set(setting);
  SequenceFormat format = SequenceFormat::kEuroc;
  if (const auto text = line.Value("--format")) {
    format = ParseChoice<SequenceFormat>("--format", *text);
  }
  const auto folder = line.Value("--out");
  if (!folder) throw InputError("synth: expected --out DIR");
  if (!world.text.empty()) CheckApart(*folder, std::array{RunInput{name}});
  CheckSequenceFolder(*folder);
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const SyntheticSequence sequence(world, options, threads);
  Countdown progress("frames", static_cast<std::size_t>(sequence.size()));
  WriteSequence(sequence, format, *folder, threads, [&](int done) {
    progress.Show(static_cast<std::size_t>(done));
  });
  std::cout << sequence.size() << (format == SequenceFormat::kEuroc ? " pairs" : " images")
            << " written to " << *folder << '\n';
  return 0;
}

}  // namespace plumbline
