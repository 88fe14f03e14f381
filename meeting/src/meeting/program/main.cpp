// SPDX-License-Identifier: Apache-2.0
// telemime-meeting: the commands of `telemime meeting` as a program of their own. The page and the avatars
// come from folders.
#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <filesystem>
#include <iostream>

#include "cli/exit_codes.h"
#include "meeting/commands/commands.h"
#include "telemime/core/errors.h"
#include "telemime/streaming/avatar_folder.h"
#include "telemime/streaming/web_path.h"

namespace telemime::meeting {
namespace {

/// The file at a path of the page, which is the file meeting.html of the folder. WebHandlers::get promises
/// that the path does not leave the folder.
std::optional<WebContent> page_file(const std::filesystem::path& folder, const std::string& path) {
  const std::filesystem::path file =
      folder / (path == "/" || path == "/room" ? "meeting.html" : path.substr(1));
  if (folder.empty() || !std::filesystem::is_regular_file(file)) {
    return std::nullopt;
  }
  WebContent content;
  content.type = web_type(file.string());
  content.file = file;
  return content;
}

int run(int argc, char** argv) {
  CLI::App app("Meetings: a shared 3-D space for people with avatars", "telemime-meeting");
  app.require_subcommand(1);
  std::filesystem::path page;
  app.add_option("--page", page, "Folder with the built files of the page.")->check(CLI::ExistingDirectory);
  add_meeting_command(app, [&page](const std::filesystem::path& avatars) {
    const AvatarFolder folder(avatars);
    return MeetingFiles{.looks = folder.looks(), .get = [&page, folder](const std::string& path) {
                          auto file = folder.file(path);
                          return file ? file : page_file(page, path);
                        }};
  });
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e, std::cout, std::cerr) == 0 ? 0 : kExitUsage;
  } catch (const Error& e) {
    std::cerr << "telemime-meeting: " << e.what() << '\n';
    return exit_code(e.kind());
  } catch (const std::exception& e) {
    std::cerr << "telemime-meeting: unexpected failure: " << e.what() << '\n';
    return kExitInternal;
  }
  return 0;
}

}  // namespace
}  // namespace telemime::meeting

int main(int argc, char** argv) {
  return telemime::meeting::run(argc, argv);
}
