// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

#include "hirosco/xml/reader.hpp"
#include "robotics/urdf/findings.hpp"
#include "robotics/urdf/robot.hpp"

namespace hirosco::robotics::urdf {
namespace {

using xml::Element;

/// A matrix with six digits may be as far from positive.
constexpr double definite_tolerance = 1e-6;
constexpr double unit_tolerance = 1e-6;

[[nodiscard]] Location place(xml::Position at) { return {at.line, at.column}; }
[[nodiscard]] Matrix3 rotation(const Vector3& rpy) {
  using Eigen::AngleAxisd;
  return (AngleAxisd{rpy.z(), Vector3::UnitZ()} * AngleAxisd{rpy.y(), Vector3::UnitY()} *
          AngleAxisd{rpy.x(), Vector3::UnitX()})
      .toRotationMatrix();
}

/// What may stand in an element: what is read, and what others read or nobody, which is passed over and named.
struct Rows {
  std::string_view element;
  std::vector<std::string_view> attributes;
  std::vector<std::string_view> children;
  std::vector<std::string_view> passed_attributes;
  std::vector<std::string_view> passed_children;
};

const std::vector<Rows>& rows() {
  static const std::vector<Rows> all{
      {"robot",
       {"name", "version"},
       {"link", "joint", "material"},
       {},
       {"gazebo", "transmission", "ros2_control", "sensor", "mujoco"}},
      {"link",
       {"name"},
       {"inertial", "visual", "collision", "gravity", "kinematic"},
       {"type"},
       {"contact", "self_filter", "collision_checking", "origin", "surface", "sensor"}},
      {"inertial", {}, {"origin", "mass", "inertia"}, {}, {}},
      {"origin", {"xyz", "rpy"}, {}, {}, {}},
      {"mass", {"value"}, {}, {}, {}},
      {"inertia", {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, {}, {}, {}},
      {"joint",
       {"name", "type"},
       {"origin", "parent", "child", "axis", "limit", "dynamics", "mimic"},
       {"dont_collapse"},
       {"safety_controller", "calibration"}},
      {"parent", {"link"}, {}, {}, {}},
      {"child", {"link"}, {}, {}, {}},
      {"axis", {"xyz"}, {}, {}, {}},
      {"limit",
       {"lower", "upper", "velocity", "effort", "acceleration", "deceleration", "jerk"},
       {},
       {"command_effort", "current", "gear_velocity"},
       {}},
      {"dynamics", {"damping", "friction"}, {}, {"D", "K", "mu_coulomb", "mu_viscous"}, {}},
      {"mimic", {"joint", "multiplier", "offset"}, {}, {}, {}},
  };
  return all;
}

[[nodiscard]] bool has(const std::vector<std::string_view>& words, std::string_view word) {
  return std::ranges::find(words, word) != words.end();
}

[[nodiscard]] std::string listed(const std::vector<std::string_view>& words, std::string_view none) {
  std::string text;
  for (const std::string_view word : words) text += (text.empty() ? "" : ", ") + std::string{word};
  return text.empty() ? std::string{none} : text;
}

[[nodiscard]] bool is_xacro(const Element& element) { return element.name.starts_with("xacro:"); }
[[nodiscard]] bool is_xacro(std::string_view value) {
  return value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos;
}
constexpr const char* xacro_hint =
    "this file is a template: expand it first with `xacro FILE > FILE.urdf`, and read that";

/// Asks elements for what is in them, and says what is wrong with that.
class ElementReader {
 public:
  explicit ElementReader(Findings& findings) : findings_{findings} {}

 protected:
  /// Is everything in it known, and as often as it may?
  void look_at(const Element& element) {
    const auto row = std::ranges::find(rows(), element.name, &Rows::element);
    for (const xml::Attribute& attribute : element.attributes) {
      if (is_xacro(attribute.value)) {
        findings_.error(place(attribute.value_at), "U0107",
                        "the value of '" + attribute.name + "' is an expression of xacro", xacro_hint);
        continue;
      }
      if (attribute.name.starts_with("xmlns") || has(row->attributes, attribute.name)) continue;
      if (has(row->passed_attributes, attribute.name) || attribute.name.find(':') != std::string::npos)
        pass("the attribute '" + attribute.name + "' of <" + element.name + ">", place(attribute.at));
      else
        findings_.error(place(attribute.at), "U0103",
                        "<" + element.name + "> has no attribute " + in_quotes(attribute.name),
                        "it has: " + listed(row->attributes, "none"));
    }
    std::set<std::string_view> seen;
    for (const Element& child : element.children) {
      const auto at = place(child.at);
      if (is_xacro(child)) {
        findings_.error(at, "U0107", "<" + child.name + "> is an element of xacro", xacro_hint);
      } else if (has(row->children, child.name)) {
        const bool many = element.name == "robot" || child.name == "visual" || child.name == "collision";
        if (!many && !seen.insert(child.name).second)
          findings_.error(at, "U0105", "a second <" + child.name + "> in this <" + element.name + ">", "keep one");
        else if (child.name != "visual" && child.name != "collision" && child.name != "material" &&
                 element.name != "robot" && child.name != "gravity" && child.name != "kinematic")
          look_at(child);
      } else if (has(row->passed_children, child.name) || child.name.find(':') != std::string::npos) {
        pass("<" + child.name + "> in <" + element.name + ">", at);
      } else {
        findings_.error(
            at, "U0102", "<" + element.name + "> has no element " + in_quotes(child.name),
            "it has: " + listed(row->children, "none") + "; what is not known may change how the robot moves");
      }
    }
    if (element.text_at.line > 0)
      findings_.error(place(element.text_at), "U0108", "text in <" + element.name + ">",
                      "URDF has attributes only: remove it");
  }

  void pass(const std::string& what, Location at) {
    auto [found, is_new] = passed_.try_emplace(what, at, 0U);
    ++found->second.second;
  }

  [[nodiscard]] static const Element* child(const Element& element, std::string_view name) {
    const auto found = std::ranges::find(element.children, name, &Element::name);
    return found == element.children.end() ? nullptr : &*found;
  }

  std::optional<std::string> text(const Element& element, std::string_view name) {
    const xml::Attribute* attribute = element.find(name);
    if (attribute == nullptr) {
      findings_.error(place(element.at), "U0104",
                      "<" + element.name + "> lacks the attribute '" + std::string{name} + "'", "add it");
      return std::nullopt;
    }
    if (attribute->value.empty()) {
      findings_.error(place(attribute->at), "U0109", "'" + std::string{name} + "' of <" + element.name + "> is empty",
                      "give it a name");
      return std::nullopt;
    }
    return attribute->value;
  }

  enum class Need : std::uint8_t { Must, May };
  std::optional<double> value(const Element& element, std::string_view name, Need need) {
    const xml::Attribute* attribute = element.find(name);
    if (attribute == nullptr) {
      if (need == Need::Must) static_cast<void>(text(element, name));
      return std::nullopt;
    }
    if (is_xacro(attribute->value)) return std::nullopt;  // said already
    const auto read = number(attribute->value);
    if (!read)
      findings_.error(place(attribute->value_at), "U0106",
                      "'" + std::string{name} + "' of <" + element.name + "> is " + in_quotes(attribute->value) +
                          ", which is no number of at most 1e20",
                      "write a decimal number without a unit, like 0.25 or 1e-3");
    return read;
  }

  Vector3 vector(const Element& element, std::string_view name, const Vector3& otherwise) {
    const xml::Attribute* attribute = element.find(name);
    if (attribute == nullptr || is_xacro(attribute->value)) return otherwise;
    const auto read = three(attribute->value);
    if (!read)
      findings_.error(place(attribute->value_at), "U0106",
                      "'" + std::string{name} + "' of <" + element.name + "> is " + in_quotes(attribute->value) +
                          ", not three numbers of at most 1e20",
                      "write three decimal numbers with spaces between them, like 0 0 0.25");
    return read.value_or(otherwise);
  }

  Pose origin(const Element& of) {
    const Element* element = child(of, "origin");
    if (element == nullptr) return {};
    return {rotation(vector(*element, "rpy", Vector3::Zero())), vector(*element, "xyz", Vector3::Zero())};
  }

  Findings& findings_;
  std::map<std::string, std::pair<Location, unsigned>> passed_;  ///< where first, how often
};

class RobotReader : private ElementReader {
 public:
  using ElementReader::ElementReader;

  [[nodiscard]] Robot read(const Element& root) {
    Robot robot;
    if (root.name != "robot") {
      findings_.error(place(root.at), "U0101", "the root element is " + in_quotes(root.name) + ", not 'robot'",
                      root.name == "mujoco" || root.name == "sdf" ? "only URDF is read: convert the file"
                                                                  : "a URDF file begins with <robot name=\"...\">");
      return robot;
    }
    look_at(root);
    if (const auto name = text(root, "name")) robot.name = *name;
    std::vector<NamedJoint> joints;
    for (const Element& child : root.children) {
      if (child.name == "link") robot.links.push_back(link(child));
      if (child.name == "joint") joints.push_back(joint(child));
    }
    for (const auto& [what, seen] : passed_)
      findings_.warning(
          seen.first, "U0501",
          what + " is passed over" + (seen.second > 1 ? ", " + std::to_string(seen.second) + " times" : std::string{}),
          "it is an extension of somebody else's; nothing in it has an effect here");
    if (robot.links.empty())
      findings_.error(place(root.at), "U0204", "the robot has no link",
                      root.find("xmlns:xacro") != nullptr
                          ? "it was made by xacro from a file that only defines macros: expand the one that uses them"
                          : "add at least two links and a joint");
    else connect(robot, joints, findings_);
    return robot;
  }

 private:
  Link link(const Element& element) {
    look_at(element);
    Link link;
    link.at = place(element.at);
    if (auto name = text(element, "name")) link.name = *name;
    link.has_shape = child(element, "visual") != nullptr || child(element, "collision") != nullptr;
    for (const auto& [word, usual, other] : {std::tuple{"gravity", "1", "true"}, std::tuple{"kinematic", "0", "false"}})
      if (const Element* found = child(element, word); found != nullptr && found->text != usual && found->text != other)
        findings_.error(
            place(found->at), "U0110",
            "<" + found->name + "> is " + in_quotes(found->text) + ": this link would not move as a body does",
            "gravity is set from outside for the whole robot: remove it");
    if (const Element* inertial = child(element, "inertial")) link.inertia = inertia(*inertial, link.name);
    return link;
  }

  std::optional<Inertia> inertia(const Element& element, const std::string& link) {
    Inertia inertia;
    const Pose pose = origin(element);
    const Element* mass = child(element, "mass");
    const Element* matrix = child(element, "inertia");
    for (const auto& [found, name] : {std::pair{mass, "mass"}, std::pair{matrix, "inertia"}})
      if (found == nullptr)
        findings_.error(place(element.at), "U0104", std::string{"<inertial> lacks <"} + name + ">",
                        "add it; a body has mass and inertia, or no <inertial> at all");
    if (mass == nullptr || matrix == nullptr) return std::nullopt;
    inertia.mass = value(*mass, "value", Need::Must).value_or(0);
    if (inertia.mass < 0)
      findings_.error(place(mass->at), "U0305", "the mass of link " + in_quotes(link) + " is negative",
                      "a mass is at least 0");
    const auto entry = [&](std::string_view name) { return value(*matrix, name, Need::Must).value_or(0); };
    const double ixx = entry("ixx"), ixy = entry("ixy"), ixz = entry("ixz"), iyy = entry("iyy"), iyz = entry("iyz"),
                 izz = entry("izz");
    Matrix3 about;
    about << ixx, ixy, ixz, ixy, iyy, iyz, ixz, iyz, izz;
    inertia.centre = pose.position;
    inertia.about_centre = pose.rotation * about * pose.rotation.transpose();
    inertia.about_centre = (inertia.about_centre + inertia.about_centre.transpose().eval()) / 2;
    check(about, inertia.mass, link, place(matrix->at));
    return inertia;
  }

  void check(const Matrix3& about, double mass, const std::string& link, Location at) {
    const double size = about.cwiseAbs().maxCoeff();
    if (!std::isfinite(size)) return;
    const Vector3 principal = Eigen::SelfAdjointEigenSolver<Matrix3>{about, Eigen::EigenvaluesOnly}.eigenvalues();
    if (principal.minCoeff() < -definite_tolerance * size)
      findings_.warning(at, "U0508",
                        "the inertia of link " + in_quotes(link) + " is not positive semi-definite: no body has it",
                        "it is taken as it is where the body that it is part of has an inertia all the same; check "
                        "signs and units (kg m2)");
    else if (principal.maxCoeff() > principal.sum() / 2 * (1 + 1e-3))
      findings_.warning(at, "U0504",
                        "no body has the inertia of link " + in_quotes(link) +
                            ": one principal moment is larger than the sum of the others",
                        "it is taken as it is; a wrong frame or a typing error makes this");
    if (mass == 0 && size > 0)
      findings_.warning(at, "U0506", "link " + in_quotes(link) + " has inertia, but no mass",
                        "it is taken as it is; say what it weighs");
  }

  NamedJoint joint(const Element& element) {
    look_at(element);
    NamedJoint named;
    Joint& joint = named.joint;
    joint.at = place(element.at);
    if (auto name = text(element, "name")) joint.name = *name;
    joint.type = type(element);
    joint.origin = origin(element);
    for (const auto& [name, link, at] :
         {std::tuple{"parent", &named.parent, &named.parent_at}, std::tuple{"child", &named.child, &named.child_at}}) {
      const Element* found = child(element, name);
      if (found == nullptr)
        findings_.error(joint.at, "U0104", "joint " + in_quotes(joint.name) + " lacks <" + name + ">",
                        std::string{"add <"} + name + " link=\"...\"/>");
      else if (auto value = text(*found, "link")) {
        *link = *value;
        *at = place(found->at);
      }
    }
    if (joint.type == JointType::Fixed) {
      if (const Element* mimic = child(element, "mimic"))
        findings_.warning(place(mimic->at), "U0505",
                          "joint " + in_quotes(joint.name) + " is fixed, so its <mimic> has no effect",
                          "remove it, or make the joint one that moves");
      return named;
    }
    axis(element, joint);
    limits(element, joint);
    if (const Element* dynamics = child(element, "dynamics")) {
      for (const auto& [name, to] : {std::pair{"damping", &joint.damping}, std::pair{"friction", &joint.friction}}) {
        *to = value(*dynamics, name, Need::May).value_or(0);
        if (*to < 0)
          findings_.error(place(dynamics->at), "U0307",
                          std::string{"the "} + name + " of joint " + in_quotes(joint.name) +
                              " is negative: it would drive the joint",
                          "it is at least 0");
      }
    }
    if (const Element* mimic = child(element, "mimic")) {
      named.mimic_at = place(mimic->at);
      named.mimicked = text(*mimic, "joint").value_or("");
      joint.mimic =
          Mimic{0, value(*mimic, "multiplier", Need::May).value_or(1), value(*mimic, "offset", Need::May).value_or(0)};
      if (std::abs(joint.mimic->multiplier) < smallest_multiplier)
        findings_.error(named.mimic_at, "U0308",
                        "the multiplier of joint " + in_quotes(joint.name) + " is 0 or next to it",
                        "a joint that never moves is a fixed one");
    }
    return named;
  }

  JointType type(const Element& element) {
    static constexpr std::array<std::pair<std::string_view, JointType>, 4> types{{{"revolute", JointType::Revolute},
                                                                                  {"continuous", JointType::Continuous},
                                                                                  {"prismatic", JointType::Prismatic},
                                                                                  {"fixed", JointType::Fixed}}};
    const auto word = text(element, "type");
    // Whatever it is meant to be, it moves: nothing more is said of it for that.
    if (!word) return JointType::Continuous;
    const auto found = std::ranges::find(types, *word, &std::pair<std::string_view, JointType>::first);
    if (found != types.end()) return found->second;
    const bool known = *word == "floating" || *word == "planar" || *word == "spherical";
    findings_.error(place(element.find("type")->value_at), "U0301",
                    known ? "a joint that is " + in_quotes(*word) + " has several coordinates, which is not supported"
                          : "there is no joint type " + in_quotes(*word),
                    known && *word == "floating" ? "take the link out that it floats from: a base may float as a whole"
                                                 : "revolute, continuous, prismatic or fixed");
    return JointType::Continuous;
  }

  void axis(const Element& element, Joint& joint) {
    const Element* found = child(element, "axis");
    if (found == nullptr) return;
    const Vector3 given = vector(*found, "xyz", Vector3::UnitX());
    const double length = given.norm();
    if (!(length > 0) || !std::isfinite(length)) {
      findings_.error(place(found->at), "U0302", "the axis of joint " + in_quotes(joint.name) + " has no direction",
                      "write a vector of length 1, like 0 0 1");
      return;
    }
    if (std::abs(length - 1) > unit_tolerance)
      findings_.warning(place(found->at), "U0502", "the axis of joint " + in_quotes(joint.name) + " is not of length 1",
                        "its direction is taken");
    joint.axis = given / length;
  }

  void limits(const Element& element, Joint& joint) {
    const Element* found = child(element, "limit");
    const bool turns_on = joint.type == JointType::Continuous;
    if (found == nullptr) {
      if (!turns_on)
        findings_.error(joint.at, "U0303", "joint " + in_quotes(joint.name) + " has no <limit>",
                        "add <limit lower=\"\" upper=\"\" velocity=\"\" effort=\"\"/>, or make it continuous if it "
                        "turns on and on");
      return;
    }
    JointLimits& limits = joint.limits;
    limits.velocity = value(*found, "velocity", Need::Must);
    limits.effort = value(*found, "effort", Need::Must);
    for (const auto& [limit, name] : {std::pair{limits.velocity, "velocity"}, std::pair{limits.effort, "effort"}})
      if (limit && *limit < 0)
        findings_.error(place(found->at), "U0304",
                        std::string{"the limit of "} + name + " of joint " + in_quotes(joint.name) + " is negative",
                        "it is at least 0, and holds both ways");
    for (const auto& [name, limit] : {std::pair{"acceleration", &limits.acceleration},
                                      {"deceleration", &limits.acceleration},
                                      {"jerk", &limits.jerk}}) {
      const auto told = value(*found, name, Need::May);
      if (told && !(*told > 0))
        findings_.error(place(found->at), "U0304",
                        std::string{"the limit of "} + name + " of joint " + in_quotes(joint.name) + " is not above 0",
                        "it holds both ways; leave it out where nobody knows it");
      else if (told) *limit = std::min(limit->value_or(*told), *told);
    }
    const auto lower = value(*found, "lower", Need::May), upper = value(*found, "upper", Need::May);
    if (turns_on) {
      if (lower || upper)
        findings_.warning(place(found->at), "U0505",
                          "joint " + in_quotes(joint.name) + " is continuous, so lower and upper have no effect",
                          "remove them, or make it revolute");
      return;
    }
    if (!lower || !upper)
      findings_.warning(place(found->at), "U0507",
                        "joint " + in_quotes(joint.name) + " has no " +
                            (lower   ? "upper"
                             : upper ? "lower"
                                     : "lower and upper") +
                            " limit: URDF takes 0",
                        "write it");
    limits.lower = lower.value_or(0);
    limits.upper = upper.value_or(0);
    if (*limits.lower > *limits.upper)
      findings_.error(place(found->at), "U0304",
                      "the lower limit of joint " + in_quotes(joint.name) + " is above the upper one", "exchange them");
    if (std::string far = beyond_reason(joint); !far.empty())
      findings_.warning(place(found->at), "U0509", std::move(far), "the file has metres and radians: check the unit");
  }
};

[[nodiscard]] const char* code_of(xml::Refusal refusal) {
  switch (refusal) {
    case xml::Refusal::NotAllowed: return "U0003";
    case xml::Refusal::TooLarge: return "U0004";
    case xml::Refusal::NotWellFormed: break;
  }
  return "U0002";
}

}  // namespace

descriptor::Reading<Robot> Findings::with(Robot robot) && {
  for (auto* list : {&problems_, &warnings_})
    std::ranges::stable_sort(*list, [](const Diagnostic& one, const Diagnostic& other) {
      return std::pair{one.at.line, one.at.column} < std::pair{other.at.line, other.at.column};
    });
  descriptor::Reading<Robot> reading;
  if (problems_.empty()) reading.value = std::move(robot);
  reading.problems = std::move(problems_);
  reading.warnings = std::move(warnings_);
  return reading;
}

descriptor::Reading<Robot> read(const std::filesystem::path& file, std::string_view text) {
  Findings findings{file};
  const auto tree = xml::read_tree(text);
  if (!tree) {
    findings.error(place(tree.error().at), code_of(tree.error().refusal), tree.error().reason,
                   hint_of(tree.error().refusal, tree.error().reason));
    return std::move(findings).with({});
  }
  Robot robot = RobotReader{findings}.read(*tree);
  return std::move(findings).with(std::move(robot));
}

descriptor::Reading<Robot> read(const std::filesystem::path& file, const descriptor::FileSource& source) {
  if (const auto text = source(file)) return read(file, *text);
  else {
    Findings findings{file};
    findings.error({}, "U0001", std::string{"the file cannot be read: "} + text.error().text,
                   "name a regular, readable file of at most 4 MiB");
    return std::move(findings).with({});
  }
}

}  // namespace hirosco::robotics::urdf
