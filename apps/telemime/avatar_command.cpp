// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>

#include "avatars/avatar.h"
#include "telemime/core/files.h"
#include "telemime/core/text.h"

namespace telemime {
namespace {

struct AvatarArguments {
  std::string look = std::string(kAvatarLooks.front().name);
  std::filesystem::path out;
  double height = Shape().stature;
  bool list = false;
};

void run(const AvatarArguments& arguments) {
  if (arguments.list) {
    for (const AvatarLook& look : kAvatarLooks) {
      std::cout << look.name << ": " << look.summary << '\n';
    }
    return;
  }
  const std::filesystem::path out =
      arguments.out.empty() ? std::filesystem::path(arguments.look + ".vrm") : arguments.out;
  Shape shape;
  shape.stature = arguments.height;
  write_whole_file(out, make_avatar(shape, avatar_look(arguments.look)));
  std::cout << "written to " << out.string() << '\n';
}

}  // namespace

void add_avatar_command(CLI::App& app) {
  const auto arguments = std::make_shared<AvatarArguments>();
  CLI::App* const command =
      app.add_subcommand("avatar", "Write one of the bundled avatars as a VRM 1.0 file");
  command->add_option("--look", arguments->look, "One of " + joined(kAvatarLooks, &AvatarLook::name) + ".")
      ->capture_default_str();
  command->add_option("--out", arguments->out, "File to write; LOOK.vrm by default.");
  command->add_option("--height", arguments->height, "Height of the person in metres.")
      ->capture_default_str();
  command->add_flag("--list", arguments->list, "List the avatars.");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace telemime
