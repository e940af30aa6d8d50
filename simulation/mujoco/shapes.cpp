// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/shapes.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include "hirosco/descriptor/model/mesh_files.hpp"

namespace hirosco::simulation {
namespace {

using xml::Element;

constexpr double smallest_m = 1e-4, largest_m = 1000;
constexpr double most_friction = 10;
constexpr double lightest_kg = 1e-3, heaviest_kg = 1e4;

/// How a kind is called, how many sizes it has, and what they are.
struct KindRow {
  ShapeKind kind;
  std::string_view name;
  std::size_t sizes;
  std::string_view said;
};
constexpr std::array kinds{
    KindRow{ShapeKind::Box, "box", 3, "A,B,C"}, KindRow{ShapeKind::Cylinder, "cylinder", 2, "RADIUS,LENGTH"},
    KindRow{ShapeKind::Sphere, "sphere", 1, "RADIUS"}, KindRow{ShapeKind::Plane, "plane", 0, ""}};

[[nodiscard]] bool good_size(double size) { return size >= smallest_m && size <= largest_m; }

/// Numbers with blanks between them; nothing where there are others than `count`.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(const Element& element, std::string_view attribute,
                                                            std::size_t count) {
  constexpr std::string_view blank = " \t\r\n";
  const auto* found = element.find(attribute);
  if (found == nullptr) return std::nullopt;
  std::string_view text = found->value;
  std::vector<double> numbers;
  while (true) {
    const auto start = text.find_first_not_of(blank);
    if (start == std::string_view::npos) break;
    text.remove_prefix(start);
    if (text.front() == '+') text.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || !std::isfinite(value) || numbers.size() == count) return std::nullopt;
    numbers.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty() && blank.find(text.front()) == std::string_view::npos) return std::nullopt;
  }
  if (numbers.size() != count) return std::nullopt;
  return numbers;
}

/// False: what stands there is not three numbers.
[[nodiscard]] bool read_origin(const Element& collision, Shape& shape) {
  const Element* origin = child_of(collision, "origin");
  if (origin == nullptr) return true;
  for (const auto& [name, to] : {std::pair{"xyz", &shape.place_m}, {"rpy", &shape.turned_rad}}) {
    if (origin->find(name) == nullptr) continue;
    const auto numbers = numbers_of(*origin, name, 3);
    if (!numbers) return false;
    std::ranges::copy(*numbers, to->begin());
  }
  return true;
}

[[nodiscard]] std::expected<Shape, std::string> read_sizes(const Element& element, Shape shape) {
  const auto take = [&](std::string_view attribute, std::size_t count, std::size_t at) {
    const auto numbers = numbers_of(element, attribute, count);
    if (!numbers || !std::ranges::all_of(*numbers, good_size)) return false;
    std::ranges::copy(*numbers, shape.sizes.begin() + static_cast<std::ptrdiff_t>(at));
    return true;
  };
  bool taken = false;
  if (element.name == "box") {
    shape.kind = ShapeKind::Box;
    taken = take("size", 3, 0);
  } else if (element.name == "cylinder") {
    shape.kind = ShapeKind::Cylinder;
    taken = take("radius", 1, 0) && take("length", 1, 1);
  } else if (element.name == "sphere") {
    shape.kind = ShapeKind::Sphere;
    taken = take("radius", 1, 0);
  } else {
    return std::unexpected{"<" + element.name + "> is no shape of a URDF file"};
  }
  if (!taken)
    return std::unexpected{
        fmt::format("the sizes of its <{}> are no numbers from {} to {} m", element.name, smallest_m, largest_m)};
  return shape;
}

[[nodiscard]] std::expected<Shape, std::string> read_mesh(const Element& element, Shape shape) {
  shape.kind = ShapeKind::Mesh;
  shape.sizes = {1, 1, 1};
  if (element.find("scale") != nullptr) {
    const auto scale = numbers_of(element, "scale", 3);
    if (!scale || std::ranges::any_of(*scale, [](double factor) { return !good_size(std::abs(factor)); }))
      return std::unexpected{"the scale of its <mesh> is no three numbers"};
    std::ranges::copy(*scale, shape.sizes.begin());
  }
  const auto* file = element.find("filename");
  if (file == nullptr || file->value.empty()) return std::unexpected{"its <mesh> names no file"};
  shape.mesh = file->value;
  return shape;
}

[[nodiscard]] std::expected<Shape, std::string> read_collision(const Element& collision) {
  Shape shape;
  if (!read_origin(collision, shape)) return std::unexpected{"its <origin> is not three numbers each"};
  const Element* geometry = child_of(collision, "geometry");
  if (geometry == nullptr || geometry->children.size() != 1) return std::unexpected{"its <geometry> is not one shape"};
  const Element& element = geometry->children.front();
  return element.name == "mesh" ? read_mesh(element, std::move(shape)) : read_sizes(element, std::move(shape));
}

}  // namespace

const Element* child_of(const Element& element, std::string_view name) noexcept {
  const auto found = std::ranges::find(element.children, name, &Element::name);
  return found != element.children.end() ? &*found : nullptr;
}

