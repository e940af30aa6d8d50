// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/mujoco_urdf.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "hirosco/xml/escaped.hpp"
#include "simulation/mujoco/geoms.hpp"
#include "simulation/mujoco/mesh_pieces.hpp"
#include "simulation/mujoco/mujoco_files.hpp"
#include "simulation/mujoco/rigid_links.hpp"

namespace hirosco::simulation {
namespace {

using xml::Element;

/// Of a joint whose file says nothing.
constexpr double default_effort = 100;
/// How much stiffer friction of a contact is than its normal direction: what stands on a slope creeps by less.
constexpr double friction_stiffness = 10;
/// Links that are nearer to each other where all joints are at 0 are built that way.
constexpr double near_m = 0.01;
/// Of link on link. What touches an obstacle has the obstacle's.
constexpr double link_friction = 0.5;

/// What MuJoCo's reader is given of a file: what moves and has mass. Shapes are read by ourselves: it takes or leaves them in silence.
constexpr std::array known{"robot", "link",   "inertial", "origin", "mass",  "inertia",
                           "joint", "parent", "child",    "axis",   "limit", "dynamics"};

void write(const Element& element, std::string& text) {
  if (std::ranges::find(known, element.name) == known.end()) return;
  text += "<" + element.name;
  for (const auto& [name, value, at, value_at] : element.attributes) {
    if (name.find(':') != std::string::npos) continue;
    text += " " + name + "=\"" + xml::escaped(body_name(value)) + "\"";
  }
  text += ">";
  if (element.name == "robot")
    text += R"(<mujoco><compiler fusestatic="false" balanceinertia="false" boundmass="0" boundinertia="0"/></mujoco>)";
  for (const Element& child : element.children) write(child, text);
  text += "</" + element.name + ">";
}

[[nodiscard]] std::string attribute(const Element& element, std::string_view name) {
  const auto* found = element.find(name);
  return found != nullptr ? found->value : std::string{};
}

[[nodiscard]] double number(const Element& element, std::string_view name, double otherwise) {
  const std::string text = attribute(element, name);
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  return problem == std::errc{} && std::isfinite(value) ? value : otherwise;
}

[[nodiscard]] double effort_of(const Element& joint) {
  const Element* limit = child_of(joint, "limit");
  const double effort = limit != nullptr ? number(*limit, "effort", 0) : 0;
  return effort > 0 ? effort : default_effort;
}

/// In the order of the file.
[[nodiscard]] std::vector<DrivenJoint> driven_joints_of(const Element& robot) {
  std::vector<DrivenJoint> joints;
  for (const Element& element : robot.children)
    if (element.name == "joint" && attribute(element, "type") != "fixed" && child_of(element, "mimic") == nullptr)
      joints.push_back({.name = attribute(element, "name"), .effort = effort_of(element)});
  return joints;
}

/// Who follows whom. It has no drive and no brake of its own.
struct Mimic {
  std::string joint;
  std::string followed;
  double multiplier{1};
  double offset{0};
};

/// As a constraint: MuJoCo knows such joints in no URDF file.
void add_mimic(const Mimic& mimic, mjSpec& spec) {
  mjsEquality& equal = *mjs_addEquality(&spec, nullptr);
  equal.type = mjEQ_JOINT;
  equal.objtype = mjOBJ_JOINT;
  mjs_setString(equal.name1, mimic.joint.c_str());
  mjs_setString(equal.name2, mimic.followed.c_str());
  equal.data[0] = mimic.offset;
  equal.data[1] = mimic.multiplier;
  equal.solref[0] = MujocoSpec::friction_s;
}

mjsMesh& add_hull(const std::string& name, mjSpec& spec) {
  mjsMesh& mesh = *mjs_addMesh(&spec, nullptr);
  mjs_setName(mesh.element, name.c_str());
  mesh.inertia = mjMESH_INERTIA_CONVEX;
  return mesh;
}
void add_mesh(const std::string& name, const std::array<double, 3>& scale, mjSpec& spec) {
  mjsMesh& mesh = add_hull(name, spec);
  mjs_setString(mesh.file, name.c_str());
  std::ranges::copy(scale, mesh.scale);
}
void add_piece(const std::string& name, const MeshPiece& corners, mjSpec& spec) {
  std::vector<float> numbers;
  for (const Corner& corner : corners)
    for (const double number : corner) numbers.push_back(static_cast<float>(number));
  mjs_setFloat(add_hull(name, spec).uservert, numbers.data(), static_cast<int>(numbers.size()));
}

/// Of one with this mesh alone, of which `add` tells it: one that cannot be read would cost the whole robot.
template <class Add>
[[nodiscard]] std::expected<MujocoModel, std::string> compiled_alone(const std::string& name, const Add& add,
                                                                     const std::map<std::string, std::string>& octets) {
  const std::unique_ptr<mjSpec, MujocoFree> trial{mj_makeSpec()};
  add(*trial);
  add_geom({.kind = ShapeKind::Mesh, .mesh = name}, link_friction, 0, *mjs_findBody(trial.get(), "world"));
  MujocoModel model{mj_compile(trial.get(), MujocoFiles{octets}.get())};
  if (model == nullptr) return std::unexpected{error_of(*trial)};
  return model;
}

/// Of the one mesh of such a model, as its file has it, but scaled: MuJoCo has it about its centre and along its main axes, and lets its geom stand there.
[[nodiscard]] std::vector<Facet> surface_of(const mjModel& model) {
  std::array<mjtNum, 9> turned{};
  mju_quat2Mat(turned.data(), model.geom_quat);
  std::vector<Facet> surface(static_cast<std::size_t>(model.mesh_facenum[0]));
  const int* point = model.mesh_face;
  for (Facet& facet : surface)
    for (Corner& corner : facet) {
      const float* own = model.mesh_vert + 3 * std::ptrdiff_t{*point++};
      const std::array<mjtNum, 3> there{own[0], own[1], own[2]};
      mju_mulMatVec3(corner.data(), turned.data(), there.data());
      mju_addTo3(corner.data(), model.geom_pos);
    }
  return surface;
}

[[nodiscard]] std::string name_of(const mjModel& model, int body) {
  const char* name = mj_id2name(&model, mjOBJ_BODY, body);
  return name != nullptr ? name : "";
}

/// The names by which MuJoCo knows a mesh and its pieces then.
struct TakenMesh {
  std::string whole;
  std::vector<std::string> pieces{};
  std::vector<std::string> refused{};  ///< of pieces, why
};

[[nodiscard]] std::expected<TakenMesh, std::string> take_mesh(const Shape& shape, const MeshSource& meshes,
                                                              std::string_view mark, MujocoSpec::Content& made) {
  const auto file = mesh_file(shape.mesh);
  if (!file) return std::unexpected{file.error()};
  if (!meshes) return std::unexpected{shape.mesh + ": nobody reads files here"};
  auto octets = meshes(*file);
  if (!octets) return std::unexpected{shape.mesh + " " + octets.error()};
  const std::string name = fmt::format("{}mesh_{}{}", mark, made.octets.size(), file->substr(file->size() - 4));
  const auto whole = compiled_alone(name, [&](mjSpec& spec) { add_mesh(name, shape.sizes, spec); }, {{name, *octets}});
  if (!whole) return std::unexpected{fmt::format("{}: {}", shape.mesh, whole.error())};
  add_mesh(name, shape.sizes, *made.spec);
  made.octets.emplace(name, std::move(*octets));
  TakenMesh taken{.whole = name};
  for (const MeshPiece& piece : pieces_of(surface_of(**whole))) {
    const std::string piece_name = fmt::format("{} piece {}", name, taken.pieces.size());
    const auto add = [&](mjSpec& spec) { add_piece(piece_name, piece, spec); };
    if (const auto alone = compiled_alone(piece_name, add, {}); !alone) {
      taken.refused.push_back(alone.error());
      continue;
    }
    add(*made.spec);
    taken.pieces.push_back(piece_name);
  }
  return taken;
}

/// Whole for what is no link of this robot, in pieces for its links.
void add_mesh_geoms(Shape shape, const TakenMesh& mesh, mjsBody& body) {
  shape.mesh = mesh.whole;
  mjsGeom& whole = add_geom(shape, link_friction, 0, body);
  whole.contype = of_meshes;
  whole.conaffinity = of_others;
  for (const std::string& name : mesh.pieces) {
    shape.mesh = name;
    mjsGeom& piece = add_geom(shape, link_friction, 0, body);
    piece.contype = piece.conaffinity = of_pieces;
  }
}

void add_shapes(const Element& robot, const MeshSource& meshes, std::string_view mark, MujocoSpec::Content& made) {
  LinkShapes shapes = link_shapes(robot);
  made.left_out = std::move(shapes.left_out);
  for (auto& [link, shape] : shapes.taken) {
    const auto leave_out = [&](const std::string& why) {
      made.left_out.push_back(fmt::format("a shape of link '{}': {}", link, why));
    };
    mjsBody* body = mjs_findBody(made.spec.get(), body_name(link).c_str());
    if (body == nullptr) {
      leave_out("MuJoCo has no such link");
      continue;
    }
    if (shape.kind != ShapeKind::Mesh) {
      add_geom(shape, link_friction, 0, *body).conaffinity = of_links | of_pieces;
      continue;
    }
    const auto mesh = take_mesh(shape, meshes, mark, made);
    if (!mesh) {
      leave_out(mesh.error());
      continue;
    }
    add_mesh_geoms(shape, *mesh, *body);
    if (!mesh->refused.empty())
      made.left_out.push_back(fmt::format("contact of link '{}' with links where {} of {} pieces of {} are: {}", link,
                                          mesh->refused.size(), mesh->refused.size() + mesh->pieces.size(), shape.mesh,
                                          mesh->refused.front()));
  }
}

/// MuJoCo leaves out neighbours by itself, but for those of what stands.
[[nodiscard]] std::expected<void, std::string> leave_out_pairs(MujocoSpec::Content& made) {
  // Itself, no copy: a copy drops without a word what leads nowhere.
  const MujocoModel compiled{mj_compile(made.spec.get(), MujocoFiles{made.octets}.get())};
  if (compiled == nullptr) return std::unexpected{error_of(*made.spec)};
  const mjModel& model = *compiled;
  const MujocoData data{mj_makeData(&model)};
  if (data == nullptr) return std::unexpected{"MuJoCo has no memory for it"};
  for (int joint = 0; joint < model.njnt; ++joint) {
    const double low = model.jnt_range[2 * joint], high = model.jnt_range[2 * joint + 1];
    data->qpos[model.jnt_qposadr[joint]] =
        model.jnt_limited[joint] != 0 && low <= high ? std::clamp(0.0, low, high) : 0;
  }
  mj_kinematics(&model, data.get());
  std::set<std::pair<int, int>> pairs;
  for (int i = 1; i < model.nbody; ++i) {
    const int moved = model.body_weldid[i];
    if (moved == 0 || model.body_weldid[model.body_parentid[moved]] != 0) continue;
    for (int j = 1; j < model.nbody; ++j)
      if (model.body_weldid[j] == 0) pairs.insert(std::minmax({i, j}));
  }
  const auto meet = [&](int one, int other) {
    return (model.geom_contype[one] & model.geom_conaffinity[other]) != 0 ||
           (model.geom_contype[other] & model.geom_conaffinity[one]) != 0;
  };
  // By the balls around them: most are far from each other, and pieces are many.
  const auto may_be_near = [&](int one, int other) {
    return mju_dist3(data->geom_xpos + 3 * one, data->geom_xpos + 3 * other) <
           model.geom_rbound[one] + model.geom_rbound[other] + near_m;
  };
  for (int i = 0; i < model.ngeom; ++i)
    for (int j = i + 1; j < model.ngeom; ++j) {
      const std::pair pair{model.geom_bodyid[i], model.geom_bodyid[j]};
      const int one = model.body_weldid[pair.first], other = model.body_weldid[pair.second];
      const auto carries = [&](int carrier, int carried) {
        return model.body_weldid[model.body_parentid[carried]] == carrier;
      };
      if (one == other || carries(one, other) || carries(other, one)) continue;
      if (!meet(i, j) || pairs.contains(pair) || !may_be_near(i, j) ||
          mj_geomDistance(&model, data.get(), i, j, 2 * near_m, nullptr) > near_m)
        continue;
      pairs.insert(pair);
      made.left_out.push_back(
          fmt::format("contact of links '{}' and '{}', which are at each other where all joints are at 0",
                      name_of(model, pair.first), name_of(model, pair.second)));
    }
  for (const auto& [one, other] : pairs) {
    if (model.body_geomnum[one] == 0 || model.body_geomnum[other] == 0) continue;
    mjsExclude& exclude = *mjs_addExclude(made.spec.get());
    mjs_setString(exclude.bodyname1, name_of(model, one).c_str());
    mjs_setString(exclude.bodyname2, name_of(model, other).c_str());
    ++made.pairs_left_out;
  }
  return {};
}

}  // namespace

std::expected<MujocoSpec, std::string> spec_of_urdf(std::string_view urdf, const MeshSource& meshes,
                                                    std::string_view mark) {
  const auto tree = xml::read_tree(urdf);
  if (!tree) return std::unexpected{"the URDF file: " + tree.error().reason};
  MujocoSpec::Content made;
  made.joints = driven_joints_of(*tree);
  std::vector<std::string> carried, carrying;
  std::vector<Mimic> mimics;
  for (const Element& element : tree->children) {
    if (element.name != "joint") continue;
    if (const Element* parent = child_of(element, "parent")) carrying.push_back(attribute(*parent, "link"));
    if (const Element* carries = child_of(element, "child")) carried.push_back(attribute(*carries, "link"));
    const Element* mimic = child_of(element, "mimic");
    if (mimic == nullptr || attribute(element, "type") == "fixed") continue;
    mimics.push_back({attribute(element, "name"), attribute(*mimic, "joint"), number(*mimic, "multiplier", 1),
                      number(*mimic, "offset", 0)});
  }
  const auto leaf = std::ranges::find_if(
      carried, [&](const std::string& link) { return std::ranges::find(carrying, link) == carrying.end(); });
  for (const Element& element : tree->children)
    if (const std::string link = attribute(element, "name");
        element.name == "link" && std::ranges::find(carried, link) == carried.end())
      made.root = body_name(link);
  std::string text;
  Element joined = *tree;
  join_impossible_links(joined);
  fill_links_between(joined);
  write(joined, text);
  std::array<char, 1000> why{};
  made.spec.reset(mj_parseXMLString(text.c_str(), nullptr, why.data(), why.size()));
  if (made.spec == nullptr) return std::unexpected{std::string{"MuJoCo: "} + why.data()};
  mjSpec& spec = *made.spec;
  spec.option.integrator = mjINT_RK4;
  spec.option.timestep = MujocoSpec::longest_sub_step_s;
  spec.option.cone = mjCONE_ELLIPTIC;
  spec.option.impratio = friction_stiffness;
  spec.compiler.usethread = 0;
  if (leaf != carried.end() && *leaf != MujocoSpec::payload_body)
    static_cast<void>(hang_payload(spec, body_name(*leaf), MujocoSpec::payload_body));
  for (const Mimic& mimic : mimics) add_mimic(mimic, spec);
  made.further_dofs = made.equalities = mimics.size();
  add_shapes(*tree, meshes, mark, made);
  if (auto done = leave_out_pairs(made); !done) return std::unexpected{std::move(done.error())};
  return MujocoSpec{std::move(made)};
}

std::expected<std::vector<DrivenJoint>, std::string> driven_joints(std::string_view urdf) {
  const auto tree = xml::read_tree(urdf);
  if (!tree) return std::unexpected{"the URDF file: " + tree.error().reason};
  return driven_joints_of(*tree);
}

}  // namespace hirosco::simulation
