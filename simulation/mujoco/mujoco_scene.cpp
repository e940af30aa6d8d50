// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "hirosco/xml/escaped.hpp"
#include "simulation/mujoco/mujoco_files.hpp"

/// A world of an MJCF file: what stands, lies and hangs in it is as the file says, the robot is its joints of certain names (docs/adr/0162).
namespace hirosco::simulation {
namespace {

using xml::Element;

/// What is for eyes, or acts by itself: drives are the device's, and nobody looks.
constexpr std::array left_out_elements{"actuator", "sensor", "keyframe", "visual", "statistic", "texture",
                                       "material", "skin",   "light",    "camera", "custom"};
constexpr std::array left_out_attributes{"material", "texture"};
/// Other files or code: one file says what the world is.
constexpr std::array refused_elements{"include", "extension", "plugin", "model", "attach"};
/// Of an asset that is a file, and where it lies by the compiler's words.
struct FileAsset {
  std::string_view element, folder;
};
constexpr std::array file_assets{FileAsset{"mesh", "meshdir"}, FileAsset{"hfield", "texturedir"}};

/// Rewrites a scene so that it reads nothing but what it is handed.
class Rewriting {
 public:
  Rewriting(const MeshSource& files, std::string_view mark) : files_{files}, mark_{mark} {}

  [[nodiscard]] std::expected<void, std::string> write(const Element& element, bool actuators) {
    text_.clear();
    octets_.clear();
    return write_element(element, actuators);
  }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  [[nodiscard]] const std::map<std::string, std::string>& octets() const noexcept { return octets_; }

  /// Where files lie: the last word of all <compiler> elements counts.
  void look_for_folders(const Element& element) {
    if (element.name == "compiler") {
      for (const char* name : {"assetdir", "meshdir", "texturedir"})
        if (const auto* said = element.find(name)) folders_[name] = said->value;
      if (const auto* strips = element.find("strippath")) strips_ = strips->value == "true";
    }
    for (const Element& child : element.children) look_for_folders(child);
  }

 private:
  [[nodiscard]] std::expected<void, std::string> write_element(const Element& element, bool actuators) {
    if (std::ranges::find(refused_elements, element.name) != refused_elements.end())
      return std::unexpected{
          fmt::format("line {}: <{}> is not read: the world is one file", element.at.line, element.name)};
    const bool acts = element.name == "actuator";
    if (acts ? !actuators : std::ranges::find(left_out_elements, element.name) != left_out_elements.end()) return {};
    text_ += "<" + element.name;
    const auto asset = std::ranges::find(file_assets, element.name, &FileAsset::element);
    const bool is_file = asset != file_assets.end() && element.find("file") != nullptr;
    for (const auto& each : element.attributes) {
      const bool folder = element.name == "compiler" && (each.name.ends_with("dir") || each.name == "strippath");
      if (folder || std::ranges::find(left_out_attributes, each.name) != left_out_attributes.end()) continue;
      if (is_file && (each.name == "file" || each.name == "name")) continue;
      say(each.name, each.value);
    }
    if (is_file)
      if (auto handed = hand_over(element, *asset); !handed) return handed;
    text_ += ">";
    for (const Element& child : element.children)
      if (auto written = write_element(child, actuators); !written) return written;
    text_ += "</" + element.name + ">";
    return {};
  }

  void say(std::string_view name, std::string_view value) {
    text_ += fmt::format(R"( {}="{}")", name, xml::escaped(value));
  }

  /// Under a name of ours: what the file calls it may be the name of another one on this computer.
  [[nodiscard]] std::expected<void, std::string> hand_over(const Element& element, const FileAsset& asset) {
    const std::filesystem::path named{element.find("file")->value};
    const auto said = folders_.find(std::string{asset.folder});
    const std::string folder = said != folders_.end() ? said->second : folders_["assetdir"];
    const std::filesystem::path file =
        (std::filesystem::path{folder} / (strips_ ? named.filename() : named)).lexically_normal();
    if (file.is_absolute() || file.string().starts_with(".."))
      return std::unexpected{fmt::format("line {}: {} is not beside the file", element.at.line, file.string())};
    if (!files_) return std::unexpected{file.string() + ": nobody reads files here"};
    auto octets = files_(file.string());
    if (!octets) return std::unexpected{file.string() + ": " + octets.error()};
    const std::string handed = fmt::format("{}asset_{}{}", mark_, octets_.size(), file.extension().string());
    octets_.insert_or_assign(handed, std::move(*octets));
    const auto* name = element.find("name");
    say("name", name == nullptr ? named.stem().string() : name->value);
    say("file", handed);
    return {};
  }

