// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "tools/terminal/screen.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ranges>

#include "tools/terminal/columns.hpp"

namespace hirosco::terminal {
namespace {

constexpr double silent_limit_s = 1.5;
constexpr std::size_t wide_columns = 100;
constexpr std::size_t least_event_rows = 4;

[[nodiscard]] std::string clock_words(double up_s) {
  const auto whole = static_cast<long long>(std::max(up_s, 0.0));
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

[[nodiscard]] std::string span_words(double ns) {
  if (ns < 1e6) return fmt::format("{:.0f} us", ns * 1e-3);
  return ns < 1e9 ? fmt::format("{:.1f} ms", ns * 1e-6) : fmt::format("{:.1f} s", ns * 1e-9);
}

[[nodiscard]] Span mark(Severity severity) {
  switch (severity) {
    case Severity::High: return {"■ ", Look::Grave};
    case Severity::Medium: return {"▲ ", Look::Note};
    case Severity::Low: return {"◆ ", Look::Plain};
    case Severity::Info: break;
  }
  return {"· ", Look::Dim};
}

[[nodiscard]] Look look_of(Severity severity) {
  if (severity == Severity::High) return Look::Grave;
  return severity == Severity::Medium ? Look::Note : Look::Plain;
}

/// A row that ends where the screen does.
class RowOf {
 public:
  explicit RowOf(std::size_t columns) : columns_{columns} {}
  RowOf& add(std::string_view text, Look look = Look::Plain) {
    std::string fitting = cut(text, columns_ - used_);
    used_ += width_of(fitting);
    if (!fitting.empty()) row_.push_back({std::move(fitting), look});
    return *this;
  }
  RowOf& add(const Span& span) { return add(span.text, span.look); }
  /// At the right edge, if there is room for a gap.
  RowOf& at_right(const std::vector<Span>& spans) {
    std::size_t width = 1;
    for (const Span& span : spans) width += width_of(span.text);
    if (used_ + width < columns_) add(std::string(columns_ - used_ - width, ' '));
    else add("  ");
    for (const Span& span : spans) add(span);
    return *this;
  }
  [[nodiscard]] PictureRow take() { return std::move(row_); }

 private:
  std::size_t columns_;
  std::size_t used_{0};
  PictureRow row_;
};

using Rows = std::vector<PictureRow>;

class Drawing {
 public:
  Drawing(const ScreenModel& model, Size size, double silent_s)
      : model_{model}, size_{size}, silent_s_{silent_s}, judged_{judge(model.overview())} {}

  [[nodiscard]] Picture picture() {
    if (size_.rows == 0 || size_.columns == 0) return {};
    Rows head{header()}, urls = url_rows(model_.url(), "page"), observer = url_rows(model_.observer_url(), "to look"),
                         table = member_rows(), findings = finding_rows(), links = link_rows(), values = value_rows();
    // What a small screen does without, in this order.
    const auto height = [&] {
      return head.size() + urls.size() + observer.size() + table.size() + findings.size() + links.size() +
             values.size() + 3;
    };
    const std::size_t room = size_.rows - std::min(size_.rows, least_event_rows);
    for (Rows* rows : {&observer, &values, &links})
      if (height() > room) rows->clear();
    while (height() > room && findings.size() > 1) findings.pop_back();
    if (height() > room) shorten(table, table.size() - std::min(table.size(), height() - room));
    Picture picture;
    const auto append = [&](Rows& rows) { std::ranges::move(rows, std::back_inserter(picture.rows)); };
    append(head);
    append(urls);
    append(observer);
    if (height() + 1 <= room) picture.rows.emplace_back();
    for (Rows* rows : {&table, &findings, &links, &values}) append(*rows);
    if (picture.rows.size() + 2 < size_.rows) picture.rows.emplace_back();
    const std::size_t left_over = size_.rows - std::min(size_.rows, picture.rows.size());
    picture.event_rows = left_over - std::min<std::size_t>(left_over, 2);
    Rows events = event_rows(picture.event_rows);
    if (left_over > 1) picture.rows.push_back(event_head());
    append(events);
    picture.rows.resize(size_.rows - 1);
    picture.rows.push_back(keys());
    return picture;
  }

 private:
  [[nodiscard]] RowOf row() const { return RowOf{size_.columns}; }

  [[nodiscard]] PictureRow header() const {
    RowOf made = row();
    if (!model_.heard()) {
      made.add(" HIROSCO", Look::Bold).at_right({{"starting", Look::Dim}});
      return made.take();
    }
    const Overview& overview = model_.overview();
    made.add(" " + overview.mission, Look::Bold).add("  " + overview.mode);
    const Span clock{"  " + clock_words(model_.up_s()) + " ", Look::Dim};
    if (silent_s_ > silent_limit_s)
      return made.at_right({{fmt::format("■ SUPERVISOR SILENT FOR {:.0f} s", silent_s_), Look::Grave}, clock}).take();
    if (model_.ending()) return made.at_right({{"ending", Look::Note}, clock}).take();
    switch (judged_.verdict) {
      case Verdict::Well: return made.at_right({{"● well", Look::Dim}, clock}).take();
      case Verdict::OnTheWay: return made.at_right({{"▲ on the way", Look::Note}, clock}).take();
      case Verdict::NotWell: break;
    }
    return made.at_right({{"■ NOT WELL", Look::Grave}, clock}).take();
  }

  /// Whole, on as many rows as it takes: half a URL is none.
  [[nodiscard]] Rows url_rows(const std::string& url, std::string_view label) const {
    if (url.empty()) return {};
    const std::string begin = " " + left(label, 8) + " ";
    if (begin.size() + width_of(url) <= size_.columns) return {row().add(begin, Look::Dim).add(url, Look::Bold).take()};
    Rows rows;
    for (std::size_t at = 0; at < url.size(); at += size_.columns)
      rows.push_back(row().add(std::string_view{url}.substr(at, size_.columns), Look::Bold).take());
    return rows;
  }

  [[nodiscard]] Rows member_rows() {
    const Overview& overview = model_.overview();
    if (overview.members.empty()) return {};
    std::size_t name_columns = 9;
    for (const auto& member : overview.members) name_columns = std::max(name_columns, width_of(member.name));
    name_columns = std::min<std::size_t>(name_columns, wide() ? 32 : 20);
    RowOf title = row();
    title.add("   " + left("SUBSYSTEM", name_columns) + "  " + left("STATE", 17) + right("CYCLE", 9) +
                  right("LATE", 10) + right("MISSED", 9),
              Look::Dim);
    if (wide()) title.add(right("OVERRAN", 10) + right("LOAD", 8) + "  ACTUATORS", Look::Dim);
    Rows rows{title.take()};
    for (const auto& member : overview.members) rows.push_back(member_row(member, name_columns));
    return rows;
  }

  [[nodiscard]] bool wide() const { return size_.columns >= wide_columns; }

  [[nodiscard]] Severity gravest_of(const Overview::Member& member) const {
    Severity gravest = Severity::Info;
    for (const Finding& finding : judged_.findings)
      if (finding.subject == member.name) gravest = std::max(gravest, finding.severity);
    return gravest;
  }

  [[nodiscard]] PictureRow member_row(const Overview::Member& member, std::size_t name_columns) const {
    const Severity gravest = gravest_of(member);
    const bool astray = gravest == Severity::High;
    const bool moves = !member.wanted.empty() && member.state != member.wanted && !astray;
    RowOf made = row();
    made.add(" ");
    if (astray) made.add({"■ ", Look::Grave});
    else if (moves) made.add({"▲ ", Look::Note});
    else if (gravest == Severity::Low) made.add({"◆ ", Look::Note});
    else made.add({member.cycling ? "● " : "· ", Look::Dim});
    made.add(left(member.name, name_columns)).add("  ");
    made.add(left(state_words(member.state), 17), astray ? Look::Grave : moves ? Look::Note : Look::Plain);
    if (!member.counted || !member.cycling) return made.take();
    const double rate_hz = 1e9 / static_cast<double>(std::max<std::uint64_t>(member.period_ns, 1));
    made.add(right(fmt::format("{:.0f} Hz", rate_hz), 9)).add(right(span_words(member.latency_max_ns), 10));
    const auto count = [](std::uint64_t number) { return number == 0 ? Look::Plain : Look::Note; };
    made.add(right(fmt::format("{}", member.missed), 9), count(member.missed));
    if (!wide()) return made.take();
    made.add(right(fmt::format("{}", member.overruns), 10), count(member.overruns));
    const double load = static_cast<double>(member.execution_mean_ns) /
                        static_cast<double>(std::max<std::uint64_t>(member.period_ns, 1));
    made.add(right(fmt::format("{:.1f} %", 100 * load), 8));
    const std::string why = inhibition_words(member.inhibited);
    made.add("  ").add(why.empty() ? "free" : "inhibited: " + why, why.empty() ? Look::Dim : Look::Note);
    return made.take();
  }

  /// The last row says how many are not seen; who deviates is.
  void shorten(Rows& table, std::size_t most) const {
    if (table.size() <= most || table.empty()) return;
    const std::size_t shown = most - std::min<std::size_t>(most, 2);  // of members
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < model_.overview().members.size(); ++i) order.push_back(i);
    std::ranges::stable_sort(order, std::ranges::greater{},
                             [&](std::size_t i) { return gravest_of(model_.overview().members[i]); });
    order.resize(std::min(shown, order.size()));
    std::ranges::sort(order);
    Rows kept;
    if (most > 0) kept.push_back(std::move(table.front()));
    for (const std::size_t i : order) kept.push_back(std::move(table[i + 1]));
    if (most > 1)
      kept.push_back(
          row().add(fmt::format("   {} more", model_.overview().members.size() - order.size()), Look::Dim).take());
    table = std::move(kept);
  }

  [[nodiscard]] Rows finding_rows() const {
    Rows rows;
    if (!model_.heard()) return rows;
    if (!model_.overview().waits_for.empty())
      rows.push_back(row().add(" waits for " + model_.overview().waits_for, Look::Note).take());
    constexpr std::size_t most = 6;
    for (const Finding& finding : judged_.findings) {
      if (finding.severity == Severity::Info && judged_.verdict == Verdict::OnTheWay) continue;
      if (rows.size() == most) break;
      rows.push_back(row().add(" ").add(mark(finding.severity)).add(finding.text, look_of(finding.severity)).take());
    }
    if (!rows.empty()) rows.insert(rows.begin(), PictureRow{});
    return rows;
  }

  /// Pieces one after the other, on as many rows as they need, two at most; what has no room is counted.
  [[nodiscard]] Rows flowing(const std::string& label, const std::vector<std::vector<Span>>& pieces) const {
    constexpr std::size_t most = 2;
    Rows rows;
    RowOf made = row();
    made.add(label, Look::Dim);
    std::size_t used = width_of(label);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      std::size_t width = 0;
      for (const Span& span : pieces[i]) width += width_of(span.text);
      const std::string more = fmt::format("  {} more", pieces.size() - i);
      const bool last_row = rows.size() + 1 == most;
      const std::size_t kept = last_row && i + 1 < pieces.size() ? width_of(more) : 0;
      if (used + width + kept > size_.columns && used > width_of(label)) {
        if (last_row) {
          made.add(more, Look::Dim);
          break;
        }
        rows.push_back(made.take());
        made = row();
        made.add(std::string(width_of(label), ' '));
        used = width_of(label);
      }
      for (const Span& span : pieces[i]) made.add(span);
      used += width;
    }
    rows.push_back(made.take());
    return rows;
  }