LinkShapes link_shapes(const Element& robot) {
  LinkShapes found;
  for (const Element& link : robot.children) {
    const auto* name = link.name == "link" ? link.find("name") : nullptr;
    if (name == nullptr) continue;
    for (const Element& collision : link.children) {
      if (collision.name != "collision") continue;
      if (auto shape = read_collision(collision)) found.taken.push_back({name->value, std::move(*shape)});
      else found.left_out.push_back(fmt::format("a shape of link '{}': {}", name->value, shape.error()));
    }
  }
  return found;
}

std::expected<std::vector<double>, std::string> listed_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    double value = 0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{} || !std::isfinite(value))
      return std::unexpected{fmt::format("number {} is none", numbers.size() + 1)};
    numbers.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (text.empty()) return numbers;
    if (text.front() != ',') return std::unexpected{"numbers have commas between them"};
    text.remove_prefix(1);
  }
}

namespace {

/// `mass_kg` null: it stands, and has none.
[[nodiscard]] std::expected<Obstacle, std::string> read_standing(std::string_view name,
                                                                 std::span<const std::string_view> words,
                                                                 double* mass_kg) {
  const std::string_view shape = words.empty() ? std::string_view{} : words.front();
  const auto row = std::ranges::find(kinds, shape, &KindRow::name);
  if (row == kinds.end() || (mass_kg != nullptr && row->kind == ShapeKind::Plane))
    return std::unexpected{mass_kg != nullptr
                               ? fmt::format("'{}' is no shape of a body: box, cylinder or sphere", shape)
                               : fmt::format("'{}' is no shape of an obstacle: box, cylinder, sphere or plane", shape)};
  Obstacle obstacle{.name = std::string{name}, .shape = {.kind = row->kind}};
  const std::string usage = fmt::format("write {}{}{}{} X,Y,Z [FRICTION [ROLL,PITCH,YAW]]", row->name,
                                        row->sizes > 0 ? " " : "", row->said, mass_kg != nullptr ? " MASS" : "");
  std::size_t at = 1;
  const std::size_t least = (row->sizes > 0 ? 3U : 2U) + (mass_kg != nullptr ? 1U : 0U);
  if (words.size() < least || words.size() > least + 2)
    return std::unexpected{fmt::format("{} words are not those of a {}: {}", words.size(), row->name, usage)};
  const auto take = [&](std::size_t count, std::array<double, 3>& to, double low, double high,
                        std::string_view what) -> std::optional<std::string> {
    const std::string_view word = words[at++];
    const auto numbers = listed_numbers(word);
    if (!numbers) return fmt::format("{} '{}': {}; {}", what, word, numbers.error(), usage);
    if (numbers->size() != count)
      return fmt::format("{} '{}' has {} numbers, not {}; {}", what, word, numbers->size(), count, usage);
    if (std::ranges::any_of(*numbers, [&](double value) { return value < low || value > high; }))
      return fmt::format("{} '{}' is not within {} to {}", what, word, low, high);
    std::ranges::copy(*numbers, to.begin());
    return std::nullopt;
  };
  if (row->sizes > 0)
    if (auto wrong = take(row->sizes, obstacle.shape.sizes, smallest_m, largest_m, "the size"))
      return std::unexpected{*wrong};
  if (mass_kg != nullptr) {
    std::array<double, 3> mass{};
    if (auto wrong = take(1, mass, lightest_kg, heaviest_kg, "the mass")) return std::unexpected{*wrong};
    *mass_kg = mass[0];
  }
  if (auto wrong = take(3, obstacle.shape.place_m, -largest_m, largest_m, "the place")) return std::unexpected{*wrong};
  if (at < words.size()) {
    std::array<double, 3> friction{};
    if (auto wrong = take(1, friction, 0, most_friction, "the friction")) return std::unexpected{*wrong};
    obstacle.friction = friction[0];
  }
  constexpr double whole_turn = 2 * std::numbers::pi;
  if (at < words.size())
    if (auto wrong = take(3, obstacle.shape.turned_rad, -whole_turn, whole_turn, "the turn"))
      return std::unexpected{*wrong};
  return obstacle;
}

}  // namespace

std::expected<Obstacle, std::string> read_obstacle(std::string_view name, std::span<const std::string_view> words) {
  return read_standing(name, words, nullptr);
}

std::expected<LooseBody, std::string> read_body(std::string_view name, std::span<const std::string_view> words) {
  LooseBody body;
  auto standing = read_standing(name, words, &body.mass_kg);
  if (!standing) return std::unexpected{std::move(standing.error())};
  body.standing = std::move(*standing);
  return body;
}

std::expected<std::string, std::string> mesh_file(std::string_view named) {
  const auto beside = descriptor::mesh_beside(named);
  if (!beside) return std::unexpected{fmt::format("{} is not beside the URDF file", named)};
  std::string ending = beside->extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  if (ending != ".stl" && ending != ".obj")
    return std::unexpected{fmt::format("{} is neither STL nor OBJ{}", named,
                                       ending == ".dae" ? ": hirosco new robot writes it as STL" : "")};
  return beside->string();
}

}  // namespace hirosco::simulation
