// SPDX-License-Identifier: Apache-2.0
#include "reference.h"

#include <fstream>
#include <vector>

#include "cli/exit_codes.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

namespace fs = std::filesystem;

constexpr const char* kAbout =
    "Telemime follows a person's body, hands and face in a webcam or a video, and passes the motion on: to "
    "an avatar on a page, "
    "to other programs, to files. Without a command it says what can be done on this computer.";

// A command with the words that call it: "telemime", "telemime live", "telemime meeting record".
struct Command {
  const CLI::App* app = nullptr;
  std::string words;
};

std::vector<Command> subcommands(const Command& command) {
  std::vector<Command> found;
  for (const CLI::App* app : command.app->get_subcommands([](const CLI::App*) { return true; })) {
    found.push_back({app, command.words + " " + app->get_name()});
  }
  return found;
}

// The command and all below it.
std::vector<Command> with_subcommands(const Command& command) {
  std::vector<Command> all = {command};
  for (const Command& below : subcommands(command)) {
    const auto more = with_subcommands(below);
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) {
    names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    names.push_back("--" + name);
  }
  return names;
}

// The values that a description lists as "One of a, b or c."
std::vector<std::string> choices_of(const std::string& description) {
  constexpr std::string_view kStart = "One of ";
  std::vector<std::string> choices;
  const std::size_t start = description.find(kStart);
  if (start == std::string::npos) {
    return choices;
  }
  std::string word;
  for (const char c :
       description.substr(start + kStart.size(), description.rfind('.') - start - kStart.size()) + ' ') {
    if (c != ' ' && c != ',') {
      word += c;
    } else if (!word.empty()) {
      if (word != "or") {
        choices.push_back(word);
      }
      word.clear();
    }
  }
  return choices;
}

std::string with_dashes(std::string words) {
  for (char& c : words) {
    c = c == ' ' ? '-' : c;
  }
  return words;
}

// Text as roff takes it: hyphens as they are typed, no line that starts with a request.
std::string roff(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) {
      result += std::string("\\&") + c;
    } else {
      result += c;
    }
  }
  return result;
}

std::string bold(const std::string& text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(const std::string& text) {
  return "\\fI" + roff(text) + "\\fR";
}

std::string sentence(std::string text) {
  if (!text.empty() && text.back() != '.') {
    text += '.';
  }
  return text;
}

std::string option_entry(const CLI::Option& option) {
  std::string entry = ".TP\n";
  if (option.get_positional()) {
    entry += italic(option.get_name(true));
  } else {
    std::string separator;
    for (const std::string& name : names_of(option)) {
      entry += separator + bold(name);
      separator = ", ";
    }
    if (option.get_type_size() != 0) {
      // "FLOAT:FLOAT in [0.001 - 1000]": the kind of value, and its range.
      const std::string type = option.get_type_name();
      entry += " " + italic(type.substr(0, type.find(':')));
    }
  }
  entry += "\n" + roff(sentence(option.get_description()));
  if (const std::string value = option.get_default_str(); !value.empty() && option.get_type_size() != 0) {
    entry += "\nDefault: " + roff(value) + ".";
  }
  return entry + (option.get_required() && !option.get_positional() ? "\nRequired." : "") + "\n";
}

std::string manual_page(const Command& command, const std::string& version) {
  const bool is_program = command.words == "telemime";
  const CLI::App& app = *command.app;
  const auto options =
      app.get_options([](const CLI::Option* option) { return !option->get_group().empty(); });
  const auto below = subcommands(command);

  // Name and synopsis.
  std::string page =
      ".\\\" Made by telemime --write-reference from the program's own options.\n.TH \"" +
      roff(with_dashes(command.words)) + "\" 1 \"\" \"Telemime " + version + "\" \"Telemime\"\n.SH NAME\n" +
      roff(with_dashes(command.words)) + " \\- " +
      roff(is_program ? "3-D motion capture of the upper body from one camera" : app.get_description()) +
      "\n.SH SYNOPSIS\n" + bold(command.words);
  if (!below.empty()) {
    page += " [" + italic("COMMAND") + "]";
  }
  page += " [" + italic("OPTION") + "...]";
  for (const CLI::Option* option : options) {
    if (option->get_positional()) {
      const std::string name = italic(option->get_name(true));
      page += option->get_required() ? " " + name : " [" + name + "]";
    }
  }
  page += "\n.SH DESCRIPTION\n" + roff(is_program ? kAbout : sentence(app.get_description())) + "\n";

  // Subcommands, arguments and options.
  if (!below.empty()) {
    page += ".SH COMMANDS\n";
    for (const Command& one : below) {
      page += ".TP\n" + bold(one.words) + "\n" + roff(sentence(one.app->get_description())) + "\nSee " +
              bold(with_dashes(one.words)) + "(1).\n";
    }
  }
  for (const bool positional : {true, false}) {
    std::string entries;
    for (const CLI::Option* option : options) {
      entries += option->get_positional() == positional ? option_entry(*option) : "";
    }
    if (!entries.empty()) {
      page += std::string(".SH ") + (positional ? "ARGUMENTS\n" : "OPTIONS\n") + entries;
    }
  }

  // What is said once, in the page of the program.
  if (is_program) {
    page += ".SH EXIT STATUS\n";
    for (const auto& [code, meaning] : kExitMeanings) {
      page += ".TP\n" + bold(std::to_string(code)) + "\n" + roff(sentence(std::string(meaning))) + "\n";
    }
    page += ".SH ENVIRONMENT\n.TP\n" + bold("TELEMIME_MODELS") +
            "\nFolder of the neural networks, in place of the installed one.\n.SH EXAMPLES\n";
    for (const auto& [line, meaning] : {
             std::pair("telemime live demo --open",
                       "Show the live page with the bundled clip in place of a camera."),
             std::pair("telemime live --send vmc://localhost:39539",
                       "Track the webcam and drive an avatar program."),
             std::pair("telemime track talk.mp4 --out result", "Write the motion of a video in all formats."),
         }) {
      page += ".TP\n" + bold(line) + "\n" + roff(meaning) + "\n";
    }
  }
  page += ".SH SEE ALSO\n";
  std::string others;
  for (const Command& other : is_program ? below : std::vector<Command>{{nullptr, "telemime"}}) {
    others += (others.empty() ? "" : ",\n") + bold(with_dashes(other.words)) + "(1)";
  }
  return page + others + "\n";
}

std::string joined_words(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    text += (text.empty() ? "" : " ") + word;
  }
  return text;
}