  [[nodiscard]] Rows link_rows() const {
    const auto& links = model_.overview().links;
    if (links.empty()) return {};
    std::vector<std::vector<Span>> pieces;
    std::size_t up = 0;
    for (const auto& link : links) {
      up += link.up ? 1U : 0U;
      const bool missing = link.wanted && !link.up;
      if (!link.up && !missing) continue;
      const bool grave = missing && judged_.verdict == Verdict::NotWell;
      pieces.push_back({{"  "},
                        missing ? Span{grave ? "■ " : "▲ ", grave ? Look::Grave : Look::Note} : Span{"● ", Look::Dim},
                        {link.from + " → " + link.to, missing ? (grave ? Look::Grave : Look::Note) : Look::Plain}});
    }
    return flowing(fmt::format(" links {}/{}", up, links.size()), pieces);
  }

  [[nodiscard]] Rows value_rows() const {
    std::vector<std::vector<Span>> pieces;
    for (const auto& [label, words] : model_.values()) pieces.push_back({{"  " + label + " ", Look::Dim}, {words}});
    if (pieces.empty()) return {};
    return flowing("", pieces);
  }

  [[nodiscard]] PictureRow event_head() const {
    RowOf made = row();
    made.add(model_.only_low_and_up() ? " EVENTS, low and up" : " EVENTS", Look::Dim);
    if (model_.scrolled() != 0) made.add(fmt::format("  {} newer below", model_.scrolled()), Look::Note);
    return made.take();
  }

