// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "tests/fuzz/fuzz.hpp"
#include "tools/dynamics/batch.hpp"
#include "tools/dynamics/lines.hpp"

/// Lines of `hirosco dynamics` from whatever octets come: each is answered by JSON, as many objects as it has output times, or at the end what is
/// wrong with it and which line that was; and no more of a line is kept than may be.
namespace {

using namespace hirosco;
using fuzz::expect;
using Json = nlohmann::json;

constexpr int joints = 2;
/// More than that only take their time.
constexpr double most_steps = 100;

/// One slider on another.
[[nodiscard]] robotics::Model sliders() {
  robotics::ModelDescription description;
  description.base = {4, robotics::Vector3::Zero(), robotics::Matrix3::Identity()};
  for (int i = 0; i < joints; ++i) {
    robotics::JointDescription joint;
    joint.kind = robotics::JointKind::Prismatic;
    joint.moved = {2.0 - i, robotics::Vector3::Zero(), robotics::Matrix3::Identity()};
    if (i > 0) joint.parent = static_cast<std::size_t>(i - 1);
    description.joints.push_back(joint);
  }
  description.frames = {{"tip", joints - 1, {}}};
  return robotics::Model::make(description).value();
}

[[nodiscard]] Json object_of(const std::string& line) {
  const Json object = Json::parse(line, nullptr, false);
  expect(object.is_object(), "an answer is a JSON object");
  return object;
}

void check_line(tools::Batch& batch, const std::string& line, std::size_t number) {
  const auto motion = tools::read_motion(line, joints);
  expect(motion || !motion.error().empty(), "what is wrong is told");
  if (motion) {
    expect(motion->step_s > 0 && motion->end_s >= 0 && motion->end_s / motion->step_s <= tools::max_steps &&
               std::ranges::is_sorted(motion->output_s) && !motion->torque.empty(),
           "a motion that is taken ends");
    expect(motion->state.q.size() == joints && motion->state.qd.size() == joints &&
               std::ranges::all_of(motion->torque, [](const auto& row) { return row.torque.size() == joints; }),
           "a motion has a value for each joint");
    fuzz::taken();
    if (!(motion->end_s / motion->step_s <= most_steps)) return;
  }
  std::vector<std::string> answers;
  const bool good = batch.answer(line, number, [&](const std::string& answer) { answers.push_back(answer); });
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const bool wrong = !good && i + 1 == answers.size();
    const Json object = object_of(answers[i]);
    expect(object.contains("error") == wrong && object.contains("t") != wrong, "only the last one says what is wrong");
    if (wrong) expect(object["line"] == number, "what is wrong says in which line");
  }
  expect(good || !answers.empty(), "what is wrong is told");
  if (good && motion) expect(answers.size() == motion->output_s.size(), "each output time has an answer");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const robotics::Model model = sliders();
  if (size == 0) return 0;
  const std::string_view text = fuzz::text_of(data, size);
  tools::Batch batch{model, model.find_frame("tip").value()};
  const auto close = [](std::FILE* file) { std::fclose(file); };
  std::string octets{text};
  const std::unique_ptr<std::FILE, decltype(close)> file{::fmemopen(octets.data(), octets.size(), "r"), close};
  constexpr std::size_t longest = 600;
  tools::BoundedLines lines{file.get(), longest};
  std::size_t number = 0;
  for (auto next = lines.next(); next != tools::BoundedLines::Next::End; next = lines.next()) {
    expect(next != tools::BoundedLines::Next::Failed, "memory can be read");
    ++number;
    if (next == tools::BoundedLines::Next::TooLong) continue;
    expect(lines.line().size() <= longest && lines.line().find('\n') == std::string::npos, "a line is a line");
    check_line(batch, lines.line(), number);
  }
  const auto ends = static_cast<std::size_t>(std::ranges::count(text, '\n'));
  expect(number == ends + (text.back() == '\n' ? 0 : 1), "no line is lost");
  return 0;
}
