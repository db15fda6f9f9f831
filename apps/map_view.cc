// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/error.h"
#include "plumbline/io/map_file/map_io.h"
#include "plumbline/viewer/viewer.h"

#include "apps/chosen_map.h"
#include "apps/command_line.h"
#include "apps/map_commands.h"
#include "apps/stop_signal.h"
#include "apps/view_options.h"
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <thread>

namespace plumbline {
namespace {

constexpr auto kStep = std::chrono::milliseconds(20);
constexpr const char* kDefaultAddress = "8080";

CommandSyntax MapViewSyntax() {
  return {"map view",
          "Shows a map file in browsers, and in Foxglove, until Ctrl-C.",
          {"FILE"},
          {kMapOption,
           {"--view", "[HOST:]PORT", "where to listen (default: 8080 of this machine)"},
           {"--view-origin", "URL", "another page that may connect; may be repeated"}}};
}

// plumbline.Frame of a keyframe of the displayed map; null if there is none.
SharedBytes PictureOf(const Atlas& atlas, ShownId id) {
  const KeyFrame* keyframe = atlas.active().Find(KeyFrameId{id});
  if (keyframe == nullptr) return nullptr;
  return std::make_shared<const std::string>(FrameMessage(ViewedFrameOf(*keyframe)).Take());
}

}  // namespace

int MapViewCommand(std::span<const std::string> arguments) {
  const CommandLine line(MapViewSyntax(), arguments);
  if (line.help()) {
    std::cout << HelpText(MapViewSyntax());
    return 0;
  }
  const std::string& path = line.Positional(0);
  ViewerOptions options;
  options.access = ReadViewOptions(line, false);
  if (!options.access) options.access = ParseWebAddress("--view", kDefaultAddress);
  SavedAtlas saved = LoadAtlas(path);
  ChooseMap(line, saved.atlas);
  ViewedRun run;
  run.name = std::filesystem::path(path).filename().string();
  run.camera = saved.context.camera;
  run.saved_map = true;
  Viewer viewer(options, run, std::nullopt, [&](ShownId id) { return PictureOf(saved.atlas, id); });
  std::clog << "plumbline: view at " << viewer.url() << " (Ctrl-C ends it)\n";
  CatchStopSignals();
  while (!StopRequested()) {
    if (viewer.WantsMaps(false)) viewer.ReadMaps(saved.atlas, {});
    if (const auto failure = viewer.TakeFailure()) throw InputError(*failure);
    std::this_thread::sleep_for(kStep);
  }
  return 0;
}

}  // namespace plumbline
