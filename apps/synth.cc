// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/base/options_io.h"
#include "plumbline/synth/sequence.h"

#include "apps/command_line.h"
#include "apps/commands.h"
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <span>
#include <string>
#include <thread>

#include <unistd.h>

namespace plumbline {
namespace {

CommandSyntax Syntax() {
  return {
      "synth",
      "Renders a stereo sequence of an invented world with exact ground truth, as a EuRoC folder.",
      {"[WORLD]"},
      {{"--out", "DIR", "folder to write, made where it does not exist"},
       {"--set", "KEY=VALUE", "set an option of the world; may be repeated"},
       {"--list", "", "list the worlds and their options"}}};
}

void List() {
  std::cout << "worlds:\n";
  for (const WorldEntry& world : Worlds()) {
    std::cout << "  " << std::left << std::setw(8) << world.name << world.help << '\n';
  }
  SynthOptions options;
  std::cout << "\noptions (--set KEY=VALUE) with their default values:\n"
            << OptionTable(options).Dump();
}

// A counter on a terminal, nothing elsewhere.
void ShowProgress(int done, int frames) {
  constexpr int kEvery = 10;
  if (isatty(STDERR_FILENO) == 0 || (done % kEvery != 0 && done != frames)) return;
  std::cerr << "\rrendering " << done << " of " << frames << " pairs"
            << (done == frames ? "\n" : "") << std::flush;
}

}  // namespace

int SynthCommand(std::span<const std::string> arguments) {
  const CommandLine line(Syntax(), arguments);
  if (line.help() || line.Has("--list")) {
    if (line.help()) {
      std::cout << HelpText(Syntax());
    } else {
      List();
    }
    return 0;
  }
  if (line.Positional(0).empty()) {
    throw InputError("synth: expected the name of a world; plumbline synth --list shows them");
  }
  SynthOptions options;
  OptionTable table(options);
  for (const std::string& setting : line.Values("--set")) table.Set(setting);
  const auto folder = line.Value("--out");
  if (!folder) throw InputError("synth: expected --out DIR");
  const int threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const StereoSequence sequence(line.Positional(0), options, threads);
  WriteSequence(sequence, *folder, threads, [&](int done) { ShowProgress(done, sequence.size()); });
  std::cout << sequence.size() << " pairs written to " << *folder << '\n';
  return 0;
}

}  // namespace plumbline
