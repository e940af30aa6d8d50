// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/hirosco/command_pages.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>
#include <vector>

#include "hirosco/utilities/version.hpp"

namespace hirosco::tools {
namespace {

/// A text in roff: a hyphen is one that can be copied, and no line begins a request.
[[nodiscard]] std::string roff(std::string_view text) {
  std::string made;
  bool begins = true;
  for (const char letter : text) {
    if (begins && (letter == '.' || letter == '\'')) made += "\\&";
    if (letter == '\\') made += "\\e";
    else if (letter == '-') made += "\\-";
    else made += letter;
    begins = letter == '\n';
  }
  return made;
}

[[nodiscard]] std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  std::vector<const CLI::App*> shown;
  for (const CLI::App* command : app.get_subcommands(nullptr))
    if (!command->get_group().empty()) shown.push_back(command);
  return shown;
}

[[nodiscard]] bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// "-h, --help", "--for TIME", "MISSION".
[[nodiscard]] std::string words_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  if (option.get_positional()) names.push_back(option.get_name(true));
  const bool value = takes_value(option) && !option.get_positional();
  return fmt::format("{}{}", fmt::join(names, ", "), value ? " " + option.get_type_name() : "");
}

/// The line that calls it, behind its name.
[[nodiscard]] std::string arguments_of(const CLI::App& app) {
  std::string line;
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    const bool many = option->get_items_expected_max() > 1;
    const std::string name = option->get_name(true) + (many ? "..." : "");
    line += option->get_required() ? " " + name : " [" + name + "]";
  }
  return line + " [OPTIONS]";
}

void add_command(std::string& page, const std::string& name, const CLI::App& app) {
  page += fmt::format(".SS {}\n{}\n.PP\n.B {}\n{}\n", roff(name), roff(app.get_description()), roff(name),
                      roff(commands_of(app).empty() ? arguments_of(app).substr(1) : "COMMAND ..."));
  for (const CLI::Option* option : app.get_options()) {
    const std::string standard = option->get_default_str();
    page += fmt::format(".TP\n.B {}\n{}{}\n", roff(words_of(*option)), roff(option->get_description()),
                        standard.empty() ? "" : roff(fmt::format(" [{}]", standard)));
  }
  const std::string footer = app.get_footer();
  if (!footer.empty()) page += fmt::format(".PP\n.nf\n{}\n.fi\n", roff(footer));
  for (const CLI::App* command : commands_of(app)) add_command(page, name + " " + command->get_name(), *command);
}

constexpr std::string_view after_commands = R"(.SH EXIT STATUS
.TP
0
as it was asked
.TP
1
a finding: a problem in a file, a refusal, a craft that is not well, something missing
.TP
2
wrong usage
.TP
3
the environment: a program, a port, a folder or an answer is missing
.TP
4
an internal error
.TP
5
of
.BR run :
a reaction of high severity that nobody had caused
.SH ENVIRONMENT
.TP
XDG_RUNTIME_DIR
where a flight keeps its lock and its local sockets; else the folder for temporary files
.TP
NO_COLOR
no colours in what is told of files
.TP
HIROSCO_SANDBOX
.B off
isolates no subsystem, for tools that look into processes
.TP
NOTIFY_SOCKET
of a service manager: told when the mission is commissioned and when it ends
.SH FILES
.TP
missions/NAME/mission.xml
a mission by its name, from the working directory upwards and where what comes with the program is
.TP
log/
of a mission, as it says itself, in the working directory
.SH SEE ALSO
.BR systemd.service (5),
.BR limits.conf (5),
the guides in /usr/share/doc/hirosco
)";

/// Every command of the tree with the words before it: "hirosco export python".
template <class With>
void each_command(const CLI::App& app, const std::string& name, With&& with) {
  with(app, name);
  for (const CLI::App* command : commands_of(app)) each_command(*command, name + " " + command->get_name(), with);
}

[[nodiscard]] bool is_mission(const CLI::Option& option) {
  return option.check_lname("mission") || (option.get_positional() && option.get_name(true) == "mission");
}

constexpr std::string_view completion_begins = R"(# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
# Completion of hirosco(1) for bash, written at build time.
_hirosco() {
  local current=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} command=hirosco words='' missions='' i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$command ${COMP_WORDS[i]}" in
)";

constexpr std::string_view completion_ends = R"sh(  esac
  [[ -z $missions ]] || words+=" $("${COMP_WORDS[0]}" command-pages missions 2>/dev/null)"
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
  if [[ $current != -* && $command != hirosco ]]; then
    compopt -o filenames 2>/dev/null
    mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current")
  fi
}
complete -F _hirosco hirosco
)sh";

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string page = fmt::format(
      ".\\\" SPDX-FileCopyrightText: 2026 The HIROSCO developers\n.\\\" SPDX-License-Identifier: Apache-2.0\n"
      ".TH HIROSCO 1 \"\" \"hirosco {}\" \"User Commands\"\n.SH NAME\nhirosco \\- {}\n"
      ".SH SYNOPSIS\n.B hirosco\n.I COMMAND\n[ARGUMENTS] [OPTIONS]\n.SH DESCRIPTION\n"
      "Flies, checks, simulates and commands missions: a supervisor, the subsystems that it watches, and the devices "
      "behind them.\n"
      ".SH OPTIONS\n",
      version, roff("high-level robotic spacecraft controller"));
  for (const CLI::Option* option : app.get_options())
    page += fmt::format(".TP\n.B {}\n{}\n", roff(words_of(*option)), roff(option->get_description()));
  page += ".SH COMMANDS\n";
  for (const CLI::App* command : commands_of(app)) add_command(page, "hirosco " + command->get_name(), *command);
  page += after_commands;
  return page;
}

std::string bash_completion(const CLI::App& app) {
  std::string nested, values, words;
  each_command(app, "hirosco", [&](const CLI::App& command, const std::string& name) {
    if (&command != &app) nested += fmt::format("      '{}') command='{}' ;;\n", name, name);
    std::vector<std::string> all;
    bool missions = false;
    for (const CLI::App* below : commands_of(command)) all.push_back(below->get_name());
    for (const CLI::Option* option : command.get_options()) {
      missions = missions || (is_mission(*option) && option->get_positional());
      for (const std::string& lname : option->get_lnames()) {
        all.push_back("--" + lname);
        if (!takes_value(*option)) continue;
        // A file, or what nobody can guess.
        values += fmt::format("    '{} --{}') {} ;;\n", name, lname,
                              is_mission(*option) ? "words='' missions=yes"
                                                  : R"(mapfile -t COMPREPLY < <(compgen -f -- "$current"); return)");
      }
      for (const std::string& sname : option->get_snames()) all.push_back("-" + sname);
    }
    words += fmt::format("    '{}') words='{}'{} ;;\n", name, fmt::join(all, " "), missions ? " missions=yes" : "");
  });
  return fmt::format(
      "{}{}    esac\n  done\n  case \"$command $before\" in\n{}    *) case $command in\n{}    esac ;;\n{}",
      completion_begins, nested, values, words, completion_ends);
}

}  // namespace hirosco::tools