  const MeshSource& files_;
  std::string_view mark_;
  std::map<std::string, std::string, std::less<>> folders_;
  bool strips_{false};
  std::string text_;
  std::map<std::string, std::string> octets_;
};

struct Parsed {
  std::unique_ptr<mjSpec, MujocoFree> spec;
  MujocoModel model;
};

[[nodiscard]] std::expected<Parsed, std::string> parse(const std::string& text,
                                                       const std::map<std::string, std::string>& octets) {
  const MujocoFiles files{octets};
  std::array<char, 1000> why{};
  Parsed made;
  made.spec.reset(mj_parseXMLString(text.c_str(), files.get(), why.data(), why.size()));
  if (made.spec == nullptr) return std::unexpected{std::string{"MuJoCo: "} + why.data()};
  made.spec->compiler.usethread = 0;
  made.spec->option.timestep = std::min(made.spec->option.timestep, MujocoSpec::longest_sub_step_s);
  made.model.reset(mj_compile(made.spec.get(), files.get()));
  if (made.model == nullptr) return std::unexpected{std::string{"MuJoCo: "} + mjs_getError(made.spec.get())};
  return made;
}

[[nodiscard]] double greatest(const mjtNum* range) { return std::max(std::abs(range[0]), std::abs(range[1])); }

/// What the scene's own drive of a joint can do; empty: it has none, or says no limit.
[[nodiscard]] std::optional<double> effort_in(const mjModel& model, int joint) {
  if (model.jnt_actfrclimited[joint] != 0) return greatest(model.jnt_actfrcrange + 2 * joint);
  for (int actuator = 0; actuator < model.nu; ++actuator) {
    if (model.actuator_trntype[actuator] != mjTRN_JOINT || model.actuator_trnid[2 * actuator] != joint) continue;
    const double gear = std::abs(model.actuator_gear[6 * actuator]);
    if (model.actuator_forcelimited[actuator] != 0) return gear * greatest(model.actuator_forcerange + 2 * actuator);
    const bool is_motor =
        model.actuator_gaintype[actuator] == mjGAIN_FIXED && model.actuator_biastype[actuator] == mjBIAS_NONE;
    if (is_motor && model.actuator_ctrllimited[actuator] != 0)
      return gear * std::abs(model.actuator_gainprm[mjNGAIN * actuator]) *
             greatest(model.actuator_ctrlrange + 2 * actuator);
  }
  return std::nullopt;
}

[[nodiscard]] std::string joints_of(const mjModel& model) {
  std::string names;
  for (int joint = 0; joint < model.njnt; ++joint)
    if (const char* name = mj_id2name(&model, mjOBJ_JOINT, joint); name != nullptr && *name != '\0')
      names += (names.empty() ? "" : ", ") + std::string{name};
  return names.empty() ? "none" : names;
}

}  // namespace

std::expected<MujocoSpec, std::string> spec_of_scene(std::string_view mjcf, std::vector<DrivenJoint> joints,
                                                     const MeshSource& files, std::string_view mark) {
  const auto tree = xml::read_tree(mjcf);
  if (!tree) return std::unexpected{fmt::format("line {}: {}", tree.error().at.line, tree.error().reason)};
  if (tree->name != "mujoco")
    return std::unexpected{fmt::format("<{}> is no MJCF file: its root is <mujoco>", tree->name)};
  Rewriting rewriting{files, mark};
  rewriting.look_for_folders(*tree);
  if (auto written = rewriting.write(*tree, true); !written) return std::unexpected{std::move(written.error())};
  const auto with_drives = parse(rewriting.text(), rewriting.octets());
  if (!with_drives) return std::unexpected{with_drives.error()};
  const mjModel& driven = *with_drives->model;
  for (DrivenJoint& joint : joints) {
    const int id = mj_name2id(&driven, mjOBJ_JOINT, joint.name.c_str());
    if (id < 0)
      return std::unexpected{fmt::format("it has no joint '{}', as the robot's URDF file has; its joints: {}",
                                         joint.name, joints_of(driven))};
    if (driven.jnt_type[id] != mjJNT_HINGE && driven.jnt_type[id] != mjJNT_SLIDE)
      return std::unexpected{fmt::format("its joint '{}' neither turns about nor slides along one axis", joint.name)};
    joint.effort = effort_in(driven, id).value_or(joint.effort);
    joint.of_scene = true;
  }
  MujocoSpec::Content made;
  if (auto written = rewriting.write(*tree, false); !written) return std::unexpected{std::move(written.error())};
  made.octets = rewriting.octets();
  auto parsed = parse(rewriting.text(), made.octets);
  if (!parsed) return std::unexpected{std::move(parsed.error())};
  const mjModel& model = *parsed->model;
  made.spec = std::move(parsed->spec);
  made.of_scene = true;
  made.further_dofs = static_cast<std::size_t>(model.nv) - joints.size();
  made.equalities = static_cast<std::size_t>(model.neq);
  made.pairs_left_out = static_cast<std::size_t>(model.nexclude);
  const int last = joints.empty() ? -1 : mj_name2id(&model, mjOBJ_JOINT, joints.back().name.c_str());
  const char* carrier = last < 0 ? nullptr : mj_id2name(&model, mjOBJ_BODY, model.jnt_bodyid[last]);
  made.joints = std::move(joints);
  MujocoSpec whole{std::move(made)};
  if (carrier != nullptr && *carrier != '\0') static_cast<void>(whole.hang_payload_on(carrier));
  return whole;
}

}  // namespace hirosco::simulation