  [[nodiscard]] Rows event_rows(std::size_t most) const {
    std::vector<const ScreenEvent*> seen;
    for (const ScreenEvent& event : model_.events() | std::views::reverse) {
      if (seen.size() == most + model_.scrolled()) break;
      if (model_.admits(event)) seen.push_back(&event);
    }
    Rows rows;
    for (std::size_t i = std::min(model_.scrolled(), seen.size()); i < seen.size(); ++i) {
      const ScreenEvent& event = *seen[i];
      RowOf made = row();
      made.add(event.at_s ? fmt::format("{:10.3f} s ", *event.at_s) : std::string(13, ' '), Look::Dim);
      made.add(mark(event.severity)).add(event.text, look_of(event.severity));
      rows.push_back(made.take());
    }
    std::ranges::reverse(rows);
    return rows;
  }

  [[nodiscard]] PictureRow keys() const {
    RowOf made = row();
    if (model_.ending()) return made.add(" ending in order; Ctrl-C again ends at once", Look::Note).take();
    if (model_.asks_for_end())
      return made.add(" End the flight? ", Look::Bold).add("q again ends it in order, any other key goes on").take();
    const auto key = [&](std::string_view name, std::string_view does) {
      made.add(" ").add(name, Look::Bold).add(" ").add(does, Look::Dim).add("  ", Look::Dim);
    };
    key("q", "end");
    key("e", model_.only_low_and_up() ? "all events" : "low and up");
    key("↑↓", "scroll");
    key("S", "stop all actuators");
    return made.take();
  }

