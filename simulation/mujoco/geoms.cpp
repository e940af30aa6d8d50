// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/mujoco/geoms.hpp"

#include <algorithm>
#include <array>

namespace hirosco::simulation {

mjsGeom& add_geom(const Shape& shape, double friction, int priority, mjsBody& body, const std::string& name) {
  mjsGeom& geom = *mjs_addGeom(&body, nullptr);
  if (!name.empty()) mjs_setName(geom.element, name.c_str());
  const auto& sizes = shape.sizes;
  const auto take = [&](mjtGeom type, std::array<double, 3> size) {
    geom.type = type;
    std::ranges::copy(size, geom.size);
  };
  switch (shape.kind) {
    case ShapeKind::Box: take(mjGEOM_BOX, {sizes[0] / 2, sizes[1] / 2, sizes[2] / 2}); break;
    case ShapeKind::Cylinder: take(mjGEOM_CYLINDER, {sizes[0], sizes[1] / 2, 0}); break;
    case ShapeKind::Sphere: take(mjGEOM_SPHERE, {sizes[0], 0, 0}); break;
    case ShapeKind::Plane: take(mjGEOM_PLANE, {0, 0, 1}); break;
    case ShapeKind::Mesh:
      geom.type = mjGEOM_MESH;
      mjs_setString(geom.meshname, shape.mesh.c_str());
      break;
  }
  std::ranges::copy(shape.place_m, geom.pos);
  mju_euler2Quat(geom.quat, shape.turned_rad.data(), "XYZ");
  geom.mass = 0;  // what a link weighs its <inertial> says
  // Without friction it is no cone of almost none, which shakes the solver.
  geom.condim = friction > 0 ? 3 : 1;
  geom.priority = priority;
  geom.friction[0] = friction;
  return geom;
}

}  // namespace hirosco::simulation
