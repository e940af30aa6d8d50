// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace hirosco::terminal {
namespace {

/// By bit of Inhibition; the page has the same words (ground/web/page/stop_story.js).
constexpr std::array<std::string_view, 7> inhibitions{"stopped by the supervisor or SAFE ALL",
                                                      "a link that it requires is missing",
                                                      "its device is lost",
                                                      "its own protection tripped",
                                                      "its cycle failed",
                                                      "the supervisor does not answer",
                                                      "a device or producer has not answered yet"};

[[nodiscard]] std::string because(std::uint32_t inhibited) {
  const std::string words = inhibition_words(inhibited);
  return words.empty() ? words : ": " + words;
}

/// 0 where it is as it should be, else 1.
std::size_t judge_member(const Overview& overview, const Overview::Member& member, std::vector<Finding>& findings) {
  const bool waits = !overview.waits_for.empty();
  if (member.missed != 0)
    findings.push_back({Severity::Low, member.name,
                        fmt::format("{} missed {} of {} cycles", member.name, member.missed, member.cycles)});
  if (member.overruns != 0)
    findings.push_back({Severity::Low, member.name,
                        fmt::format("{}: {} cycles took longer than they may", member.name, member.overruns)});
  if (member.wanted.empty()) return 0;
  const Severity grave = waits ? Severity::Info : Severity::High;
  if (!member.runs)
    findings.push_back({grave, member.name,
                        fmt::format("{} does not run, the mode has it {}", member.name, state_words(member.wanted))});
  else if (member.state != member.wanted)
    findings.push_back({grave, member.name,
                        fmt::format("{} is {}, the mode has it {}{}", member.name, state_words(member.state),
                                    state_words(member.wanted), because(member.inhibited))});
  else if (member.inhibited != 0)
    findings.push_back(
        {grave, member.name, fmt::format("{}: actuators inhibited{}", member.name, because(member.inhibited))});
  else return 0;
  return 1;
}

[[nodiscard]] std::string counted(std::size_t count, std::string_view what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

std::string state_words(std::string_view state) {
  std::string words;
  char before = ' ';
  for (const char letter : state) {
    if (letter >= 'A' && letter <= 'Z' && before >= 'a' && before <= 'z') words += '-';
    words += letter;
    before = letter;
  }
  return words;
}

std::string inhibition_words(std::uint32_t inhibited) {
  std::string words;
  for (std::size_t bit = 1; bit < inhibitions.size(); ++bit)
    if ((inhibited >> bit & 1) != 0) words += fmt::format("{}{}", words.empty() ? "" : ", ", inhibitions[bit]);
  // Last: whoever has a reason of his own is stopped by the supervisor because of it.
  if ((inhibited & 1) != 0) words += fmt::format("{}{}", words.empty() ? "" : ", ", inhibitions[0]);
  return words;
}

std::vector<std::string> way_up(const Overview& overview, const descriptor::Mission& mission) {
  const descriptor::Mode* const mode = descriptor::mode_up(mission, overview.mode, overview.usual_mode);
  std::vector<std::string> commands;
  if (mode == nullptr) return commands;
  for (const auto& step : mode->commission) {
    const auto member = std::ranges::find(overview.members, step.subsystem, &Overview::Member::name);
    if (member != overview.members.end() && !member->runs)
      commands.push_back(fmt::format("hirosco tc {} SET_STATE 0", member->name));
  }
  commands.push_back("hirosco mode " + mode->name);
  return commands;
}

nlohmann::ordered_json verdict_json(const std::string& mission, const Judgement& judged,
                                    const std::vector<std::string>& commands) {
  auto findings = nlohmann::ordered_json::array();
  for (const Finding& finding : judged.findings)
    findings.push_back({{"severity", to_text(finding.severity)}, {"subject", finding.subject}, {"text", finding.text}});
  return {{"mission", mission},
          {"verdict", to_text(judged.verdict)},
          {"line", judged.line},
          {"findings", std::move(findings)},
          {"way_up", commands}};
}

Judgement judge(const Overview& overview) {
  Judgement judged;
  std::size_t wanted = 0, astray = 0, links = 0, down = 0;
  bool reduced = false;
  for (const Overview::Member& member : overview.members) {
    wanted += member.wanted.empty() ? 0U : 1U;
    astray += judge_member(overview, member, judged.findings);
    reduced = reduced || (member.cycling && !member.realtime);
  }
  const bool waits = !overview.waits_for.empty();
  for (const Overview::Link& link : overview.links) {
    links += link.wanted ? 1U : 0U;
    if (!link.wanted || link.up) continue;
    ++down;
    judged.findings.push_back({waits ? Severity::Info : Severity::High, "",
                               fmt::format("link {}, {} → {}, is down", link.id, link.from, link.to)});
  }
  const bool nobody = wanted == 0 && overview.mode == overview.initial_mode && !overview.usual_mode.empty() &&
                      overview.usual_mode != overview.mode;
  if (nobody && !waits)
    judged.findings.push_back(
        {Severity::High, "",
         fmt::format("mode {} has nobody up; the usual one is {}", overview.mode, overview.usual_mode)});
  if (reduced) judged.findings.push_back({Severity::Info, "", "no real-time scheduling: the reduced limits hold"});
  std::ranges::stable_sort(judged.findings, std::ranges::greater{}, &Finding::severity);
  if (waits) {
    judged.verdict = Verdict::OnTheWay;
    judged.line = "on the way: waits for " + overview.waits_for;
  } else if (astray + down != 0) {
    judged.verdict = Verdict::NotWell;
    judged.line = "NOT WELL: ";
    if (astray != 0)
      judged.line += fmt::format("{} of {} not as mode {} has {}", astray, counted(wanted, "subsystem"), overview.mode,
                                 astray == 1 ? "it" : "them");
    if (down != 0) judged.line += fmt::format("{}{} down", astray != 0 ? ", " : "", counted(down, "link"));
  } else if (nobody) {
    judged.verdict = Verdict::NotWell;
    judged.line = fmt::format("NOT WELL: nobody is up in mode {}", overview.mode);
  } else {
    judged.verdict = Verdict::Well;
    judged.line = fmt::format("well: mode {}, {} as it has them{}", overview.mode, counted(wanted, "subsystem"),
                              links == 0 ? "" : ", " + counted(links, "link") + " up");
  }
  return judged;
}

void miss_keeper(Judgement& judged) {
  constexpr std::string_view gone = "NOT WELL: the keeper of this flight is gone; ";
  if (judged.verdict == Verdict::Well) judged.line = fmt::format("{}all else is well", gone);
  if (judged.verdict == Verdict::OnTheWay) judged.line = std::string{gone} + judged.line;
  judged.verdict = Verdict::NotWell;
  judged.findings.insert(judged.findings.begin(),
                         Finding{Severity::High, "", "the keeper is gone: if the supervisor dies, nobody goes on"});
  judged.findings.push_back(
      Finding{Severity::Info, "", "Ctrl-C reaches nobody: it ends by hirosco tc supervisor SHUTDOWN"});
}

}  // namespace hirosco::terminal