  const ScreenModel& model_;
  Size size_;
  double silent_s_;
  Judgement judged_;
};

[[nodiscard]] std::string_view sgr(Look look, bool colour) {
  switch (look) {
    case Look::Plain: return "\x1b[0m";
    case Look::Dim: return "\x1b[0;2m";
    case Look::Bold: return "\x1b[0;1m";
    case Look::Note: return colour ? "\x1b[0;33m" : "\x1b[0;1m";
    case Look::Grave: return colour ? "\x1b[0;1;31m" : "\x1b[0;1;7m";
  }
  return "\x1b[0m";
}

}  // namespace

Picture draw(const ScreenModel& model, Size size, double silent_s) { return Drawing{model, size, silent_s}.picture(); }

std::vector<std::string> words_of(const Picture& picture) {
  std::vector<std::string> lines;
  for (const PictureRow& row : picture.rows) {
    std::string line;
    for (const Span& span : row) line += span.text;
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(std::move(line));
  }
  return lines;
}

std::string paint(const Picture& next, const Picture& last, Size size, Palette palette) {
  std::string sent;
  for (std::size_t i = 0; i < next.rows.size(); ++i) {
    if (i < last.rows.size() && last.rows[i] == next.rows[i]) continue;
    sent += fmt::format("\x1b[{};1H", i + 1);
    std::size_t used = 0;
    for (const Span& span : next.rows[i]) {
      const std::string text = palette.unicode ? span.text : ascii(span.text);
      sent += sgr(span.look, palette.colour);
      sent += text;
      used += width_of(text);
    }
    // A row that is full leaves the cursor on its last column, which this would clear.
    if (used < size.columns) sent += "\x1b[0m\x1b[K";
  }
  if (!sent.empty()) sent += "\x1b[0m";
  return sent;
}

std::vector<std::string> farewell(const ScreenModel& model, const std::string& log) {
  const Overview& overview = model.at_work();
  if (!model.heard() || overview.members.empty()) return {};
  std::vector<std::string> lines;
  const Judgement judged = judge(overview);
  lines.push_back(fmt::format("{} flew {}, in mode {} at the end. {}", overview.mission, clock_words(model.up_s()),
                              overview.mode, judged.verdict == Verdict::NotWell ? "It was NOT WELL:" : "It was well."));
  if (judged.verdict == Verdict::NotWell)
    for (const Finding& finding : judged.findings)
      if (finding.severity == Severity::High) lines.push_back("  " + finding.text);
  if (model.gravest())
    lines.push_back(fmt::format("{} event{} of medium or high severity; {:.3f} s: {}", model.grave_events(),
                                model.grave_events() == 1 ? "" : "s", model.gravest()->at_s.value_or(0.0),
                                model.gravest()->text));
  lines.push_back(model.gravest() ? "What stopped and why: hirosco why. All of it: hirosco log" +
                                        (log.empty() ? "" : " (" + log + ")")
                                  : "All of it: hirosco log" + (log.empty() ? "" : " (" + log + ")"));
  return lines;
}

}  // namespace hirosco::terminal