std::string bash_completion(const std::vector<Command>& commands) {
  std::string calls, values, words;
  for (const Command& command : commands) {
    std::vector<std::string> offered, below;
    for (const CLI::Option* option : command.app->get_options()) {
      if (option->get_positional() || option->get_group().empty()) {
        continue;
      }
      const auto names = names_of(*option);
      offered.insert(offered.end(), names.begin(), names.end());
      const auto choices = choices_of(option->get_description());
      if (option->get_type_size() != 0 && !choices.empty()) {
        values += "    \"" + command.words + " " + names.back() + "\") words=\"" + joined_words(choices) +
                  "\" ;;\n";
      }
    }
    for (const Command& one : subcommands(command)) {
      below.push_back(one.app->get_name());
      calls += "      \"" + one.words + "\") command=\"" + one.words + "\" ;;\n";
    }
    words += "      \"" + command.words + "\") words=\"" + joined_words(offered) + "\" below=\"" +
             joined_words(below) + "\" ;;\n";
  }
  return "# Completion of telemime's command line in bash. Made by telemime --write-reference from the "
         "program's own\n"
         "# options.\n_telemime() {\n"
         "  local command=telemime words=\"\" below=\"\" word=\"${COMP_WORDS[COMP_CWORD]}\" i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n    case \"$command ${COMP_WORDS[i]}\" in\n" +
         calls + "    esac\n  done\n  case \"$command ${COMP_WORDS[COMP_CWORD - 1]}\" in\n" + values +
         "  esac\n  if [[ -z \"$words\" ]]; then\n    case \"$command\" in\n" + words +
         "    esac\n    # Where a file may stand, options are offered after a dash only.\n"
         "    [[ \"$word\" == -* ]] || words=\"$below\"\n  fi\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n}\n"
         "complete -o default -F _telemime telemime\n";
}

void write_file(const fs::path& path, const std::string& text) {
  std::error_code failed;
  fs::create_directories(path.parent_path(), failed);
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) {
    throw Error(ErrorKind::output, path.string() + " cannot be written", "Choose another folder.");
  }
}

}  // namespace

void write_reference(const CLI::App& app, const fs::path& folder, const std::string& version) {
  const auto commands = with_subcommands({&app, app.get_name()});
  for (const Command& command : commands) {
    write_file(folder / "man1" / (with_dashes(command.words) + ".1"), manual_page(command, version));
  }
  write_file(folder / "completions" / "telemime", bash_completion(commands));
}

}  // namespace telemime
